// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/join_cells.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "burin/geom/surface/basis.h"
#include "burin/geom/surface/evaluate.h"

namespace burin::geom::detail {
namespace {

/// Cuts run on through all neighbours and can go round closed surfaces for ever: no more than this.
constexpr std::size_t kMaxCuts = 4000;
constexpr std::size_t kMaxCells = 20000;
/// Cuts closer than the tolerance are one; as a share of the source's length never below rounding, and in a
/// source hardly longer than the tolerance never so much that its ends become one.
constexpr double kLeastNear = 1e-12, kMostNear = 0.1;

/// The cuts of one source in one direction, normalised, with 0 and 1.
struct Cuts {
  std::vector<double> at{0, 1};
  double near = 0;  ///< closer ones are the same

  /// The index, or -1.
  int find(double t) const {
    int best = -1;
    for (std::size_t i = 0; i < at.size(); ++i)
      if (std::abs(at[i] - t) <= near &&
          (best < 0 || std::abs(at[i] - t) < std::abs(at[static_cast<std::size_t>(best)] - t)))
        best = static_cast<int>(i);
    return best;
  }
};

class Cutter {
 public:
  Cutter(const std::vector<Source>& sources, const std::vector<Contact>& contacts, double tolerance)
      : sources_(sources),
        contacts_(contacts),
        tolerance_(tolerance),
        cuts_(sources.size()),
        of_(sources.size()) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      for (const Direction d : {Direction::u, Direction::v})
        cuts(static_cast<int>(i), d).near =
            std::clamp(tolerance / std::max(sources[i].length(d), tolerance), kLeastNear, kMostNear);
    }
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      of_[static_cast<std::size_t>(contacts[k].a)].push_back(k);
      if (contacts[k].a != contacts[k].b) of_[static_cast<std::size_t>(contacts[k].b)].push_back(k);
    }
    cells_ = sources.size();
    cut_at_ends();
    propagate();
  }

  const Cuts& cuts(int source, Direction d) const {
    return cuts_[static_cast<std::size_t>(source)][d == Direction::u ? 0 : 1];
  }

  /// Of a parameter on the a side, on the b side; and back.
  double to_b(const Contact& c, double a) const {
    if (a == c.match.a0) return c.match.b0;
    if (a == c.match.a1) return c.match.b1;
    if (c.match.exact) return c.match.b_at(a);
    const auto& edge = sources_[static_cast<std::size_t>(c.a)].edges[static_cast<std::size_t>(c.side_a)];
    const auto& partner = sources_[static_cast<std::size_t>(c.b)].edges[static_cast<std::size_t>(c.side_b)];
    return by_place(edge, partner, a, c.match.b0, c.match.b1).value_or(c.match.b_at(a));
  }
  double to_a(const Contact& c, double b) const {
    const double f = (b - c.match.b0) / (c.match.b1 - c.match.b0);
    const double linear = c.match.a0 + (c.match.a1 - c.match.a0) * moebius(1 / c.match.alpha, f);
    if (c.match.exact) return linear;
    const auto& edge = sources_[static_cast<std::size_t>(c.b)].edges[static_cast<std::size_t>(c.side_b)];
    const auto& partner = sources_[static_cast<std::size_t>(c.a)].edges[static_cast<std::size_t>(c.side_a)];
    return by_place(edge, partner, b, c.match.a0, c.match.a1).value_or(linear);
  }

 private:
  Cuts& cuts(int source, Direction d) {
    return cuts_[static_cast<std::size_t>(source)][d == Direction::u ? 0 : 1];
  }

  std::optional<double> by_place(const EdgeCurve& edge, const EdgeCurve& partner, double t, double from,
                                 double to) const {
    for (const double s : near_parameters(partner, point(edge.curve, t), 2 * tolerance_))
      if (s >= std::min(from, to) && s <= std::max(from, to)) return s;
    return {};
  }

  /// Onto a knot that is nearly there: no slivers of spans.
  double on_knot(int source, Direction d, double t, double near) const {
    const NurbsSurface& s = sources_[static_cast<std::size_t>(source)].surface;
    const Interval domain = s.domain(d);
    for (const Knot& knot : inner_knots(s.knots(d), s.degree(d))) {
      const double k = (knot.value - domain.lo) / domain.length();
      if (std::abs(k - t) <= near) return k;
    }
    return t;
  }

  void add(int source, Direction d, double t) {
    Cuts& c = cuts(source, d);
    if (c.find(t) >= 0) return;
    const std::size_t across_count = cuts(source, other(d)).at.size() - 1;
    if (added_ >= kMaxCuts || cells_ + across_count > kMaxCells) return;
    t = on_knot(source, d, t, c.near);
    c.at.insert(std::lower_bound(c.at.begin(), c.at.end(), t), t);
    ++added_;
    cells_ += across_count;
    queue_.push_back({source, d, t});
  }

  void cut_at_ends() {
    for (const Contact& c : contacts_) {
      for (const double t : {c.match.a0, c.match.a1}) add(c.a, along(c.side_a), t);
      for (const double t : {c.match.b0, c.match.b1}) add(c.b, along(c.side_b), t);
    }
  }

  void propagate() {
    while (!queue_.empty()) {
      const Cut cut = queue_.front();
      queue_.pop_front();
      for (const std::size_t k : of_[static_cast<std::size_t>(cut.source)]) {
        const Contact& c = contacts_[k];
        const double lo_b = std::min(c.match.b0, c.match.b1), hi_b = std::max(c.match.b0, c.match.b1);
        if (c.a == cut.source && along(c.side_a) == cut.direction && cut.t > c.match.a0 && cut.t < c.match.a1)
          add(c.b, along(c.side_b), to_b(c, cut.t));
        if (c.b == cut.source && along(c.side_b) == cut.direction && cut.t > lo_b && cut.t < hi_b)
          add(c.a, along(c.side_a), to_a(c, cut.t));
      }
    }
  }

  struct Cut {
    int source;
    Direction direction;
    double t;
  };
  const std::vector<Source>& sources_;
  const std::vector<Contact>& contacts_;
  double tolerance_;
  std::vector<std::array<Cuts, 2>> cuts_;
  std::vector<std::vector<std::size_t>> of_;
  std::deque<Cut> queue_;
  std::size_t added_ = 0, cells_ = 0;
};

