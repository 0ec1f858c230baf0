// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "burin/geom/vec.h"
#include "burin/plan/rotary/reach.h"

namespace burin::rotary {

namespace {

constexpr double kTurn = 2 * geom::kPi;

/// theta in [-pi, pi).
double wrapped(double theta) {
  const double t = std::remainder(theta, kTurn);
  return t >= geom::kPi ? -geom::kPi : t;
}

bool whole(const AngleInterval& i) {
  return i.hi - i.lo >= kTurn;
}

/// What to add to theta to come to the nearest angle of the interval; at most pi.
double way_to(const AngleInterval& i, double theta) {
  if (whole(i)) return 0;
  const double half = 0.5 * (i.hi - i.lo), off = std::remainder(theta - (i.lo + half), kTurn);
  if (std::abs(off) <= half) return 0;
  return off > 0 ? half - off : -half - off;
}

}  // namespace

bool contains(const AngleSet& set, double theta) {
  if (!std::isfinite(theta)) return false;
  return std::any_of(set.begin(), set.end(), [theta](const AngleInterval& i) {
    // Both forms: exact at the ends that are written down, and anywhere after turns.
    return (i.lo <= theta && theta <= i.hi) || way_to(i, theta) == 0;
  });
}

AngleSet narrowed(const AngleSet& set, double clearance) {
  constexpr double kLeft = 0.1;  // of an interval that has no room for the clearance
  AngleSet out;
  for (const AngleInterval& i : set) {
    if (whole(i) || !(clearance > 0)) {
      out.push_back(i);
      continue;
    }
    const double width = i.hi - i.lo, by = std::min(clearance, 0.5 * (1 - kLeft) * width);
    AngleInterval n{i.lo + by, i.hi - by};
    if (!(n.lo < n.hi)) n = i;  // a few roundings wide
    if (n.lo >= geom::kPi) n = {n.lo - kTurn, n.hi - kTurn};
    out.push_back(n);
  }
  std::sort(out.begin(), out.end(),
            [](const AngleInterval& a, const AngleInterval& b) { return a.lo < b.lo; });
  return out;
}

double total(const AngleSet& set) {
  double sum = 0;
  for (const AngleInterval& i : set) sum += i.hi - i.lo;
  return sum;
}

double nearest(const AngleSet& set, double theta) {
  if (set.empty()) return theta;
  if (!std::isfinite(theta)) return wrapped(set.front().lo);
  double best = way_to(set.front(), theta);
  for (const AngleInterval& i : set) {
    const double way = way_to(i, theta);
    if (std::abs(way) < std::abs(best)) best = way;
  }
  return theta + best;
}

}  // namespace burin::rotary
