// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/join_pieces.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "burin/geom/surface/join_cells.h"
#include "burin/geom/surface/modify.h"

namespace burin::geom::detail {
namespace {

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

/// Knots of neighbours nearer than this part of the interval may become one.
constexpr double kMaxKnotShift = 1e-6, kMinKnotShift = 1e-12;

/// Times the control points allowed: so much may be asked for before knots that are the same are one.
constexpr double kMostKnots = 1e3;

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
void level_weights(Pieces& pieces) {
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
  const auto lowest = std::min_element(pieces.orders.begin(), pieces.orders.end()) - pieces.orders.begin();
  const double unit = factor[static_cast<std::size_t>(lowest)];
  for (std::size_t i = 0; i < factor.size(); ++i)
    if (factor[i] != unit) pieces.nets[i] = with_weights_scaled(pieces.nets[i], factor[i] / unit);
}

/// Eq. 4 to 7 and 11 to 14: the nets side by side, rows that are shared once, the joint's knot as often as
/// the degree. Shared points are those of the lowest-numbered piece.
NurbsSurface side_by_side(const Pieces& pieces) {
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
            [&](int a, int b) { return pieces.orders[index(a)] > pieces.orders[index(b)]; });
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
  if (u * v <= kMostKnots * kMaxControlPoints) return {};
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

/// Every column (row) gets common knots in the direction across it.
void unify_columns(Pieces& pieces, bool in_x, double tolerance_mm) {
  for (int k = 0; k < (in_x ? pieces.width : pieces.height); ++k) {
    std::vector<NurbsSurface*> line;
    std::vector<int> orders;
    for (int j = 0; j < (in_x ? pieces.height : pieces.width); ++j) {
      line.push_back(in_x ? &pieces.at(k, j) : &pieces.at(j, k));
      orders.push_back(pieces.orders[in_x ? pieces.place(k, j) : pieces.place(j, k)]);
    }
    unify_knots(line, orders, in_x ? Direction::u : Direction::v, tolerance_mm);
  }
}

}  // namespace

Result<NurbsSurface> put_together(Pieces pieces, double tolerance_mm) {
  if (auto ok = check_pieces(pieces); !ok) return std::move(ok).error();
  raise_degrees(pieces);
  if (auto ok = check_effort(pieces); !ok) return std::move(ok).error();
  for (const bool in_x : {true, false}) {
    unify_columns(pieces, in_x, tolerance_mm);
    if (auto ok = check_size(pieces); !ok) return std::move(ok).error();
  }
  if (auto ok = check_knots(pieces); !ok) return std::move(ok).error();
  level_weights(pieces);
  NurbsSurface out = side_by_side(pieces);
  if (auto ok = validate(out); !ok) return std::move(ok).error();
  return out;
}

}  // namespace burin::geom::detail