/// Gauss, three points a span: it ranks rectangles, nothing else.
double area_of(SurfaceEvaluator& evaluator, const NurbsSurface& s, Interval u, Interval v) {
  constexpr double x[3] = {0.1127016653792583, 0.5, 0.8872983346207417},
                   w[3] = {5 / 18.0, 8 / 18.0, 5 / 18.0};
  const std::vector<double> us = spans_in(s.knots_u, u), vs = spans_in(s.knots_v, v);
  double sum = 0;
  for (std::size_t b = 0; b + 1 < vs.size(); ++b) {
    for (std::size_t a = 0; a + 1 < us.size(); ++a) {
      const double du = us[a + 1] - us[a], dv = vs[b + 1] - vs[b];
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
          const SurfaceDerivatives d = evaluator.derivatives(us[a] + x[i] * du, vs[b] + x[j] * dv);
          sum += w[i] * w[j] * du * dv * norm(cross(d.du, d.dv));
        }
      }
    }
  }
  return sum;
}

double at_fraction(Interval t, double f) {
  return f == 0 ? t.lo : f == 1 ? t.hi : t.lo + f * t.length();
}

/// Cell numbers of the sources.
struct Layout {
  std::vector<int> first, columns, rows;

  /// The cell on a side, `k`-th along it.
  int on_side(int source, SideIndex side, int k) const {
    const auto s = static_cast<std::size_t>(source);
    const int nu = columns[s], nv = rows[s];
    const int i = across(side) == Direction::u ? (at_high_end(side) ? nu - 1 : 0) : k;
    const int j = across(side) == Direction::u ? k : (at_high_end(side) ? nv - 1 : 0);
    return first[s] + i + j * nu;
  }
};

