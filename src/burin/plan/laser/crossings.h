// SPDX-License-Identifier: Apache-2.0
// Closed outlines that cross themselves or each other, and how deep. Internal to the laser planner.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/geom/curve/arc_spline.h"

namespace burin::laser::detail {

struct CrossingReport {
  std::uint32_t first = 0, second = 0;  ///< outlines; equal for a self-crossing; first < second otherwise
  bool deep = false;                    ///< deeper than the tolerance
  geom::Point2 position;
};

/// Every pair of closed outlines (and every single one) that crosses, sorted by (first, second). Outlines
/// that touch, in points or along stretches, within `point_mm` do not cross. Crossings shallower than
/// `tolerance_mm` are reported with deep = false. Open outlines are passed over. Cost O(n log n + meetings).
std::vector<CrossingReport> find_crossings(const std::vector<geom::ArcSpline>& outlines, double tolerance_mm,
                                           double point_mm);

}  // namespace burin::laser::detail
