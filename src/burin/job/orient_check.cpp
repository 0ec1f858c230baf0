// SPDX-License-Identifier: Apache-2.0
#include "burin/job/orient_check.h"

#include <algorithm>
#include <string>
#include <vector>

#include "burin/verify/path.h"

namespace burin::job {
namespace {

/// `record_of(i)`: what record i of the program that `path` was made of stands for.
template <class RecordOf>
Result<OrientCheck> check(const orient::Part& part, const Result<verify::CheckedPath>& path,
                          const OrientCheckOptions& options, RecordOf&& record_of) {
  if (!path) return path.error();
  const auto report = verify::check_mill(
      part.mesh, *path, {.resolution_mm = options.resolution_mm, .threads = options.threads});
  if (!report) return report.error();
  OrientCheck out{report->cutter, report->holder, report->bound_mm + part.deflection_mm, path->moves.size()};
  for (verify::MillFinding* f : {&out.cutter, &out.holder})
    if (f->mm > 0) f->move = record_of(path->moves[f->move].record);
  return out;
}

verify::ToolSource source(const model::Mill& mill) {
  return [mill](const cl::ToolChange&) -> Result<verify::CheckedMill> {
    if (auto ok = model::validate(mill); !ok) return ok.error();
    return checked_mill(mill);
  };
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
  return check(part, verify::make_checked_path(program, source(mill), {.motion_mm = options.motion_mm}),
               options, [](std::size_t record) { return record; });
}

Result<OrientCheck> check_orient_job(const orient::Part& part, const model::Mill& mill,
                                     const kinematics::Kinematics& machine, const kinematics::JointPath& path,
                                     const OrientCheckOptions& options) {
  cl::Program program;
  std::vector<kinematics::Joints> joints;
  for (const kinematics::JointMove& move : path.moves) {
    const cl::Pose to = machine.forward(move.to);
    if (move.rapid)
      program.add(cl::Rapid{to});
    else
      program.add(cl::Feed{to});
    joints.push_back(move.to);
  }
  return check(
      part,
      verify::make_checked_path(program, joints, {}, machine, source(mill), {.motion_mm = options.motion_mm}),
      options, [&](std::size_t i) { return path.moves[i].record; });
}

}  // namespace burin::job
