// SPDX-License-Identifier: Apache-2.0
#include "burin/view/mesh_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

namespace burin::view {
namespace {

using geom::Mesh;
using geom::Point3;
using geom::Vec3;
using Triangle = std::array<std::uint32_t, 3>;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr int kRounds = 24;  ///< of halving
/// Rounds in which values spread to vertices that no sample is next to.
constexpr int kSpread = 4;
/// A sample and a vertex whose normals differ by more (cosine) are on different sides of a wall or an edge.
constexpr double kSameSide = 0.5;

/// The middle of an edge, made once. (Only looked up, never walked.)
class Middles {
 public:
  Middles(Mesh& mesh, double longest) : mesh_(mesh), longest_(longest) {}
  /// Nothing: the edge stays.
  std::uint32_t of(std::uint32_t a, std::uint32_t b) {
    if (geom::distance(mesh_.vertices[a], mesh_.vertices[b]) <= longest_) return kStays;
    const std::uint64_t key = a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
    const auto [at, fresh] = made_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (fresh) mesh_.vertices.push_back(lerp(mesh_.vertices[a], mesh_.vertices[b], 0.5));
    return at->second;
  }
  static constexpr std::uint32_t kStays = 0xffffffffu;

 private:
  Mesh& mesh_;
  double longest_;
  std::unordered_map<std::uint64_t, std::uint32_t> made_;
};

void split(const Triangle& t, const std::array<std::uint32_t, 3>& middle, std::vector<Triangle>& out) {
  const auto has = [&middle](std::size_t k) { return middle[k] != Middles::kStays; };
  const int count = has(0) + has(1) + has(2);
  if (count == 0) {
    out.push_back(t);
  } else if (count == 3) {
    out.push_back({t[0], middle[0], middle[2]});
    out.push_back({middle[0], t[1], middle[1]});
    out.push_back({middle[2], middle[1], t[2]});
    out.push_back({middle[0], middle[1], middle[2]});
  } else {
    // Turned so that side 0 is halved, and side 2 is not.
    std::size_t k = 0;
    while (!(has(k) && !has((k + 2) % 3))) ++k;
    const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3], ab = middle[k],
                        bc = middle[(k + 1) % 3];
    out.push_back({a, ab, c});
    if (count == 1) {
      out.push_back({ab, b, c});
    } else {
      out.push_back({ab, b, bc});
      out.push_back({ab, bc, c});
    }
  }
}

/// Vertices in cells of a grid, by sorted keys.
class VertexGrid {
 public:
  VertexGrid(const Mesh& mesh, double cell) : mesh_(mesh), cell_(cell) {
    for (const Point3& p : mesh.vertices) box_.add(p);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      sorted_.push_back({key(place(mesh.vertices[v], 0, 0, 0)), static_cast<std::uint32_t>(v)});
    std::sort(sorted_.begin(), sorted_.end());
  }
  template <class Each>
  void near(Point3 p, const Each& each) const {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const std::uint64_t wanted = key(place(p, x, y, z));
          auto at = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair{wanted, 0u});
          for (; at != sorted_.end() && at->first == wanted; ++at) each(at->second);
        }
      }
    }
  }

 private:
  std::array<std::int64_t, 3> place(Point3 p, int x, int y, int z) const {
    const auto at = [this](double v) { return static_cast<std::int64_t>(std::floor(v / cell_)); };
    return {at(p.x - box_.lo.x) + x + 1, at(p.y - box_.lo.y) + y + 1, at(p.z - box_.lo.z) + z + 1};
  }
  static std::uint64_t key(const std::array<std::int64_t, 3>& c) {
    constexpr std::uint64_t kMask = (1u << 21) - 1;
    return (static_cast<std::uint64_t>(c[0]) & kMask) << 42 |
           (static_cast<std::uint64_t>(c[1]) & kMask) << 21 | (static_cast<std::uint64_t>(c[2]) & kMask);
  }
  const Mesh& mesh_;
  double cell_;
  geom::Box3 box_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted_;
};

std::vector<Vec3> vertex_normals(const Mesh& mesh) {
  std::vector<Vec3> sum(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    const Point3 a = mesh.vertices[t[0]];
    const Vec3 area = cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
    for (const std::uint32_t v : t) sum[v] = sum[v] + area;
  }
  for (Vec3& n : sum) n = geom::unit(n);
  return sum;
}

void spread(const Mesh& mesh, std::vector<float>& values, std::vector<bool>& known) {
  for (int round = 0; round < kSpread; ++round) {
    std::vector<double> sum(values.size(), 0);
    std::vector<int> count(values.size(), 0);
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (const std::uint32_t other : {t[(k + 1) % 3], t[(k + 2) % 3]}) {
          if (known[t[k]] || !known[other] || std::isnan(values[other])) continue;
          sum[t[k]] += values[other];
          ++count[t[k]];
        }
      }
    }
    for (std::size_t v = 0; v < values.size(); ++v) {
      if (count[v] == 0) continue;
      values[v] = static_cast<float>(sum[v] / count[v]);
      known[v] = true;
    }
  }
}

}  // namespace

Mesh refined(Mesh mesh, double longest_mm, std::size_t max_triangles) {
  if (!(longest_mm > 0)) return mesh;
  for (int round = 0; round < kRounds; ++round) {
    Mesh next;
    next.vertices = mesh.vertices;
    Middles middles(next, longest_mm);
    for (const Triangle& t : mesh.triangles) {
      const std::array<std::uint32_t, 3> middle{middles.of(t[0], t[1]), middles.of(t[1], t[2]),
                                                middles.of(t[2], t[0])};
      split(t, middle, next.triangles);
      if (next.triangles.size() > max_triangles) return mesh;
    }
    const bool done = next.triangles.size() == mesh.triangles.size();
    mesh = std::move(next);
    if (done) break;
  }
  return mesh;
}

double edge_for(const Mesh& mesh, std::size_t triangles) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Point3 a = mesh.vertices[t[0]];
    area += norm(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a)) / 2;
  }
  // Halving leaves edges between half of the longest and the longest: three quarters in the middle.
  return std::sqrt(area / static_cast<double>(std::max<std::size_t>(1, triangles)) * 4 / std::sqrt(3.0)) /
         0.75;
}

std::vector<float> vertex_values(const Mesh& mesh, const std::vector<verify::SurfaceSample>& samples,
                                 const std::vector<float>& values) {
  const std::size_t n = mesh.vertices.size();
  std::vector<float> out(n, kNaN);
  const double cell = edge_for(mesh, mesh.triangles.size());
  if (!(cell > 0) || samples.size() != values.size()) return out;
  const std::vector<Vec3> normals = vertex_normals(mesh);
  const VertexGrid grid(mesh, cell);
  std::vector<bool> known(n, false);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double best = std::numeric_limits<double>::infinity();
    std::size_t nearest = n;
    grid.near(samples[i].p, [&](std::uint32_t v) {
      const double d = geom::distance(mesh.vertices[v], samples[i].p);
      if (d >= best || dot(normals[v], samples[i].n) < kSameSide) return;
      best = d;
      nearest = v;
    });
    if (nearest == n) continue;
    known[nearest] = true;
    float& worst = out[nearest];
    if (!std::isnan(values[i]) && (std::isnan(worst) || std::abs(values[i]) > std::abs(worst)))
      worst = values[i];
  }
  spread(mesh, out, known);
  return out;
}

}  // namespace burin::view
