// SPDX-License-Identifier: Apache-2.0
// Exact changes of representation: the shape stays, the net changes. The NURBS Book, chapter 5. Arguments are
// preconditions checked by assertions unless a Result is returned.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "burin/base/result.h"
#include "burin/geom/surface/nurbs.h"

namespace burin::geom {

/// `values` ascending, inside the domain, repeated as often as they are to be inserted; insertions beyond
/// multiplicity `degree` are ignored.
NurbsCurve insert_knots(const NurbsCurve& curve, std::span<const double> values);
NurbsSurface insert_knots(const NurbsSurface& surface, Direction direction, std::span<const double> values);

/// Takes the inner knot out up to `times` times as long as the surface moves by at most `tolerance_mm` (bound
/// from the control points, weights regarded). Returns how often and the bound of the deviation.
struct KnotRemoval {
  NurbsSurface surface;
  int removed = 0;
  double deviation_mm = 0;
};
KnotRemoval remove_knot(const NurbsSurface& surface, Direction direction, double value, int times,
                        double tolerance_mm);

/// Raises the degree by `by` >= 0. Error (range) above kMaxSurfaceDegree.
Result<NurbsCurve> elevate_degree(const NurbsCurve& curve, int by);
Result<NurbsSurface> elevate_degree(const NurbsSurface& surface, Direction direction, int by);

/// At `at` strictly inside the domain; both parts keep their parameters.
std::pair<NurbsSurface, NurbsSurface> split(const NurbsSurface& surface, Direction direction, double at);
/// The part over [u.lo, u.hi] x [v.lo, v.hi]; parameters kept.
NurbsSurface sub_surface(const NurbsSurface& surface, Interval u, Interval v);
NurbsCurve sub_curve(const NurbsCurve& curve, Interval t);

/// t -> lo + hi - t in that direction (domain kept).
NurbsCurve reversed(const NurbsCurve& curve);
NurbsSurface reversed(const NurbsSurface& surface, Direction direction);
/// S'(u, v) = S(v, u).
NurbsSurface swapped(const NurbsSurface& surface);
/// Domain mapped linearly onto `to`.
NurbsCurve with_domain(const NurbsCurve& curve, Interval to);
NurbsSurface with_domain(const NurbsSurface& surface, Direction direction, Interval to);
/// All weights multiplied by `factor` > 0 (homogeneous points scaled): same shape.
NurbsSurface with_weights_scaled(const NurbsSurface& surface, double factor);
NurbsSurface translated(const NurbsSurface& surface, Vec3 by);

/// The curve of constant parameter: direction u: v = at fixed, runs along u.
NurbsCurve iso_curve(const NurbsSurface& surface, Direction along, double at);

/// Rational Bezier pieces: (degree_u + 1) x (degree_v + 1) points each, with their parameter rectangle; u
/// fastest.
struct BezierPatch {
  Interval u, v;
  NurbsSurface surface;  ///< knots at the ends of u and v only
};
std::vector<BezierPatch> bezier_patches(const NurbsSurface& surface);

}  // namespace burin::geom
