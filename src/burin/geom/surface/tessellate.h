// SPDX-License-Identifier: Apache-2.0
// Triangles that stay within a proven distance of a surface. mm. docs/surfaces.md
#pragma once

#include <cstddef>
#include <vector>

#include "burin/base/result.h"
#include "burin/geom/mesh/mesh.h"
#include "burin/geom/surface/nurbs.h"

namespace burin::geom {

struct TessellateOptions {
  double deflection_mm = 0.01;
  double max_edge_mm = 0;  ///< 0: as the deflection allows
  std::size_t max_triangles = 2'000'000;
};

/// Parameters of the columns and rows of a grid whose cells, cut in triangles in any way, leave the surface
/// by at most `deflection_mm`. All knots are among them.
struct GridLines {
  std::vector<double> u, v;
  double deflection_mm = 0;
};
/// Lines per Bezier piece and direction from bounds of the second derivatives (Filip, Magedson & Markot
/// 1986). Error (range): options.max_triangles is too few for one cell a piece, numbers that are not
/// positive.
Result<GridLines> grid_lines(const NurbsSurface& surface, const TessellateOptions& options);

struct Tessellation {
  Mesh mesh;  ///< counter-clockwise about Su x Sv (about its opposite with `reversed`)
  double deflection_mm =
      0;  ///< proven bound of triangle to surface, both ways; larger than asked for when triangles ran out
};
/// Over the cells of grid_lines: neighbours share their corners, no cracks. `trims`: polygons in (u, v) as in
/// TrimLoop (none: the whole domain); cells outside go, cells the trim passes are cut along it. Errors as
/// grid_lines; (geometry) trims that are not finite.
Result<Tessellation> tessellate(const NurbsSurface& surface, bool reversed,
                                const std::vector<std::vector<Point2>>& trims,
                                const TessellateOptions& options);

}  // namespace burin::geom
