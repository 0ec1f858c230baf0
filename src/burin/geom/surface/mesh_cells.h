// SPDX-License-Identifier: Apache-2.0
// From cells of the parameter plane to triangles. Internal to geom/surface.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "burin/geom/mesh/mesh.h"

namespace burin::geom::detail {

/// Corners at one place (poles) make no triangle.
inline void add_triangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, bool reversed) {
  const auto& p = mesh.vertices;
  if (p[a] == p[b] || p[b] == p[c] || p[c] == p[a]) return;
  if (reversed) std::swap(b, c);
  mesh.triangles.push_back({a, b, c});
}

/// Counter-clockwise corners; cut at the shorter diagonal.
inline void add_cell(Mesh& mesh, const std::array<std::uint32_t, 4>& c, bool reversed) {
  const auto& p = mesh.vertices;
  const std::size_t k = distance(p[c[0]], p[c[2]]) <= distance(p[c[1]], p[c[3]]) ? 0 : 1;
  add_triangle(mesh, c[k], c[k + 1], c[k + 2], reversed);
  add_triangle(mesh, c[k], c[k + 2], c[(k + 3) % 4], reversed);
}

}  // namespace burin::geom::detail
