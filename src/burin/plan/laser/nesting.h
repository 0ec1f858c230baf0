// SPDX-License-Identifier: Apache-2.0
// Which path lies inside which. Internal to the laser planner.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/plan/laser/profile.h"

namespace burin::laser::detail {

inline constexpr std::uint32_t kNoParent = 0xffffffffu;

/// For every path the smallest closed cut path that contains it, kNoParent when there is none. Engraved paths
/// contain nothing and are contained by nothing (they are done first of all). Paths may touch. A parent has a
/// larger area than its child, so there are no cycles. O(n log n) and the number of segments level with a
/// path.
std::vector<std::uint32_t> path_parents(const std::vector<CutPath>& paths, double point_mm);

}  // namespace burin::laser::detail
