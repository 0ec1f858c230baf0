// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "burin/base/text.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/join_assemble.h"
#include "burin/geom/surface/join_cells.h"
#include "burin/geom/surface/modify.h"

namespace burin::geom::detail {
namespace {

constexpr int kAngleSamples = 5;
/// Tangent planes that differ by less are one smooth surface when several patches compete for an edge, and a
/// patch that leaves the edge in the same direction as the other, within this, lies on it. Radians.
constexpr double kSmooth = 1e-2, kFold = 1e-3;
/// A derivative across the edge whose part square to it is smaller than this share runs along the edge.
constexpr double kAlongEdge = 1e-9;
/// A stretch of a side may share this part of its length with its neighbours.
constexpr double kSharedEnds = 1e-3;
/// Edges up to this many tolerances apart are reported.
constexpr double kNearMiss = 10;

struct Candidate {
  Contact contact;
  bool fold = false;
};

Point2 parameters_on_side(const NurbsSurface& s, SideIndex side, double t) {
  const Interval u = s.domain(Direction::u), v = s.domain(Direction::v);
  if (across(side) == Direction::u) return {at_high_end(side) ? u.hi : u.lo, v.lo + t * v.length()};
  return {u.lo + t * u.length(), at_high_end(side) ? v.hi : v.lo};
}

/// Unit vector in the surface, square to the edge, into the patch; zero where there is none.
Vec3 inward(const Source& source, SideIndex side, double t) {
  const Point2 at = parameters_on_side(source.surface, side, t);
  const SurfaceDerivatives d = derivatives(source.surface, at.x, at.y);
  const bool u = across(side) == Direction::u;
  const Vec3 edge = unit(u ? d.dv : d.du);
  const Vec3 cross_edge = at_high_end(side) ? -(u ? d.du : d.dv) : (u ? d.du : d.dv);
  const Vec3 square = cross_edge - dot(cross_edge, edge) * edge;
  return norm(square) > kAlongEdge * norm(cross_edge) ? unit(square) : Vec3{};
}

/// Smooth: everywhere opposite directions. Fold: everywhere the same.
void judge_angle(const std::vector<Source>& sources, Candidate& candidate) {
  const Contact& c = candidate.contact;
  int seen = 0;
  double straightest = 0, sharpest = 0;
  for (int k = 0; k < kAngleSamples; ++k) {
    const double a = c.match.a0 + (c.match.a1 - c.match.a0) * (k + 0.5) / kAngleSamples;
    const Vec3 one = inward(sources[static_cast<std::size_t>(c.a)], c.side_a, a);
    const Vec3 two = inward(sources[static_cast<std::size_t>(c.b)], c.side_b, c.match.b_at(a));
    if (norm(one) == 0 || norm(two) == 0) continue;
    ++seen;
    straightest = std::max(straightest, norm(one + two));
    sharpest = std::max(sharpest, norm(one - two));
  }
  candidate.contact.smooth = seen > 0 && straightest < kSmooth;
  candidate.fold = seen > 0 && sharpest < kFold;
}

bool covers_side(double from, double to) {
  return std::min(from, to) == 0 && std::max(from, to) == 1;
}

std::string text_of(double mm) {
  return format_fixed(mm, 6) + " mm";
}

/// Whole edges that are only a little too far apart: the user should know.
void near_miss(const std::vector<Source>& sources, int a, SideIndex side_a, int b, SideIndex side_b,
               double tolerance, JoinReport& report) {
  const Source &one = sources[static_cast<std::size_t>(a)], &two = sources[static_cast<std::size_t>(b)];
  if (one.patch == two.patch) return;
  for (const Overlap& overlap :
       overlaps(one.edges[static_cast<std::size_t>(side_a)], two.edges[static_cast<std::size_t>(side_b)],
                kNearMiss * tolerance)) {
    const Match &first = overlap.pieces.front(), &last = overlap.pieces.back();
    if (!covers_side(first.a0, last.a1) || !covers_side(first.b0, last.b1)) continue;
    Candidate candidate;
    candidate.contact = {a, b, side_a, side_b, first, false, false, false};
    judge_angle(sources, candidate);
    if (candidate.fold) continue;
    report_unjoined(
        report, one.patch, two.patch,
        "their edges are " + text_of(overlap.gap_mm()) + " apart (joined up to " + text_of(tolerance) + ")");
  }
}

void compare_sides(const std::vector<Source>& sources, int a, SideIndex side_a, int b, SideIndex side_b,
                   double tolerance, std::vector<Candidate>& out, JoinReport& report) {
  const auto& edge_a = sources[static_cast<std::size_t>(a)].edges[static_cast<std::size_t>(side_a)];
  const auto& edge_b = sources[static_cast<std::size_t>(b)].edges[static_cast<std::size_t>(side_b)];
  const Source &one = sources[static_cast<std::size_t>(a)], &two = sources[static_cast<std::size_t>(b)];
  const bool same_patch = one.patch == two.patch, bent = one.bent || two.bent;
  const std::vector<Overlap> found = overlaps(edge_a, edge_b, tolerance);
  if (found.empty() && a != b) near_miss(sources, a, side_a, b, side_b, tolerance, report);
  for (const Overlap& overlap : found) {
    const Match &first = overlap.pieces.front(), &last = overlap.pieces.back();
    const bool partial = !covers_side(first.a0, last.a1) || !covers_side(first.b0, last.b1);
    if (a == b && partial) continue;
    for (const Match& piece : overlap.pieces) {
      Candidate candidate;
      candidate.contact = {
          a, b, side_a, side_b, piece, partial || (bent && !same_patch), bent && same_patch, false};
      judge_angle(sources, candidate);
      out.push_back(candidate);
    }
  }
}

/// Pairs of sides whose boxes overlap: a sweep along x.
std::vector<Candidate> candidates(const std::vector<Source>& sources, double tolerance, JoinReport& report) {
  struct Entry {
    double lo, hi;
    int source;
    SideIndex side;
  };
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    for (SideIndex side = 0; side < 4; ++side) {
      const auto s = static_cast<std::size_t>(side);
      if (sources[i].collapsed[s]) continue;
      const Box3 box = sources[i].edges[s].box.grown(kNearMiss * tolerance);
      entries.push_back({box.lo.x, box.hi.x, static_cast<int>(i), side});
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& x, const Entry& y) {
    return std::tie(x.lo, x.source, x.side) < std::tie(y.lo, y.source, y.side);
  });
  std::vector<Candidate> out;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (std::size_t j = i + 1; j < entries.size() && entries[j].lo <= entries[i].hi; ++j) {
      const bool ordered =
          std::tie(entries[i].source, entries[i].side) < std::tie(entries[j].source, entries[j].side);
      const Entry &x = ordered ? entries[i] : entries[j], &y = ordered ? entries[j] : entries[i];
      // A patch meets itself only across: a ring that is closed.
      if (x.source == y.source && across(x.side) != across(y.side)) continue;
      compare_sides(sources, x.source, x.side, y.source, y.side, tolerance, out, report);
    }
  }
  return out;
}

