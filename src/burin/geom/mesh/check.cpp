// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/mesh/check.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "burin/geom/mesh/edges.h"

namespace burin::geom {

namespace {

/// Heights below this part of the longest edge are rounding.
constexpr double kFlat = 1e-15;

bool without_area(const Mesh& mesh, std::size_t triangle) {
  if (!is_triangle(mesh, triangle)) return true;
  const auto& t = mesh.triangles[triangle];
  const Point3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
  return !(height_of(mesh, triangle) > kFlat * std::max({norm(b - a), norm(c - b), norm(a - c)}));
}

/// Six times the volume between the triangle and `o`.
double wedge(const Mesh& mesh, std::size_t triangle, Point3 o) {
  const auto& t = mesh.triangles[triangle];
  return dot(mesh.vertices[t[0]] - o, cross(mesh.vertices[t[1]] - o, mesh.vertices[t[2]] - o));
}

/// Follows the open edges and cuts their chains into loops without repeated corners.
class Holes {
 public:
  Holes(const Mesh& mesh, const Edges& edges) : mesh_(mesh), twin_(edges.twin), used_(twin_.size(), false) {
    for (HalfEdge h = 0; h < twin_.size(); ++h) {
      if (twin_[h] != kBoundary) continue;
      leaving_.emplace(from(mesh, h), h);
      arriving_.emplace(to(mesh, h), h);
    }
  }

  std::vector<MeshHole> all() {
    for (HalfEdge h = 0; h < twin_.size(); ++h) {
      if (twin_[h] == kBoundary && !used_[h]) follow(h);
    }
    return std::move(out_);
  }

 private:
  void follow(HalfEdge first) {
    std::vector<std::uint32_t> path{from(mesh_, first)};
    std::map<std::uint32_t, std::size_t> place{{path[0], 0}};
    for (HalfEdge h = first; h != kBoundary; h = next(path.back())) {
      used_[h] = true;
      const std::uint32_t at = from(mesh_, h) == path.back() ? to(mesh_, h) : from(mesh_, h);
      const auto [found, is_new] = place.try_emplace(at, path.size());
      if (is_new) {
        path.push_back(at);
        continue;
      }
      const std::size_t start = found->second;
      add(path, start);
      for (std::size_t i = start + 1; i < path.size(); ++i) place.erase(path[i]);
      path.resize(start + 1);
      if (start == 0) return;
    }
    add(path, 0);  // the chain ends where many triangles share an edge
  }

  HalfEdge next(std::uint32_t vertex) const {
    for (const auto* edges : {&leaving_, &arriving_}) {
      for (auto [i, end] = edges->equal_range(vertex); i != end; ++i) {
        if (!used_[i->second]) return i->second;
      }
    }
    return kBoundary;
  }

  void add(const std::vector<std::uint32_t>& path, std::size_t start) {
    MeshHole& hole = out_.emplace_back();
    for (std::size_t i = start; i < path.size(); ++i) {
      hole.points.push_back(mesh_.vertices[path[i]]);
      hole.box.add(hole.points.back());
    }
  }

  const Mesh& mesh_;
  const std::vector<HalfEdge>& twin_;
  std::vector<bool> used_;
  std::multimap<std::uint32_t, HalfEdge> leaving_, arriving_;
  std::vector<MeshHole> out_;
};

}  // namespace

MeshReport examine(const Mesh& mesh) {
  MeshReport out;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (without_area(mesh, t)) ++out.degenerate;
    if (!is_triangle(mesh, t)) continue;
    for (const std::uint32_t i : mesh.triangles[t]) out.bounds.add(mesh.vertices[i]);
  }
  const Point3 middle = out.bounds.empty() ? Point3{} : lerp(out.bounds.lo, out.bounds.hi, 0.5);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_triangle(mesh, t)) out.signed_volume += wedge(mesh, t, middle) / 6;
  }
  const Edges edges = find_edges(mesh);
  out.shared_by_many = edges.shared_by_many;
  for (HalfEdge h = 0; h < edges.twin.size(); ++h) {
    const HalfEdge other = edges.twin[h];
    if (is_pair(other) && h < other && from(mesh, h) == from(mesh, other)) ++out.against_sense;
  }
  out.holes = Holes(mesh, edges).all();
  return out;
}

}  // namespace burin::geom
