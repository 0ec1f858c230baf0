// SPDX-License-Identifier: Apache-2.0
// The angles that are forbidden so far, as disjoint arcs. Angles are kept as `turns`: a number that grows
// with the angle from -2 (theta = -pi) to 2 (pi) and takes one division instead of an arc tangent. Internal
// to plan/rotary.
#pragma once

#include <cmath>
#include <vector>

#include "burin/plan/rotary/reach.h"

namespace burin::rotary::detail {

/// Of the direction with cosine c and sine s, of any length but 0.
inline double turn_of(double c, double s) {
  return std::copysign(1 - c / (std::abs(c) + std::abs(s)), s);
}
double angle_of_turn(double turn);

class Arcs {
 public:
  Arcs() { arcs_.reserve(16); }

  /// From `lo` counter-clockwise to `hi`, both in [-2, 2]; across the seam when hi < lo.
  void add(double lo, double hi);
  void add_all() { arcs_.assign(1, {-2, 2}); }
  /// Whether the arc sticks out of what is forbidden by no more than `slack` (turns) at either end.
  bool covers(double lo, double hi, double slack) const;
  bool all() const { return arcs_.size() == 1 && arcs_[0].lo <= -2 && arcs_[0].hi >= 2; }
  /// What is left; gaps narrower than `least` (radians) are none.
  AngleSet gaps(double least) const;

 private:
  struct Arc {
    double lo, hi;
  };
  void add_straight(double lo, double hi);
  bool covers_straight(double lo, double hi, double slack) const;
  std::vector<Arc> arcs_;  ///< ascending, disjoint, within [-2, 2]
};

}  // namespace burin::rotary::detail
