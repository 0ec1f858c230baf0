// SPDX-License-Identifier: Apache-2.0
// How the surface runs through a cell of eight nodes: one sheet or several. Internal to removal.
#pragma once

#include <array>
#include <cstdint>

namespace burin::removal {

/// Corners of a cell: bit dx + 2 dy + 4 dz, set for material. Edge (axis, p, q): 4 axis + p + 2 q, where p
/// and q are the places on the next axes in the order x, y, z, x. Face (axis, s): 2 axis + s.
struct CellSheets {
  static constexpr std::uint8_t kNone = 0xff;
  std::array<std::uint8_t, 12> of_edge{};  ///< kNone: the surface does not cross it
  std::uint8_t count = 0;
};
/// On faces with material in two opposite corners only the sheets keep the material apart; where bit of the
/// face is set in `joined`, together.
CellSheets cell_sheets(unsigned corners, unsigned joined);
/// Material in two opposite corners of the face only, and all four crossings in one sheet (none joined).
/// Where this is so on both sides of a face, an edge of the mesh would have four triangles: such faces are
/// joined.
bool meets_itself(unsigned corners, unsigned face);

/// Corner number of an edge's lower node; the upper one is 1 << axis more.
constexpr unsigned corner_of_edge(unsigned edge) {
  const unsigned axis = edge / 4, p = edge & 1, q = edge >> 1 & 1;
  return p << (axis + 1) % 3 | q << (axis + 2) % 3;
}

}  // namespace burin::removal
