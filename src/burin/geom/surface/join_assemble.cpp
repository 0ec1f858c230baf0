// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/join_assemble.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "burin/geom/surface/join_measure.h"
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
/// Knots of neighbours nearer than this part of the interval may become one.
constexpr double kMaxKnotShift = 1e-6, kMinKnotShift = 1e-12;

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

struct PieceKnot {
  double value = 0;
  std::size_t piece = 0;
  int multiplicity = 0;
  int order = 0;
};

/// Knots that belong together, from one column of pieces: what is nearly equal becomes equal, with the value
/// of the lowest-numbered patch.
struct Cluster {
  double value = 0;
  int order = 0;
  std::map<std::size_t, int> multiplicity;  ///< by piece

  int most() const {
    int m = 0;
    for (const auto& [piece, times] : multiplicity) m = std::max(m, times);
    return m;
  }
};

std::vector<Cluster> clusters_of(std::vector<PieceKnot> knots, double near, int degree) {
  std::sort(knots.begin(), knots.end(), [](const PieceKnot& a, const PieceKnot& b) {
    return a.value != b.value ? a.value < b.value : a.piece < b.piece;
  });
  std::vector<Cluster> out;
  double begin = 0;
  for (const PieceKnot& knot : knots) {
    bool open = !out.empty() && knot.value - begin <= near;
    if (open) {
      const auto there = out.back().multiplicity.find(knot.piece);
      open = there == out.back().multiplicity.end() || there->second + knot.multiplicity <= degree;
    }
    if (!open) {
      // The cluster before may have moved to this very value: back to where it began.
      if (!out.empty() && out.back().value >= knot.value) out.back().value = begin;
      out.push_back({knot.value, knot.order, {}});
      begin = knot.value;
    }
    Cluster& cluster = out.back();
    cluster.multiplicity[knot.piece] += knot.multiplicity;
    if (knot.order < cluster.order && (out.size() < 2 || knot.value > out[out.size() - 2].value)) {
      cluster.order = knot.order;
      cluster.value = knot.value;
    }
  }
  return out;
}

/// All pieces of a column (row) get the same knots in `d`.
void unify_knots(std::vector<NurbsSurface*> pieces, const std::vector<int>& orders, Direction d,
                 double tolerance) {
  std::vector<PieceKnot> knots;
  double size = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    size = std::max(size, bounds(*pieces[i]).diagonal());
    for (const Knot& knot : inner_knots(pieces[i]->knots(d), pieces[i]->degree(d)))
      knots.push_back({knot.value, i, knot.multiplicity, orders[i]});
  }
  const Interval domain = pieces.front()->domain(d);
  const int degree = pieces.front()->degree(d);
  const double shift = std::clamp(tolerance / std::max(size, tolerance), kMinKnotShift, kMaxKnotShift);
  const std::vector<Cluster> clusters = clusters_of(std::move(knots), shift * domain.length(), degree);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    std::vector<double> own(index(degree + 1), domain.lo), missing;
    for (const Cluster& cluster : clusters) {
      const auto there = cluster.multiplicity.find(i);
      const int times = there == cluster.multiplicity.end() ? 0 : there->second;
      own.insert(own.end(), index(times), cluster.value);
      missing.insert(missing.end(), index(cluster.most() - times), cluster.value);
    }
    own.insert(own.end(), index(degree + 1), domain.hi);
    (d == Direction::u ? pieces[i]->knots_u : pieces[i]->knots_v) = std::move(own);
    if (!missing.empty()) *pieces[i] = insert_knots(*pieces[i], d, missing);
  }
}

struct Pieces {
  int width = 0, height = 0;
  std::vector<NurbsSurface> nets;
  NurbsSurface& at(int x, int y) { return nets[index(x + y * width)]; }
  const NurbsSurface& at(int x, int y) const { return nets[index(x + y * width)]; }
};

