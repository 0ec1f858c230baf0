// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/join_forced.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "burin/base/text.h"
#include "burin/geom/surface/join_measure.h"
#include "burin/geom/surface/modify.h"
#include "burin/geom/surface/rows.h"

namespace burin::geom::detail {
namespace {

/// Bases that are replaced at most: their parts can be bases again.
constexpr int kMaxForced = 500;
/// Weights correspond when their quotient is constant within this.
constexpr double kSameWeights = 1e-6;
constexpr double kSameKnots = 1e-9;

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

bool same_points(const std::vector<HPoint>& base, int first, const std::vector<HPoint>& partial,
                 bool reversed, double tolerance) {
  const int n = static_cast<int>(partial.size());
  const double quotient = base[index(first)].w / (reversed ? partial.back() : partial.front()).w;
  for (int k = 0; k < n; ++k) {
    const HPoint &a = base[index(first + k)], &b = partial[index(reversed ? n - 1 - k : k)];
    if (distance(project(a), project(b)) > tolerance) return false;
    if (std::abs(a.w / b.w / quotient - 1) > kSameWeights) return false;
  }
  return true;
}

std::vector<double> normalised(const std::vector<double>& knots, bool reversed) {
  std::vector<double> out;
  for (const double knot : knots) out.push_back((knot - knots.front()) / (knots.back() - knots.front()));
  if (reversed) {
    std::reverse(out.begin(), out.end());
    for (double& knot : out) knot = 1 - knot;
  }
  return out;
}

bool same_knots(const NurbsCurve& a, const NurbsCurve& b, bool reversed) {
  const std::vector<double> x = normalised(a.knots, false), y = normalised(b.knots, reversed);
  if (x.size() != y.size()) return false;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::abs(x[i] - y[i]) > kSameKnots) return false;
  return true;
}

/// A part of the base and what its ends are in the base's parameter.
struct Strip {
  Rows rows;
  Interval of_base;
};

Rows some_rows(const Rows& base, int first, int last) {
  Rows out{base.degree, base.width, {}, {base.row(first), base.row(last + 1)}};
  return out;
}

std::vector<double> bezier_knots(int degree, Interval t) {
  std::vector<double> knots(index(degree + 1), t.lo);
  knots.insert(knots.end(), index(degree + 1), t.hi);
  return knots;
}

/// Where row i sits in the parameter (Greville).
double place_of_row(const Rows& rows, int i) {
  double sum = 0;
  for (int k = 1; k <= rows.degree; ++k) sum += rows.knots[index(i + k)];
  return sum / rows.degree;
}

/// Eq. 20: rows 0 .. last, V = {v_0 .. v_last, v_(last+1) (q+1 times)}. With too few rows for the degree that
/// is empty: then one Bezier piece of lower degree.
Strip lower_rest(const Rows& base, int last) {
  Strip out{some_rows(base, 0, last), {}};
  if (last >= base.degree) {
    out.of_base = {base.knots.front(), base.knots[index(last + 1)]};
    out.rows.knots.assign(base.knots.begin(), base.knots.begin() + last + 1);
    out.rows.knots.insert(out.rows.knots.end(), index(base.degree + 1), out.of_base.hi);
  } else {
    out.of_base = {base.knots.front(), place_of_row(base, last)};
    out.rows.degree = last;
    out.rows.knots = bezier_knots(last, out.of_base);
  }
  return out;
}

/// Eq. 19: rows first .. m, V = {v_(first+q) (q+1 times), v_(first+q+1) .. v_(m+q+1)}.
Strip upper_rest(const Rows& base, int first) {
  const int m = base.count() - 1, q = base.degree;
  Strip out{some_rows(base, first, m), {}};
  if (m - first >= q) {
    out.of_base = {base.knots[index(first + q)], base.knots.back()};
    out.rows.knots.assign(index(q + 1), out.of_base.lo);
    out.rows.knots.insert(out.rows.knots.end(), base.knots.begin() + first + q + 1, base.knots.end());
  } else {
    out.of_base = {place_of_row(base, first), base.knots.back()};
    out.rows.degree = m - first;
    out.rows.knots = bezier_knots(m - first, out.of_base);
  }
  return out;
}

/// From the parameters of a strip to those of the base, as a member without swaps.
Member map_of(const NurbsSurface& part, Direction d, Interval of_base) {
  Member m;
  m.u = part.domain(Direction::u);
  m.v = part.domain(Direction::v);
  m.pu = {0, 1, 0};
  m.pv = {0, 0, 1};
  const Interval own = part.domain(d);
  const double slope = of_base.length() / own.length();
  if (d == Direction::u)
    m.pu = {of_base.lo - slope * own.lo, slope, 0};
  else
    m.pv = {of_base.lo - slope * own.lo, 0, slope};
  return m;
}

std::optional<Run> common_rows(const Source& base, SideIndex base_side, const Source& partial,
                               SideIndex partial_side, double tolerance_mm) {
  const NurbsCurve& a = base.edges[index(base_side)].curve;
  const NurbsCurve& b = partial.edges[index(partial_side)].curve;
  const int n = static_cast<int>(a.points.size()), m = static_cast<int>(b.points.size());
  if (a.degree != b.degree || m > n) return {};
  for (int first = 0; first + m <= n; ++first) {
    for (const bool reversed : {false, true}) {
      if (!same_points(a.points, first, b.points, reversed, tolerance_mm)) continue;
      if (m == n && same_knots(a, b, reversed)) return {};  // an ordinary contact
      return Run{first, first + m - 1, reversed};
    }
  }
  return {};
}

struct Pairing {
  std::size_t partial = 0;
  SideIndex base_side = 0, partial_side = 0;
  Run run;
};

/// The first partial patch (by number) whose edge is made of rows of the base but does not lie on its edge.
std::optional<Pairing> find_pairing(const std::vector<Source>& sources, std::size_t base,
                                    const std::set<std::pair<std::size_t, std::size_t>>& refused,
                                    double tolerance) {
  const Source& b = sources[base];
  for (std::size_t j = 0; j < sources.size(); ++j) {
    const Source& p = sources[j];
    if (p.patch == b.patch || refused.count({b.patch, p.patch})) continue;
    for (SideIndex side_b = 0; side_b < 4; ++side_b) {
      const auto sb = index(side_b);
      if (b.collapsed[sb]) continue;
      const Box3 box = b.edges[sb].box.grown(tolerance);
      for (SideIndex side_p = 0; side_p < 4; ++side_p) {
        const auto sp = index(side_p);
        if (p.collapsed[sp] || !box.overlaps(p.edges[sp].box)) continue;
        const auto run = common_rows(b, side_b, p, side_p, tolerance);
        if (!run || !overlaps(b.edges[sb], p.edges[sp], tolerance).empty()) continue;
        return Pairing{j, side_b, side_p, *run};
      }
    }
  }
  return {};
}

}  // namespace

