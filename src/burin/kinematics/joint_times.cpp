// SPDX-License-Identifier: Apache-2.0
// Speed and acceleration of the rotary axes from move to move. A row of linear moves has corners that no axis
// follows; controls round them. What is measured is the motion rounded as far as the tolerance of the axis
// allows: a second difference over the time tau in which an axis at its acceleration a leaves a corner by the
// tolerance, a tau^2 / 8.
#include <algorithm>
#include <cmath>

#include "burin/kinematics/joint_path.h"

namespace burin::kinematics {
namespace {

// Sweeps over a stretch of moves: each takes the root of what is too much.
constexpr int kMaxSweeps = 100;
// An axis at its acceleration by more than this share is beyond it.
constexpr double kSlack = 1e-3;

bool timed(const std::vector<JointMove>& moves, std::size_t n) {
  return n > 0 && !moves[n].rapid && moves[n].minutes > 0;
}

/// rad/min^2 from deg/s^2.
double most(const Kinematics& machine, std::size_t axis) {
  return geom::radians(machine.rotary_axis(static_cast<int>(axis)).acceleration) * 3600;
}

/// Feed moves first to last after each other; knots are their ends, the start included.
class Stretch {
 public:
  Stretch(const Kinematics& machine, const std::vector<JointMove>& moves, std::size_t first, std::size_t last)
      : machine_(machine), moves_(moves), first_(first), times_(last - first + 2) {
    for (std::size_t k = 1; k < times_.size(); ++k) times_[k] = times_[k - 1] + moves[first + k - 1].minutes;
  }

  /// Calls found(share, k0, k1) for each inner knot: the share of the axis' acceleration there, measured over
  /// moves first + k0 to first + k1.
  template <class Found>
  void each(std::size_t axis, double axis_tolerance, const Found& found) const {
    const double acceleration = most(machine_, axis);
    if (!(acceleration > 0)) return;
    const double tau = std::sqrt(8 * axis_tolerance / acceleration);
    std::size_t behind = 0, ahead = 0;  // moves in which the two ends of the window lie
    const std::size_t last = times_.size() - 2;
    for (std::size_t k = 1; k <= last; ++k) {
      const double from = std::max(times_.front(), times_[k] - tau);
      const double to = std::min(times_.back(), times_[k] + tau);
      while (behind < last && times_[behind + 1] <= from) ++behind;
      while (ahead < last && times_[ahead + 1] < to) ++ahead;
      const double here = place(k, axis);
      const double before = (here - at(behind, from, axis)) / (times_[k] - from);
      const double after = (at(ahead, to, axis) - here) / (to - times_[k]);
      found(std::abs(after - before) / tau / acceleration, behind, ahead);
    }
  }

 private:
  double place(std::size_t knot, std::size_t axis) const { return moves_[first_ + knot - 1].to.rotary[axis]; }
  double at(std::size_t move, double time, std::size_t axis) const {
    const double t = (time - times_[move]) / (times_[move + 1] - times_[move]);
    return place(move, axis) + t * (place(move + 1, axis) - place(move, axis));
  }

  const Kinematics& machine_;
  const std::vector<JointMove>& moves_;
  std::size_t first_;
  std::vector<double> times_;
};

/// Calls with the first and last move of each row of timed feed moves.
template <class Found>
void each_stretch(const std::vector<JointMove>& moves, const Found& found) {
  for (std::size_t n = 1; n < moves.size(); ++n) {
    if (!timed(moves, n)) continue;
    std::size_t last = n;
    while (last + 1 < moves.size() && timed(moves, last + 1)) ++last;
    found(n, last);
    n = last;
  }
}

}  // namespace

RotaryShares rotary_shares(const Kinematics& machine, const std::vector<JointMove>& moves,
                           double axis_tolerance_rad) {
  RotaryShares shares;
  each_stretch(moves, [&](std::size_t first, std::size_t last) {
    const Stretch stretch(machine, moves, first, last);
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(machine.rotary_count()); ++axis) {
      const double fastest = geom::radians(machine.rotary_axis(static_cast<int>(axis)).speed);
      for (std::size_t n = first; n <= last && fastest > 0; ++n)
        shares.speed[axis] =
            std::max(shares.speed[axis], std::abs(moves[n].to.rotary[axis] - moves[n - 1].to.rotary[axis]) /
                                             moves[n].minutes / fastest);
      stretch.each(axis, axis_tolerance_rad, [&](double share, std::size_t, std::size_t) {
        shares.acceleration[axis] = std::max(shares.acceleration[axis], share);
      });
    }
  });
  return shares;
}

std::size_t keep_acceleration(const Kinematics& machine, std::vector<JointMove>& moves,
                              double axis_tolerance_rad) {
  std::size_t slowed = 0;
  each_stretch(moves, [&](std::size_t first, std::size_t last) {
    std::vector<double> longer(last - first + 1);
    std::vector<bool> touched(longer.size(), false);
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
      std::fill(longer.begin(), longer.end(), 1.0);
      bool any = false;
      const Stretch stretch(machine, moves, first, last);
      for (std::size_t axis = 0; axis < static_cast<std::size_t>(machine.rotary_count()); ++axis)
        stretch.each(axis, axis_tolerance_rad, [&](double share, std::size_t k0, std::size_t k1) {
          if (share <= 1 + kSlack) return;
          for (std::size_t k = k0; k <= k1; ++k) longer[k] = std::max(longer[k], std::sqrt(share));
          any = true;
        });
      if (!any) break;
      for (std::size_t k = 0; k < longer.size(); ++k) {
        moves[first + k].minutes *= longer[k];
        if (longer[k] > 1) touched[k] = true;
      }
    }
    slowed += static_cast<std::size_t>(std::count(touched.begin(), touched.end(), true));
  });
  return slowed;
}

}  // namespace burin::kinematics
