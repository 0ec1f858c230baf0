// SPDX-License-Identifier: Apache-2.0
// The angles that are forbidden so far, as disjoint arcs. Angles are kept as `turns`: a number that grows
// with the angle from -2 (theta = -pi) to 2 (pi) and takes one division instead of an arc tangent. Internal
// to plan/rotary.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "burin/geom/vec.h"
#include "burin/plan/rotary/reach.h"

namespace burin::rotary::detail {

/// Of the direction with cosine c and sine s, of any length but 0.
inline double turn_of(double c, double s) {
  return std::copysign(1 - c / (std::abs(c) + std::abs(s)), s);
}
double angle_of_turn(double turn);
inline geom::Vec2 direction_of_turn(double turn) {
  const double c = 1 - std::abs(turn);
  return unit(geom::Vec2{c, std::copysign(1 - std::abs(c), turn)});
}

/// What the angles may be off. Where a point stands as far away as the piece is wide (the place that the ball
/// touches, and all of a flat face beside it), rounding of squares (1e-16) becomes 1e-8 in the angle, as the
/// arc sine has no slope left. A gap narrower than this is none, and what sticks out of an arc by less is not
/// looked at. In turns (an
/// eighth of the circle is half a turn; 0.5 to 1 of them a radian).
constexpr double kSlack = 1e-7;

class Arcs {
 public:
  Arcs() { arcs_.reserve(16); }

  /// From `lo` counter-clockwise to `hi`, both in [-2, 2]; across the seam when hi < lo.
  void add(double lo, double hi);
  void add_all() { arcs_.assign(1, {-2, 2}); }
  /// Whether the arc sticks out of what is forbidden by no more than kSlack at either end.
  bool covers(double lo, double hi) const {
    return lo <= hi ? covers_straight(lo, hi) : covers_straight(lo, 2) && covers_straight(-2, hi);
  }
  bool none() const { return arcs_.empty(); }
  bool all() const { return arcs_.size() == 1 && arcs_[0].lo <= -2 && arcs_[0].hi >= 2; }
  /// What is left.
  AngleSet gaps() const;
  /// The same as axis directions (cosine, sine) at the ends, and whether it is more than half the circle. Not
  /// for none().
  template <class Gap>
  void for_gaps(const Gap& gap) const {
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      const bool last = i + 1 == arcs_.size();
      const double lo = arcs_[i].hi, hi = last ? arcs_[0].lo + 4 : arcs_[i + 1].lo;
      if (hi - lo > kSlack) gap(direction_of_turn(lo), direction_of_turn(last ? hi - 4 : hi), hi - lo > 2);
    }
  }

 private:
  struct Arc {
    double lo, hi;
  };
  void add_straight(double lo, double hi);
  bool covers_straight(double lo, double hi) const {
    for (const Arc& a : arcs_) {
      if (a.hi + kSlack >= hi) return a.lo - kSlack <= lo;
    }
    return false;
  }
  std::vector<Arc> arcs_;  ///< ascending, more than kSlack apart, within [-2, 2]
};

}  // namespace burin::rotary::detail
