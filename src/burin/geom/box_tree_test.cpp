// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace burin::geom {
namespace {

TEST(BoxTree2, FindsWhatAScanFinds) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(0, 100), size(0, 5);
  for (const std::size_t n : {0u, 1u, 7u, 300u}) {
    std::vector<Box2> boxes(n);
    for (Box2& b : boxes) {
      const Point2 p{place(random), place(random)};
      b = {p, {p.x + size(random), p.y + size(random)}};
    }
    const BoxTree2 tree(boxes);
    for (int i = 0; i < 200; ++i) {
      const Point2 p{place(random), place(random)};
      const Box2 area{p, {p.x + 3 * size(random), p.y + size(random)}};
      std::vector<std::uint32_t> found, wanted;
      tree.query(area, [&](std::uint32_t k) { return found.push_back(k), true; });
      std::sort(found.begin(), found.end());
      for (std::uint32_t k = 0; k < n; ++k) {
        if (boxes[k].overlaps(area)) wanted.push_back(k);
      }
      EXPECT_EQ(found, wanted);
    }
  }
}

}  // namespace
}  // namespace burin::geom
