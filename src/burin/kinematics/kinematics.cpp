// SPDX-License-Identifier: Apache-2.0
#include "burin/kinematics/kinematics.h"

#include <algorithm>
#include <cmath>

#include "burin/base/text.h"

namespace burin::kinematics {
namespace {

using geom::dot;
using geom::Point3;
using geom::Vec3;

constexpr Vec3 kUp{0, 0, 1};
// Directions in machine files have this much rounding.
constexpr double kDirection = 1e-9;
// Sine of the angle to the first rotary axis below which that axis does not matter: the tool axis goes astray
// by at most twice that, 1e-9, whatever the first axis does.
constexpr double kSingular = 5e-10;
// A tool axis is unreachable when it misses what the machine can do by more than this (CL files keep 1e-6).
constexpr double kReach = 5e-6;
// Beyond a limit by less than the control's resolution is not beyond it.
constexpr double kLimitSlack = 1e-6;

/// Angle of `to` against `from` about `axis`, after both are projected along it.
double angle_about(Vec3 axis, Vec3 from, Vec3 to) {
  const Vec3 a = from - dot(axis, from) * axis, b = to - dot(axis, to) * axis;
  return std::atan2(dot(axis, geom::cross(a, b)), dot(a, b));
}

/// By whole turns next to `near`, then into the limits if a whole turn does it.
double placed(double angle, double near, const model::Axis& axis) {
  const double turn = 2 * geom::kPi;
  double best = angle + turn * std::round((near - angle) / turn);
  const double lo = geom::radians(axis.min) - kLimitSlack, hi = geom::radians(axis.max) + kLimitSlack;
  if (best > hi) best -= turn * std::ceil((best - hi) / turn);
  if (best < lo) best += turn * std::ceil((lo - best) / turn);
  return best;
}

Error unsupported(const std::string& machine, const std::string& what) {
  return Error{ErrorCode::unsupported, "machine " + machine + ": " + what, {}};
}

}  // namespace

Vec3 turned(Vec3 v, Vec3 axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return c * v + s * geom::cross(axis, v) + ((1 - c) * dot(axis, v)) * axis;
}

std::string LimitViolation::text() const {
  const bool rotary = letter >= 'A' && letter <= 'C';
  return std::string(1, letter) + " " + format_fixed(value, 3) + (rotary ? " deg" : " mm") + " (" +
         format_shortest(min) + " to " + format_shortest(max) + ")";
}

Result<Kinematics> Kinematics::make(const model::Machine& machine) {
  Kinematics k;
  k.machine_ = machine;
  constexpr std::array<Vec3, 3> kFrame = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  bool head = false;
  for (const model::Axis& axis : machine.axes) {
    const std::string letter(1, axis.letter);
    if (axis.kind == model::AxisKind::linear) {
      const std::size_t i = static_cast<std::size_t>(axis.letter - 'X');
      if (i > 2 || norm(axis.direction - kFrame[i]) > kDirection)
        return unsupported(machine.name, "linear axis " + letter + " (X, Y or Z along its own direction)");
      if (k.linear_[i]) return unsupported(machine.name, "two axes " + letter + " (one)");
      k.linear_[i] = axis;
      continue;
    }
    if (k.rotary_count_ == 2) return unsupported(machine.name, "more than two rotary axes (two)");
    const bool in_head = axis.side == model::AxisSide::head;
    if (head && !in_head)
      return unsupported(machine.name, "table axis " + letter + " behind a head axis (table axes first)");
    if (in_head && norm(axis.point - Point3{}) > kDirection)
      return unsupported(
          machine.name,
          "head axis " + letter + " beside the spindle (point = [0, 0, 0], distance as pivot_length)");
    head = in_head;
    k.rotary_[static_cast<std::size_t>(k.rotary_count_++)] = axis;
  }
  for (std::size_t i = 0; i < 3 && k.rotary_count_ > 0; ++i)
    if (!k.linear_[i])
      return unsupported(machine.name, "no axis " + std::string(1, static_cast<char>('X' + i)) +
                                           " (X, Y and Z beside rotary axes)");
  if (k.rotary_count_ == 2 && norm(geom::cross(k.rotary_[0].direction, k.rotary_[1].direction)) < 1e-6)
    return unsupported(machine.name, "two rotary axes in the same direction (different ones)");
  return k;
}

double Kinematics::sign(int i) const {
  return rotary_axis(i).side == model::AxisSide::table ? -1 : 1;
}

bool Kinematics::table_only() const {
  for (int i = 0; i < rotary_count_; ++i)
    if (rotary_axis(i).side == model::AxisSide::head) return false;
  return true;
}

Point3 Kinematics::to_machine(Point3 p, const std::array<double, 2>& rotary) const {
  for (int i = 0; i < rotary_count_; ++i) {
    const model::Axis& axis = rotary_axis(i);
    if (axis.side == model::AxisSide::table)
      p = axis.point + turned(p - axis.point, axis.direction, rotary[static_cast<std::size_t>(i)]);
  }
  return p;
}

Point3 Kinematics::to_part(Point3 p, const std::array<double, 2>& rotary) const {
  for (int i = rotary_count_ - 1; i >= 0; --i) {
    const model::Axis& axis = rotary_axis(i);
    if (axis.side == model::AxisSide::table)
      p = axis.point + turned(p - axis.point, axis.direction, -rotary[static_cast<std::size_t>(i)]);
  }
  return p;
}

Vec3 Kinematics::head_axis(const std::array<double, 2>& rotary) const {
  Vec3 u = kUp;
  for (int i = rotary_count_ - 1; i >= 0; --i) {
    const model::Axis& axis = rotary_axis(i);
    if (axis.side == model::AxisSide::head)
      u = turned(u, axis.direction, rotary[static_cast<std::size_t>(i)]);
  }
  return u;
}

cl::Pose Kinematics::forward(const Joints& joints) const {
  const Vec3 head = head_axis(joints.rotary);
  const Point3 reference{joints.linear[0], joints.linear[1], joints.linear[2]};
  const double length = machine_.pivot_length;
  cl::Pose pose;
  pose.tip = to_part(reference - length * (head - kUp), joints.rotary);
  pose.axis = kUp;
  for (int i = rotary_count_ - 1; i >= 0; --i)
    pose.axis =
        turned(pose.axis, rotary_axis(i).direction, sign(i) * joints.rotary[static_cast<std::size_t>(i)]);
  return pose;
}

Kinematics::Turns Kinematics::turns_to(Vec3 u) const {
  Turns turns;
  if (!(dot(u, u) > 0.5)) return turns;  // no direction
  if (rotary_count_ == 0) {
    turns.count = norm(u - kUp) <= kReach ? 1 : 0;
    return turns;
  }
  const Vec3 a = rotary_[0].direction;
  if (rotary_count_ == 1) {
    if (!(std::abs(dot(a, u) - dot(a, kUp)) <= kReach)) return turns;
    turns.count = 1;
    turns.free[0] = norm(geom::cross(a, u)) < kSingular;
    if (!turns.free[0]) turns.angles[0][0] = sign(0) * angle_about(a, kUp, u);
    return turns;
  }
  // v = R2 z is as far along a as u is, and as far along b as z is.
  const Vec3 b = rotary_[1].direction, ab = geom::cross(a, b);
  const double c = dot(a, b), along_a = dot(a, u), along_b = dot(b, kUp), det = dot(ab, ab);
  const double alpha = (along_a - c * along_b) / det, beta = (along_b - c * along_a) / det;
  // What is left of |v|^2 = 1 for ab, written so that it keeps its digits where u nearly runs along a:
  // det (1 - |alpha a + beta b|^2) = |a x u|^2 |b x z|^2 - (c - along_a along_b)^2.
  const double across_a = norm(geom::cross(a, u)), across_b = norm(geom::cross(b, kUp));
  const double short_of = across_a * across_a / (1 + std::abs(along_a));  // 1 - |along_a|
  const double skew = along_a > 0 ? (c - along_b) + along_b * short_of : (c + along_b) - along_b * short_of;
  const double rest = (across_a * across_a * across_b * across_b - skew * skew) / det;
  if (!(rest >= -kReach)) return turns;
  const double gamma = std::sqrt(std::max(0.0, rest) / det);
  turns.free = {across_a < kSingular, across_b < kSingular};
  for (const double side : {1.0, -1.0}) {
    const Vec3 v = alpha * a + beta * b + (side * gamma) * ab;
    std::array<double, 2>& angles = turns.angles[static_cast<std::size_t>(turns.count++)];
    if (!turns.free[0]) angles[0] = sign(0) * angle_about(a, v, u);
    if (!turns.free[1]) angles[1] = sign(1) * angle_about(b, kUp, v);
    if (gamma == 0) break;
  }
  return turns;
}

Joints Kinematics::with_rotary(const Point3& tip, const std::array<double, 2>& rotary) const {
  const Point3 p = to_machine(tip, rotary);
  const Vec3 offset = machine_.pivot_length * (head_axis(rotary) - kUp);
  return {{p.x + offset.x, p.y + offset.y, p.z + offset.z}, rotary};
}

Solutions Kinematics::inverse_all(const cl::Pose& pose, const Joints& free) const {
  Turns turns = turns_to(unit(pose.axis));
  Solutions solutions;
  solutions.count = turns.free[0] || turns.free[1] ? std::min(turns.count, 1) : turns.count;
  solutions.free = turns.free;
  for (std::size_t i = 0; i < static_cast<std::size_t>(solutions.count); ++i) {
    for (std::size_t k = 0; k < 2; ++k)
      if (turns.free[k]) turns.angles[i][k] = free.rotary[k];
    solutions.joints[i] = with_rotary(pose.tip, turns.angles[i]);
  }
  return solutions;
}

Result<Joints> Kinematics::inverse(const cl::Pose& pose, const Joints& near) const {
  const Turns turns = turns_to(unit(pose.axis));
  if (turns.count == 0)
    return unsupported(machine_.name, "cannot bring the tool axis to (" + format_fixed(pose.axis.x, 6) +
                                          ", " + format_fixed(pose.axis.y, 6) + ", " +
                                          format_fixed(pose.axis.z, 6) + ")");
  std::array<double, 2> rotary{};
  std::optional<double> best;
  for (std::size_t n = 0; n < static_cast<std::size_t>(turns.count); ++n) {
    std::array<double, 2> angles = turns.angles[n];
    double cost = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(rotary_count_); ++i) {
      angles[i] = turns.free[i] ? near.rotary[i] : placed(angles[i], near.rotary[i], rotary_[i]);
      cost = std::max(cost, std::abs(angles[i] - near.rotary[i]));
      const double lo = geom::radians(rotary_[i].min) - kLimitSlack;
      const double hi = geom::radians(rotary_[i].max) + kLimitSlack;
      if (angles[i] < lo || angles[i] > hi) cost += 1e6;
    }
    if (!best || cost < *best) {
      best = cost;
      rotary = angles;
    }
  }
  return with_rotary(pose.tip, rotary);
}

std::optional<LimitViolation> Kinematics::violation(const Joints& joints) const {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!linear_[i]) continue;
    const double value = joints.linear[i];
    if (!(value >= linear_[i]->min - kLimitSlack && value <= linear_[i]->max + kLimitSlack))
      return LimitViolation{linear_[i]->letter, value, linear_[i]->min, linear_[i]->max};
  }
  for (int i = 0; i < rotary_count_; ++i) {
    const double value = geom::degrees(joints.rotary[static_cast<std::size_t>(i)]);
    const double slack = geom::degrees(2 * kLimitSlack);
    if (!(value >= rotary_axis(i).min - slack && value <= rotary_axis(i).max + slack))
      return LimitViolation{rotary_axis(i).letter, value, rotary_axis(i).min, rotary_axis(i).max};
  }
  return {};
}

}  // namespace burin::kinematics
