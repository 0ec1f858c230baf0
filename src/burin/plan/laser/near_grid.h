// SPDX-License-Identifier: Apache-2.0
// Points by place: a hashed grid that answers "which points lie near here" for radii up to half its cell
// size.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::laser::detail {

class NearGrid {
 public:
  /// `expected`: about how many points will be inserted.
  NearGrid(double cell, std::size_t expected) : cell_(cell) {
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
};

}  // namespace burin::laser::detail
