// SPDX-License-Identifier: Apache-2.0
// Where two segments (lines or arcs) meet. mm.
#pragma once

#include <array>
#include <variant>

#include "burin/geom/curve/arc_spline.h"

namespace burin::geom {

struct NoIntersection {};
/// One or two points (tangent contact counts as one).
struct PointIntersections {
  std::array<Point2, 2> point;
  int count = 0;
};
/// Carried by the same line or circle within the tolerance, and sharing the stretch from `a` to `b` (in the
/// direction of the first segment). Two arcs of one circle may share a second stretch; it is then in `c`,
/// `d`.
struct Overlap {
  Point2 a, b;
  bool twice = false;
  Point2 c{}, d{};
};
using Intersection = std::variant<NoIntersection, PointIntersections, Overlap>;

/// Segments that come within `tolerance` of each other without crossing count as meeting there: ends on the
/// other segment, tangent contact, coincident carriers. Points lie on both within tolerance plus rounding.
Intersection intersect(const Segment& s, const Segment& t, double tolerance);

}  // namespace burin::geom
