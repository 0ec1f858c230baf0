// SPDX-License-Identifier: Apache-2.0
#include "burin/view/mesh_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

namespace burin::view {
namespace {

using geom::Point3;
using geom::Vec3;
using Triangle = std::array<std::uint32_t, 3>;

constexpr double kCrease = 0.8;   ///< cosine of the angle between triangles that are drawn with an edge
constexpr double kSmooth = 0.02;  ///< vertices less sharp than this are all alike
constexpr std::size_t kFan = 64;  ///< a vertex with more triangles (the hub of a fan) is drawn flat

Vec3 normal_of(const geom::Mesh& mesh, const Triangle& t) {
  const Point3 a = mesh.vertices[t[0]];
  return cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
}

/// Vertices put together by cells of a grid and the side they look to (a thin wall keeps both): each cell is
/// drawn at the vertex with the sharpest edge in it, without one at the vertex next to its middle.
class Clusters {
 public:
  Clusters(const geom::Mesh& mesh, std::size_t first, std::size_t end, Point3 corner, double cell)
      : corner_(corner), cell_(cell), cell_of_(mesh.vertices.size(), kNone) {
    const std::size_t n = mesh.vertices.size();
    std::vector<Vec3> sum(n);
    std::vector<double> weight(n, 0);
    for (std::size_t i = first; i < end; ++i) {
      const Vec3 area = normal_of(mesh, mesh.triangles[i]);
      for (const std::uint32_t v : mesh.triangles[i]) sum[v] = sum[v] + area, weight[v] += norm(area);
    }
    std::unordered_map<std::uint64_t, std::uint32_t> seen;  // only looked up, never walked
    std::vector<std::pair<double, double>> best;            // sharpness, distance from the middle of the cell
    for (std::size_t v = 0; v < n; ++v) {
      if (!(weight[v] > 0)) continue;
      const auto [at, fresh] =
          seen.try_emplace(key(mesh.vertices[v], sum[v]), static_cast<std::uint32_t>(points.size()));
      const double sharp = std::max(1 - norm(sum[v]) / weight[v], kSmooth),
                   off = from_middle(mesh.vertices[v]);
      if (fresh) points.push_back(mesh.vertices[v]), best.push_back({sharp, off});
      auto& [sharpest, nearest] = best[at->second];
      if (sharp > sharpest || (sharp == sharpest && off < nearest))
        sharpest = sharp, nearest = off, points[at->second] = mesh.vertices[v];
      cell_of_[v] = at->second;
    }
  }
  /// Nothing for a triangle that falls together.
  std::optional<Triangle> of(const Triangle& t) const {
    const Triangle c{cell_of_[t[0]], cell_of_[t[1]], cell_of_[t[2]]};
    const bool whole =
        c[0] != c[1] && c[1] != c[2] && c[2] != c[0] && c[0] != kNone && c[1] != kNone && c[2] != kNone;
    return whole ? std::optional(c) : std::nullopt;
  }
  std::vector<std::uint32_t> cells() && { return std::move(cell_of_); }
  std::vector<Point3> points;

 private:
  static constexpr std::uint32_t kNone = ReducedMesh::kGone;
  std::uint64_t key(Point3 p, Vec3 side) const {
    const auto part = [this](double v) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v / cell_))) & 0xfffffu;
    };
    // The greatest component of the normal and its sign: six sides.
    const double x = std::abs(side.x), y = std::abs(side.y), z = std::abs(side.z);
    const double most = x >= y && x >= z ? side.x : y >= z ? side.y : side.z;
    const std::uint64_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    return (2 * axis + (most < 0 ? 1 : 0)) << 60 | part(p.x - corner_.x) << 40 | part(p.y - corner_.y) << 20 |
           part(p.z - corner_.z);
  }
  double from_middle(Point3 p) const {
    const auto off = [this](double v) { return v / cell_ - std::floor(v / cell_) - 0.5; };
    return norm(Vec3{off(p.x - corner_.x), off(p.y - corner_.y), off(p.z - corner_.z)});
  }
  Point3 corner_;
  double cell_;
  std::vector<std::uint32_t> cell_of_;
};

std::optional<ReducedMesh> clustered(const geom::Mesh& mesh, std::size_t first, std::size_t end,
                                     Point3 corner, double cell, std::size_t max_triangles) {
  Clusters clusters(mesh, first, end, corner, cell);
  ReducedMesh out;
  for (std::size_t i = first; i < end; ++i) {
    const auto t = clusters.of(mesh.triangles[i]);
    if (!t) continue;
    if (out.source.size() >= max_triangles) return std::nullopt;
    out.mesh.triangles.push_back(*t);
    out.source.push_back(i);
  }
  out.mesh.vertices = std::move(clusters.points);
  out.became = std::move(clusters).cells();
  return out;
}

}  // namespace

ReducedMesh reduced(const geom::Mesh& mesh, std::size_t first, std::size_t end, std::size_t max_triangles) {
  end = std::min(end, mesh.triangles.size());
  first = std::min(first, end);
  if (end - first <= max_triangles) {
    ReducedMesh out;
    out.mesh.vertices = mesh.vertices;
    out.became.resize(mesh.vertices.size());
    std::iota(out.became.begin(), out.became.end(), 0u);
    for (std::size_t i = first; i < end; ++i)
      out.mesh.triangles.push_back(mesh.triangles[i]), out.source.push_back(i);
    return out;
  }
  geom::Box3 box;
  double area = 0;
  for (std::size_t i = first; i < end; ++i) {
    for (const std::uint32_t v : mesh.triangles[i]) box.add(mesh.vertices[v]);
    area += norm(normal_of(mesh, mesh.triangles[i])) / 2;
  }
  const double wanted = std::sqrt(area / static_cast<double>(std::max<std::size_t>(1, max_triangles)));
  // A cell's number along an axis has 20 bits; without area nothing is drawn.
  const double least = norm(box.hi - box.lo) / (1 << 18);
  double cell = std::max({wanted, least, std::numeric_limits<double>::min()});
  for (;; cell *= 1.25) {
    auto out = clustered(mesh, first, end, box.lo, cell, max_triangles);
    if (out) return std::move(*out);
  }
}

Shape shaded(const geom::Mesh& mesh, const ReducedMesh& reduced) {
  std::vector<Vec3> area;
  std::vector<std::uint32_t> start(mesh.vertices.size() + 1, 0), about(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    area.push_back(normal_of(mesh, t));
    for (const std::uint32_t v : t) ++start[v + 1];
  }
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i]) about[next[v]++] = static_cast<std::uint32_t>(i);
  Shape shape;
  for (std::size_t i = 0; i < reduced.source.size(); ++i) {
    const Vec3 flat = unit(area[reduced.source[i]]);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh.triangles[reduced.source[i]][c];
      Vec3 sum{};
      if (start[v + 1] - start[v] <= kFan) {
        for (std::uint32_t k = start[v]; k < start[v + 1]; ++k) {
          const Vec3 other = area[about[k]];
          if (dot(flat, other) >= kCrease * norm(other)) sum = sum + other;
        }
      }
      const double length = norm(sum);
      shape.points.push_back(reduced.mesh.vertices[reduced.mesh.triangles[i][c]]);
      shape.normals.push_back(length > 0 ? sum / length : flat);
    }
  }
  return shape;
}

}  // namespace burin::view