std::vector<Source> forced_parts(const Source& base, SideIndex base_side, const Run& run,
                                 std::vector<double> partial_knots, double tolerance_mm) {
  const Direction d = along(base_side);
  const Rows rows = rows_of(base.surface, d);
  if (run.reversed) {
    const double sum = partial_knots.front() + partial_knots.back();
    std::reverse(partial_knots.begin(), partial_knots.end());
    for (double& knot : partial_knots) knot = sum - knot;
  }
  std::vector<Strip> strips;
  Interval middle = base.surface.domain(d);
  if (run.first > 0) {
    strips.push_back(lower_rest(rows, run.first));
    middle.lo = strips.back().of_base.hi;
  }
  std::optional<Strip> upper;
  if (run.last < rows.count() - 1) {
    upper = upper_rest(rows, run.last);
    middle.hi = upper->of_base.lo;
  }
  Strip with_partial{some_rows(rows, run.first, run.last), middle};
  with_partial.rows.knots = std::move(partial_knots);
  strips.push_back(std::move(with_partial));
  if (upper) strips.push_back(std::move(*upper));

  std::vector<NurbsSurface> parts;
  std::vector<Member> maps;
  for (Strip& strip : strips) {
    // Overlapping runs of rows can leave nothing of the middle in the base's parameter.
    if (!(strip.of_base.length() > 0)) return {};
    parts.push_back(surface_of(std::move(strip.rows), d, base.surface));
    maps.push_back(map_of(parts.back(), d, strip.of_base));
  }
  const double deviation = distance_to_parts(base.surface, parts, maps, kNegligible * tolerance_mm);
  std::vector<Source> out;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Source s = source_of(parts[i], base.patch, tolerance_mm);
    s.bent = true;
    s.deviation_mm = base.deviation_mm + deviation;
    const auto chain = [](const std::array<double, 2>& outer, double start, double slope) {
      return std::array{outer[0] + outer[1] * start, outer[1] * slope};
    };
    s.map_u = chain(base.map_u, maps[i].pu[0], maps[i].pu[1]);
    s.map_v = chain(base.map_v, maps[i].pv[0], maps[i].pv[2]);
    out.push_back(std::move(s));
  }
  return out;
}

void force_partial_joins(std::vector<Source>& sources, const JoinOptions& options, JoinReport& report,
                         Diagnostics& diagnostics) {
  std::set<std::pair<std::size_t, std::size_t>> refused;
  int forced = 0;
  for (std::size_t i = 0; i < sources.size();) {
    const auto found =
        forced < kMaxForced ? find_pairing(sources, i, refused, options.tolerance_mm) : std::nullopt;
    if (!found) {
      ++i;
      continue;
    }
    const Source& base = sources[i];
    const Source& partial = sources[found->partial];
    const auto& knots = partial.surface.knots(along(found->partial_side));
    std::vector<Source> parts = forced_parts(base, found->base_side, found->run, knots, options.tolerance_mm);
    const double deviation =
        parts.empty() ? std::numeric_limits<double>::infinity() : parts.front().deviation_mm;
    if (deviation <= options.max_deviation_mm) {
      ++forced;
      sources.erase(sources.begin() + static_cast<std::ptrdiff_t>(i));
      sources.insert(sources.begin() + static_cast<std::ptrdiff_t>(i), std::make_move_iterator(parts.begin()),
                     std::make_move_iterator(parts.end()));
      continue;
    }
    refused.insert({base.patch, partial.patch});
    const std::string figure = parts.empty() ? "would leave nothing of it"
                                             : "would bend it by " + format_fixed(deviation, 6) + " mm";
    const std::string reason = "joining patch " + std::to_string(partial.patch + 1) + " to rows " +
                               std::to_string(found->run.first + 1) + " to " +
                               std::to_string(found->run.last + 1) + " of patch " +
                               std::to_string(base.patch + 1) + " " + figure + " (at most " +
                               format_fixed(options.max_deviation_mm, 6) + " mm is allowed)";
    report_unjoined(report, base.patch, partial.patch, reason, parts.empty() ? 0 : deviation);
    diagnostics.left_out("join_refused", reason);
  }
}

}  // namespace burin::geom::detail
