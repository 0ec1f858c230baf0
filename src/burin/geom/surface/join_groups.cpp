// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/join_groups.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <queue>
#include <set>
#include <tuple>

namespace burin::geom::detail {
namespace {

using Row = std::vector<Placed>;

/// Steps over the cells that are still free.
class Grower {
 public:
  explicit Grower(const CellGraph& graph) : graph_(graph), taken_(graph.cells.size(), false) {}

  bool free(int cell) const { return !taken_[static_cast<std::size_t>(cell)]; }
  void take(const Rectangle& r) {
    for (const Placed& p : r.cells) taken_[static_cast<std::size_t>(p.cell)] = true;
  }
  std::size_t size() const { return taken_.size(); }

  std::optional<Placed> next(const Placed& from, Step step) const {
    const Link& link = link_towards(graph_, from, step);
    if (link.cell < 0 || link.barrier || !free(link.cell)) return {};
    return Placed{link.cell, behind(from.orientation, step, link)};
  }

  /// The row (or column) beside `side`, whose cells follow each other towards `run`: complete, connected in
  /// the same way, and of cells that are not in `inside`.
  std::optional<Row> beside(const Row& side, Step step, Step run, const std::set<int>& inside) const {
    Row row;
    std::set<int> seen;
    for (const Placed& p : side) {
      const auto cell = next(p, step);
      if (!cell || inside.count(cell->cell) || !seen.insert(cell->cell).second) return {};
      if (!row.empty() && next(row.back(), run) != cell) return {};
      row.push_back(*cell);
    }
    return row;
  }

 private:
  const CellGraph& graph_;
  std::vector<bool> taken_;
};

Row column_of(const Rectangle& r, int x) {
  Row column;
  for (int y = 0; y < r.height; ++y) column.push_back(r.at(x, y));
  return column;
}
Row row_of(const Rectangle& r, int y) {
  return {r.cells.begin() + y * r.width, r.cells.begin() + (y + 1) * r.width};
}
std::set<int> numbers(const Rectangle& r) {
  std::set<int> out;
  for (const Placed& p : r.cells) out.insert(p.cell);
  return out;
}

void add_row(Rectangle& r, const Row& row, bool north) {
  r.cells.insert(north ? r.cells.end() : r.cells.begin(), row.begin(), row.end());
  ++r.height;
}
void add_column(Rectangle& r, const Row& column, bool east) {
  Rectangle out{r.width + 1, r.height, {}};
  for (int y = 0; y < r.height; ++y) {
    if (!east) out.cells.push_back(column[static_cast<std::size_t>(y)]);
    for (int x = 0; x < r.width; ++x) out.cells.push_back(r.at(x, y));
    if (east) out.cells.push_back(column[static_cast<std::size_t>(y)]);
  }
  r = std::move(out);
}

/// One whole side in x (or y): on the high side, else on the low one.
bool grow(const Grower& grower, Rectangle& r, bool in_x) {
  const std::set<int> inside = numbers(r);
  for (const bool high : {true, false}) {
    const Step step = in_x ? (high ? Step::east : Step::west) : (high ? Step::north : Step::south);
    const Row side = in_x ? column_of(r, high ? r.width - 1 : 0) : row_of(r, high ? r.height - 1 : 0);
    const auto row = grower.beside(side, step, in_x ? Step::north : Step::east, inside);
    if (!row) continue;
    in_x ? add_column(r, *row, high) : add_row(r, *row, high);
    return true;
  }
  return false;
}

/// Turned so that the cell with the lowest number has its own orientation.
Rectangle in_own_orientation(const Rectangle& r) {
  const Placed& first = *std::min_element(r.cells.begin(), r.cells.end(),
                                          [](const Placed& a, const Placed& b) { return a.cell < b.cell; });
  const Orientation turn = first.orientation;
  Rectangle out{turn.swap ? r.height : r.width, turn.swap ? r.width : r.height, {}};
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      // Grid x of the old rectangle runs along the first cell's u (v if swapped), against it if flipped.
      int old_x = turn.swap ? y : x, old_y = turn.swap ? x : y;
      if (turn.flip_x) old_x = r.width - 1 - old_x;
      if (turn.flip_y) old_y = r.height - 1 - old_y;
      Placed p = r.at(old_x, old_y);
      Orientation o = p.orientation;
      o.flip_x = o.flip_x != turn.flip_x;
      o.flip_y = o.flip_y != turn.flip_y;
      if (turn.swap) {
        o.swap = !o.swap;
        std::swap(o.flip_x, o.flip_y);
      }
      p.orientation = o;
      out.cells.push_back(p);
    }
  }
  return out;
}

