// SPDX-License-Identifier: Apache-2.0
// A grid of its own for every Bezier piece; neighbours share all places on their common side. Internal to
// geom/surface.
#pragma once

#include "burin/geom/mesh/mesh.h"
#include "burin/geom/surface/spans.h"
#include "burin/geom/surface/tessellate.h"

namespace burin::geom::detail {

/// burin::geom::grid_lines from given bounds.
Result<GridLines> grid_lines(const Spans& spans, const TessellateOptions& options);

struct PatchCounts {
  std::vector<std::uint32_t> u, v;  ///< columns and rows, [i + j * spans.u.size()]
  double total = 0;                 ///< about so many triangles
  double deflection_mm = 0;         ///< proven
};
PatchCounts patch_counts(const Spans& spans, double deflection, double max_edge);
Mesh patch_mesh(const NurbsSurface& surface, const Spans& spans, const PatchCounts& counts, bool reversed);

}  // namespace burin::geom::detail
