// SPDX-License-Identifier: Apache-2.0
// Internal to joining: which cells become one surface (the E word). Topology and areas only.
#pragma once

#include <vector>

#include "burin/geom/surface/join_cells.h"

namespace burin::geom::detail {

/// width x height cells, x fastest; at(0, 0) is the corner of lowest u and v.
struct Rectangle {
  int width = 0, height = 0;
  std::vector<Placed> cells;

  const Placed& at(int x, int y) const { return cells[static_cast<std::size_t>(x + y * width)]; }
  Placed& at(int x, int y) { return cells[static_cast<std::size_t>(x + y * width)]; }
};

/// Every cell in exactly one rectangle; each rectangle turned so that its first cell is in its own
/// orientation; ordered by the first cell. `u`, `v` of u_first and v_first are those of the first patch of
/// each connected part, carried on over the contacts.
std::vector<Rectangle> group(const CellGraph& graph, Grouping grouping);

}  // namespace burin::geom::detail
