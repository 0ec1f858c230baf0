// SPDX-License-Identifier: Apache-2.0
#include "burin/kinematics/feed_way.h"

#include <cmath>

#include "burin/kinematics/kinematics.h"

namespace burin::kinematics {

using geom::Vec3;

FeedWay::FeedWay(const cl::Pose& from, const cl::Pose& to) : from_(from), to_(to) {
  // A turn below this moves nothing: the axis is then rounding.
  constexpr double kNoTurn = 1e-12;
  const Vec3 across = cross(from.axis, to.axis);
  turn_ = std::atan2(norm(across), dot(from.axis, to.axis));
  if (turn_ < kNoTurn) {
    turn_ = 0;
    return;
  }
  const Vec3& a = from.axis;
  const Vec3 beside = std::abs(a.x) <= std::abs(a.y) && std::abs(a.x) <= std::abs(a.z) ? Vec3{1, 0, 0}
                      : std::abs(a.y) <= std::abs(a.z)                                 ? Vec3{0, 1, 0}
                                                                                       : Vec3{0, 0, 1};
  about_ = norm(across) > kNoTurn ? unit(across) : unit(cross(a, beside));
}

cl::Pose FeedWay::at(double t) const {
  return {lerp(from_.tip, to_.tip, t), carried(from_.axis, t)};
}

Vec3 FeedWay::carried(const Vec3& v, double t) const {
  return turn_ == 0 ? v : turned(v, about_, t * turn_);
}

}  // namespace burin::kinematics
