// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/biarc.h"

namespace burin::geom::fit {

Arc arc_towards(Point2 a, Vec2 ta, double k, Point2 p) {
  // m points from the circle's nearest point towards the left, scaled by (distance to centre) * k when k !=
  // 0.
  const Vec2 m = unit(left(ta) - k * (p - a));
  return {a, ta, k, p - signed_distance(a, ta, k, p) * m, right(m)};
}

bool make_biarc(Point2 a, Vec2 ta, Point2 b, Vec2 tb, double r, Biarc& out) {
  // Tangent lengths alpha = r beta and beta satisfy |b - a - alpha ta - beta tb| = alpha + beta.
  const Vec2 v = b - a;
  const double v2 = norm2(v);
  const double qa = 2 * r * (1 - dot(ta, tb)), qb = 2 * dot(v, r * ta + tb);
  const double root = std::sqrt(qb * qb + 4 * qa * v2);
  const double beta = qb >= 0 ? 2 * v2 / (qb + root) : (root - qb) / (2 * qa);
  if (!(beta > 0) || !std::isfinite(beta)) return false;
  const double alpha = r * beta;
  const Point2 p = a + alpha * ta, q = b - beta * tb;
  const Point2 joint = lerp(p, q, alpha / (alpha + beta));
  const Vec2 tangent = unit(q - p);
  if (joint == a || joint == b || tangent == Vec2{}) return false;
  const double k0 = curvature_through(a, ta, joint), k1 = -curvature_through(b, -tb, joint);
  if (!std::isfinite(k0) || !std::isfinite(k1)) return false;
  out[0] = {a, ta, k0, joint, tangent};
  out[1] = {joint, tangent, k1 == 0 ? 0.0 : k1, b, tb};
  return true;
}

Segment to_segment(const Arc& arc) {
  // A turn of less than this is rounding, and the centre could not be stored: the sagitta is below 2e-14
  // chords.
  constexpr double kStraight = 1e-13;
  if (std::abs(arc.k) * distance(arc.a, arc.b) <= kStraight) return make_line(arc.a, arc.b);
  return make_arc(arc.a, arc.b, arc.a + left(arc.ta) / arc.k, arc.k > 0);
}

}  // namespace burin::geom::fit
