// SPDX-License-Identifier: Apache-2.0
// The same faces milled in other ways at the same scallop. Internal to plan/orient.
#pragma once

#include "burin/plan/orient/path_task.h"

namespace burin::orient {

/// The least tilt at yaw 0 that suits all points which any angles suit, and how many it does not suit (when
/// no tilt of the range suits all: the one of a grid that suits most).
struct SturzTilt {
  double tilt = 0;
  std::size_t unreachable = 0;
};
SturzTilt sturz_tilt(const Setting& setting, const std::vector<OrientedPath>& paths, Workers& workers);

/// Largest curvature of the faces towards the tool decides the ball.
Comparison compare_sturz(const std::vector<PathFamily>& families, const model::Mill& mill,
                         const OrientOptions& options, const SturzTilt& tilt);
Comparison compare_ball(const std::vector<PathFamily>& families, const std::vector<OrientedPath>& paths,
                        const model::Mill& mill, const OrientOptions& options);

/// Length of a path's polyline.
double length_of(const std::vector<CcPoint>& points);

}  // namespace burin::orient
