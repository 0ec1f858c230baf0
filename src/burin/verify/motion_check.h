// SPDX-License-Identifier: Apache-2.0
// Gouge and excess of a tool moved by a machine: every move, cutting or not, as its joints run (linearly),
// against samples of the design surface. Ball, shank and holder. Uses nothing of plan/. mm, radians.
//
// Bound of the check: a design point nobody asked about lies within `spacing` of a sample, and the motion
// between two places looked at is bent by at most `motion_mm`; a gouge is therefore deeper than reported by
// at most
//   bound = spacing^2 / (4 r) + motion_mm + deflection,   r the least radius of ball, shank and holder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "burin/geom/mesh/mesh.h"
#include "burin/kinematics/kinematics.h"

namespace burin::verify {

struct DesignSample {
  geom::Point3 p;
  bool machined = true;  ///< false: must not be cut, but is not expected to be reached (end faces)
};

/// Points on the triangles, no place of a triangle farther than spacing / sqrt(2) from one. `machined[t]`
/// says it for triangle t; empty: all are. More than `max_samples` make the spacing wider: the spacing used
/// comes back.
struct SampledDesign {
  std::vector<DesignSample> samples;
  double spacing_mm = 0;
};
SampledDesign sample_mesh(const geom::Mesh& mesh, const std::vector<bool>& machined, double spacing_mm,
                          std::size_t max_samples = 20'000'000);

/// A cylinder about the tool axis, heights from the ball's centre upwards.
struct ToolCylinder {
  double radius = 0, from = 0, to = 0;
  bool holder = false;
};
struct BallEndTool {
  double radius = 0;
  std::vector<ToolCylinder> cylinders;  ///< shank and holder pieces
};

/// From where the move before ended. `cutting` false: rapids and ways through the air, which remove nothing
/// wanted but may gouge all the same.
struct CheckedMove {
  kinematics::Joints to;  ///< of the tip
  bool cutting = true;
};

struct MotionCheckOptions {
  double motion_mm = 0.0005;
  double window_mm = 20;  ///< excess beyond this is reported as this
};

struct Finding {
  double mm = 0;  ///< depth, 0 when there is none
  geom::Point3 at;
  std::size_t move = 0;  ///< index into the moves
};
struct MotionCheckReport {
  Finding ball, shank, holder;  ///< deepest gouges
  double excess_max_mm = 0;     ///< left standing on machined samples, cusps included
  geom::Point3 excess_at;
  std::vector<float>
      deviation_mm;     ///< a sample: negative cut away (any part of the tool), positive left standing
  double bound_mm = 0;  ///< without the deflection of the mesh, which the caller knows
  double gouge_max_mm() const;
};

/// moves.front() is where the motion begins.
MotionCheckReport check_motion(const SampledDesign& design, const std::vector<CheckedMove>& moves,
                               const kinematics::Kinematics& machine, const BallEndTool& tool,
                               const MotionCheckOptions& options);

}  // namespace burin::verify
