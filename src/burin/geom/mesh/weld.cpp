// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/edges.h"

namespace burin::geom {

namespace {

/// Points no two of which are nearer than the tolerance, in cubes of four tolerances: few a cube, so that the
/// time stays linear whatever the points are.
class Leaders {
 public:
  explicit Leaders(double tolerance) : tolerance_(tolerance > 0 ? tolerance : 0) {}

  /// The nearest leader within the tolerance (of equally near ones the first); a new one when there is none.
  std::uint32_t of(Point3 p) {
    const Cell lo = cell(p, -tolerance_), hi = cell(p, tolerance_);  // neighbours, if not the same
    std::uint32_t best = kNone;
    double distance2 = tolerance_ * tolerance_;
    for (unsigned i = 0; i < 8; ++i) {
      Cell at = lo;
      bool is_new = true;
      for (unsigned k = 0; k < 3; ++k) {
        if ((i >> k & 1) == 0) continue;
        is_new = is_new && hi[k] != lo[k];
        at[k] = hi[k];
      }
      if (is_new) look_at(at, p, best, distance2);
    }
    if (best != kNone) return best;
    best = static_cast<std::uint32_t>(points_.size());
    points_.push_back(p);
    const auto [first, is_new] = first_.try_emplace(cell(p, 0), best);
    next_.push_back(is_new ? kNone : first->second);
    first->second = best;
    return best;
  }

  std::vector<Point3> points() && { return std::move(points_); }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  using Cell = std::array<double, 3>;
  struct Hash {
    std::size_t operator()(const Cell& c) const {
      std::uint64_t h = 0;
      for (const double v : c) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &v, sizeof bits);
        h = (h ^ bits) * 0x9e3779b97f4a7c15ULL;
        h ^= h >> 32;
      }
      return static_cast<std::size_t>(h);
    }
  };

  /// Whole numbers, and -0 as 0. Where numbers are too large for cubes every number is its own cube.
  Cell cell(Point3 p, double by) const {
    const auto number = [&](double v) {
      const double at = v + by;
      return tolerance_ > 0 && std::abs(at) < 1e15 * tolerance_ ? std::floor(at / (4 * tolerance_)) + 0.0
                                                                : v + 0.0;
    };
    return {number(p.x), number(p.y), number(p.z)};
  }

  void look_at(const Cell& where, Point3 p, std::uint32_t& best, double& distance2) const {
    const auto first = first_.find(where);
    if (first == first_.end()) return;
    for (std::uint32_t i = first->second; i != kNone; i = next_[i]) {
      const Vec3 d = points_[i] - p;
      const double d2 = dot(d, d);
      if (d2 < distance2 || (d2 == distance2 && i < best)) distance2 = d2, best = i;
    }
  }

  double tolerance_;
  std::vector<Point3> points_;
  std::unordered_map<Cell, std::uint32_t, Hash> first_;
  std::vector<std::uint32_t> next_;
};

/// Corners in ascending order, and whether that turns the triangle over.
struct Corners {
  std::array<std::uint32_t, 3> sorted;
  bool turned;
};
Corners corners_of(std::array<std::uint32_t, 3> t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  const bool turned = t[1] > t[2];
  if (turned) std::swap(t[1], t[2]);
  return {t, turned};
}

/// Of triangles with the same corners those of opposite sense cancel; of the rest one stays.
std::vector<bool> repeated(const Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.triangles.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::vector<Corners> corners;
  corners.reserve(order.size());
  for (const auto& t : mesh.triangles) corners.push_back(corners_of(t));
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return corners[a].sorted != corners[b].sorted ? corners[a].sorted < corners[b].sorted : a < b;
  });
  std::vector<bool> gone(order.size(), false);
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    int sum = 0;
    for (; end < order.size() && corners[order[end]].sorted == corners[order[i]].sorted; ++end)
      sum += corners[order[end]].turned ? -1 : 1;
    bool kept = sum == 0;
    for (; i < end; ++i) {
      const bool right = corners[order[i]].turned == (sum < 0);
      gone[order[i]] = kept || !right;
      kept = kept || right;
    }
  }
  return gone;
}

/// Leaves out what no triangle has.
Mesh compacted(const Mesh& mesh) {
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> to(mesh.vertices.size(), kUnused);
  Mesh out;
  for (auto t : mesh.triangles) {
    for (std::uint32_t& i : t) {
      if (to[i] == kUnused) {
        to[i] = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[i]);
      }
      i = to[i];
    }
    out.triangles.push_back(t);
  }
  return out;
}

}  // namespace

Mesh welded(const Mesh& mesh, double tolerance_mm) {
  Leaders leaders(tolerance_mm);
  std::vector<std::uint32_t> to(mesh.vertices.size());
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = leaders.of(mesh.vertices[i]);
  Mesh joined;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!is_triangle(mesh, i)) continue;
    auto t = mesh.triangles[i];
    for (std::uint32_t& k : t) k = to[k];
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) joined.triangles.push_back(t);
  }
  joined.vertices = std::move(leaders).points();
  const std::vector<bool> gone = repeated(joined);
  std::size_t n = 0;
  for (std::size_t i = 0; i < joined.triangles.size(); ++i) {
    if (!gone[i]) joined.triangles[n++] = joined.triangles[i];
  }
  joined.triangles.resize(n);
  return compacted(joined);
}

}  // namespace burin::geom
