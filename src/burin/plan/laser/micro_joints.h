// SPDX-License-Identifier: Apache-2.0
// Places where a closed contour is not cut, so that the part stays in the sheet. Internal to the laser
// planner.
#pragma once

#include <vector>

#include "burin/plan/laser/options.h"
#include "burin/plan/laser/strokes.h"

namespace burin::laser::detail {

struct JointPlan {
  std::vector<Span> gaps;  ///< beam off; sorted, disjoint, none over the ends of the path
  int missing = 0;         ///< for which there was no place
};

/// Gaps of `gap_mm` on a closed path of `length`, spread evenly (the first half a pitch after the start),
/// each moved along the path by less than half a pitch to keep out of `zones` (corners; sorted and disjoint)
/// and of the first and last `margin_mm`.
JointPlan plan_joints(double length, int count, double gap_mm, const std::vector<Span>& zones,
                      double margin_mm);

}  // namespace burin::laser::detail
