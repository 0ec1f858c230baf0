// SPDX-License-Identifier: Apache-2.0
// Internal to geom/surface: a curve or a surface seen as a spline in one direction whose control points are
// rows of homogeneous points. Every change of representation in one direction (knots, degree,
// reparametrising) is written once for rows; a curve has rows of one point.
#pragma once

#include <span>
#include <vector>

#include "burin/geom/surface/nurbs.h"

namespace burin::geom::detail {

struct Rows {
  int degree = 0;
  int width = 0;
  std::vector<double> knots;
  std::vector<HPoint> points;  ///< row after row

  int count() const { return static_cast<int>(knots.size()) - degree - 1; }
  HPoint* row(int i) { return points.data() + static_cast<std::ptrdiff_t>(i) * width; }
  const HPoint* row(int i) const { return points.data() + static_cast<std::ptrdiff_t>(i) * width; }
};

Rows rows_of(const NurbsCurve& curve);
/// The rows follow each other in `direction`.
Rows rows_of(const NurbsSurface& surface, Direction direction);
NurbsCurve curve_of(Rows rows);
/// `like` gives degree and knots of the other direction.
NurbsSurface surface_of(Rows rows, Direction direction, const NurbsSurface& like);

/// The row of homogeneous points at t (The NURBS Book, A3.1 without the projection).
std::vector<HPoint> row_at(const Rows& rows, double t);
HPoint homogeneous_point(const NurbsCurve& curve, double t);

/// `values` ascending; those outside the open domain and those beyond multiplicity `degree` are ignored.
void insert(Rows& rows, std::span<const double> values);
void elevate_once(Rows& rows);
void reverse(Rows& rows);
void map_domain(Rows& rows, Interval to);
/// New parameter s with t = lo + L alpha s' / (1 + (alpha - 1) s'), s' = (s - lo) / L: the same shape, other
/// weights (Lee & Lucian 1991). alpha > 0. Both parameters run over the same domain.
void bend(Rows& rows, double alpha);
/// Rows over [part.lo, part.hi] (inside the domain), clamped.
Rows part(Rows rows, Interval part);

}  // namespace burin::geom::detail
