// SPDX-License-Identifier: Apache-2.0
// A motion of a tool as stretches on which the tip goes straight and the axis turns evenly. Internal to
// verify. mm, radians.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "burin/base/result.h"
#include "burin/verify/mill_check.h"

namespace burin::verify {

struct Placed {
  geom::Point3 tip;
  geom::Vec3 axis;
};

struct Stretch {
  Placed middle;
  geom::Vec3 way;     ///< of the tip
  geom::Vec3 turn;    ///< rotation vector of the axis, perpendicular to it
  geom::Vec3 across;  ///< turn's direction x middle.axis
  double angle = 0;
  static constexpr double kSmall = 4e-4;

  static Stretch between(const cl::Pose& a, const cl::Pose& b);
  /// t from 0 to 1.
  Placed at(double t) const {
    const double s = t - 0.5;
    if (angle == 0) return {middle.tip + s * way, middle.axis};
    const double x = s * angle, xx = x * x;
    if (xx < kSmall) {
      // The next terms are below rounding.
      const double cosine = 1 - xx / 2 * (1 - xx / 12 * (1 - xx / 30)),
                   sine = x * (1 - xx / 6 * (1 - xx / 20));
      return {middle.tip + s * way, cosine * middle.axis + sine * across};
    }
    return {middle.tip + s * way, std::cos(x) * middle.axis + std::sin(x) * across};
  }
};

/// A unit vector, as far as files keep one.
bool is_axis(geom::Vec3 v);
/// No great circle between them that rounding does not choose.
bool opposite(geom::Vec3 a, geom::Vec3 b);
/// Finite, with a unit vector for an axis; a way between that a great circle decides. The errors (geometry)
/// name the move.
Result<void> validate_pose(const cl::Pose& pose, std::size_t move);
Result<void> validate_turn(const cl::Pose& from, const cl::Pose& to, std::size_t move);

}  // namespace burin::verify
