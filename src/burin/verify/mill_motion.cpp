// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/mill_motion.h"

#include <string>

#include "burin/geom/point_tools.h"

namespace burin::verify {
namespace {

using geom::Vec3;

// An axis may be so far from a unit vector: files keep six or seven decimals.
constexpr double kUnit = 1e-6;
// Axes nearer to opposite than this have no great circle that rounding does not choose.
constexpr double kOpposite = 1e-9;

Error wrong_move(std::size_t move, const std::string& what) {
  return {ErrorCode::geometry, "move " + std::to_string(move) + ": " + what, {}};
}

}  // namespace

Stretch Stretch::between(const cl::Pose& a, const cl::Pose& b) {
  Stretch s;
  s.way = b.tip - a.tip;
  const Vec3 from = unit(a.axis), to = unit(b.axis), normal = cross(from, to);
  s.middle = {lerp(a.tip, b.tip, 0.5), from};
  const double sine = norm(normal);
  if (sine > 0) {
    const Vec3 about = (1 / sine) * normal;
    s.angle = std::atan2(sine, dot(from, to));
    s.turn = s.angle * about;
    s.middle.axis = std::cos(0.5 * s.angle) * from + std::sin(0.5 * s.angle) * cross(about, from);
    s.across = cross(about, s.middle.axis);
  }
  return s;
}

bool is_axis(Vec3 v) {
  return is_finite(v) && std::abs(norm(v) - 1) <= kUnit;
}
bool opposite(Vec3 a, Vec3 b) {
  return dot(a, b) < 0 && norm(cross(a, b)) < kOpposite;
}

Result<void> validate_pose(const cl::Pose& pose, std::size_t move) {
  if (!is_finite(pose.tip) || !is_finite(pose.axis)) return wrong_move(move, "a pose that is not finite");
  if (!is_axis(pose.axis)) return wrong_move(move, "the tool axis is no unit vector");
  return {};
}
Result<void> validate_turn(const cl::Pose& from, const cl::Pose& to, std::size_t move) {
  if (opposite(from.axis, to.axis))
    return wrong_move(move,
                      "the axis turns by half a turn, which no great circle decides (put a pose between)");
  return {};
}

}  // namespace burin::verify
