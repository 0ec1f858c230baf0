// SPDX-License-Identifier: Apache-2.0
// The Bezier pieces of a surface with the bounds of their derivatives, and how many cells they need. Internal
// to geom/surface.
#pragma once

#include <vector>

#include "burin/base/result.h"
#include "burin/geom/surface/second_bounds.h"
#include "burin/geom/surface/tessellate.h"

namespace burin::geom::detail {

struct Spans {
  std::vector<Interval> u, v;
  std::vector<SecondBounds> bounds;  ///< [i + j * u.size()]
  const SecondBounds& at(std::size_t i, std::size_t j) const { return bounds[i + j * u.size()]; }
};
/// `along`: deviations along the surface count too (faces that are cut along trims). Error (range): more
/// pieces or more points of all pieces than memory should hold; what validate() says.
Result<Spans> spans_of(const NurbsSurface& surface, bool along);

/// Error (range): a deflection or longest edge that is not positive, fewer triangles than two a piece.
Result<void> check_budget(const Spans& spans, const TessellateOptions& options);

/// The share of the deflection that the curvature along u may take: candidates, the cheapest wins.
inline constexpr double kShares[] = {0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95};
/// Twisted pieces can be cut into long slivers or into squares at nearly the same price: squares may cost
/// this much more.
inline constexpr double kForShape = 1.25;

/// What cells of a x b leave a surface by, times 8.
inline double deviation8(const SecondBounds& m, double a, double b) {
  return a * a * m.uu + 2 * a * b * m.uv + b * b * m.vv;
}
/// Columns that a piece of this length in u needs at this share; `square`: also for cells as wide as high.
double columns_for(const SecondBounds& m, double length, double share, double deflection, double max_edge,
                   bool square);
/// Rows that go with columns of width a; infinite when none are enough.
double rows_for(const SecondBounds& m, double a, double length, double deflection, double max_edge);

}  // namespace burin::geom::detail
