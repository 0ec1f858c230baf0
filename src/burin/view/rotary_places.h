// SPDX-License-Identifier: Apache-2.0
// What the pictures of a rotary plan show: sections, places left, the axis as it would be without smoothing.
// Private to view. mm, radians.
#pragma once

#include <cstddef>
#include <vector>

#include "burin/plan/rotary/rotary.h"

namespace burin::view {

/// A section that can be looked at. `path` is the ring that lies in it, -1 where the paths cross it.
struct SectionPlace {
  double x = 0;
  int path = -1;
};
/// Rings: all of them, or as many as allowed, evenly. Else: evenly along the part.
std::vector<SectionPlace> section_places(const rotary::Part& part, const rotary::RotaryPlan& plan,
                                         rotary::Pattern pattern, std::size_t most);

/// Points that belong to a section: those of its ring; else of every path that comes within `half_mm` of it
/// the one nearest (lines) or all within (spiral). Numbers into plan.points, ascending.
std::vector<std::size_t> section_points(const rotary::RotaryPlan& plan, rotary::Pattern pattern,
                                        const SectionPlace& place, double half_mm);

/// Neighbouring points of a path that were moved, or not reached: first and last, numbers into plan.points.
struct LeftPlace {
  std::size_t path = 0, first = 0, last = 0;
  rotary::State state = rotary::State::moved;
  double excess_mm = 0;   ///< the most that is left
  std::size_t worst = 0;  ///< where
};
/// Unreachable ones first, then by what is left.
std::vector<LeftPlace> left_places(const rotary::RotaryPlan& plan);

/// The reachable angle nearest to the paper's first axis: what each point would choose on its own. Where
/// nothing is reachable, the first axis.
double unsmoothed(const rotary::RotaryPoint& point, double clearance);

}  // namespace burin::view
