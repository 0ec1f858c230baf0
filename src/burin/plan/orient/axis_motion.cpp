// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/axis_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burin::orient {
namespace {

constexpr double kTurn = 2 * geom::kPi;
// A tip that moves less than this between two points has no time of its own to turn in, mm.
constexpr double kStill_mm = 1e-6;

}  // namespace

AxisMotion::AxisMotion(const kinematics::Kinematics* machine, double feed_mm_min)
    : machine_(machine), feed_mm_min_(feed_mm_min) {
  for (int i = 0; i < axes(); ++i) {
    const model::Axis& axis = machine->rotary_axis(i);
    const std::size_t k = static_cast<std::size_t>(i);
    endless_[k] = axis.max - axis.min >= 720;  // never at an end within a path
    speed_[k] = geom::radians(axis.speed);
  }
}

double AxisMotion::acceleration(int axis) const {
  return geom::radians(machine_->rotary_axis(axis).acceleration) * 3600;
}

Rotary AxisMotion::rotary(const cl::Pose& pose) const {
  Rotary rotary;
  if (machine_ == nullptr) return rotary;
  constexpr double kSlack = 1e-6;  // as the kinematics grants
  const kinematics::Solutions solutions = machine_->inverse_all(pose);
  rotary.free = solutions.free;
  for (std::size_t n = 0; n < static_cast<std::size_t>(solutions.count); ++n) {
    std::array<double, 2> angles = solutions.joints[n].rotary;
    bool within = true;
    for (std::size_t i = 0; i < static_cast<std::size_t>(axes()); ++i) {
      const model::Axis& axis = machine_->rotary_axis(static_cast<int>(i));
      const double lo = geom::radians(axis.min) - kSlack, hi = geom::radians(axis.max) + kSlack;
      if (!endless_[i]) angles[i] += kTurn * std::ceil((lo - angles[i]) / kTurn);
      within = within && angles[i] <= hi;
    }
    if (within) rotary.angles[static_cast<std::size_t>(rotary.count++)] = angles;
  }
  return rotary;
}

AxisMotion::Step AxisMotion::step(const cl::Pose& a, const Rotary& ra, int from_branch, const cl::Pose& b,
                                  const Rotary& rb, int to_branch) const {
  Step step;
  if (machine_ == nullptr) {
    step.turn = std::atan2(norm(cross(a.axis, b.axis)), dot(a.axis, b.axis));
    step.by[0] = step.turn;
    return step;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(axes()); ++i) {
    if (ra.free[i] || rb.free[i]) continue;
    double by = rb.angles[static_cast<std::size_t>(to_branch)][i] -
                ra.angles[static_cast<std::size_t>(from_branch)][i];
    if (endless_[i]) by -= kTurn * std::round(by / kTurn);
    step.by[i] = by;
    step.turn = std::max(step.turn, std::abs(by));
    if (speed_[i] > 0) step.minutes = std::max(step.minutes, std::abs(by) / speed_[i]);
  }
  return step;
}

Shares shares_along(const AxisMotion& motion, const std::vector<cl::Pose>& poses) {
  Shares shares;
  if (motion.axes() == 0) return shares;
  Rotary at;
  int branch = 0;
  std::array<double, 2> speed{};
  double minutes_before = 0;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    const Rotary to = motion.rotary(poses[n]);
    if (to.count == 0) return shares;
    if (n > 0) {
      AxisMotion::Step least;
      int chosen = 0;
      for (int b = 0; b < to.count; ++b) {
        const AxisMotion::Step step = motion.step(poses[n - 1], at, branch, poses[n], to, b);
        if (b == 0 || step.turn < least.turn) least = step, chosen = b;
      }
      branch = chosen;
      const double way = std::max(geom::distance(poses[n - 1].tip, poses[n].tip), kStill_mm);
      const double minutes = way / motion.feed_mm_min();
      shares.speed = std::max(shares.speed, least.minutes / minutes);
      for (std::size_t i = 0; i < static_cast<std::size_t>(motion.axes()); ++i) {
        const double now = least.by[i] / minutes;
        const double most = motion.acceleration(static_cast<int>(i));
        if (n > 1 && most > 0)
          shares.acceleration = std::max(
              shares.acceleration, std::abs(now - speed[i]) / (0.5 * (minutes + minutes_before)) / most);
        speed[i] = now;
      }
      minutes_before = minutes;
    }
    at = to;
  }
  return shares;
}

}  // namespace burin::orient