Layout lay_out(const std::vector<Source>& sources, const Cutter& cutter, CellGraph& graph) {
  Layout layout;
  for (int i = 0; i < static_cast<int>(sources.size()); ++i) {
    const NurbsSurface& s = sources[static_cast<std::size_t>(i)].surface;
    const auto &us = cutter.cuts(i, Direction::u).at, &vs = cutter.cuts(i, Direction::v).at;
    const int nu = static_cast<int>(us.size()) - 1, nv = static_cast<int>(vs.size()) - 1;
    const int first = static_cast<int>(graph.cells.size());
    layout.first.push_back(first);
    layout.columns.push_back(nu);
    layout.rows.push_back(nv);
    const Interval du = s.domain(Direction::u), dv = s.domain(Direction::v);
    SurfaceEvaluator evaluator(s);
    for (std::size_t b = 0; b + 1 < vs.size(); ++b) {
      for (std::size_t a = 0; a + 1 < us.size(); ++a) {
        Cell cell;
        cell.source = i;
        cell.u = {at_fraction(du, us[a]), at_fraction(du, us[a + 1])};
        cell.v = {at_fraction(dv, vs[b]), at_fraction(dv, vs[b + 1])};
        cell.area = area_of(evaluator, s, cell.u, cell.v);
        graph.cells.push_back(cell);
      }
    }
    Link inside;
    inside.artificial = inside.inner = true;
    for (int b = 0; b < nv; ++b) {
      for (int a = 0; a < nu; ++a) {
        const int cell = first + a + b * nu;
        if (a + 1 < nu) connect(graph, cell, 1, cell + 1, 0, inside);
        if (b + 1 < nv) connect(graph, cell, 3, cell + nu, 2, inside);
      }
    }
  }
  return layout;
}

/// All cell sides along one contact; false when the cuts of both sides do not correspond.
bool connect_contact(const Cutter& cutter, const Layout& layout, const Contact& c, CellGraph& graph) {
  const Cuts &on_a = cutter.cuts(c.a, along(c.side_a)), &on_b = cutter.cuts(c.b, along(c.side_b));
  const int from = on_a.find(c.match.a0), to = on_a.find(c.match.a1);
  if (from < 0 || to <= from) return false;
  const bool reversed = c.match.b1 < c.match.b0;
  bool all = true;
  const auto fraction = [&](int k) {
    if (k == from) return 0.0;
    if (k == to) return 1.0;
    return (on_a.at[static_cast<std::size_t>(k)] - c.match.a0) / (c.match.a1 - c.match.a0);
  };
  const auto partner = [&](int k) {
    const double a = k == from ? c.match.a0 : k == to ? c.match.a1 : on_a.at[static_cast<std::size_t>(k)];
    return on_b.find(cutter.to_b(c, a));
  };
  for (int k = from; k < to; ++k) {
    const int b0 = partner(k), b1 = partner(k + 1);
    if (b0 < 0 || b1 < 0 || b1 - b0 != (reversed ? -1 : 1)) {
      all = false;
      continue;
    }
    Link link;
    link.reversed = reversed;
    link.alpha = moebius_part(c.match.alpha, fraction(k), fraction(k + 1));
    link.gap_mm = c.match.gap_mm;
    link.exact = c.match.exact;
    link.partial = c.partial;
    link.inner = c.inner;
    const int a = layout.on_side(c.a, c.side_a, k), b = layout.on_side(c.b, c.side_b, std::min(b0, b1));
    if (a == b && c.side_a == c.side_b) continue;
    if (graph.cells[static_cast<std::size_t>(a)].links[static_cast<std::size_t>(c.side_a)].cell >= 0 ||
        graph.cells[static_cast<std::size_t>(b)].links[static_cast<std::size_t>(c.side_b)].cell >= 0) {
      all = false;  // contacts that overlap by less than they were allowed to
      continue;
    }
    connect(graph, a, c.side_a, b, c.side_b, link);
  }
  return all;
}

