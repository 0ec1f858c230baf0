// SPDX-License-Identifier: Apache-2.0
<<<<<<< HEAD
// Points by place: a hashed grid that answers "which points lie near here" for radii up to half its cell
// size.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
=======
// Points that come and go, and the nearest of them. Internal to the laser planner.
#pragma once

#include <cstdint>
>>>>>>> toolpath
#include <vector>

#include "burin/geom/vec.h"

namespace burin::laser::detail {

<<<<<<< HEAD
class PointGrid {
 public:
  /// `expected`: about how many points will be inserted.
  PointGrid(double cell, std::size_t expected) : cell_(cell) {
    std::size_t buckets = 16;
    while (buckets < 2 * expected) buckets *= 2;
    heads_.assign(buckets, kEnd);
    nodes_.reserve(expected);
  }

  void insert(geom::Point2 p, std::uint32_t id) {
    std::uint32_t& head = heads_[bucket(std::floor(p.x / cell_), std::floor(p.y / cell_))];
    nodes_.push_back({p, id, head});
    head = static_cast<std::uint32_t>(nodes_.size() - 1);
  }

  /// Calls visit(id, squared distance) for the points within `radius` <= cell / 2 of p, in no useful order,
  /// until it returns false. A point may be seen twice when cells share a bucket.
  template <class Visit>
  void near(geom::Point2 p, double radius, Visit visit) const {
    const double x0 = std::floor((p.x - radius) / cell_), x1 = std::floor((p.x + radius) / cell_);
    const double y0 = std::floor((p.y - radius) / cell_), y1 = std::floor((p.y + radius) / cell_);
    const double xs[2] = {x0, x1}, ys[2] = {y0, y1};
    const int nx = x1 != x0 ? 2 : 1, ny = y1 != y0 ? 2 : 1;
    for (int i = 0; i < nx; ++i) {
      for (int j = 0; j < ny; ++j) {
        for (std::uint32_t k = heads_[bucket(xs[i], ys[j])]; k != kEnd; k = nodes_[k].next) {
          const double d2 = geom::distance2(p, nodes_[k].point);
          if (d2 <= radius * radius && !visit(nodes_[k].id, d2)) return;
        }
      }
    }
  }

 private:
  static constexpr std::uint32_t kEnd = 0xffffffffU;
  struct Node {
    geom::Point2 point;
    std::uint32_t id, next;
  };

  static std::uint64_t mix(double v) {
    v += 0.0;  // -0 becomes 0
    std::uint64_t bits = 0;
    std::memcpy(&bits, &v, sizeof bits);
    bits ^= bits >> 29;
    bits *= 0xbf58476d1ce4e5b9ULL;
    bits ^= bits >> 32;
    return bits;
  }
  std::size_t bucket(double cx, double cy) const {
    std::uint64_t h = mix(cx) * 0x9e3779b97f4a7c15ULL + mix(cy);
    h ^= h >> 31;
    h *= 0x94d049bb133111ebULL;
    h ^= h >> 29;
    return static_cast<std::size_t>(h) & (heads_.size() - 1);
  }

  double cell_;
  std::vector<std::uint32_t> heads_;
  std::vector<Node> nodes_;
=======
/// Square cells with about two points each; ties of distance go to the smaller id, so answers do not depend
/// on the order of insertion. Shrinks with the number of points: n insertions, n nearest() and n erasures are
/// O(n log n) for points that are spread evenly when the grid is made.
class PointGrid {
 public:
  /// `points[id]` for all ids that will ever be inserted.
  explicit PointGrid(std::vector<geom::Point2> points);

  void insert(std::uint32_t id);
  void erase(std::uint32_t id);
  std::size_t size() const { return alive_; }

  static constexpr std::uint32_t kNone = 0xffffffffu;
  /// The id nearest to p, kNone when the grid is empty.
  std::uint32_t nearest(geom::Point2 p) const;
  /// Up to `count` nearest ids, nearest first.
  std::vector<std::uint32_t> nearest(geom::Point2 p, std::size_t count) const;

 private:
  void rebuild();
  std::size_t cell_of(geom::Point2 p) const;
  int column_of(double x) const;
  int row_of(double y) const;
  template <class Visit>
  void visit_ring(int column, int row, int ring, Visit&& visit) const;

  std::vector<geom::Point2> points_;
  std::vector<std::uint8_t> in_;
  std::vector<std::vector<std::uint32_t>> cells_;
  geom::Point2 origin_{};
  double size_ = 1;
  int columns_ = 1, rows_ = 1;
  std::size_t alive_ = 0, built_for_ = 0;
>>>>>>> toolpath
};

}  // namespace burin::laser::detail
