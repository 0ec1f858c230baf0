// SPDX-License-Identifier: Apache-2.0
// Static binary tree over boxes of the plane: which of many things may lie in an area.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::geom {

/// O(n log n) to build, O(log n + hits) to ask. Deterministic.
class BoxTree2 {
 public:
  explicit BoxTree2(std::vector<Box2> boxes = {});

  Box2 bounds() const { return nodes_.empty() ? Box2{} : nodes_.front().box; }

  /// Calls `visit(index)` for every box that overlaps `area`; it returns false to stop. The order of visits
  /// is fixed but means nothing. False when stopped.
  template <class Visit>
  bool query(const Box2& area, Visit&& visit) const {
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
    Box2 box;
    std::uint32_t first = 0, end = 0;
    std::uint32_t left = 0, right = 0;  ///< right 0: a leaf
  };
  std::uint32_t build(std::uint32_t first, std::uint32_t end);

  std::vector<Box2> boxes_;
  std::vector<std::uint32_t> index_;
  std::vector<Node> nodes_;
};

}  // namespace burin::geom
