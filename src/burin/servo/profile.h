// SPDX-License-Identifier: Apache-2.0
// Limits along the run -> feed profile of piecewise constant jerk, from rest to rest. Part of the planner;
// the method and its proof are in docs/servo.md.
#pragma once

#include <vector>

#include "burin/servo/plan.h"

namespace burin::servo {

/// On [begin, end] (a point when equal) at most speed v and tangential acceleration a.
struct LimitSpan {
  double begin = 0, end = 0;
  double v = 0, a = 0;
};

/// A motion of piecewise constant acceleration: knots (t, s, v), between them v changes evenly.
struct RawKnot {
  double t = 0, s = 0, v = 0;
};

/// The fastest motion over [0, total] within the limits, widened so that its mean over any window of tau
/// seconds keeps them too, and with tau seconds of steady speed between speeding up and slowing down.
std::vector<RawKnot> raw_profile(const std::vector<LimitSpan>& spans, double total, double tau);

/// Its mean over the last tau seconds: jerk at most a / tau. Ends at rest at exactly `total`.
std::vector<ProfilePiece> smooth_profile(const std::vector<RawKnot>& raw, double total, double tau);

}  // namespace burin::servo
