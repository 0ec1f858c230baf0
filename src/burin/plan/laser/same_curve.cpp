// SPDX-License-Identifier: Apache-2.0
// Whether two curves draw the same points, whatever their kind and parameters.
#include <algorithm>
#include <cmath>

#include "burin/plan/laser/join_parts.h"

namespace burin::laser::detail {
namespace {

constexpr int kSamples = 32;  // places of one curve that must lie on the other
constexpr int kCoarse = 128;  // places of the other that a nearest point is searched from
constexpr int kNewtonSteps = 12;

/// Distance from p to the curve: from the nearest of kCoarse places, Newton on (C - p) . C' = 0, kept between
/// its neighbours.
double distance_to(const geom::Curve2& curve, const std::vector<geom::Point2>& coarse, geom::Point2 p) {
  const auto nearest = std::min_element(coarse.begin(), coarse.end(), [&](geom::Point2 x, geom::Point2 y) {
    return geom::distance2(x, p) < geom::distance2(y, p);
  });
  const double at = static_cast<double>(nearest - coarse.begin()) / kCoarse;
  const double lo = std::max(0.0, at - 1.0 / kCoarse), hi = std::min(1.0, at + 1.0 / kCoarse);
  double best = geom::distance(*nearest, p);
  double t = at;
  for (int i = 0; i < kNewtonSteps; ++i) {
    const geom::Derivatives2 d = geom::derivatives_at(curve, t);
    const geom::Vec2 away = d.point - p;
    best = std::min(best, geom::norm(away));
    const double slope = geom::norm2(d.d1) + geom::dot(away, d.d2);
    if (!(slope > 0)) break;
    const double next = std::clamp(t - geom::dot(away, d.d1) / slope, lo, hi);
    if (next == t) break;
    t = next;
  }
  return best;
}

std::vector<geom::Point2> places(const geom::Curve2& curve, int count) {
  std::vector<geom::Point2> points;
  points.reserve(static_cast<std::size_t>(count) + 1);
  for (int i = 0; i <= count; ++i) points.push_back(geom::point_at(curve, static_cast<double>(i) / count));
  return points;
}

bool same_parameters(const geom::Curve2& a, const geom::Curve2& b, bool turned, double tolerance) {
  for (int i = 0; i <= kSamples; ++i) {
    const double t = static_cast<double>(i) / kSamples;
    if (geom::distance(geom::point_at(a, t), geom::point_at(b, turned ? 1 - t : t)) > tolerance) return false;
  }
  return true;
}

bool lies_on(const geom::Curve2& a, const geom::Curve2& b, double tolerance) {
  const std::vector<geom::Point2> coarse = places(b, kCoarse);
  for (int i = 0; i <= kSamples; ++i) {
    // The middle first: most different curves differ there.
    const double t = static_cast<double>((i + kSamples / 2) % (kSamples + 1)) / kSamples;
    if (distance_to(b, coarse, geom::point_at(a, t)) > tolerance) return false;
  }
  return true;
}

}  // namespace

bool same_curve(const geom::Curve2& a, const geom::Curve2& b, double tolerance) {
  return same_parameters(a, b, false, tolerance) || same_parameters(a, b, true, tolerance) ||
         (lies_on(a, b, tolerance) && lies_on(b, a, tolerance));
}

}  // namespace burin::laser::detail
