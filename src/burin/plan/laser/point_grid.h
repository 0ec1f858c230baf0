// SPDX-License-Identifier: Apache-2.0
// Points that come and go, and the nearest of them. Internal to the laser planner.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::laser::detail {

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
};

}  // namespace burin::laser::detail
