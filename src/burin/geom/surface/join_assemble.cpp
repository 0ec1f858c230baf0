// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/join_assemble.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/geom/surface/join_measure.h"
#include "burin/geom/surface/join_pieces.h"
#include "burin/geom/surface/modify.h"
#include "burin/geom/surface/rows.h"

namespace burin::geom::detail {
namespace {

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

/// Projective factors and ratios this near to 1 are rounding: no bend.
constexpr double kNoBend = 1e-11;
/// Cuts of one patch on both sides of a line divide it in the same ratio within this.
constexpr double kSameRatio = 1e-9;

/// A cell or several neighbouring ones of the same source, in the grid of the new surface.
struct Block {
  int order = 0;  ///< lowest cell
  int source = 0;
  Interval u, v;
  Orientation orientation;
  double bend_x = 1, bend_y = 1;

  double length_x() const { return orientation.swap ? v.length() : u.length(); }
  double length_y() const { return orientation.swap ? u.length() : v.length(); }
};

/// Line k lies between column (row) k and k + 1.
struct Line {
  double gap_mm = 0;
  bool artificial = true;  ///< everywhere inside one source
};

struct Grid {
  int width = 0, height = 0;
  std::vector<Block> blocks;
  std::vector<Line> lines_x, lines_y;

  Block& at(int x, int y) { return blocks[index(x + y * width)]; }
  const Block& at(int x, int y) const { return blocks[index(x + y * width)]; }
};

double along_grid(const Link& link, bool flipped) {
  const double alpha = flipped ? 1 / link.alpha : link.alpha;
  return std::abs(alpha - 1) <= kNoBend ? 1 : alpha;
}

/// In every column the projective maps from the lowest-numbered cell's parameter; rows in the same way.
void set_bends(const CellGraph& graph, const Rectangle& r, Grid& grid) {
  for (const bool in_x : {true, false}) {
    for (int line = 0; line < (in_x ? r.width : r.height); ++line) {
      const int n = in_x ? r.height : r.width;
      std::vector<double> bend{1};
      int reference = 0;
      for (int k = 0; k < n; ++k) {
        const Placed& p = in_x ? r.at(line, k) : r.at(k, line);
        const Placed& q = in_x ? r.at(line, reference) : r.at(reference, line);
        if (p.cell < q.cell) reference = k;
        const Link& link = link_towards(graph, p, in_x ? Step::north : Step::east);
        bend.push_back(bend.back() * along_grid(link, in_x ? p.orientation.flip_x : p.orientation.flip_y));
      }
      for (int k = 0; k < n; ++k) {
        double b = bend[index(k)] / bend[index(reference)];
        if (std::abs(b - 1) <= kNoBend) b = 1;
        (in_x ? grid.at(line, k).bend_x : grid.at(k, line).bend_y) = b;
      }
    }
  }
}

Grid grid_of(const CellGraph& graph, const Rectangle& r) {
  Grid grid{
      r.width, r.height, {}, std::vector<Line>(index(r.width - 1)), std::vector<Line>(index(r.height - 1))};
  for (const Placed& p : r.cells) {
    const Cell& cell = graph.cells[index(p.cell)];
    grid.blocks.push_back({p.cell, cell.source, cell.u, cell.v, p.orientation, 1, 1});
  }
  const auto add = [](Line& line, const Link& link) {
    line.gap_mm = std::max(line.gap_mm, link.gap_mm);
    line.artificial = line.artificial && link.artificial;
  };
  for (int y = 0; y < r.height; ++y) {
    for (int x = 0; x < r.width; ++x) {
      if (x + 1 < r.width) add(grid.lines_x[index(x)], link_towards(graph, r.at(x, y), Step::east));
      if (y + 1 < r.height) add(grid.lines_y[index(y)], link_towards(graph, r.at(x, y), Step::north));
    }
  }
  set_bends(graph, r, grid);
  return grid;
}

/// Could columns (rows) k and k + 1 be one, because the line between them is only a cut that this rectangle
/// does not need?
bool needless(const Grid& grid, int k, bool in_x) {
  if (!(in_x ? grid.lines_x : grid.lines_y)[index(k)].artificial) return false;
  double first = 0;
  for (int j = 0; j < (in_x ? grid.height : grid.width); ++j) {
    const Block& a = in_x ? grid.at(k, j) : grid.at(j, k);
    const Block& b = in_x ? grid.at(k + 1, j) : grid.at(j, k + 1);
    if ((in_x ? a.bend_x : a.bend_y) != 1 || (in_x ? b.bend_x : b.bend_y) != 1) return false;
    const double ratio = in_x ? a.length_x() / b.length_x() : a.length_y() / b.length_y();
    if (j == 0) first = ratio;
    if (std::abs(ratio / first - 1) > kSameRatio) return false;
  }
  return true;
}

Block merged(const Block& a, const Block& b) {
  Block out = a;
  out.order = std::min(a.order, b.order);
  out.u = {std::min(a.u.lo, b.u.lo), std::max(a.u.hi, b.u.hi)};
  out.v = {std::min(a.v.lo, b.v.lo), std::max(a.v.hi, b.v.hi)};
  return out;
}

/// Takes out the lines that are not needed.
Grid coarsened(const Grid& grid, bool in_x) {
  const int n = in_x ? grid.width : grid.height, across_count = in_x ? grid.height : grid.width;
  std::vector<std::vector<Block>> strips;
  std::vector<Line> lines;
  for (int k = 0; k < n; ++k) {
    const bool merge = k > 0 && needless(grid, k - 1, in_x);
    if (k > 0 && !merge) lines.push_back((in_x ? grid.lines_x : grid.lines_y)[index(k - 1)]);
    if (!merge) strips.emplace_back();
    for (int j = 0; j < across_count; ++j) {
      const Block& block = in_x ? grid.at(k, j) : grid.at(j, k);
      if (merge)
        strips.back()[index(j)] = merged(strips.back()[index(j)], block);
      else
        strips.back().push_back(block);
    }
  }
  Grid out = grid;
  const int left = static_cast<int>(strips.size());
  (in_x ? out.width : out.height) = left;
  (in_x ? out.lines_x : out.lines_y) = lines;
  out.blocks.assign(index(out.width * out.height), {});
  for (int k = 0; k < left; ++k)
    for (int j = 0; j < across_count; ++j) (in_x ? out.at(k, j) : out.at(j, k)) = strips[index(k)][index(j)];
  return out;
}

/// Where columns (rows) begin and end in the new surface: the knot intervals of the lowest-numbered patch of
/// each (eq. 7: the ratio of the intervals is kept).
std::vector<double> positions(const Grid& grid, bool in_x) {
  std::vector<double> at{0};
  for (int k = 0; k < (in_x ? grid.width : grid.height); ++k) {
    const Block* lowest = nullptr;
    for (int j = 0; j < (in_x ? grid.height : grid.width); ++j) {
      const Block& block = in_x ? grid.at(k, j) : grid.at(j, k);
      if (!lowest || block.order < lowest->order) lowest = &block;
    }
    at.push_back(at.back() + (in_x ? lowest->length_x() : lowest->length_y()));
  }
  return at;
}

/// The block's net in the orientation, domain and parametrisation of the grid.
NurbsSurface piece_of(const std::vector<Source>& sources, const Block& block, Interval x, Interval y) {
  NurbsSurface s = sub_surface(sources[index(block.source)].surface, block.u, block.v);
  if (block.orientation.swap) s = swapped(s);
  if (block.orientation.flip_x) s = reversed(s, Direction::u);
  if (block.orientation.flip_y) s = reversed(s, Direction::v);
  s = with_domain(with_domain(s, Direction::u, x), Direction::v, y);
  for (const Direction d : {Direction::u, Direction::v}) {
    const double bend_by = d == Direction::u ? block.bend_x : block.bend_y;
    if (bend_by == 1) continue;
    Rows rows = rows_of(s, d);
    bend(rows, bend_by);
    s = surface_of(std::move(rows), d, s);
  }
  return s;
}

Member member_of(const Source& source, const Block& block, Interval x, Interval y) {
  Member m;
  m.patch = source.patch;
  m.u = x;
  m.v = y;
  m.bend_u = block.bend_x;
  m.bend_v = block.bend_y;
  const auto linear = [](Interval from, Interval to, bool flip, const std::array<double, 2>& map) {
    const double slope = (flip ? -1 : 1) * to.length() / from.length();
    const double start = (flip ? to.hi : to.lo) - slope * from.lo;
    return std::array{map[0] + map[1] * start, map[1] * slope};
  };
  const Orientation& o = block.orientation;
  if (!o.swap) {
    const auto u = linear(x, block.u, o.flip_x, source.map_u), v = linear(y, block.v, o.flip_y, source.map_v);
    m.pu = {u[0], u[1], 0};
    m.pv = {v[0], 0, v[1]};
  } else {
    const auto u = linear(y, block.u, o.flip_y, source.map_u), v = linear(x, block.v, o.flip_x, source.map_v);
    m.pu = {u[0], 0, u[1]};
    m.pv = {v[0], v[1], 0};
  }
  return m;
}

}  // namespace

Result<JoinedSurface> assemble(const std::vector<Source>& sources, const CellGraph& graph,
                               const Rectangle& rectangle, double tolerance_mm) {
  const Grid grid = coarsened(coarsened(grid_of(graph, rectangle), true), false);
  const std::vector<double> xs = positions(grid, true), ys = positions(grid, false);
  const auto x_of = [&](int x) { return Interval{xs[index(x)], xs[index(x + 1)]}; };
  const auto y_of = [&](int y) { return Interval{ys[index(y)], ys[index(y + 1)]}; };

  Pieces pieces{grid.width, grid.height, {}, {}};
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      pieces.nets.push_back(piece_of(sources, grid.at(x, y), x_of(x), y_of(y)));
      pieces.orders.push_back(grid.at(x, y).order);
    }
  }
  auto surface = put_together(std::move(pieces), tolerance_mm);
  if (!surface) return std::move(surface).error();

  JoinedSurface out;
  out.surface = std::move(*surface);
  const double negligible = kNegligible * tolerance_mm;
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const Block& block = grid.at(x, y);
      const Source& source = sources[index(block.source)];
      Source plain;  // the same without the way back to the patch
      const Member to_source = member_of(plain, block, x_of(x), y_of(y));
      out.members.push_back(member_of(source, block, x_of(x), y_of(y)));
      double deviation = source.deviation_mm;
      if (grid.blocks.size() > 1)
        deviation +=
            distance_by_samples(out.surface, {x_of(x), y_of(y)}, source.surface, to_source, negligible);
      out.deviation_mm = std::max(out.deviation_mm, deviation);
    }
  }
  for (int x = 0; x + 1 < grid.width; ++x)
    out.joints.push_back({Direction::u, xs[index(x + 1)], grid.lines_x[index(x)].gap_mm,
                          continuity_along(out.surface, Direction::u, xs[index(x + 1)])});
  for (int y = 0; y + 1 < grid.height; ++y)
    out.joints.push_back({Direction::v, ys[index(y + 1)], grid.lines_y[index(y)].gap_mm,
                          continuity_along(out.surface, Direction::v, ys[index(y + 1)])});
  return out;
}