/// What of a side is taken already.
struct Taken {
  std::vector<Interval> intervals;
  bool free(Interval t) const {
    const double slack = kSharedEnds * t.length();
    return std::none_of(intervals.begin(), intervals.end(), [&](const Interval& other) {
      return t.lo < other.hi - slack && other.lo < t.hi - slack;
    });
  }
};

auto rank(const Contact& c) {
  return std::make_tuple(!c.match.exact, !c.smooth, c.partial, c.a, c.b, c.side_a, c.side_b, c.match.a0,
                         c.match.b0);
}

/// Joining parts that only agree in place bends the higher-numbered patch: by how much, and is that allowed?
bool allowed(const std::vector<Source>& sources, const Contact& c, const JoinOptions& options,
             JoinReport& report, Diagnostics& diagnostics) {
  if (c.match.exact) return true;
  const double deviation = deviation_of_contact(sources, c, options.tolerance_mm);
  if (deviation <= options.max_deviation_mm) return true;
  const std::size_t a = sources[static_cast<std::size_t>(c.a)].patch,
                    b = sources[static_cast<std::size_t>(c.b)].patch;
  const std::string reason = "their common edge is parametrised differently; joining would deviate by " +
                             text_of(deviation) + " (at most " + text_of(options.max_deviation_mm) + ")";
  report_unjoined(report, a, b, reason, deviation);
  diagnostics.left_out("join_refused",
                       "patches " + std::to_string(a + 1) + " and " + std::to_string(b + 1) + ": " + reason);
  return false;
}

}  // namespace

