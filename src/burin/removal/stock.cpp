// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/stock.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/edges.h"
#include "burin/geom/point_tools.h"

namespace burin::removal {
namespace {

using geom::component;

// The axis may be so far from a unit vector.
constexpr double kUnit = 1e-6;
// Coordinates beyond this (mm) are no stock of any machine; single precision and squares hold them.
constexpr double kLargest = 1e6;

Error wrong(const std::string& what) {
  return {ErrorCode::range, "stock: " + what, {}};
}

bool in_reach(geom::Point3 p) {
  return is_finite(p) && std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kLargest;
}

Result<void> check(const BlockStock& block) {
  if (!in_reach(block.lo) || !in_reach(block.hi))
    return wrong("a corner of the block is not finite or too far (up to 1e6 mm)");
  if (!(block.lo.x < block.hi.x && block.lo.y < block.hi.y && block.lo.z < block.hi.z))
    return wrong("the block has no volume (lo < hi in x, y and z)");
  return {};
}

Result<void> check(const CylinderStock& cylinder) {
  if (!in_reach(cylinder.base) || !is_finite(cylinder.axis))
    return wrong("base or axis of the cylinder is not finite or too far (up to 1e6 mm)");
  if (std::abs(norm(cylinder.axis) - 1) > kUnit)
    return wrong("the axis of the cylinder is no unit vector (length 1)");
  for (const double x : {cylinder.radius, cylinder.length})
    if (!(x > 0 && x <= kLargest))
      return wrong("radius and length of the cylinder must be positive (up to 1e6 mm)");
  return {};
}

/// Edges along which the triangles of one sense do not cancel those of the other: none on a closed mesh,
/// whatever touches whatever.
std::size_t open_edges(const geom::Mesh& mesh) {
  std::vector<std::pair<std::uint64_t, int>> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (geom::HalfEdge h = 0; h < 3 * mesh.triangles.size(); ++h) {
    const std::uint32_t a = from(mesh, h), b = to(mesh, h);
    if (a != b) sides.emplace_back(edge_key(mesh, h), a < b ? 1 : -1);
  }
  std::sort(sides.begin(), sides.end());
  std::size_t open = 0;
  for (std::size_t i = 0; i < sides.size();) {
    int sum = 0;
    const std::uint64_t key = sides[i].first;
    for (; i < sides.size() && sides[i].first == key; ++i) sum += sides[i].second;
    open += sum != 0;
  }
  return open;
}

Result<void> check(const MeshStock& stock) {
  const geom::Mesh& mesh = stock.mesh;
  const auto bad = [](const std::string& what) { return Error{ErrorCode::geometry, "stock: " + what, {}}; };
  if (mesh.triangles.empty()) return bad("the mesh has no triangles (a closed mesh)");
  if (mesh.triangles.size() > geom::kNoEdge / 3)
    return wrong("the mesh has too many triangles (up to 1.4e9)");
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (v >= mesh.vertices.size() || !in_reach(mesh.vertices[v]))
        return bad("triangle " + std::to_string(t) +
                   " has a corner that is not there, not finite or too far (up to 1e6 mm)");
  if (const std::size_t open = open_edges(mesh); open > 0)
    return bad("the mesh is open along " + std::to_string(open) +
               " edges (a closed mesh, triangles counter-clockwise from outside)");
  const double volume = geom::examine(mesh).signed_volume;
  if (!(volume > 0))
    return bad(volume < 0 ? "the mesh is inside out (a closed mesh, triangles counter-clockwise from outside)"
                          : "the mesh has no volume (a closed mesh)");
  return {};
}

geom::Box3 box_of(const BlockStock& block) {
  return {block.lo, block.hi};
}
geom::Box3 box_of(const CylinderStock& c) {
  const auto aside = [&](std::size_t i) {
    const double a = component(c.axis, i);
    return c.radius * std::sqrt(std::max(0.0, 1 - a * a));
  };
  const geom::Vec3 grow{aside(0), aside(1), aside(2)};
  geom::Box3 box;
  for (const geom::Point3 end : {c.base, c.base + c.length * c.axis}) {
    box.add(end - grow);
    box.add(end + grow);
  }
  return box;
}
geom::Box3 box_of(const MeshStock& stock) {
  geom::Box3 box;
  for (const auto& t : stock.mesh.triangles)
    for (const std::uint32_t v : t) box.add(stock.mesh.vertices[v]);
  return box;
}

}  // namespace

Result<void> validate(const Stock& stock) {
  return std::visit([](const auto& s) { return check(s); }, stock);
}
geom::Box3 bounds(const Stock& stock) {
  return std::visit([](const auto& s) { return box_of(s); }, stock);
}

}  // namespace burin::removal
