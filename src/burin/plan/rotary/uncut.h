// SPDX-License-Identifier: Apache-2.0
// What is left at contact points that are not cut. Private to plan/rotary.
#pragma once

#include <vector>

#include "burin/plan/rotary/rotary.h"

namespace burin::rotary {

/// Sets `excess_mm` of the unreachable points: how far the nearest cut (poses joined by chords) keeps the
/// ball from them. The largest of them and of `more` contact points, 0 when there is none.
double uncut_excess(RotaryPlan& plan, const std::vector<geom::Point3>& more, double radius);

}  // namespace burin::rotary
