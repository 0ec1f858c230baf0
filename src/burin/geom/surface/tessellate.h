// SPDX-License-Identifier: Apache-2.0
// Triangles that stay within a proven distance of a surface. mm. docs/surfaces.md
#pragma once

#include <cstddef>
#include <memory>
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

/// One face, for which the bounds are computed once. Copies share them.
class Tessellator {
 public:
  /// `trims`: polygons in (u, v) as in TrimLoop (none: the whole domain). Keeps the addresses of both. Errors
  /// (range): more pieces than memory should hold; (geometry) damaged surfaces, trims that are not finite.
  static Result<Tessellator> make(const NurbsSurface& surface, const std::vector<std::vector<Point2>>& trims);

  /// About how many triangles the face has (without trims).
  double triangles(double deflection_mm, double max_edge_mm = 0) const;
  /// Without trims every Bezier piece has a grid of its own; neighbours share all places of their common
  /// sides: no cracks. With trims over the cells of grid_lines: those outside go, those the trim passes are
  /// cut along it. Errors as grid_lines.
  Result<Tessellation> build(bool reversed, const TessellateOptions& options) const;

 private:
  struct State;
  Tessellator() = default;
  std::shared_ptr<const State> state_;
};
Result<Tessellation> tessellate(const NurbsSurface& surface, bool reversed,
                                const std::vector<std::vector<Point2>>& trims,
                                const TessellateOptions& options);

}  // namespace burin::geom
