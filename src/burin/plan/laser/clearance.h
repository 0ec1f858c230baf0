// SPDX-License-Identifier: Apache-2.0
// Distances between moves and outlines, answered from a tree of boxes. Internal to the laser planner.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "burin/geom/curve/arc_spline.h"
#include "burin/plan/laser/profile.h"

namespace burin::laser::detail {

/// Static binary tree over boxes; a query visits every box that overlaps. O(n log n) to build.
class BoxTree {
 public:
  explicit BoxTree(std::vector<geom::Box2> boxes = {});

  geom::Box2 bounds() const { return nodes_.empty() ? geom::Box2{} : nodes_.front().box; }

  /// `visit(index)` returns false to stop; the order of visits is fixed but means nothing. False when
  /// stopped.
  template <class Visit>
  bool query(const geom::Box2& area, Visit&& visit) const {
    if (nodes_.empty()) return true;
    std::uint32_t stack[kMaxDepth];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const Node& node = nodes_[stack[--top]];
      if (!node.box.overlaps(area)) continue;
      if (node.right != 0) {
        stack[top++] = node.right;
        stack[top++] = node.left;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.end; ++i) {
        if (boxes_[index_[i]].overlaps(area) && !visit(index_[i])) return false;
      }
    }
    return true;
  }

 private:
  /// Median splits of 2^32 boxes need 32 levels; depth-first search keeps one sibling a level.
  static constexpr int kMaxDepth = 72;
  struct Node {
    geom::Box2 box;
    std::uint32_t first = 0, end = 0;
    std::uint32_t left = 0, right = 0;  ///< right 0: a leaf
  };
  std::uint32_t build(std::uint32_t first, std::uint32_t end);

  std::vector<geom::Box2> boxes_;
  std::vector<std::uint32_t> index_;
  std::vector<Node> nodes_;
};

/// Smallest distance between two segments; 0 when they meet. Exact up to rounding: the minimum is at a
/// crossing, at an end of one of the two, or where the line of centres (the normal of the line) meets an arc.
double segment_distance(const geom::Segment& s, const geom::Segment& t);

geom::Segment moved(const geom::Segment& s, geom::Vec2 by);

/// Where the copies of the part lie: copy (i, j) is moved by (i pitch.x, j pitch.y).
struct Tiling {
  int columns = 1, rows = 1;
  geom::Vec2 pitch{};
};

/// Segments with an owner, repeated over all copies.
class Clearance {
 public:
  Clearance(std::vector<geom::Segment> segments, std::vector<std::uint32_t> owner, Tiling tiling);

  /// Whether `move` keeps at least `distance` from every segment of every copy. `skip`: an owner of the same
  /// copy that does not count.
  bool is_free(const geom::Segment& move, double distance, std::uint32_t skip = kNobody) const;

  static constexpr std::uint32_t kNobody = 0xffffffffu;

 private:
  bool is_free_of_copy(const geom::Segment& move, const geom::Box2& box, double distance, geom::Vec2 shift,
                       std::uint32_t skip) const;

  std::vector<geom::Segment> segments_;
  std::vector<std::uint32_t> owner_;
  Tiling tiling_;
  BoxTree tree_;
};

Clearance clearance_of_outlines(const Profile& profile, const Tiling& tiling);
Clearance clearance_of_paths(const Profile& profile, const Tiling& tiling);

}  // namespace burin::laser::detail
