// SPDX-License-Identifier: Apache-2.0
// Which triangles meet at which edges. Internal to geom/mesh and what repairs meshes.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/geom/mesh/mesh.h"

namespace burin::geom {

/// Side k of triangle t, from corner k to the next, is half-edge 3 t + k.
using HalfEdge = std::uint32_t;
inline constexpr HalfEdge kBoundary = 0xffffffffu;  ///< no other triangle has this edge
inline constexpr HalfEdge kMany = 0xfffffffeu;      ///< more than one other has it
inline constexpr HalfEdge kNoEdge =
    0xfffffffdu;  ///< of a triangle with a corner twice, or one that is missing
inline bool is_pair(HalfEdge twin) {
  return twin < kNoEdge;
}

inline HalfEdge next_side(HalfEdge h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
inline HalfEdge side_before(HalfEdge h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}
inline std::uint32_t from(const Mesh& mesh, HalfEdge h) {
  return mesh.triangles[h / 3][h % 3];
}
inline std::uint32_t to(const Mesh& mesh, HalfEdge h) {
  return from(mesh, next_side(h));
}
/// The same number for both half-edges of an edge.
inline std::uint64_t edge_key(const Mesh& mesh, HalfEdge h) {
  const std::uint64_t a = from(mesh, h), b = to(mesh, h);
  return a < b ? a << 32 | b : b << 32 | a;
}
/// Three different corners that exist.
bool is_triangle(const Mesh& mesh, std::size_t triangle);

struct Edges {
  std::vector<HalfEdge> twin;      ///< of each half-edge: the other one of its edge, or why there is none
  std::size_t shared_by_many = 0;  ///< edges of more than two triangles
};
Edges find_edges(const Mesh& mesh);

/// Twice the area over the longest edge; 0 where two corners are one.
double height_of(const Mesh& mesh, std::size_t triangle);

}  // namespace burin::geom