/// Would a rectangle that holds `cell` and its neighbour in the same source hold both partners at a partial
/// contact beside the line between them?
bool leaves_contact_open(const CellGraph& graph, int cell, SideIndex side) {
  const Placed here{cell, {}};
  const Step across_line = side == 0   ? Step::west
                           : side == 1 ? Step::east
                           : side == 2 ? Step::south
                                       : Step::north;
  const Link& line = graph.cells[static_cast<std::size_t>(cell)].links[static_cast<std::size_t>(side)];
  const Placed there{line.cell, {}};
  const std::array<Step, 2> ends = across(side) == Direction::u ? std::array{Step::south, Step::north}
                                                                : std::array{Step::west, Step::east};
  for (const Step end : ends) {
    const Link &one = link_towards(graph, here, end), &two = link_towards(graph, there, end);
    if (!one.partial && !two.partial) continue;
    if (one.cell < 0 || two.cell < 0) return true;
    const Placed partner{one.cell, behind({}, end, one)}, wanted{two.cell, behind({}, end, two)};
    const Link& between = link_towards(graph, partner, across_line);
    if (between.cell < 0) return true;
    if (!(Placed{between.cell, behind(partner.orientation, across_line, between)} == wanted)) return true;
  }
  return false;
}

}  // namespace

void connect(CellGraph& graph, int a, SideIndex side_a, int b, SideIndex side_b, Link link) {
  link.cell = b;
  link.side = side_b;
  graph.cells[static_cast<std::size_t>(a)].links[static_cast<std::size_t>(side_a)] = link;
  link.cell = a;
  link.side = side_a;
  if (!link.reversed) link.alpha = 1 / link.alpha;
  graph.cells[static_cast<std::size_t>(b)].links[static_cast<std::size_t>(side_b)] = link;
}

SideIndex side_facing(const Orientation& o, Step step) {
  const bool x = step == Step::east || step == Step::west;
  const bool positive = (step == Step::east || step == Step::north) != (x ? o.flip_x : o.flip_y);
  const bool local_u = x != o.swap;
  return (local_u ? 0 : 2) + (positive ? 1 : 0);
}

Orientation behind(const Orientation& o, Step step, const Link& link) {
  const bool x = step == Step::east || step == Step::west;
  const bool local_u = across(link.side) == Direction::u;
  const bool back_is_positive = step == Step::west || step == Step::south;
  const bool flip = back_is_positive != at_high_end(link.side);
  Orientation out;
  out.swap = local_u != x;
  (x ? out.flip_x : out.flip_y) = flip;
  (x ? out.flip_y : out.flip_x) = (x ? o.flip_y : o.flip_x) != link.reversed;
  return out;
}

CellGraph make_cells(const std::vector<Source>& sources, const std::vector<Contact>& contacts,
                     const JoinOptions& options, JoinReport& report) {
  const Cutter cutter(sources, contacts, options.tolerance_mm);
  CellGraph graph;
  const Layout layout = lay_out(sources, cutter, graph);
  for (const Contact& c : contacts) {
    if (connect_contact(cutter, layout, c, graph)) continue;
    report_unjoined(report, sources[static_cast<std::size_t>(c.a)].patch,
                    sources[static_cast<std::size_t>(c.b)].patch,
                    "their cuts do not correspond, or there are too many of them");
  }
  for (int cell = 0; cell < static_cast<int>(graph.cells.size()); ++cell) {
    for (SideIndex side = 0; side < 4; ++side) {
      Link& link = graph.cells[static_cast<std::size_t>(cell)].links[static_cast<std::size_t>(side)];
      if (link.inner) link.barrier = leaves_contact_open(graph, cell, side);
    }
  }
  return graph;
}

}  // namespace burin::geom::detail
