// SPDX-License-Identifier: Apache-2.0
// Paths that cross a valley: near the crease the ball on one flank cuts into the other; it is lifted there,
// and what it would leave without says nothing.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "burin/plan/cycle/passes.h"

namespace burin::cycle {
namespace {

using geom::Side;

/// The distance of `x` from what lies beyond the crease (`above`: at larger t), near (crease, w).
double from_flank(const Sheet& sheet, Point3 x, double crease, bool above, double w) {
  const Side side = above ? Side::right : Side::left;
  const geom::Interval ws = sheet.w_range();
  const double lo = above ? crease : sheet.t_range().lo, hi = above ? sheet.t_range().hi : crease;
  double t = crease, best = 1e300;
  constexpr int kIterations = 12;
  for (int i = 0; i < kIterations; ++i) {
    const Contact q = sheet.contact(t, w, t == crease ? side : Side::right);
    const Vec3 e = x - q.s;
    const double away = norm(e);
    if (!(away < best)) break;
    best = away;
    // Gauss-Newton within the flank; where t stays on the crease w moves alone.
    const double tt = dot(q.st, q.st), ww = dot(q.sw, q.sw), tw = dot(q.st, q.sw);
    const double rt = dot(e, q.st), rw = dot(e, q.sw), det = tt * ww - tw * tw;
    if (!(det > 0) || !(ww > 0)) break;
    const double next = std::clamp(t + (rt * ww - rw * tw) / det, lo, hi);
    w = std::clamp(w + (rw - (next - t) * tw) / ww, ws.lo, ws.hi);
    t = next;
  }
  return best;
}

}  // namespace

bool in_valley(const Sheet& sheet, double t, double w) {
  const double reach = sheet.radius() + sheet.stock();
  for (const double crease : sheet.t_creases()) {
    const bool above = t <= crease;
    const Contact b = sheet.contact(t, w, t == crease ? Side::left : Side::right);
    // Flanks nearly face to face are no valley that a ball would go into.
    constexpr double kFar = 8;
    if (distance(b.s, sheet.point(crease, w)) > kFar * reach) continue;
    constexpr double kCuts = 1e-6;
    if (from_flank(sheet, b.c, crease, above, w) < (1 - kCuts) * reach) return true;
  }
  return false;
}

std::vector<Pass::Section> between_valleys(const Sheet& sheet, const Pass& pass) {
  struct Gap {
    double lo = 0, hi = 0, crease = 0;
  };
  std::vector<Gap> gaps;
  for (const Graph& g : pass.graphs) {
    const auto inside = [&](double t) { return in_valley(sheet, t, g.at(t).w); };
    // From a place in the valley to where the ball fits, through the nodes and then between two of them.
    const auto edge = [&](double in, auto first, auto last) {
      double out = in;
      for (; first != last && inside(out); ++first) in = out, out = *first;
      constexpr int kHalvings = 30;
      for (int i = 0; i < kHalvings && !inside(out); ++i) {
        const double mid = 0.5 * (in + out);
        if (inside(mid))
          in = mid;
        else if (out = mid; std::abs(out - in) < 1e-9 * (g.hi() - g.lo()))
          break;
      }
      return out;
    };
    for (const double crease : sheet.t_creases()) {
      if (!(crease > g.lo() && crease < g.hi()) || !inside(crease)) continue;
      const auto above = std::upper_bound(g.t.begin(), g.t.end(), crease);
      const auto below = std::make_reverse_iterator(std::lower_bound(g.t.begin(), g.t.end(), crease));
      gaps.push_back({edge(crease, below, g.t.rend()), edge(crease, above, g.t.end()), crease});
    }
  }
  if (gaps.empty()) return {};
  std::vector<Pass::Section> out;
  double from = pass.graphs.front().lo();
  gaps.push_back({pass.graphs.back().hi(), 0, pass.graphs.back().hi()});
  for (const Gap& gap : gaps) {
    Track part = cut_track(pass.track, from, gap.lo);
    if (!part.empty()) out.push_back({gap.crease, std::move(part)});
    from = std::max(from, gap.hi);
  }
  return out;
}

}  // namespace burin::cycle
