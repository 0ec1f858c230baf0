// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/point_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace burin::laser::detail {

using geom::Point2;

PointGrid::PointGrid(std::vector<Point2> points) : points_(std::move(points)), in_(points_.size(), 0) {
  rebuild();
}

void PointGrid::rebuild() {
  geom::Box2 box;
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    if (alive_ == 0 || in_[i]) box.add(points_[i]);
  }
  const std::size_t n = alive_ == 0 ? points_.size() : alive_;
  built_for_ = n;
  if (box.empty()) box.add(Point2{});
  origin_ = box.lo;
  // About half a cell per point: cells = max(1, n / 2), square, and never more than 2 n of them in a thin
  // strip.
  const double cells = std::max(1.0, static_cast<double>(n) / 2);
  const double w = box.width(), h = box.height();
  size_ = std::max({std::sqrt(w * h / cells), w / cells, h / cells});
  if (!(size_ > 0)) size_ = 1;
  columns_ = static_cast<int>(w / size_) + 1;
  rows_ = static_cast<int>(h / size_) + 1;
  cells_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), {});
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    if (in_[i]) cells_[cell_of(points_[i])].push_back(i);
  }
}

int PointGrid::column_of(double x) const {
  return static_cast<int>(std::clamp((x - origin_.x) / size_, 0.0, static_cast<double>(columns_ - 1)));
}
int PointGrid::row_of(double y) const {
  return static_cast<int>(std::clamp((y - origin_.y) / size_, 0.0, static_cast<double>(rows_ - 1)));
}
std::size_t PointGrid::cell_of(Point2 p) const {
  return static_cast<std::size_t>(row_of(p.y)) * static_cast<std::size_t>(columns_) +
         static_cast<std::size_t>(column_of(p.x));
}

void PointGrid::insert(std::uint32_t id) {
  if (in_[id]) return;
  in_[id] = 1;
  ++alive_;
  cells_[cell_of(points_[id])].push_back(id);
}

void PointGrid::erase(std::uint32_t id) {
  if (!in_[id]) return;
  in_[id] = 0;
  --alive_;
  auto& cell = cells_[cell_of(points_[id])];
  cell.erase(std::find(cell.begin(), cell.end(), id));
  // Few points in many cells make the search walk through nothing.
  constexpr std::size_t kSmallest = 64;
  if (alive_ >= kSmallest && alive_ * 4 < built_for_) rebuild();
}

/// Cells whose column or row differs by exactly `ring` from the given one (and the other by no more).
template <class Visit>
void PointGrid::visit_ring(int column, int row, int ring, Visit&& visit) const {
  const auto cell = [&](int c, int r) {
    for (const std::uint32_t id : cells_[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) +
                                         static_cast<std::size_t>(c)]) {
      visit(id);
    }
  };
  const int left = std::max(column - ring, 0), right = std::min(column + ring, columns_ - 1);
  for (const int r : {row - ring, row + ring}) {
    if (r >= 0 && r < rows_) {
      for (int c = left; c <= right; ++c) cell(c, r);
    }
    if (ring == 0) return;
  }
  const int low = std::max(row - ring + 1, 0), high = std::min(row + ring - 1, rows_ - 1);
  for (const int c : {column - ring, column + ring}) {
    if (c < 0 || c >= columns_) continue;
    for (int r = low; r <= high; ++r) cell(c, r);
  }
}

std::vector<std::uint32_t> PointGrid::nearest(Point2 p, std::size_t count) const {
  count = std::min(count, alive_);
  if (count == 0) return {};
  using Found = std::pair<double, std::uint32_t>;
  std::vector<Found> best;  // a heap, the worst on top
  const int column = column_of(p.x), row = row_of(p.y);
  const int last = std::max({column, columns_ - 1 - column, row, rows_ - 1 - row});
  // What lies outside ring k is at least k cells away from p's cell; p may stand outside the grid, which only
  // adds to the distance.
  for (int ring = 0; ring <= last; ++ring) {
    const double reached = (ring - 1) * size_;
    if (best.size() == count && reached > 0 && best.front().first <= reached * reached) break;
    visit_ring(column, row, ring, [&](std::uint32_t id) {
      const Found found{geom::distance2(p, points_[id]), id};
      if (best.size() == count) {
        if (!(found < best.front())) return;
        std::pop_heap(best.begin(), best.end());
        best.pop_back();
      }
      best.push_back(found);
      std::push_heap(best.begin(), best.end());
    });
  }
  std::sort(best.begin(), best.end());
  std::vector<std::uint32_t> ids;
  for (const Found& f : best) ids.push_back(f.second);
  return ids;
}

std::uint32_t PointGrid::nearest(Point2 p) const {
  const auto ids = nearest(p, 1);
  return ids.empty() ? kNone : ids.front();
}

}  // namespace burin::laser::detail
