// SPDX-License-Identifier: Apache-2.0
// When each node of a coarse grid lost its material: the same cuts once more, on lines through these nodes.
#include <algorithm>
#include <cmath>

#include "burin/removal/crossings.h"
#include "burin/removal/field.h"
#include "burin/removal/stock_lines.h"

namespace burin::removal {
namespace {

using geom::component;

/// Cubes over the box and one layer of empty nodes around it: the lowest material node is half a step inside.
Grid clock_grid(const geom::Box3& box, std::size_t max_nodes) {
  const geom::Vec3 size = box.hi - box.lo;
  const auto count = [&](double step, std::size_t i) {
    constexpr double kRounding = 1e-9;
    return std::max(1.0, std::ceil(component(size, i) / step - kRounding));
  };
  // Small steps up to one that fits; never fewer than the 27 nodes of one cell and its border.
  const double nodes = static_cast<double>(std::max<std::size_t>(max_nodes, 27));
  double step = std::cbrt(size.x * size.y * size.z / nodes);
  constexpr double kFiner = 1.005;
  while ((count(step, 0) + 2) * (count(step, 1) + 2) * (count(step, 2) + 2) > nodes) step *= kFiner;
  Grid grid;
  for (std::size_t i = 0; i < 3; ++i) {
    grid.step[i] = step;
    grid.count[i] = static_cast<std::uint32_t>(count(step, i));
    // What the cubes are more than the box is left on both sides.
    const double over = grid.length(i) - component(size, i);
    geom::set_component(grid.origin, i, component(box.lo, i) - 0.5 * over);
  }
  return grid;
}

std::vector<DexelField> fields_over(const Grid& grid, const Stock& stock, unsigned threads) {
  std::vector<DexelField> fields;
  for (const std::size_t axis : {0U, 1U, 2U}) {
    fields.emplace_back(grid, axis);
    // A mesh that was taken in the finer grid is taken here.
    if (!fill(fields.back(), stock, threads)) return {};
  }
  return fields;
}

std::uint8_t share(const Crossings& crossings, std::array<std::uint32_t, 3> node, std::size_t axis,
                   bool leaves, double step) {
  const Crossing c = crossings.at(node, axis, leaves);
  if (!c.known) return 0;
  const double part = (component(c.p, axis) - crossings.node(axis, node[axis])) / step;
  constexpr double kSteps = 256;
  return static_cast<std::uint8_t>(std::clamp(std::lround(part * kSteps), 1L, 255L));
}

/// Nodes of the material that is there before the first cut: kNever, all others kEmpty.
std::vector<std::uint32_t> nodes_of(const DexelField& along_z) {
  const Grid& g = along_z.grid();
  std::vector<std::uint32_t> nodes(static_cast<std::size_t>(g.count[0]) * g.count[1] * g.count[2],
                                   StockClock::kEmpty);
  for (std::uint32_t j = 0; j < g.count[1]; ++j)
    for (std::uint32_t i = 0; i < g.count[0]; ++i)
      for (const Span* s = along_z.begin(i, j); s != along_z.end(i, j); ++s) {
        const auto [from, to] = g.nodes_in(2, s->lo, s->hi);
        for (std::uint32_t k = from; k < to; ++k)
          nodes[(static_cast<std::size_t>(k) * g.count[1] + j) * g.count[0] + i] = StockClock::kNever;
      }
  return nodes;
}

/// With the border of empty nodes.
StockClock with_border(const Grid& grid, const std::vector<std::uint32_t>& inner) {
  StockClock clock;
  clock.step_mm = grid.step[0];
  std::size_t total = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    clock.count[i] = grid.count[i] + 2;
    total *= clock.count[i];
    geom::set_component(clock.origin, i, grid.node(i, -1));
  }
  clock.cut_at.assign(total, StockClock::kEmpty);
  clock.crossing.assign(3 * total, 0);
  std::size_t n = 0;
  for (std::uint32_t k = 1; k <= grid.count[2]; ++k)
    for (std::uint32_t j = 1; j <= grid.count[1]; ++j)
      for (std::uint32_t i = 1; i <= grid.count[0]; ++i)
        clock.cut_at[(static_cast<std::size_t>(k) * clock.count[1] + j) * clock.count[0] + i] = inner[n++];
  return clock;
}

void cross_edges(StockClock& clock, const Crossings& at_start, const Crossings& at_end) {
  const std::array<std::size_t, 3> stride{1, clock.count[0],
                                          static_cast<std::size_t>(clock.count[0]) * clock.count[1]};
  std::size_t n = 0;
  for (std::uint32_t k = 0; k < clock.count[2]; ++k)
    for (std::uint32_t j = 0; j < clock.count[1]; ++j)
      for (std::uint32_t i = 0; i < clock.count[0]; ++i, ++n) {
        const std::array<std::uint32_t, 3> node{i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (node[axis] + 1 >= clock.count[axis]) continue;
          const std::uint32_t a = clock.cut_at[n], b = clock.cut_at[n + stride[axis]];
          std::uint8_t& out = clock.crossing[3 * n + axis];
          if ((a == StockClock::kEmpty) != (b == StockClock::kEmpty)) {
            out = share(at_start, node, axis, a != StockClock::kEmpty, clock.step_mm);
          } else if ((a == StockClock::kNever) != (b == StockClock::kNever)) {
            out = share(at_end, node, axis, a == StockClock::kNever, clock.step_mm);
          }
        }
      }
}

}  // namespace

StockClock make_clock(const Stock& stock, const verify::CheckedPath& path, const CutLimits& limits,
                      unsigned threads, std::size_t max_nodes) {
  const Grid grid = clock_grid(bounds(stock), max_nodes);
  const std::vector<DexelField> before = fields_over(grid, stock, threads);
  if (before.empty()) return {};
  std::vector<DexelField> after = before;
  std::vector<std::uint32_t> inner = nodes_of(before[2]);
  // Nobody asks for contacts here, and without a sink nothing stops it.
  if (!cut_all(after, path, limits, threads, nullptr, {inner.data()})) return {};
  StockClock clock = with_border(grid, inner);
  cross_edges(clock, {grid, before}, {grid, after});
  return clock;
}

}  // namespace burin::removal