double deviation_of_contact(const std::vector<Source>& sources, const Contact& contact, double tolerance_mm) {
  CellGraph graph;
  const auto cell_of = [&](int source, SideIndex side, double from, double to) {
    const NurbsSurface& s = sources[index(source)].surface;
    Cell cell;
    cell.source = source;
    cell.u = s.domain(Direction::u);
    cell.v = s.domain(Direction::v);
    Interval& t = along(side) == Direction::u ? cell.u : cell.v;
    const double lo = std::min(from, to), hi = std::max(from, to), length = t.length();
    t = {lo == 0 ? t.lo : t.lo + lo * length, hi == 1 ? t.hi : t.lo + hi * length};
    return cell;
  };
  const Match& m = contact.match;
  graph.cells = {cell_of(contact.a, contact.side_a, m.a0, m.a1),
                 cell_of(contact.b, contact.side_b, m.b0, m.b1)};
  Link link;
  link.reversed = m.b1 < m.b0;
  link.alpha = m.alpha;
  connect(graph, 0, contact.side_a, 1, contact.side_b, link);
  const Step step = across(contact.side_a) == Direction::u ? Step::east : Step::north;
  // The first cell lies so that the contact is on its east (north) side.
  Placed first{0, {}};
  if (!at_high_end(contact.side_a))
    (step == Step::east ? first.orientation.flip_x : first.orientation.flip_y) = true;
  const Placed second{1, behind(first.orientation, step, link_towards(graph, first, step))};
  const Rectangle pair{step == Step::east ? 2 : 1, step == Step::east ? 1 : 2, {first, second}};
  const auto joined = assemble(sources, graph, pair, tolerance_mm);
  return joined ? joined->deviation_mm : std::numeric_limits<double>::infinity();
}

}  // namespace burin::geom::detail
