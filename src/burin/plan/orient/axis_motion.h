// SPDX-License-Identifier: Apache-2.0
// What a machine's rotary axes do along a row of poses, at a feed of the tip. Internal to plan/orient.
#pragma once

#include <array>
#include <vector>

#include "burin/kinematics/kinematics.h"

namespace burin::orient {

/// Rotary angles of a pose: as many as there are solutions within the travel, at most two. Without a machine
/// none.
struct Rotary {
  std::array<std::array<double, 2>, 2> angles{};
  int count = 0;
  std::array<bool, 2> free{};  ///< axes that do not matter there
};

class AxisMotion {
 public:
  /// nullptr: the turn of the tool axis itself, without limits.
  AxisMotion(const kinematics::Kinematics* machine, double feed_mm_min);

  Rotary rotary(const cl::Pose& pose) const;

  struct Step {
    std::array<double, 2> by{};  ///< change of each rotary axis, radians; without a machine the axis' turn
    double turn = 0;             ///< the larger one
    double minutes = 0;          ///< that the slower rotary axis needs
  };
  /// From solution `from_branch` of a to solution `to_branch` of b, the short way round where the travel
  /// allows whole turns.
  Step step(const cl::Pose& a, const Rotary& ra, int from_branch, const cl::Pose& b, const Rotary& rb,
            int to_branch) const;

  double feed_mm_min() const { return feed_mm_min_; }
  /// rad/min^2 of a rotary axis; 0: not known.
  double acceleration(int axis) const;
  int axes() const { return machine_ == nullptr ? 0 : machine_->rotary_count(); }

 private:
  const kinematics::Kinematics* machine_;
  double feed_mm_min_;
  std::array<bool, 2> endless_{};
  std::array<double, 2> speed_{};  ///< rad/min; 0: not known
};

/// Largest shares of speed and acceleration along poses in order; the solution that changes least from one to
/// the next is taken.
struct Shares {
  double speed = 0, acceleration = 0;
};
Shares shares_along(const AxisMotion& motion, const std::vector<cl::Pose>& poses);

}  // namespace burin::orient
