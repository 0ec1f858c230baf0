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

class StretchedMotion {
 public:
  /// `span`: no place of the tool is farther from the tip. Keeps references.
  StretchedMotion(const geom::Mesh& mesh, const MillMotion& motion, double span, double motion_mm);

  Result<void> validate() const;
  bool exact() const { return joints_ == nullptr; }
  std::size_t count() const { return joints_ ? joints_->joints.size() : poses_->size(); }

  /// Of the move that ends in pose or joints `m`, m >= 1.
  template <class Each>
  void for_each_stretch(std::size_t m, Each&& each) const {
    if (poses_) {
      each(Stretch::between((*poses_)[m - 1], (*poses_)[m]));
      return;
    }
    const kinematics::Joints &from = joints_->joints[m - 1], &to = joints_->joints[m];
    const int count = pieces(from, to);
    cl::Pose a = joints_->machine->forward(from);
    for (int k = 1; k <= count; ++k) {
      const cl::Pose b = joints_->machine->forward(between(from, to, static_cast<double>(k) / count));
      each(Stretch::between(a, b));
      a = b;
    }
  }

 private:
  static kinematics::Joints between(const kinematics::Joints& a, const kinematics::Joints& b, double t);
  int pieces(const kinematics::Joints& from, const kinematics::Joints& to) const;

  const PoseMotion* poses_ = nullptr;
  const JointMotion* joints_ = nullptr;
  double reach_ = 0, motion_mm_ = 0;
};

}  // namespace burin::verify