// ---- E1 ----

/// Areas as whole numbers: sums do not depend on their order, equal sets are equal.
std::vector<std::int64_t> whole_areas(const CellGraph& graph) {
  double total = 0;
  for (const Cell& cell : graph.cells) total += cell.area;
  const double unit = total > 0 && std::isfinite(total) ? total * 0x1p-40 : 1;
  std::vector<std::int64_t> out;
  for (const Cell& cell : graph.cells) {
    const double units = cell.area / unit;
    out.push_back(1 + (std::isfinite(units) ? std::llround(std::min(units, 0x1p41)) : 0));
  }
  return out;
}

struct Best {
  std::int64_t area = 0;
  int lowest = 0, inset = 0, start = 0, quadrant = 0, width = 0, height = 0;

  /// Better ones first: larger, then with the lowest cell, then (rings) with it at the low end of its own
  /// directions.
  auto key() const { return std::make_tuple(-area, lowest, inset, start, quadrant); }
};

/// The largest rectangle with one corner at a cell, towards one of its four corners.
class Explorer {
 public:
  Explorer(const Grower& grower, const std::vector<std::int64_t>& areas)
      : grower_(grower), areas_(areas), stamp_(areas.size(), {-1, 0}) {}

  Best explore(int start, int quadrant) {
    Best best;
    best.start = start;
    best.quadrant = quadrant;
    rows_.clear();
    sums_.clear();
    lowest_.clear();
    ++time_;
    std::size_t limit = areas_.size();
    Placed first{start, {false, (quadrant & 1) != 0, (quadrant & 2) != 0}};
    while (true) {
      if (!lay_row(first, limit)) break;
      limit = rows_.back().size();
      std::int64_t area = 0;
      int lowest = start;
      for (std::size_t y = 0; y < rows_.size(); ++y) {
        area += sums_[y][limit - 1];
        lowest = std::min(lowest, lowest_[y][limit - 1]);
      }
      if (area > best.area) {
        best.area = area;
        best.lowest = lowest;
        best.width = static_cast<int>(limit);
        best.height = static_cast<int>(rows_.size());
      }
      const auto above = grower_.next(rows_.back().front(), Step::north);
      if (!above) break;
      first = *above;
    }
    best.inset = inset_of(best);
    return best;
  }

  Rectangle rectangle(const Best& best) {
    explore(best.start, best.quadrant);
    Rectangle r{best.width, best.height, {}};
    for (int y = 0; y < best.height; ++y) {
      const Row& row = rows_[static_cast<std::size_t>(y)];
      r.cells.insert(r.cells.end(), row.begin(), row.begin() + best.width);
    }
    return r;
  }