void raise_degrees(Pieces& pieces) {
  for (const Direction d : {Direction::u, Direction::v}) {
    int degree = 0;
    for (const NurbsSurface& s : pieces.nets) degree = std::max(degree, s.degree(d));
    for (NurbsSurface& s : pieces.nets)
      if (s.degree(d) < degree) s = std::move(*elevate_degree(s, d, degree - s.degree(d)));
  }
}

/// Sum of the weights of one edge row.
double edge_weight(const NurbsSurface& s, SideIndex side) {
  double sum = 0;
  const bool u = across(side) == Direction::u;
  for (int k = 0; k < (u ? s.count_v : s.count_u); ++k) {
    const int i = u ? (at_high_end(side) ? s.count_u - 1 : 0) : k;
    const int j = u ? k : (at_high_end(side) ? s.count_v - 1 : 0);
    sum += s.at(i, j).w;
  }
  return sum;
}

/// A common factor on the weights of each piece, so that the rows where pieces meet are the same.
void level_weights(const Grid& grid, Pieces& pieces) {
  std::vector<double> factor(pieces.nets.size(), 1);
  for (int x = 0; x < pieces.width; ++x) {
    if (x > 0)
      factor[index(x)] =
          factor[index(x - 1)] * edge_weight(pieces.at(x - 1, 0), 1) / edge_weight(pieces.at(x, 0), 0);
    for (int y = 1; y < pieces.height; ++y)
      factor[index(x + y * pieces.width)] = factor[index(x + (y - 1) * pieces.width)] *
                                            edge_weight(pieces.at(x, y - 1), 3) /
                                            edge_weight(pieces.at(x, y), 2);
  }
  std::size_t lowest = 0;
  for (std::size_t i = 0; i < grid.blocks.size(); ++i)
    if (grid.blocks[i].order < grid.blocks[lowest].order) lowest = i;
  const double unit = factor[lowest];
  for (std::size_t i = 0; i < factor.size(); ++i)
    if (factor[i] != unit) pieces.nets[i] = with_weights_scaled(pieces.nets[i], factor[i] / unit);
}

/// Eq. 4 to 7 and 11 to 14: the nets side by side, rows that are shared once, the joint's knot as often as
/// the degree. Shared points are those of the lowest-numbered block.
NurbsSurface put_together(const Grid& grid, const Pieces& pieces) {
  const NurbsSurface& corner = pieces.at(0, 0);
  NurbsSurface out;
  out.degree_u = corner.degree_u;
  out.degree_v = corner.degree_v;
  std::vector<int> first_u{0}, first_v{0};
  out.knots_u.assign(index(out.degree_u + 1), 0.0);
  out.knots_v.assign(index(out.degree_v + 1), 0.0);
  for (int x = 0; x < pieces.width; ++x) {
    const NurbsSurface& s = pieces.at(x, 0);
    first_u.push_back(first_u.back() + s.count_u - 1);
    out.knots_u.insert(out.knots_u.end(), s.knots_u.begin() + s.degree_u + 1, s.knots_u.end() - 1);
  }
  for (int y = 0; y < pieces.height; ++y) {
    const NurbsSurface& s = pieces.at(0, y);
    first_v.push_back(first_v.back() + s.count_v - 1);
    out.knots_v.insert(out.knots_v.end(), s.knots_v.begin() + s.degree_v + 1, s.knots_v.end() - 1);
  }
  out.knots_u.push_back(out.knots_u.back());
  out.knots_v.push_back(out.knots_v.back());
  out.count_u = first_u.back() + 1;
  out.count_v = first_v.back() + 1;
  out.points.resize(index(out.count_u) * index(out.count_v));
  std::vector<int> order(pieces.nets.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return grid.blocks[index(a)].order > grid.blocks[index(b)].order; });
  for (const int k : order) {
    const int x = k % pieces.width, y = k / pieces.width;
    const NurbsSurface& s = pieces.at(x, y);
    for (int j = 0; j < s.count_v; ++j)
      for (int i = 0; i < s.count_u; ++i) out.at(first_u[index(x)] + i, first_v[index(y)] + j) = s.at(i, j);
  }
  return out;
}

