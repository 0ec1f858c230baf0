// SPDX-License-Identifier: Apache-2.0
// Paths that cross a valley: near the crease the ball on one flank cuts into the other; it is lifted there,
// and what it would leave without says nothing.
#include <algorithm>
#include <cmath>

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

}  // namespace burin::cycle
