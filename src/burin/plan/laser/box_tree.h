// SPDX-License-Identifier: Apache-2.0
// A static tree of boxes, halved at the median of the longer side: finds the boxes that meet a given one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::laser::detail {

class BoxTree {
 public:
  explicit BoxTree(std::vector<geom::Box2> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (!boxes_.empty()) build(0, static_cast<std::uint32_t>(boxes_.size()));
  }

  /// Calls visit(index) for every box that overlaps `box` until it returns false.
  template <class Visit>
  void query(const geom::Box2& box, Visit visit) const {
    std::uint32_t stack[64];
    int depth = 0;
    if (!nodes_.empty()) stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!node.box.overlaps(box)) continue;
      if (node.right != 0) {
        stack[depth++] = node.right;
        stack[depth++] = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.end; ++i) {
        if (boxes_[order_[i]].overlaps(box) && !visit(order_[i])) return;
      }
    }
  }

 private:
  static constexpr std::uint32_t kLeaf = 8;
  struct Node {
    geom::Box2 box;
    std::uint32_t first = 0, end = 0;
    std::uint32_t right = 0;  ///< the left child follows the node; 0: a leaf
  };

  // Depth is log2(n / kLeaf) because every split is a true half: 29 at most.
  std::uint32_t build(std::uint32_t first, std::uint32_t end) {
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({});
    geom::Box2 box, centres;
    for (std::uint32_t i = first; i < end; ++i) {
      box.add(boxes_[order_[i]]);
      centres.add(centre(order_[i]));
    }
    nodes_[at].box = box;
    nodes_[at].first = first;
    nodes_[at].end = end;
    if (end - first <= kLeaf) return at;
    const bool by_x = centres.width() >= centres.height();
    const std::uint32_t middle = first + (end - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t i, std::uint32_t j) {
                       const geom::Point2 p = centre(i), q = centre(j);
                       const double a = by_x ? p.x : p.y, b = by_x ? q.x : q.y;
                       return a != b ? a < b : i < j;
                     });
    build(first, middle);
    const std::uint32_t right = build(middle, end);
    nodes_[at].right = right;
    return at;
  }
  geom::Point2 centre(std::uint32_t i) const { return geom::lerp(boxes_[i].lo, boxes_[i].hi, 0.5); }

  std::vector<geom::Box2> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace burin::laser::detail
