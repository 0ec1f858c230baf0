// SPDX-License-Identifier: Apache-2.0
// Samples in cubic cells, cell by cell in memory. Internal to verify.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "burin/verify/motion_check.h"

namespace burin::verify {

class SampleGrid {
 public:
  /// `subset`: indices into the samples, in any order.
  SampleGrid(const std::vector<DesignSample>& samples, const std::vector<std::uint32_t>& subset, double cell);

  struct Item {
    geom::Point3 p;
    std::uint32_t index = 0;
  };
  /// Calls visit(item) for all samples in cells that meet `box` and for which near(centre, half diagonal)
  /// holds, of the block of cells and of the cell.
  template <class Near, class Visit>
  void query(const geom::Box3& box, Near&& near, Visit&& visit) const {
    if (items_.empty() || box.empty() || !box.overlaps(bounds_)) return;
    const Range x = range(box.lo.x, box.hi.x, bounds_.lo.x, count_[0]);
    const Range y = range(box.lo.y, box.hi.y, bounds_.lo.y, count_[1]);
    const Range z = range(box.lo.z, box.hi.z, bounds_.lo.z, count_[2]);
    for (int bz = z.lo / kBlock; bz <= z.hi / kBlock; ++bz)
      for (int by = y.lo / kBlock; by <= y.hi / kBlock; ++by)
        for (int bx = x.lo / kBlock; bx <= x.hi / kBlock; ++bx) {
          if (blocks_[block_index(bx, by, bz)] == 0 ||
              !near(center(bx, by, bz, kBlock * cell_), kBlock * half_diagonal()))
            continue;
          cells({std::max(x.lo, bx * kBlock), std::min(x.hi, bx * kBlock + kBlock - 1)},
                {std::max(y.lo, by * kBlock), std::min(y.hi, by * kBlock + kBlock - 1)},
                {std::max(z.lo, bz * kBlock), std::min(z.hi, bz * kBlock + kBlock - 1)}, near, visit);
        }
  }
  double half_diagonal() const { return 0.8660254037844387 * cell_; }
  const geom::Box3& bounds() const { return bounds_; }

 private:
  static constexpr int kBlock = 6;  ///< cells along the side of a block
  struct Range {
    int lo, hi;
  };
  template <class Near, class Visit>
  void cells(Range x, Range y, Range z, Near&& near, Visit&& visit) const {
    for (int k = z.lo; k <= z.hi; ++k)
      for (int j = y.lo; j <= y.hi; ++j)
        for (int i = x.lo; i <= x.hi; ++i) {
          const std::size_t c = cell_index(i, j, k);
          if (first_[c] == first_[c + 1] || !near(center(i, j, k, cell_), half_diagonal())) continue;
          for (std::uint32_t n = first_[c]; n < first_[c + 1]; ++n) visit(items_[n]);
        }
  }
  std::size_t block_index(int x, int y, int z) const {
    const auto blocks = [](int n) { return static_cast<std::size_t>((n + kBlock - 1) / kBlock); };
    return (static_cast<std::size_t>(z) * blocks(count_[1]) + static_cast<std::size_t>(y)) *
               blocks(count_[0]) +
           static_cast<std::size_t>(x);
  }
  Range range(double lo, double hi, double origin, int count) const {
    const auto at = [&](double v) {
      return static_cast<int>(std::clamp(std::floor((v - origin) / cell_), 0.0, count - 1.0));
    };
    return {at(lo), at(hi)};
  }
  std::size_t cell_index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(count_[0]) +
           static_cast<std::size_t>(x);
  }
  geom::Point3 center(int x, int y, int z, double size) const {
    return {bounds_.lo.x + (x + 0.5) * size, bounds_.lo.y + (y + 0.5) * size,
            bounds_.lo.z + (z + 0.5) * size};
  }

  double cell_;
  geom::Box3 bounds_;
  int count_[3] = {1, 1, 1};
  std::vector<std::uint32_t> first_;   // of each cell, into items_
  std::vector<std::uint32_t> blocks_;  // samples in each block
  std::vector<Item> items_;
};

}  // namespace burin::verify
