// SPDX-License-Identifier: Apache-2.0
// Plane curves as drawings give them: lines, circular arcs, elliptic arcs and NURBS, kept as they are (no
// tessellation on import). Parameters run over [0, 1] for every kind, so that algorithms treat all alike.
// mm; angles in radians, counter-clockwise positive.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "burin/base/result.h"
#include "burin/geom/vec.h"

namespace burin::geom {

struct Line2 {
  Point2 a, b;
  bool operator==(const Line2&) const = default;
};

/// C(t) = center + radius * (cos, sin)(start + t * sweep); sweep in [-2 pi, 2 pi], sign = direction.
struct Arc2 {
  Point2 center;
  double radius = 0;  // > 0
  double start = 0;
  double sweep = 0;
  bool operator==(const Arc2&) const = default;
};

/// C(t) = center + cos(u) * major + sin(u) * minor, u = start + t * sweep. `major` and `minor` are conjugate
/// half-diameters (perpendicular for a plain ellipse; an affine map keeps the form, skew or mirrored).
struct EllipseArc2 {
  Point2 center;
  Vec2 major, minor;
  double start = 0;
  double sweep = 0;
  bool operator==(const EllipseArc2&) const = default;
};

/// Clamped or unclamped NURBS curve of degree p: knots.size() == points.size() + p + 1, knots nondecreasing,
/// weights.size() == points.size() and all > 0 (a polynomial curve has all weights 1). The curve is the part
/// over [knots[p], knots[points.size()]]; t in [0, 1] maps onto it linearly.
struct Nurbs2 {
  int degree = 0;
  std::vector<double> knots;
  std::vector<Point2> points;
  std::vector<double> weights;
  bool operator==(const Nurbs2&) const = default;
};

using Curve2 = std::variant<Line2, Arc2, EllipseArc2, Nurbs2>;

/// Checks shape, finiteness and ranges; an error (geometry) says what is wrong. Importers call it on
/// everything.
Result<void> validate(const Curve2& curve);

Point2 point_at(const Curve2& curve, double t);
struct Derivatives2 {
  Point2 point;
  Vec2 d1, d2;  ///< with respect to t in [0, 1]
};
Derivatives2 derivatives_at(const Curve2& curve, double t);
inline Point2 start_point(const Curve2& curve) {
  return point_at(curve, 0.0);
}
inline Point2 end_point(const Curve2& curve) {
  return point_at(curve, 1.0);
}
/// Unit tangent in the direction of growing t; taken as the limit where the first derivative vanishes
/// (coincident control points at an end), (0, 0) only for a curve that is a single point.
Vec2 tangent_at(const Curve2& curve, double t);

Curve2 reversed(const Curve2& curve);
/// The part over [t0, t1], 0 <= t0 < t1 <= 1, as a curve of the same kind.
Curve2 part(const Curve2& curve, double t0, double t1);
/// Exact under every affine map: an arc becomes an elliptic arc unless the map keeps circles round.
Curve2 transformed(const Affine2& map, const Curve2& curve);
/// A box that contains the curve (tight for lines and arcs, from the control net for NURBS).
Box2 bounds(const Curve2& curve);
/// Arc length within `tolerance` mm.
double length(const Curve2& curve, double tolerance = 1e-6);

/// Splits a NURBS curve into rational Bezier pieces (degree + 1 points each, clamped, knots 0..0 1..1), in
/// order; zero-length knot spans give no piece.
std::vector<Nurbs2> bezier_pieces(const Nurbs2& curve);

/// Parameters strictly inside (0, 1) at which the tangent turns by more than `tangent_rad` at once (knots of
/// full multiplicity, cusps, coincident control points): where step 1 of the offset splits a curve.
std::vector<double> corner_parameters(const Curve2& curve, double tangent_rad);

/// Interpolates points by a cubic spline (chord-length parameters, natural ends unless end tangents are
/// given; closed: periodic with C2 continuity), as CAD systems do for DXF splines that hold fit points only.
/// Errors (geometry): fewer than 2 different points.
Result<Nurbs2> interpolate(const std::vector<Point2>& fit_points, bool closed, Vec2 start_tangent = {},
                           Vec2 end_tangent = {});

}  // namespace burin::geom