Result<void> check_size(const Pieces& pieces) {
  double u = 1, v = 1;
  for (int x = 0; x < pieces.width; ++x) u += pieces.at(x, 0).count_u - 1;
  for (int y = 0; y < pieces.height; ++y) v += pieces.at(0, y).count_v - 1;
  if (u * v <= kMaxControlPoints) return {};
  return Error{
      ErrorCode::range,
      "one surface of them would have more than " + std::to_string(kMaxControlPoints) + " control points",
      {}};
}

/// Before all knots are in: an upper bound of what the common knots will need.
Result<void> check_effort(const Pieces& pieces) {
  double u = 1, v = 1;
  for (int x = 0; x < pieces.width; ++x)
    for (int y = 0; y < pieces.height; ++y) u += pieces.at(x, y).count_u;
  for (int y = 0; y < pieces.height; ++y)
    for (int x = 0; x < pieces.width; ++x) v += pieces.at(x, y).count_v;
  if (u * v <= 1e3 * kMaxControlPoints) return {};
  return Error{ErrorCode::range, "one surface of them would need too many knots", {}};
}

/// Intervals far out of proportion can make knots of one piece fall together: then it is no spline any more,
/// and nothing may be computed with it.
Result<void> check_pieces(const Pieces& pieces) {
  for (const NurbsSurface& s : pieces.nets) {
    for (const Direction d : {Direction::u, Direction::v}) {
      const Interval domain = s.domain(d);
      bool good = domain.length() > 0 && std::is_sorted(s.knots(d).begin(), s.knots(d).end());
      for (const Knot& knot : inner_knots(s.knots(d), s.degree(d)))
        good = good && knot.value > domain.lo && knot.value < domain.hi && knot.multiplicity <= s.degree(d);
      if (!good) return Error{ErrorCode::geometry, "knots of a part of them fall together", {}};
    }
  }
  return {};
}

/// Numbers far out of proportion can make knots fall together in one piece and not in the other.
Result<void> check_knots(const Pieces& pieces) {
  for (int y = 0; y < pieces.height; ++y) {
    for (int x = 0; x < pieces.width; ++x) {
      const NurbsSurface& s = pieces.at(x, y);
      if (s.knots_u == pieces.at(x, 0).knots_u && s.knots_v == pieces.at(0, y).knots_v) continue;
      return Error{ErrorCode::geometry, "their knots cannot be made the same", {}};
    }
  }
  return {};
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

  Pieces pieces{grid.width, grid.height, {}};
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x)
      pieces.nets.push_back(piece_of(sources, grid.at(x, y), x_of(x), y_of(y)));
  if (auto ok = check_pieces(pieces); !ok) return std::move(ok).error();
  raise_degrees(pieces);
  if (auto ok = check_effort(pieces); !ok) return std::move(ok).error();
  for (const bool in_x : {true, false}) {
    for (int k = 0; k < (in_x ? grid.width : grid.height); ++k) {
      std::vector<NurbsSurface*> line;
      std::vector<int> orders;
      for (int j = 0; j < (in_x ? grid.height : grid.width); ++j) {
        line.push_back(in_x ? &pieces.at(k, j) : &pieces.at(j, k));
        orders.push_back((in_x ? grid.at(k, j) : grid.at(j, k)).order);
      }
      unify_knots(line, orders, in_x ? Direction::u : Direction::v, tolerance_mm);
    }
    if (auto ok = check_size(pieces); !ok) return std::move(ok).error();
  }
  if (auto ok = check_knots(pieces); !ok) return std::move(ok).error();
  level_weights(grid, pieces);

  JoinedSurface out;
  out.surface = put_together(grid, pieces);
  if (auto ok = validate(out.surface); !ok) return std::move(ok).error();
  const double negligible = 1e-3 * tolerance_mm;
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
