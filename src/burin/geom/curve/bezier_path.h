// SPDX-License-Identifier: Apache-2.0
// Internal to the fit: a curve as a chain of rational Bezier pieces, and the Bernstein arithmetic on them.
// The parameter tau runs over [0, number of pieces]; piece k covers [k, k + 1].
#pragma once

#include <array>
#include <vector>

#include "burin/base/result.h"
#include "burin/geom/curve/curve.h"

namespace burin::geom::fit {

inline constexpr int kMaxDegree = 15;

/// C(t) = X(t) / w(t) in Bernstein form, with a vector polynomial D(t) that has the direction of C'(t): the
/// numerator of C' with its zeros at t = 0 and t = 1 divided out, so that D points along the limit of the
/// tangent where control points coincide.
struct Bezier {
  int degree = 0;  ///< of X and w
  int hodograph_degree = 0;
  bool rational = false;
  std::array<Vec2, kMaxDegree + 1> x;
  std::array<double, kMaxDegree + 1> w;
  std::array<Vec2, 2 * kMaxDegree> d;

  Bezier() {}  // leaves the arrays as they are: only `degree + 1` entries are ever read
  Bezier(const Bezier& other) { *this = other; }
  Bezier& operator=(const Bezier& other);
};

double binomial(int n, int k);

/// Halves at t: `lower` covers [0, t], `upper` [t, 1]; both may be null, neither may alias `b`.
void split(const Bezier& b, double t, Bezier* lower, Bezier* upper);
/// The part over [t0, t1].
Bezier part(const Bezier& b, double t0, double t1);

struct PointTangent {
  Point2 point;
  Vec2 tangent;  ///< unit
};

struct Path {
  std::vector<Bezier> pieces;
  double magnitude = 0;  ///< largest absolute coordinate: the scale of rounding errors

  double end() const { return static_cast<double>(pieces.size()); }
  Point2 point(double tau) const;
  PointTangent at(double tau) const;
};

/// Elliptic arcs and NURBS as exact Bezier pieces; piece k covers [t_begin[k], t_end[k]] of the curve. Pieces
/// that are a single point are left out.
struct PathOfCurve {
  Path path;
  std::vector<double> t_begin, t_end;

  double tau_of(double t) const;
};
Result<PathOfCurve> path_of(const Curve2& curve);
/// The part of a path between two parameters, as a path of its own.
Path part(const Path& path, double tau0, double tau1);

}  // namespace burin::geom::fit
