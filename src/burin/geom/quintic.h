// SPDX-License-Identifier: Apache-2.0
// Smooth space curves as quintic Hermite splines: nodes with position and the first two derivatives. What
// planners hand to the interpolator, to the fitting of NC blocks and to pictures, so that none of these knows
// a surface. C2 inside a path. mm; the parameter t has no unit of its own (a surface parameter, an angle, a
// length).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::geom {

/// d1, d2: derivatives with respect to t.
struct QuinticNode {
  double t = 0;
  Point3 p;
  Vec3 d1, d2;
  bool operator==(const QuinticNode&) const = default;
};

struct QuinticDerivatives {
  Point3 p;
  Vec3 d1, d2, d3;
};

/// At least two nodes, t strictly increasing. Between neighbours the polynomial of degree 5 that has their
/// values.
struct QuinticPath {
  std::vector<QuinticNode> nodes;

  bool empty() const { return nodes.size() < 2; }
  Point3 start() const { return nodes.front().p; }
  Point3 end() const { return nodes.back().p; }
};

/// Coefficients c[k] of f(t0 + h x) = sum c[k] x^k, x in [0, 1], h = t1 - t0, from value and derivatives at
/// both ends (one coordinate).
std::array<double, 6> quintic_coefficients(double h, double p0, double d0, double dd0, double p1, double d1,
                                           double dd1);
/// Piece i (between nodes i and i + 1) at x in [0, 1]; derivatives with respect to t.
QuinticDerivatives evaluate_piece(const QuinticPath& path, std::size_t i, double x);
/// At t (clamped to the path's range), by binary search.
QuinticDerivatives evaluate(const QuinticPath& path, double t);
/// The straight line from a to b, t from 0 to |b - a| (unit speed; t from 0 to 1 when a == b).
QuinticPath straight(Point3 a, Point3 b);
/// Arc (or helix) from `start` about `center` with unit `normal`, counter-clockwise by `sweep` rad > 0,
/// rising by `rise` along the normal; t is the angle. Deviates from the exact arc by less than 1e-8 of the
/// radius.
QuinticPath arc(Point3 start, Point3 center, Vec3 normal, double sweep, double rise);
/// Arc length of the whole path, and of its pieces, by Gauss-Legendre quadrature (relative error below 1e-9
/// on pieces whose speed varies by less than a factor of two).
double length(const QuinticPath& path);
double piece_length(const QuinticPath& path, std::size_t i);
/// The same curve run backwards (t -> -t).
QuinticPath reversed(const QuinticPath& path);

}  // namespace burin::geom
