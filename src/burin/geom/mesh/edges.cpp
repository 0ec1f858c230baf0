// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/mesh/edges.h"

#include <algorithm>
#include <utility>

namespace burin::geom {

bool is_triangle(const Mesh& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const std::size_t n = mesh.vertices.size();
  return t[0] < n && t[1] < n && t[2] < n && t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

double height_of(const Mesh& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Point3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
  const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
  return longest > 0 ? norm(cross(b - a, c - a)) / longest : 0;
}

Edges find_edges(const Mesh& mesh) {
  const std::size_t sides = 3 * mesh.triangles.size();
  Edges out;
  out.twin.assign(sides, kNoEdge);
  std::vector<std::pair<std::uint64_t, HalfEdge>> list;
  list.reserve(sides);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!is_triangle(mesh, t)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto h = static_cast<HalfEdge>(3 * t + k);
      list.emplace_back(edge_key(mesh, h), h);
    }
  }
  std::sort(list.begin(), list.end());
  for (std::size_t i = 0; i < list.size();) {
    std::size_t end = i + 1;
    while (end < list.size() && list[end].first == list[i].first) ++end;
    if (end - i == 2) {
      out.twin[list[i].second] = list[i + 1].second;
      out.twin[list[i + 1].second] = list[i].second;
    } else {
      for (std::size_t k = i; k < end; ++k) out.twin[list[k].second] = end - i == 1 ? kBoundary : kMany;
      if (end - i > 2) ++out.shared_by_many;
    }
    i = end;
  }
  return out;
}

}  // namespace burin::geom
