// SPDX-License-Identifier: Apache-2.0
// Triangles that stay within a proven distance of a surface. mm.
#pragma once

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
struct Tessellation {
  Mesh mesh;  ///< counter-clockwise about Su x Sv (about its opposite with `reversed`)
  double deflection_mm =
      0;  ///< proven bound of triangle to surface, both ways; larger than asked for when triangles ran out
};
/// Grid lines per Bezier piece and direction from bounds of the second derivatives (Filip, Magedson & Markot
/// 1986), so that neighbouring cells share their corners: no cracks. `trims`: polygons in (u, v) as in
/// TrimLoop (none: the whole domain); cells outside go, cells the trim passes are cut along it. Error
/// (range): max_triangles is too few for one cell a piece.
Result<Tessellation> tessellate(const NurbsSurface& surface, bool reversed,
                                const std::vector<std::vector<Point2>>& trims,
                                const TessellateOptions& options);

}  // namespace burin::geom
