// SPDX-License-Identifier: Apache-2.0
#include "burin/job/orient_check.h"

#include <algorithm>

namespace burin::job {
namespace {

/// Shares of the tolerance by which the check may be wrong: searching, and straightening joint moves.
constexpr double kResolutionShare = 0.05, kMotionShare = 0.05;

verify::CheckedMill checked(const model::Mill& mill) {
  verify::CheckedMill tool{mill.radius, mill.corner_radius, mill.length, {}};
  double z = mill.length;
  for (const model::HolderPiece& piece : mill.holder) {
    tool.cylinders.push_back({piece.radius, z, z + piece.height, true});
    z += piece.height;
  }
  return tool;
}

}  // namespace

Result<verify::MillCheckReport> check_orient_motion(const orient::Part& part, const model::Mill& mill,
                                                    const cl::Program& program,
                                                    const kinematics::Kinematics* machine,
                                                    const kinematics::JointPath* joints,
                                                    double tolerance_mm, unsigned threads) {
  verify::MillMotion motion;
  if (joints != nullptr) {
    verify::JointMotion moves{machine, {}};
    for (const kinematics::JointMove& move : joints->moves) moves.joints.push_back(move.to);
    if (moves.joints.empty()) return verify::MillCheckReport{};
    motion = std::move(moves);
  } else {
    verify::PoseMotion poses;
    for (const cl::Record& record : program.records)
      if (const cl::Pose* pose = cl::pose_of(record)) poses.push_back(*pose);
    if (poses.empty()) return verify::MillCheckReport{};
    motion = std::move(poses);
  }
  return verify::check_mill(part.mesh, checked(mill), motion,
                            {kResolutionShare * tolerance_mm, kMotionShare * tolerance_mm, threads});
}

}  // namespace burin::job
