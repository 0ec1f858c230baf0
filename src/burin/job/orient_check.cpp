// SPDX-License-Identifier: Apache-2.0
#include "burin/job/orient_check.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace burin::job {
namespace {

/// `records[i]`: of the move that ends in the motion's place i.
Result<OrientCheck> check(const orient::Part& part, const model::Mill& mill, const verify::MillMotion& motion,
                          const std::vector<std::size_t>& records, const OrientCheckOptions& options) {
  if (auto ok = model::validate(mill); !ok) return ok.error();
  const auto report = verify::check_mill(
      part.mesh, checked_mill(mill), motion,
      {.resolution_mm = options.resolution_mm, .motion_mm = options.motion_mm, .threads = options.threads});
  if (!report) return report.error();
  OrientCheck out{report->cutter, report->holder, report->bound_mm + part.deflection_mm,
                  records.empty() ? 0 : records.size() - 1};
  for (verify::MillFinding* f : {&out.cutter, &out.holder})
    if (f->mm > 0) f->move = records[f->move];
  return out;
}

}  // namespace

double OrientCheck::gouge_max_mm() const {
  return std::max(cutter.mm, holder.mm);
}

verify::CheckedMill checked_mill(const model::Mill& mill) {
  verify::CheckedMill out{
      mill.radius, mill.kind == model::MillKind::bull ? mill.corner_radius : 0, mill.length, {}};
  double from = mill.length;
  for (const model::HolderPiece& piece : mill.holder) {
    out.cylinders.push_back({piece.radius, from, from + piece.height, true});
    from += piece.height;
  }
  return out;
}

Result<OrientCheck> check_orient_job(const orient::Part& part, const model::Mill& mill,
                                     const cl::Program& program, const OrientCheckOptions& options) {
  verify::PoseMotion poses;
  std::vector<std::size_t> records;
  if (program.from) poses.push_back(*program.from), records.push_back(0);
  for (std::size_t i = 0; i < program.records.size(); ++i) {
    if (std::holds_alternative<cl::Arc>(program.records[i]))
      return Error{ErrorCode::unsupported,
                   "record " + std::to_string(i) + " is an arc (straight moves of the tip can be checked)",
                   {}};
    if (const cl::Pose* pose = cl::pose_of(program.records[i])) poses.push_back(*pose), records.push_back(i);
  }
  return check(part, mill, std::move(poses), records, options);
}

Result<OrientCheck> check_orient_job(const orient::Part& part, const model::Mill& mill,
                                     const kinematics::Kinematics& machine, const kinematics::JointPath& path,
                                     const OrientCheckOptions& options) {
  verify::JointMotion motion{&machine, {}};
  std::vector<std::size_t> records;
  for (const kinematics::JointMove& move : path.moves) {
    motion.joints.push_back(move.to);
    records.push_back(move.record);
  }
  return check(part, mill, std::move(motion), records, options);
}

}  // namespace burin::job
