// SPDX-License-Identifier: Apache-2.0
// Internal to the fit: arcs and lines as one kind ("start, tangent, curvature"), and the one-parameter family
// of biarcs between two points with tangents.
#pragma once

#include <array>
#include <cmath>

#include "burin/geom/curve/arc_spline.h"
#include "burin/geom/vec.h"

namespace burin::geom::fit {

/// From a in direction ta with signed curvature k (positive to the left, 0 a line) to b, where the direction
/// is tb. Formulas in k have no cancellation for flat arcs, unlike those in centre and radius.
struct Arc {
  Point2 a;
  Vec2 ta;
  double k = 0;
  Point2 b;
  Vec2 tb;
};

/// Signed distance of p to the left of the full circle (line) of an arc from a along ta: with p - a = q and
/// left normal n, F = q.n - k |q|^2 / 2 gives 2 F / (1 + sqrt(1 - 2 k F)).
inline double signed_distance(Point2 a, Vec2 ta, double k, Point2 p) {
  const Vec2 q = p - a;
  const double f = cross(ta, q) - 0.5 * k * norm2(q);
  return 2 * f / (1 + std::sqrt(std::max(0.0, 1 - 2 * k * f)));
}

/// The arc from a along ta that ends where p projects onto its circle.
Arc arc_towards(Point2 a, Vec2 ta, double k, Point2 p);
/// Curvature of the circle from a along ta through b.
inline double curvature_through(Point2 a, Vec2 ta, Point2 b) {
  const Vec2 q = b - a;
  return 2 * cross(ta, q) / norm2(q);
}

using Biarc = std::array<Arc, 2>;
/// The biarc whose tangent lengths (a to joint tangent, joint tangent to b) have the ratio r > 0. False when
/// there is none with both arcs below a half turn.
bool make_biarc(Point2 a, Vec2 ta, Point2 b, Vec2 tb, double r, Biarc& out);

Segment to_segment(const Arc& arc);

}  // namespace burin::geom::fit
