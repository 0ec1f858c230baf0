// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/mill_motion.h"

#include <string>

#include "burin/geom/point_tools.h"

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

// An axis may be so far from a unit vector.
constexpr double kUnit = 1e-6;
// Axes nearer to opposite than this have no great circle that rounding does not choose.
constexpr double kOpposite = 1e-9;
constexpr double kMostPieces = 1e6;

/// How far from the rotary axes places of the part can be when the tool touches them.
double reach_of(const geom::Mesh& mesh, const kinematics::Kinematics& machine, double span) {
  geom::Box3 box;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) box.add(mesh.vertices[v]);
  double most = 0, apart = 0;
  for (int i = 0; i < machine.rotary_count(); ++i) {
    const model::Axis& axis = machine.rotary_axis(i);
    if (i > 0) apart = distance(axis.point, machine.rotary_axis(i - 1).point);
    if (axis.side == model::AxisSide::table) {
      // What an axis between turned first has kept its distance from that one.
      for (int corner = 0; corner < 8 && !box.empty(); ++corner)
        most = std::max(most, distance(axis.point, Point3{corner & 1 ? box.lo.x : box.hi.x,
                                                          corner & 2 ? box.lo.y : box.hi.y,
                                                          corner & 4 ? box.lo.z : box.hi.z}));
    } else {
      most = std::max(most, machine.machine().pivot_length + span);
    }
  }
  return most + apart;
}

Error wrong_move(std::size_t move, const std::string& what) {
  return {ErrorCode::geometry, "move " + std::to_string(move) + ": " + what, {}};
}

}  // namespace

Stretch Stretch::between(const cl::Pose& a, const cl::Pose& b) {
  Stretch s;
  s.from = {a.tip, unit(a.axis)};
  s.way = b.tip - a.tip;
  const Vec3 to = unit(b.axis), normal = cross(s.from.axis, to);
  const double sine = norm(normal);
  if (sine > 0) {
    s.angle = std::atan2(sine, dot(s.from.axis, to));
    s.turn = (s.angle / sine) * normal;
    s.across = cross((1 / sine) * normal, s.from.axis);
  }
  return s;
}

StretchedMotion::StretchedMotion(const geom::Mesh& mesh, const MillMotion& motion, double span,
                                 double motion_mm)
    : poses_(std::get_if<PoseMotion>(&motion)),
      joints_(std::get_if<JointMotion>(&motion)),
      motion_mm_(motion_mm) {
  if (joints_ && joints_->machine) reach_ = reach_of(mesh, *joints_->machine, span);
}

Result<void> validate_pose(const cl::Pose& pose, std::size_t move) {
  if (!is_finite(pose.tip) || !is_finite(pose.axis)) return wrong_move(move, "a pose that is not finite");
  if (std::abs(norm(pose.axis) - 1) > kUnit) return wrong_move(move, "the tool axis is no unit vector");
  return {};
}
Result<void> validate_turn(const cl::Pose& from, const cl::Pose& to, std::size_t move) {
  if (dot(from.axis, to.axis) < 0 && norm(cross(from.axis, to.axis)) < kOpposite)
    return wrong_move(move,
                      "the axis turns by half a turn, which no great circle decides (put a pose between)");
  return {};
}

Result<void> StretchedMotion::validate() const {
  if (joints_) {
    if (!joints_->machine) return Error{ErrorCode::usage, "joint moves need a machine", {}};
    for (std::size_t i = 0; i < joints_->joints.size(); ++i) {
      for (const double x : joints_->joints[i].linear)
        if (!std::isfinite(x)) return wrong_move(i, "a position that is not finite");
      for (const double x : joints_->joints[i].rotary)
        if (!std::isfinite(x)) return wrong_move(i, "a position that is not finite");
    }
    return {};
  }
  for (std::size_t i = 0; i < poses_->size(); ++i) {
    if (auto ok = validate_pose((*poses_)[i], i); !ok) return ok.error();
    if (i > 0)
      if (auto ok = validate_turn((*poses_)[i - 1], (*poses_)[i], i); !ok) return ok.error();
  }
  return {};
}

kinematics::Joints StretchedMotion::between(const kinematics::Joints& a, const kinematics::Joints& b,
                                            double t) {
  kinematics::Joints j;
  for (std::size_t i = 0; i < 3; ++i) j.linear[i] = a.linear[i] + t * (b.linear[i] - a.linear[i]);
  for (std::size_t i = 0; i < 2; ++i) j.rotary[i] = a.rotary[i] + t * (b.rotary[i] - a.rotary[i]);
  return j;
}

/// Joint motion and stretch agree at the ends of each piece; between they differ by at most an eighth of
/// their second differences. A place of the part, seen from the tool, has reach turn^2 + 2 turn travel of it
/// in the joint motion (turn: of both axes together); in the stretch, spinning about the tool axis added so
/// that both agree, at most four times that.
int StretchedMotion::pieces(const kinematics::Joints& from, const kinematics::Joints& to) const {
  double turn = 0, travel = 0;
  for (std::size_t i = 0; i < 2; ++i) turn += std::abs(to.rotary[i] - from.rotary[i]);
  for (std::size_t i = 0; i < 3; ++i) travel = std::hypot(travel, to.linear[i] - from.linear[i]);
  const double bend = 5 * (reach_ * turn * turn + 2 * turn * travel) / 8;
  return static_cast<int>(std::clamp(std::ceil(std::sqrt(bend / motion_mm_)), 1.0, kMostPieces));
}

}  // namespace burin::verify
