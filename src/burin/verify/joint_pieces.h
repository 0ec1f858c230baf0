// SPDX-License-Identifier: Apache-2.0
// A move whose axes run evenly, as pieces on which the tip goes straight and the tool axis turns evenly along
// the great circle. Internal to verify. mm, radians.
//
// At the same time of piece and move a place of the tool, a body of revolution, lies off by at most
//   e(t) = |p - p^| + span |u - u^|        (span: no place of the tool is farther from the tip)
// e is 0 at both ends of a piece. What is measured in the middle and a bound M of the third derivatives of
// both differences bound it between: the parabola through the ends and the middle misses by at most
// M h^3 sqrt(3)/216, h the length of the piece.
#pragma once

#include <vector>

#include "burin/base/result.h"
#include "burin/kinematics/kinematics.h"

namespace burin::verify {

struct JointWay {
  const kinematics::Kinematics* machine = nullptr;
  kinematics::Joints from, to;
  /// Under G43.4: the rotary axes run evenly, the tip straight on the part.
  bool tip_straight = false;

  /// Where the tool is at t from 0 to 1.
  cl::Pose at(double t) const;
};

struct JointPieces {
  std::vector<cl::Pose> ends;  ///< of the pieces, the last is at(1)
  double motion_mm = 0;        ///< no place of the tool leaves its way by more
};
/// As few equal pieces as keep `motion_mm`. Error (range): more than `most` are needed.
Result<JointPieces> split_joint_way(const JointWay& way, double span, double motion_mm, std::size_t most);

}  // namespace burin::verify
