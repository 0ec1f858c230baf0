// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/sample_grid.h"

#include <algorithm>

namespace burin::verify {
namespace {

// Cells beyond this would cost more memory than the samples.
constexpr double kMaxCells = 2e7;

}  // namespace

SampleGrid::SampleGrid(const std::vector<DesignSample>& samples, const std::vector<std::uint32_t>& subset,
                       double cell)
    : cell_(cell) {
  for (const std::uint32_t i : subset) bounds_.add(samples[i].p);
  if (bounds_.empty()) return;
  const double size[3] = {bounds_.hi.x - bounds_.lo.x, bounds_.hi.y - bounds_.lo.y,
                          bounds_.hi.z - bounds_.lo.z};
  while ((size[0] / cell_ + 1) * (size[1] / cell_ + 1) * (size[2] / cell_ + 1) > kMaxCells) cell_ *= 1.5;
  for (int i = 0; i < 3; ++i) count_[i] = 1 + static_cast<int>(size[i] / cell_);
  const auto cell_of = [&](geom::Point3 p) {
    return cell_index(range(p.x, p.x, bounds_.lo.x, count_[0]).lo,
                      range(p.y, p.y, bounds_.lo.y, count_[1]).lo,
                      range(p.z, p.z, bounds_.lo.z, count_[2]).lo);
  };
  first_.assign(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
                        static_cast<std::size_t>(count_[2]) +
                    1,
                0);
  for (const std::uint32_t i : subset) ++first_[cell_of(samples[i].p) + 1];
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  blocks_.assign(block_index(0, 0, (count_[2] + kBlock - 1) / kBlock), 0);
  for (const std::uint32_t i : subset) {
    const geom::Point3 p = samples[i].p;
    ++blocks_[block_index(range(p.x, p.x, bounds_.lo.x, count_[0]).lo / kBlock,
                          range(p.y, p.y, bounds_.lo.y, count_[1]).lo / kBlock,
                          range(p.z, p.z, bounds_.lo.z, count_[2]).lo / kBlock)];
  }
  items_.resize(subset.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const std::uint32_t i : subset) items_[next[cell_of(samples[i].p)]++] = {samples[i].p, i};
}

}  // namespace burin::verify
