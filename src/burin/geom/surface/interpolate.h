// SPDX-License-Identifier: Apache-2.0
// Surfaces through grids of points. Piegl & Tiller, The NURBS Book, 9.2. mm.
#pragma once

#include <vector>

#include "burin/base/result.h"
#include "burin/geom/surface/nurbs.h"

namespace burin::geom {

/// Points (i, j) at [i + j * count_u], i along u.
struct PointGrid {
  int count_u = 0, count_v = 0;
  std::vector<Point3> points;
};

/// Bicubic (lower where a direction has fewer than four points) surface that passes through all points;
/// centripetal parameters averaged over rows and columns, averaged knots. C2 inside. Errors (geometry): fewer
/// than 2 x 2 points, points that are not finite, a row or column without length (a single row or column at
/// one end may collapse to a point).
Result<NurbsSurface> interpolate(const PointGrid& grid);

/// The same at given parameters, strictly ascending, one for each column (u) and row (v): surfaces that share
/// a row of points and its parameters share the whole edge. Error (geometry) also for other parameters.
Result<NurbsSurface> interpolate(const PointGrid& grid, const std::vector<double>& u,
                                 const std::vector<double>& v);

}  // namespace burin::geom
