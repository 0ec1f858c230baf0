// SPDX-License-Identifier: Apache-2.0
// Speed and acceleration of the rotary axes from move to move.
#include <algorithm>
#include <cmath>

#include "burin/kinematics/joint_path.h"

namespace burin::kinematics {
namespace {

// Sweeps over a stretch of moves: each brings a jump of speed within its bound, which may raise the one
// beside it; in practice a few are enough.
constexpr int kMaxSweeps = 200;
// An axis at its acceleration by more than this share is beyond it.
constexpr double kSlack = 1e-6;

double speed(const std::vector<JointMove>& moves, std::size_t n, std::size_t axis) {
  return (moves[n].to.rotary[axis] - moves[n - 1].to.rotary[axis]) / moves[n].minutes;
}

/// Of the axis between moves n and n + 1 (feed moves that take time, n > 0), rad/min^2.
double jump(const std::vector<JointMove>& moves, std::size_t n, std::size_t axis) {
  return std::abs(speed(moves, n + 1, axis) - speed(moves, n, axis)) /
         (0.5 * (moves[n].minutes + moves[n + 1].minutes));
}

bool timed(const std::vector<JointMove>& moves, std::size_t n) {
  return n > 0 && n < moves.size() && !moves[n].rapid && moves[n].minutes > 0;
}

/// rad/min^2 from deg/s^2.
double most(const Kinematics& machine, std::size_t axis) {
  return geom::radians(machine.rotary_axis(static_cast<int>(axis)).acceleration) * 3600;
}

}  // namespace

RotaryShares rotary_shares(const Kinematics& machine, const std::vector<JointMove>& moves) {
  RotaryShares shares;
  for (std::size_t n = 1; n < moves.size(); ++n) {
    if (!timed(moves, n)) continue;
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(machine.rotary_count()); ++axis) {
      const double fastest = geom::radians(machine.rotary_axis(static_cast<int>(axis)).speed);
      if (fastest > 0)
        shares.speed[axis] = std::max(shares.speed[axis], std::abs(speed(moves, n, axis)) / fastest);
      if (timed(moves, n + 1) && most(machine, axis) > 0)
        shares.acceleration[axis] =
            std::max(shares.acceleration[axis], jump(moves, n, axis) / most(machine, axis));
    }
  }
  return shares;
}

std::size_t keep_acceleration(const Kinematics& machine, std::vector<JointMove>& moves) {
  std::vector<bool> slowed(moves.size(), false);
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    bool any = false;
    const auto at = [&](std::size_t n) {
      if (!timed(moves, n) || !timed(moves, n + 1)) return;
      double share = 0;
      for (std::size_t axis = 0; axis < static_cast<std::size_t>(machine.rotary_count()); ++axis)
        if (most(machine, axis) > 0) share = std::max(share, jump(moves, n, axis) / most(machine, axis));
      if (share <= 1 + kSlack) return;
      // Both at a speed lower by the root: the change of speed and the time it has go with it.
      const double longer = std::sqrt(share);
      moves[n].minutes *= longer, moves[n + 1].minutes *= longer;
      slowed[n] = slowed[n + 1] = any = true;
    };
    // To and fro, so that a stop is prepared as far ahead as it needs.
    for (std::size_t n = 1; n + 1 < moves.size(); ++n) at(n);
    for (std::size_t n = moves.size(); n-- > 1;) at(n);
    if (!any) break;
  }
  return static_cast<std::size_t>(std::count(slowed.begin(), slowed.end(), true));
}

}  // namespace burin::kinematics
