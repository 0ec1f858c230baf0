// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/trim_cells.h"

#include <algorithm>
#include <cmath>

namespace burin::geom::detail {
namespace {

double value(const std::vector<double>& lines, std::int64_t at) {
  const auto i = static_cast<std::size_t>(at / kCell);
  const std::int64_t rest = at % kCell;
  if (rest == 0) return lines[i];
  return lines[i] + (lines[i + 1] - lines[i]) * (double(rest) / double(kCell));
}

std::int64_t nearest(const std::vector<double>& lines, double t) {
  if (!(t > lines.front())) return 0;
  const auto cells = static_cast<std::int64_t>(lines.size()) - 1;
  if (!(t < lines.back())) return cells * kCell;
  const auto i =
      static_cast<std::size_t>(std::upper_bound(lines.begin(), lines.end(), t) - lines.begin()) - 1;
  return static_cast<std::int64_t>(i) * kCell +
         std::llround((t - lines[i]) / (lines[i + 1] - lines[i]) * double(kCell));
}

/// Grid lines strictly between a and b, in the direction from a to b.
template <class Visit>
bool lines_between(std::int64_t a, std::int64_t b, Visit&& visit) {
  if (a < b) {
    for (std::int64_t at = (a / kCell + 1) * kCell; at < b; at += kCell)
      if (!visit(at)) return false;
  } else {
    for (std::int64_t at = (a - 1) / kCell * kCell; at > b; at -= kCell)
      if (!visit(at)) return false;
  }
  return true;
}

/// The other coordinate where the straight line from a to b passes `at`, never beyond `from` and b.
std::int64_t crossing(double ta, double tb, double t, double sa, double sb, const std::vector<double>& other,
                      std::int64_t from, std::int64_t to) {
  const double s = sa + (sb - sa) * ((t - ta) / (tb - ta));
  return std::clamp(nearest(other, s), std::min(from, to), std::max(from, to));
}

}  // namespace

Point2 TrimCells::place(LatticePoint p) const {
  return {value(lines_->u, p.x), value(lines_->v, p.y)};
}

LatticePoint TrimCells::snapped(Point2 p) const {
  return {nearest(lines_->u, p.x), nearest(lines_->v, p.y)};
}

std::optional<TrimCells> TrimCells::make(const GridLines& lines,
                                         const std::vector<std::vector<Point2>>& trims, std::size_t most) {
  TrimCells out(lines);
  for (const auto& loop : trims) {
    if (loop.empty()) continue;
    LatticePoint a = out.snapped(loop.back());
    for (const Point2 p : loop) {
      const LatticePoint b = out.snapped(p);
      if (!(a == b) && !out.add_edge(a, b, most)) return std::nullopt;
      a = b;
    }
  }
  std::stable_sort(out.pieces_.begin(), out.pieces_.end(),
                   [](const TrimPiece& a, const TrimPiece& b) { return a.cell < b.cell; });
  std::sort(out.crossings_.begin(), out.crossings_.end());
  return out;
}

/// First at the columns' lines, each part then at the rows' lines: both ends of every piece lie in the same
/// closed cell whatever rounding does.
bool TrimCells::add_edge(LatticePoint a, LatticePoint b, std::size_t most) {
  const auto in_column = [&](LatticePoint from, LatticePoint to) {
    const Point2 p = place(from), q = place(to);
    LatticePoint last = from;
    const bool fine = lines_between(from.y, to.y, [&](std::int64_t y) {
      const LatticePoint cut{crossing(p.y, q.y, value(lines_->v, y), p.x, q.x, lines_->u, last.x, to.x), y};
      const bool added = add_piece(last, cut, most);
      last = cut;
      return added;
    });
    return fine && add_piece(last, to, most);
  };
  const Point2 p = place(a), q = place(b);
  LatticePoint last = a;
  const bool fine = lines_between(a.x, b.x, [&](std::int64_t x) {
    const LatticePoint cut{x, crossing(p.x, q.x, value(lines_->u, x), p.y, q.y, lines_->v, last.y, b.y)};
    const bool added = in_column(last, cut);
    last = cut;
    return added;
  });
  return fine && in_column(last, b);
}

bool TrimCells::add_piece(LatticePoint a, LatticePoint b, std::size_t most) {
  if (a == b) return true;
  if (pieces_.size() >= most) return false;
  const auto columns_count = static_cast<std::int64_t>(columns()),
             rows_count = static_cast<std::int64_t>(rows());
  const std::int64_t x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  const bool on_column = a.x == b.x && x % kCell == 0, on_row = a.y == b.y && y % kCell == 0;
  const auto add = [&](std::int64_t column, std::int64_t row) {
    if (column < 0 || row < 0 || column >= columns_count || row >= rows_count) return;
    pieces_.push_back({static_cast<std::uint64_t>(column + row * columns_count), a, b});
  };
  const std::int64_t column = x / kCell, row = y / kCell;
  add(column, row);
  if (on_column) add(column - 1, row);
  if (on_row) add(column, row - 1);
  const std::int64_t middle = row * kCell + kCell / 2;
  if ((a.y > middle) != (b.y > middle)) crossings_.push_back({row, on_column ? column - 1 : column});
  add_places_on_sides(a);
  add_places_on_sides(b);
  return true;
}

void TrimCells::add_places_on_sides(LatticePoint p) {
  const bool on_column = p.x % kCell == 0, on_row = p.y % kCell == 0;
  if (on_column == on_row) return;  // inside of a cell, or a corner, which all have
  const auto columns_count = static_cast<std::int64_t>(columns()),
             rows_count = static_cast<std::int64_t>(rows());
  const std::int64_t column = p.x / kCell, row = p.y / kCell;
  for (const std::int64_t back : {0, 1}) {
    const std::int64_t i = on_column ? column - back : column, j = on_row ? row - back : row;
    if (i < 0 || j < 0 || i >= columns_count || j >= rows_count) continue;
    pieces_.push_back({static_cast<std::uint64_t>(i + j * columns_count), p, p});
  }
}

std::vector<char> TrimCells::inside(std::size_t row) const {
  const auto wanted = static_cast<std::int64_t>(row);
  std::vector<char> out(columns(), 0);
  auto at = std::lower_bound(crossings_.begin(), crossings_.end(), Crossing{wanted, -2});
  char in = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (; at != crossings_.end() && at->row == wanted && at->column < static_cast<std::int64_t>(i); ++at)
      in = in ? 0 : 1;
    out[i] = in;
  }
  return out;
}

}  // namespace burin::geom::detail