void report_unjoined(JoinReport& report, std::size_t a, std::size_t b, std::string reason,
                     double deviation_mm) {
  if (a == b) return;
  if (a > b) std::swap(a, b);
  for (const auto& u : report.unjoined)
    if (u.patch_a == a && u.patch_b == b && u.reason == reason) return;
  report.unjoined.push_back({a, b, std::move(reason), deviation_mm});
}

Source source_of(NurbsSurface surface, std::size_t patch, double tolerance_mm) {
  Source source;
  source.patch = patch;
  const Interval u = surface.domain(Direction::u), v = surface.domain(Direction::v);
  source.edges = {
      edge_curve(iso_curve(surface, Direction::v, u.lo)), edge_curve(iso_curve(surface, Direction::v, u.hi)),
      edge_curve(iso_curve(surface, Direction::u, v.lo)), edge_curve(iso_curve(surface, Direction::u, v.hi))};
  // An edge within a few tolerances of one point is a pole.
  for (std::size_t k = 0; k < 4; ++k)
    source.collapsed[k] = source.edges[k].box.diagonal() <= 4 * tolerance_mm;
  source.length_u = std::max(source.edges[2].length, source.edges[3].length);
  source.length_v = std::max(source.edges[0].length, source.edges[1].length);
  source.surface = std::move(surface);
  return source;
}

std::vector<Contact> find_contacts(const std::vector<Source>& sources, const JoinOptions& options,
                                   JoinReport& report, Diagnostics& diagnostics) {
  std::vector<Candidate> all = candidates(sources, options.tolerance_mm, report);
  std::sort(all.begin(), all.end(),
            [](const Candidate& x, const Candidate& y) { return rank(x.contact) < rank(y.contact); });
  std::vector<std::array<Taken, 4>> taken(sources.size());
  std::vector<Contact> out;
  for (const Candidate& candidate : all) {
    const Contact& c = candidate.contact;
    const auto a = static_cast<std::size_t>(c.a), b = static_cast<std::size_t>(c.b);
    const std::size_t patch_a = sources[a].patch, patch_b = sources[b].patch;
    if (candidate.fold) {
      report_unjoined(report, patch_a, patch_b, "at their common edge one lies on the other");
      continue;
    }
    auto& side_a = taken[a][static_cast<std::size_t>(c.side_a)];
    auto& side_b = taken[b][static_cast<std::size_t>(c.side_b)];
    const Interval on_a{c.match.a0, c.match.a1};
    const Interval on_b{std::min(c.match.b0, c.match.b1), std::max(c.match.b0, c.match.b1)};
    if (!side_a.free(on_a) || !side_b.free(on_b)) {
      report_unjoined(report, patch_a, patch_b, "more than two patches meet at this edge");
      continue;
    }
    if (!allowed(sources, c, options, report, diagnostics)) continue;
    side_a.intervals.push_back(on_a);
    side_b.intervals.push_back(on_b);
    out.push_back(c);
  }
  return out;
}

}  // namespace burin::geom::detail
