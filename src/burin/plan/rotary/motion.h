// SPDX-License-Identifier: Apache-2.0
// Whether the tool gouges while the machine moves from one pose to the next with its joints running linearly:
// not only at the CL points. mm, radians, part frame.
//   tip in machine coordinates  p' = Rx(theta) p;  joints (x, y', z', theta) run linearly
#pragma once

#include "burin/geom/mesh/mesh_index.h"
#include "burin/model/tool.h"
#include "burin/plan/rotary/body_index.h"
#include "burin/plan/rotary/swept_distance.h"

namespace burin::rotary {

struct AxisPose {
  geom::Point3 center;  ///< of the ball, part frame
  double theta = 0;     ///< unwrapped
};
/// The pose at t in [0, 1] of the joint-linear move.
AxisPose between(const AxisPose& from, const AxisPose& to, double t);
geom::Point3 tip_of(const AxisPose& pose, double radius);

struct MotionOptions {
  double tolerance_mm = 0.01;  ///< nothing goes deeper than this
  /// What is allowed for the ball, when other than tolerance_mm (links and rapids: less than 0 keeps a
  /// distance).
  double ball_mm = 0.01;
  /// How far the mesh may leave the part: both allowances are kept against the part.
  double deflection_mm = 0;
  /// The part itself, asked where the mesh does not decide about the ball; may be null.
  const SweptDistance* design = nullptr;
};
struct MoveCheck {
  bool clear = false;
  double at = 0;          ///< t of the first place found to gouge
  double ball_depth = 0;  ///< deepest that the ball sinks in, upper bound
};
/// Conservative: `clear` is a proof within the tolerance.
MoveCheck check_move(const AxisPose& from, const AxisPose& to, const BodyIndex& body,
                     const geom::MeshIndex& part, const model::BallTool& tool, const MotionOptions& options);

}  // namespace burin::rotary
