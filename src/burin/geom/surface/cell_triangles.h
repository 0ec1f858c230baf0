// SPDX-License-Identifier: Apache-2.0
// One rectangle cut in triangles along given segments: constrained Delaunay triangulation on a lattice, exact
// in what is left or right. Internal to geom/surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace burin::geom::detail {

/// Sides of a cell in lattice steps. Products of differences fit in 64 bits with room to spare.
inline constexpr std::int64_t kCell = std::int64_t{1} << 26;

struct CellPoint {
  std::int64_t x = 0, y = 0;  ///< 0 .. kCell
  bool operator==(const CellPoint&) const = default;
};
struct CellSegment {
  std::uint32_t from = 0, to = 0;  ///< points
};
struct CellTriangles {
  /// Those given, after them places where segments cross (rounded to the lattice).
  std::vector<CellPoint> points;
  std::vector<std::array<std::uint32_t, 3>> inside;  ///< counter-clockwise
};

/// `points`: the four corners counter-clockwise from (0, 0) first, then others, all different. What is inside
/// changes at every segment (twice the same one: not). `left_inside`: just right of the left side, just above
/// its middle, is inside. `width_share`: real width over real height of the rectangle, for good triangles.
/// Where segments overlap in ways that rounding makes hopeless, some of them are left out.
CellTriangles triangulate_cell(std::vector<CellPoint> points, const std::vector<CellSegment>& segments,
                               bool left_inside, double width_share);

}  // namespace burin::geom::detail
