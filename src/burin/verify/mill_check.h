// SPDX-License-Identifier: Apache-2.0
// How deep a moving mill (ball, flat or bull end, shank, holder) gets into triangles. Uses nothing of plan/:
// a check must not share the planner's mistakes. mm, radians. docs/verify-mill.md
//
// The depth of a place in a piece of the tool is its distance to the surface of that piece. It is a concave
// function of the place, so that boxes and triangles over pieces of the motion are bounded from above by one
// evaluation, and a search from the whole to the detail ends with proof: the deepest gouge of all places of
// all triangles at all moments is at most
//   finding + bound_mm,   bound = resolution + motion_mm of the path.
// Nothing is sampled. How far the triangles are from the true surface (their deflection) comes on top; the
// caller knows it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "burin/base/result.h"
#include "burin/geom/mesh/mesh.h"
#include "burin/kinematics/kinematics.h"
#include "burin/verify/motion_check.h"

namespace burin::verify {

/// Heights above the tip, which is the lowest point of the axis. corner_radius 0: flat; radius: a ball.
struct CheckedMill {
  double radius = 0, corner_radius = 0;
  double length = 0;                    ///< of the cutter
  std::vector<ToolCylinder> cylinders;  ///< shank and holder; heights from the tip, too
};

struct MillCheckOptions {
  double resolution_mm = 0.001;
  unsigned threads = 1;  ///< 0: as many as there are; the result is the same for any number
};

struct MillFinding {
  double mm = 0;  ///< depth, 0 when there is none
  geom::Point3 at;
  std::size_t move = 0;  ///< GOTO number
  std::uint32_t triangle = 0;
};
struct MillCheckReport {
  MillFinding cutter, shank, holder;
  double bound_mm = 0;
  std::uint64_t evaluations = 0;
  double gouge_max_mm() const;
};

struct CheckedPath;
/// Errors: numbers of tools or options that are not finite and positive, a corner beyond radius or length
/// (range); a motion or a triangle that is not finite, an axis that is not a unit vector, a half turn of the
/// axis, which has no great circle (geometry; names the move); vertices that do not exist.
Result<MillCheckReport> check_mill(const geom::Mesh& mesh, const CheckedPath& path,
                                   const MillCheckOptions& options = {});

}  // namespace burin::verify
