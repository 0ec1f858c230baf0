// SPDX-License-Identifier: Apache-2.0
// Lines and arcs of the plane against each other: distances, bounds over stretches, a tree. For the check of
// beams and what reads for it. Arcs here turn by a quarter at most (quarters()), so that their tangents meet
// and their sector is convex. mm. docs/verify-beam.md
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "burin/geom/curve/arc_spline.h"

namespace burin::verify::flat {

using geom::Box2;
using geom::Point2;
using geom::Segment;
using geom::Vec2;

inline constexpr double kNever = std::numeric_limits<double>::infinity();
/// Numbers of this size (mm) are rounding: coordinates up to 1e5 mm carry 2e-11, a few operations more.
inline constexpr double kRounding = 1e-9;

struct Range {
  double lo = 0, hi = 0;
};

/// The segment in equal parts that turn by a quarter at most.
void quarters(const Segment& s, std::vector<Segment>& out);
/// The stretch of `s` between the fractions f0 and f1 of its length.
Segment stretch(const Segment& s, double f0, double f1);
/// To the right of the direction of travel: out of a part on the left.
Vec2 normal_at(const Segment& s, double f);

struct Pair {
  double distance = kNever;
  Point2 p, q;  ///< on the first, on the second
};
/// The least distance: 0 where they meet.
Pair nearest_pair(const Segment& s, const Segment& k);
/// No point of `s` is further from `k` than this. Exact for lines against lines and for concentric arcs.
double most_distance(const Segment& s, const Segment& k);
/// Of |p - c| over the points p of `s`.
Range distances_from(Point2 c, const Segment& s);
/// Of w . n and w x n over the normals of `s`.
Range normal_dots(Vec2 w, const Segment& s);
Range normal_crosses(Vec2 w, const Segment& s);
/// Of (p - q) . m over the points of `s`.
Range heights(Point2 q, Vec2 m, const Segment& s);

/// Binary tree over the boxes of segments. O(n log n) to build. Deterministic.
class Tree {
 public:
  explicit Tree(std::vector<Segment> segments = {});
  const std::vector<Segment>& segments() const { return segments_; }
  bool empty() const { return segments_.empty(); }
  Box2 bounds() const { return nodes_.empty() ? Box2{} : nodes_.front().box; }

  struct Near {
    double distance = kNever;
    Point2 point;
    std::uint32_t segment = 0;
    bool found() const { return distance < kNever; }
  };
  /// The nearest place within `limit`; of equal ones any, but always the same.
  Near nearest(Point2 p, double limit = kNever) const;
  struct NearPair : Pair {
    std::uint32_t segment = 0;
  };
  NearPair nearest(const Segment& s, double limit) const;
  /// Of all segments together, which are closed curves, about p; those with numbers in [first, end), a closed
  /// curve as well, do not count.
  int winding(Point2 p, std::uint32_t first = 0, std::uint32_t end = 0) const;

  /// Calls visit(index) for the segments whose box, grown by `by`, the ray p + s n meets for s in [0, reach];
  /// visit returns the reach from there on.
  template <class Visit>
  void along(Point2 p, Vec2 n, double reach, double by, Visit&& visit) const;

 private:
  struct Node {
    Box2 box;
    std::uint32_t first = 0, end = 0;
    std::uint32_t right = 0;  ///< 0: a leaf; the left child follows its parent
  };
  static constexpr int kDepth = 72;  ///< 2^32 segments need 32 levels; one sibling is kept a level
  void build(std::uint32_t first, std::uint32_t end, const std::vector<Box2>& boxes);
  template <class Key, class Leaf>
  void search(const Key& key, const Leaf& leaf, double& limit) const;
  static bool meets(const Box2& box, Point2 p, Vec2 n, double reach);

  std::vector<Segment> segments_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

inline bool Tree::meets(const Box2& box, Point2 p, Vec2 n, double reach) {
  double from = 0, to = reach;
  for (int axis = 0; axis < 2; ++axis) {
    const double o = axis == 0 ? p.x : p.y, d = axis == 0 ? n.x : n.y;
    const double lo = axis == 0 ? box.lo.x : box.lo.y, hi = axis == 0 ? box.hi.x : box.hi.y;
    if (d == 0) {
      if (o < lo || o > hi) return false;
      continue;
    }
    const double s = (lo - o) / d, t = (hi - o) / d;
    from = std::max(from, std::min(s, t));
    to = std::min(to, std::max(s, t));
  }
  return from <= to;
}

template <class Visit>
void Tree::along(Point2 p, Vec2 n, double reach, double by, Visit&& visit) const {
  if (nodes_.empty()) return;
  std::uint32_t stack[kDepth];
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t at = stack[--top];
    const Node& node = nodes_[at];
    if (!meets(node.box.grown(by), p, n, reach)) continue;
    if (node.right != 0) {
      stack[top++] = node.right;
      stack[top++] = at + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.end; ++i) reach = visit(order_[i]);
  }
}

}  // namespace burin::verify::flat
