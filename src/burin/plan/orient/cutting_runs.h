// SPDX-License-Identifier: Apache-2.0
// Oriented points -> runs of feed moves that keep within the allowed set on the way. Internal to
// plan/orient.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/plan/orient/motion_check.h"
#include "burin/plan/orient/orient.h"

namespace burin::orient {

struct RunPoint {
  cl::Pose pose;
  geom::Vec3 normal;         ///< of the surface there
  std::uint32_t source = 0;  ///< index over all points of all paths; of a point between: of the next
};
using Run = std::vector<RunPoint>;  ///< at least one point

struct Runs {
  std::vector<Run> runs;
  std::vector<std::size_t> broken;  ///< points whose feed move to the next had to be given up
};

/// Unreachable points and the ends of paths end a run. One path is one task of `threads`.
Runs cutting_runs(const Scene& scene, const MotionCheck& check, const std::vector<OrientedPath>& paths,
                  unsigned threads);

}  // namespace burin::orient
