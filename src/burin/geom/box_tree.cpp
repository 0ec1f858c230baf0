// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/box_tree.h"

#include <algorithm>
#include <numeric>

namespace burin::geom {
namespace {
constexpr std::uint32_t kLeafSize = 4;
}

BoxTree2::BoxTree2(std::vector<Box2> boxes) : boxes_(std::move(boxes)), index_(boxes_.size()) {
  std::iota(index_.begin(), index_.end(), 0u);
  if (boxes_.empty()) return;
  nodes_.reserve(boxes_.size());
  build(0, static_cast<std::uint32_t>(boxes_.size()));
}

std::uint32_t BoxTree2::build(std::uint32_t first, std::uint32_t end) {
  const auto self = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({});
  Box2 box, centres;
  for (std::uint32_t i = first; i < end; ++i) {
    const Box2& b = boxes_[index_[i]];
    box.add(b);
    centres.add(lerp(b.lo, b.hi, 0.5));
  }
  nodes_[self].box = box;
  nodes_[self].first = first;
  nodes_[self].end = end;
  if (end - first <= kLeafSize) return self;
  const bool by_x = centres.width() >= centres.height();
  const std::uint32_t middle = first + (end - first) / 2;
  std::nth_element(index_.begin() + first, index_.begin() + middle, index_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const Box2 &p = boxes_[a], &q = boxes_[b];
                     const double u = by_x ? p.lo.x + p.hi.x : p.lo.y + p.hi.y;
                     const double v = by_x ? q.lo.x + q.hi.x : q.lo.y + q.hi.y;
                     return u != v ? u < v : a < b;
                   });
  const std::uint32_t l = build(first, middle);
  const std::uint32_t r = build(middle, end);
  nodes_[self].left = l;
  nodes_[self].right = r;
  return self;
}

}  // namespace burin::geom
