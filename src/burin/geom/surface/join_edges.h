// SPDX-License-Identifier: Apache-2.0
// Internal to joining: where two edge curves run along each other, and how their parameters correspond.
#pragma once

#include <vector>

#include "burin/geom/surface/nurbs.h"

namespace burin::geom::detail {

/// The projective map of [0, 1] onto itself; its inverse has 1 / alpha. Where both directions are turned
/// round (t -> 1 - t) alpha also becomes 1 / alpha.
inline double moebius(double alpha, double t) {
  return alpha == 1 ? t : alpha * t / (1 + (alpha - 1) * t);
}
/// Of the map restricted to [from, to], both ranges normalised again.
inline double moebius_part(double alpha, double from, double to) {
  return alpha == 1 ? 1 : (1 + (alpha - 1) * to) / (1 + (alpha - 1) * from);
}

/// An edge of a patch over [0, 1].
struct EdgeCurve {
  NurbsCurve curve;
  std::vector<NurbsCurve> pieces;  ///< Bezier
  Box3 box;
  double length = 0;  ///< of the control polygons of the pieces: an upper bound that is nearly reached
};
EdgeCurve edge_curve(const NurbsCurve& curve);

/// a in [a0, a1] runs along b between b0 and b1 (b1 < b0: against it), with normalised parameters
/// b' = moebius(alpha, a').
struct Match {
  double a0 = 0, a1 = 1, b0 = 0, b1 = 1;
  double alpha = 1;
  double gap_mm = 0;  ///< largest distance of corresponding points
  /// Parameters and weights correspond: one row of homogeneous points serves both. Otherwise only the places
  /// agree.
  bool exact = true;

  double b_at(double a) const { return b0 + (b1 - b0) * moebius(alpha, (a - a0) / (a1 - a0)); }
};

/// A stretch along which both curves agree within the tolerance, in pieces of one projective map each
/// (one piece in all ordinary cases). Stretches end at an end of one of the curves.
struct Overlap {
  std::vector<Match> pieces;
  double gap_mm() const;
};
std::vector<Overlap> overlaps(const EdgeCurve& a, const EdgeCurve& b, double tolerance_mm);

/// Parameters of all local minima of the distance that are within the tolerance, ascending.
std::vector<double> near_parameters(const EdgeCurve& edge, Point3 p, double tolerance_mm);

}  // namespace burin::geom::detail