 private:
  /// How many cells lie before the lowest one in its own u and v.
  int inset_of(const Best& best) const {
    for (int y = 0; y < best.height; ++y) {
      for (int x = 0; x < best.width; ++x) {
        const Placed& p = rows_[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
        if (p.cell != best.lowest) continue;
        const Orientation& o = p.orientation;
        return (o.flip_x ? best.width - 1 - x : x) + (o.flip_y ? best.height - 1 - y : y);
      }
    }
    return 0;
  }

  /// The next row, at most as wide as `limit`. A cell that came before limits the width so that only one of
  /// the two places stays in the rectangle.
  bool lay_row(Placed cell, std::size_t limit) {
    Row row;
    std::vector<std::int64_t> sums;
    std::vector<int> lowest;
    for (std::size_t x = 0; x < limit; ++x) {
      if (x > 0) {
        const auto right = grower_.next(row.back(), Step::east);
        if (!right) break;
        cell = *right;
        if (!rows_.empty() && grower_.next(rows_.back()[x], Step::north) != cell) break;
      }
      auto& stamp = stamp_[static_cast<std::size_t>(cell.cell)];
      if (stamp.time == time_) {
        if (stamp.x <= x) break;
        limit = std::min(limit, stamp.x);
      }
      stamp = {time_, x};
      row.push_back(cell);
      sums.push_back((sums.empty() ? 0 : sums.back()) + areas_[static_cast<std::size_t>(cell.cell)]);
      lowest.push_back(lowest.empty() ? cell.cell : std::min(lowest.back(), cell.cell));
    }
    if (row.empty()) return false;
    rows_.push_back(std::move(row));
    sums_.push_back(std::move(sums));
    lowest_.push_back(std::move(lowest));
    return true;
  }

  struct Stamp {
    std::int64_t time;
    std::size_t x;
  };
  const Grower& grower_;
  const std::vector<std::int64_t>& areas_;
  std::vector<Stamp> stamp_;
  std::int64_t time_ = 0;
  std::vector<Row> rows_;
  std::vector<std::vector<std::int64_t>> sums_;
  std::vector<std::vector<int>> lowest_;
};

/// The best of every corner stays best until one of its cells is taken: then, and only then, it is sought
/// again (it can only become smaller).
std::vector<Rectangle> largest_first(const CellGraph& graph) {
  Grower grower(graph);
  const std::vector<std::int64_t> areas = whole_areas(graph);
  Explorer explorer(grower, areas);
  const auto worse = [](const Best& a, const Best& b) { return a.key() > b.key(); };
  std::priority_queue<Best, std::vector<Best>, decltype(worse)> queue(worse);
  for (int cell = 0; cell < static_cast<int>(graph.cells.size()); ++cell)
    for (int quadrant = 0; quadrant < 4; ++quadrant) queue.push(explorer.explore(cell, quadrant));
  std::vector<Rectangle> out;
  while (!queue.empty()) {
    const Best best = queue.top();
    queue.pop();
    if (!grower.free(best.start)) continue;
    const Best now = explorer.explore(best.start, best.quadrant);
    if (now.key() != best.key()) {
      queue.push(now);
      continue;
    }
    // Not `best`: another rectangle of the same area may have taken its place.
    out.push_back(explorer.rectangle(now));
    grower.take(out.back());
  }
  return out;
}

// ---- E2 ----

/// The cells of the first source that is still free, as one rectangle if nothing keeps them apart; otherwise
/// its largest cell.
Rectangle seed_of(const CellGraph& graph, const Grower& grower, int first) {
  const auto& cells = graph.cells;
  const int source = cells[static_cast<std::size_t>(first)].source;
  int last = first, biggest = first;
  for (int c = first;
       c < static_cast<int>(cells.size()) && cells[static_cast<std::size_t>(c)].source == source; ++c) {
    last = c;
    if (grower.free(c) &&
        cells[static_cast<std::size_t>(c)].area > 1.000001 * cells[static_cast<std::size_t>(biggest)].area)
      biggest = c;
  }
  Rectangle all{1, 1, {Placed{first, {}}}};
  const auto own = [&](const Row& row) {
    return std::all_of(row.begin(), row.end(), [&](const Placed& p) {
      return cells[static_cast<std::size_t>(p.cell)].source == source;
    });
  };
  for (const bool in_x : {true, false}) {
    while (true) {
      const Row side = in_x ? column_of(all, all.width - 1) : row_of(all, all.height - 1);
      const auto row =
          grower.beside(side, in_x ? Step::east : Step::north, in_x ? Step::north : Step::east, numbers(all));
      if (!row || !own(*row)) break;
      in_x ? add_column(all, *row, true) : add_row(all, *row, true);
    }
  }
  if (static_cast<int>(all.cells.size()) == last - first + 1) return all;
  return {1, 1, {Placed{biggest, {}}}};
}

std::vector<Rectangle> from_first(const CellGraph& graph) {
  Grower grower(graph);
  std::vector<Rectangle> out;
  for (int cell = 0; cell < static_cast<int>(graph.cells.size()); ++cell) {
    while (grower.free(cell)) {
      Rectangle r = seed_of(graph, grower, cell);
      bool u = true, v = true;
      while (u || v) {
        u = grow(grower, r, true);
        v = grow(grower, r, false);
      }
      grower.take(r);
      out.push_back(std::move(r));
    }
  }
  return out;
}

// ---- E3, E4 ----

/// An orientation for every cell such that neighbours agree where that is possible: from the first cell of
/// each connected part over the contacts, breadth first.
std::vector<Orientation> orientations(const CellGraph& graph, bool u_first) {
  std::vector<Orientation> out(graph.cells.size());
  std::vector<bool> seen(graph.cells.size(), false);
  for (int root = 0; root < static_cast<int>(graph.cells.size()); ++root) {
    if (seen[static_cast<std::size_t>(root)]) continue;
    seen[static_cast<std::size_t>(root)] = true;
    out[static_cast<std::size_t>(root)].swap = !u_first;
    std::deque<int> queue{root};
    while (!queue.empty()) {
      const Placed here{queue.front(), out[static_cast<std::size_t>(queue.front())]};
      queue.pop_front();
      for (const Step step : {Step::east, Step::west, Step::north, Step::south}) {
        const Link& link = link_towards(graph, here, step);
        if (link.cell < 0 || seen[static_cast<std::size_t>(link.cell)]) continue;
        seen[static_cast<std::size_t>(link.cell)] = true;
        out[static_cast<std::size_t>(link.cell)] = behind(here.orientation, step, link);
        queue.push_back(link.cell);
      }
    }
  }
  return out;
}

/// The run along grid x through a cell: to the east, then to the west. A ring begins at the cell given.
Row run_through(const Grower& grower, const std::vector<Orientation>& orientation, int cell) {
  const auto same_axis = [&](const Placed& p) {
    return p.orientation.swap == orientation[static_cast<std::size_t>(p.cell)].swap;
  };
  std::deque<Placed> run{{cell, orientation[static_cast<std::size_t>(cell)]}};
  std::set<int> inside{cell};
  for (const Step step : {Step::east, Step::west}) {
    while (true) {
      const auto next = grower.next(step == Step::east ? run.back() : run.front(), step);
      if (!next || !same_axis(*next) || !inside.insert(next->cell).second) break;
      step == Step::east ? run.push_back(*next) : run.push_front(*next);
    }
  }
  return {run.begin(), run.end()};
}

/// Grows by rows that are whole runs themselves.
void stack_equal(const Grower& grower, const std::vector<Orientation>& orientation, Rectangle& r) {
  for (const bool north : {true, false}) {
    while (true) {
      const Row side = row_of(r, north ? r.height - 1 : 0);
      const auto row = grower.beside(side, north ? Step::north : Step::south, Step::east, numbers(r));
      if (!row || run_through(grower, orientation, row->front().cell).size() != row->size()) break;
      add_row(r, *row, north);
    }
  }
}

std::vector<Rectangle> runs_first(const CellGraph& graph, bool u_first) {
  Grower grower(graph);
  const std::vector<Orientation> orientation = orientations(graph, u_first);
  // The longest run first (by cells), among equals the one with the lowest cell.
  std::vector<Row> runs;
  std::vector<bool> seen(graph.cells.size(), false);
  for (int cell = 0; cell < static_cast<int>(graph.cells.size()); ++cell) {
    if (seen[static_cast<std::size_t>(cell)]) continue;
    runs.push_back(run_through(grower, orientation, cell));
    for (const Placed& p : runs.back()) seen[static_cast<std::size_t>(p.cell)] = true;
  }
  std::stable_sort(runs.begin(), runs.end(), [](const Row& a, const Row& b) { return a.size() > b.size(); });
  std::vector<Rectangle> out;
  const auto make = [&](Row run) {
    Rectangle r{static_cast<int>(run.size()), 1, std::move(run)};
    stack_equal(grower, orientation, r);
    grower.take(r);
    out.push_back(std::move(r));
  };
  const auto is_free = [&](const Placed& p) { return grower.free(p.cell); };
  for (const Row& run : runs)
    if (std::all_of(run.begin(), run.end(), is_free)) make(run);
  // Where the orientations contradict each other, runs can cross: what is left of them.
  for (int cell = 0; cell < static_cast<int>(graph.cells.size()); ++cell)
    if (grower.free(cell)) make(run_through(grower, orientation, cell));
  return out;
}

}  // namespace

std::vector<Rectangle> group(const CellGraph& graph, Grouping grouping) {
  std::vector<Rectangle> rectangles;
  switch (grouping) {
    case Grouping::largest:
      rectangles = largest_first(graph);
      break;
    case Grouping::first_block:
      rectangles = from_first(graph);
      break;
    case Grouping::u_first:
      rectangles = runs_first(graph, true);
      break;
    case Grouping::v_first:
      rectangles = runs_first(graph, false);
      break;
  }
  for (Rectangle& r : rectangles) r = in_own_orientation(r);
  const auto first = [](const Rectangle& r) {
    int lowest = r.cells.front().cell;
    for (const Placed& p : r.cells) lowest = std::min(lowest, p.cell);
    return lowest;
  };
  std::sort(rectangles.begin(), rectangles.end(),
            [&](const Rectangle& a, const Rectangle& b) { return first(a) < first(b); });
  return rectangles;
}

}  // namespace burin::geom::detail
