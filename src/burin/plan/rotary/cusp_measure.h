// SPDX-License-Identifier: Apache-2.0
// For tests: the cusps of contact paths by brute force, sharing nothing with the planner.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "burin/plan/rotary/part.h"

namespace burin::rotary::cases {

using geom::Point3;
using geom::Vec3;

inline constexpr double kBall = 2;

inline Part part_of(const SweptSection& s) {
  auto part = make_swept(s, {});
  EXPECT_TRUE(part) << part.error().message;
  return std::move(*part);
}

inline PatternResult paths_of(const Part& part, Pattern pattern, double scallop = 0.05) {
  PatternOptions o;
  o.pattern = pattern;
  o.ball_radius = kBall;
  o.scallop = scallop;
  Diagnostics diagnostics;
  auto result = make_paths(part, o, diagnostics);
  EXPECT_TRUE(result) << result.error().message;
  return std::move(*result);
}

struct Tube {
  Point3 a, b;
};
inline std::vector<Tube> tubes_of(const PatternResult& result) {
  std::vector<Tube> tubes;
  for (const ContactPath& path : result.paths) {
    const std::size_t n = path.points.size();
    for (std::size_t i = 0; i + 1 < n + (path.closed ? 1 : 0); ++i) {
      const Contact &a = path.points[i], &b = path.points[(i + 1) % n];
      tubes.push_back({a.p + kBall * a.n, b.p + kBall * b.n});
    }
  }
  return tubes;
}

inline double distance_to(Point3 p, const Tube& t) {
  const Vec3 ab = t.b - t.a, ap = p - t.a;
  const double l2 = dot(ab, ab);
  const double f = l2 > 0 ? std::clamp(dot(ap, ab) / l2, 0.0, 1.0) : 0;
  return norm(ap - f * ab);
}

/// The largest distance of points of the surface from the union of the balls, by brute force over a window of
/// X.
inline double measured_cusp(const SweptSection& s, const PatternResult& result, double x0, double x1, int nu,
                            int nx) {
  std::vector<Tube> near;
  for (const Tube& t : tubes_of(result)) {
    if (std::max(t.a.x, t.b.x) > x0 - 3 * kBall && std::min(t.a.x, t.b.x) < x1 + 3 * kBall) near.push_back(t);
  }
  double worst = 0;
  const double length = length_of(s.section);
  for (const geom::Segment& seg : s.section.segments) {
    const int n = std::max(2, int(std::ceil(nu * length_of(seg) / length)));
    for (int i = 0; i <= n; ++i) {
      const geom::Point2 c = point_on(seg, double(i) / n);
      for (int k = 0; k <= nx; ++k) {
        const double x = x0 + (x1 - x0) * k / nx;
        const double a = s.turn_at(x);
        const Point3 p{x, c.x * std::cos(a) - c.y * std::sin(a), c.x * std::sin(a) + c.y * std::cos(a)};
        double least = std::numeric_limits<double>::infinity();
        for (const Tube& t : near) least = std::min(least, distance_to(p, t));
        worst = std::max(worst, least - kBall);
      }
    }
  }
  return worst;
}

}  // namespace burin::rotary::cases
