// SPDX-License-Identifier: Apache-2.0
// Distance of a point from a swept part itself, not from its mesh. Private to plan/rotary. mm, radians.
//   At X = x the section stands turned by turn(x): for a centre c
//   F(x) = (x - cx)^2 + dist(Rot(-turn(x)) c, section)^2,  distance = min sqrt(F)
//   F is the least of functions f_q (q on the section) with f_q'' <= K = 2 + 2 rate^2 |c| |q|max, so over a
//   stretch h     F(x + s h) >= (1-s) F(x) + s F(x + h) - K/2 s (1-s) h^2,   halved until that is near
//   enough.
#pragma once

#include <vector>

#include "burin/plan/rotary/part.h"

namespace burin::rotary {

class SweptDistance {
 public:
  /// `swept` must have passed make_swept and outlive it. Answers are short of the distance by at most
  /// `accuracy_mm`.
  SweptDistance(const SweptSection& swept, double accuracy_mm);

  /// A lower bound of the distance of c from the part (its ends included), for c outside of it; at most
  /// `high`. Precondition: something of the part is not farther than `high`, near x = `guess`.
  double least(geom::Point3 c, double high, double guess) const;

 private:
  struct Piece {
    geom::Point2 center;  ///< of a circle that holds it
    double radius = 0;
  };
  struct Query;

  const SweptSection& swept_;
  double accuracy_, radius_ = 0;
  std::vector<Piece> pieces_;
};

}  // namespace burin::rotary
