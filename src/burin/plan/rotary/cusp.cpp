// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/cusp.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/plan/rotary/sweep.h"

namespace burin::rotary::detail {

using geom::Point3;
using geom::Vec3;

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// Segments looked at beyond the nearest one so far: distances along a centre path are smooth, small bumps of
/// its polygon are passed.
constexpr std::size_t kPatience = 6;

}  // namespace

double CenterLine::distance2(Point3 q, std::size_t segment) const {
  const Point3 a = points_[segment], b = points_[(segment + 1) % points_.size()];
  const Vec3 ab = b - a, aq = q - a;
  const double length2 = dot(ab, ab);
  const double f = length2 > 0 ? std::clamp(dot(aq, ab) / length2, 0.0, 1.0) : 0;
  const Vec3 d = aq - f * ab;
  return dot(d, d);
}

std::size_t CenterLine::closest(Point3 q, std::size_t hint) const {
  const std::size_t n = segments();
  std::size_t best = std::min(hint, n - 1);
  double least = distance2(q, best);
  for (const bool forward : {true, false}) {
    std::size_t at = best, idle = 0;
    for (std::size_t walked = 0; walked < n && idle < kPatience; ++walked) {
      if (!closed_ && (forward ? at + 1 == n : at == 0)) break;
      at = forward ? (at + 1) % n : (at + n - 1) % n;
      const double d = distance2(q, at);
      if (d < least) {
        least = d;
        best = at;
        idle = 0;
      } else {
        ++idle;
      }
    }
  }
  return best;
}

Point3 CenterLine::place(Point3 q, std::size_t segment) const {
  const Point3 a = points_[segment], b = points_[(segment + 1) % points_.size()];
  const double length2 = dot(b - a, b - a);
  return length2 > 0 ? lerp(a, b, std::clamp(dot(q - a, b - a) / length2, 0.0, 1.0)) : a;
}

namespace {

/// Where the ray from q enters the ball.
double into_ball(Point3 q, Vec3 n, Point3 center, double radius) {
  const Vec3 d = q - center;
  const double along = dot(d, n), c = dot(d, d) - radius * radius;
  if (c <= 0) return 0;
  const double root = along * along - c;
  return root < 0 || along >= 0 ? kNever : c / (-along + std::sqrt(root));
}

/// closest(p) is the segment nearest to p, place(p, segment) the centre on it.
template <class Closest, class Place>
double first_entry(Point3 q, Vec3 n, double radius, const Closest& closest, const Place& place) {
  // The ball that belongs to the contact (q, n) would stand here: the nearest one faces it. (The centre
  // nearest to q says nothing at a corner of the part, about which the ball rolls at one distance.)
  const Point3 facing = q + radius * n;
  double t = into_ball(q, n, place(facing, closest(facing)), radius);
  // Of all balls the one that is entered first has its centre nearest to the place where it is entered.
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds && t > 0 && t < kNever; ++round) {
    const Point3 at = q + t * n;
    const double sooner = into_ball(q, n, place(at, closest(at)), radius);
    if (!(sooner < t)) break;
    const bool done = sooner > 0.9999 * t;
    t = sooner;
    if (done) break;
  }
  return t;
}

}  // namespace

double CenterLine::entry(Point3 q, Vec3 n, double radius, std::size_t& hint) const {
  return first_entry(
      q, n, radius, [&](Point3 p) { return hint = closest(p, hint); },
      [&](Point3 p, std::size_t segment) { return place(p, segment); });
}

double entry(const SegmentRuns& way, Point3 q, Vec3 n, double radius, std::size_t& hint) {
  double d2 = 0;
  return first_entry(
      q, n, radius, [&](Point3 p) { return hint = way.nearest(p, hint, d2); },
      [&](Point3 p, std::size_t segment) {
        const Point3 a = way[segment].a, b = way[segment].b;
        const double length2 = dot(b - a, b - a);
        return length2 > 0 ? lerp(a, b, std::clamp(dot(p - a, b - a) / length2, 0.0, 1.0)) : a;
      });
}

double ring_cusp(const RingAt& ring, std::size_t count, double a, double b, double radius) {
  std::vector<Point3> at_a, at_b;
  at_a.reserve(count);
  at_b.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    at_a.push_back(center_of(ring(i, a), radius));
    at_b.push_back(center_of(ring(i, b), radius));
  }
  const CenterLine line_a(std::move(at_a), true), line_b(std::move(at_b), true);
  double worst = 0;
  std::size_t hint_a = 0, hint_b = 0;
  for (std::size_t i = 0; i < count; ++i) {
    hint_a = hint_b = i;
    double f = 0.5, height = 0;
    // The place where both leave the same: heights go as the squares of the distances from their paths.
    for (int round = 0; round < 3; ++round) {
      const Contact q = ring(i, a + f * (b - a));
      const double from_a = line_a.entry(q.p, q.n, radius, hint_a),
                   from_b = line_b.entry(q.p, q.n, radius, hint_b);
      height = std::max(height, std::min(from_a, from_b));
      if (!(from_a < kNever) || !(from_b < kNever) || from_a + from_b <= 0) break;
      const double slope_a = std::sqrt(from_a) / f, slope_b = std::sqrt(from_b) / (1 - f);
      f = std::clamp(slope_b / (slope_a + slope_b), 0.05, 0.95);
    }
    worst = std::max(worst, height);
    if (!(worst < kNever)) break;
  }
  return worst;
}

double step_for(const std::function<double(double)>& cusp, double scallop, double guess, double longest) {
  constexpr double kGoodEnough = 0.985;  // of the scallop
  constexpr int kRounds = 24;
  double step = std::min(guess, longest), good = 0, bad = kNever;
  for (int round = 0; round < kRounds; ++round) {
    const double height = cusp(step);
    if (height <= scallop) {
      good = std::max(good, step);
      if (height >= kGoodEnough * scallop || step >= longest) break;
    } else {
      bad = std::min(bad, step);
    }
    double factor = height > 0 ? std::clamp(std::sqrt(0.994 * scallop / height), 0.25, 2.0) : 2.0;
    double next = std::min(step * factor, longest);
    // Between what held and what did not.
    if (good > 0 && bad < kNever && (next <= good || next >= bad)) next = 0.5 * (good + bad);
    if (good > 0 && bad < kNever && bad - good < 1e-3 * good) break;
    step = next;
  }
  return good;
}

}  // namespace burin::rotary::detail
