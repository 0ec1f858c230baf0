// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/joint_pieces.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "burin/kinematics/joint_path.h"
#include "burin/verify/mill_motion.h"

namespace burin::verify {
namespace {

using geom::Point3;

// sqrt(3) / 216: the greatest |t (t - 1/2) (t - 1)| / 6 on [0, 1].
constexpr double kThird = 0.00801875373874481;
// More than anything takes; keeps the count an integer.
constexpr double kMostPieces = 1e12;

/// Bounds of the third derivatives over the whole move, t from 0 to 1: of the tip's way less a straight one,
/// and of the axis less one that turns along a great circle (it turns no farther than the axes together).
struct ThirdDerivatives {
  double tip = 0, axis = 0;
};
ThirdDerivatives third_derivatives(const JointWay& way) {
  const kinematics::Kinematics& machine = *way.machine;
  double table = 0, head = 0, travel = 0, reach = 0;
  for (std::size_t i = 0; i < 3; ++i) travel = std::hypot(travel, way.to.linear[i] - way.from.linear[i]);
  const model::Axis* inner = nullptr;  // the table axis nearer to the tool
  for (int i = machine.rotary_count() - 1; i >= 0; --i) {
    const model::Axis& axis = machine.rotary_axis(i);
    const auto k = static_cast<std::size_t>(i);
    const double turn = std::abs(way.to.rotary[k] - way.from.rotary[k]);
    if (axis.side == model::AxisSide::head) {
      head += turn;
      continue;
    }
    // The distance to a point on the axis is convex along the straight way of X, Y, Z: largest at an end.
    const auto far = [&](const kinematics::Joints& j) {
      return distance(axis.point, Point3{j.linear[0], j.linear[1], j.linear[2]});
    };
    reach += inner ? distance(axis.point, inner->point) : std::max(far(way.from), far(way.to));
    inner = &axis;
    table += turn;
  }
  const double length = machine.machine().pivot_length;
  // p = R y, |y| <= reach: the tip in the machine's frame, itself bent by the head only.
  const double y1 = travel + length * head, y2 = length * head * head, y3 = y2 * head;
  reach += head > 0 ? 2 * length : 0;
  const double turn = table + head;
  ThirdDerivatives third;
  if (!way.tip_straight) third.tip = table * (table * (table * reach + 3 * y1) + 3 * y2) + y3;
  third.axis = 2 * turn * turn * turn;
  return third;
}

}  // namespace

cl::Pose JointWay::at(double t) const {
  const kinematics::Joints now = t == 1 ? to : kinematics::between(from, to, t);
  cl::Pose pose = machine->forward(now);
  if (tip_straight && t < 1) pose.tip = lerp(machine->forward(from).tip, machine->forward(to).tip, t);
  return pose;
}

Result<JointPieces> split_joint_way(const JointWay& way, double span, double motion_mm, std::size_t most) {
  const ThirdDerivatives third = third_derivatives(way);
  JointPieces pieces;
  const cl::Pose from = way.at(0);
  for (std::size_t count = 1; count <= most;) {
    const double n = static_cast<double>(count),
                 rest = kThird * (third.tip + span * third.axis) / (n * n * n);
    double worst = 0;
    pieces.ends.clear();
    cl::Pose at = from;
    for (std::size_t i = 0; i < count && worst + rest <= motion_mm; ++i) {
      const cl::Pose to = way.at(static_cast<double>(i + 1) / n);
      const cl::Pose middle = way.at((static_cast<double>(i) + 0.5) / n);
      const Placed straight = Stretch::between(at, to).at(0.5);
      worst = std::max(worst, distance(middle.tip, straight.tip) + span * norm(middle.axis - straight.axis));
      pieces.ends.push_back(at = to);
    }
    pieces.motion_mm = worst + rest;
    if (pieces.motion_mm <= motion_mm) return pieces;
    // The parabola shrinks with the square of the count, the rest with its cube: fewer will not do.
    const double more = n * std::max(std::sqrt(worst / motion_mm), std::cbrt(rest / motion_mm));
    count = static_cast<std::size_t>(std::ceil(std::clamp(more, n + 1, kMostPieces)));
  }
  return Error{ErrorCode::range,
               "more than " + std::to_string(most) +
                   " straight pieces are needed to follow it (a shorter move, a coarser motion bound)",
               {}};
}

}  // namespace burin::verify
