// SPDX-License-Identifier: Apache-2.0
// What is left at contact points that are not cut. Private to plan/rotary.
#pragma once

#include "burin/plan/rotary/rotary.h"

namespace burin::rotary {

/// Sets `excess_mm` of the unreachable points: how far the nearest cut (poses joined by chords) keeps the
/// ball from them. The largest of them, 0 when there is none.
double uncut_excess(RotaryPlan& plan, double radius);

}  // namespace burin::rotary
