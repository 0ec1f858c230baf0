// SPDX-License-Identifier: Apache-2.0
// For tests: the cusps of contact paths by brute force, sharing nothing with the planner.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
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

/// Tubes by cells of space, so that a point looks only at those near it.
class TubeGrid {
 public:
  TubeGrid(const std::vector<Tube>& tubes, double x0, double x1) : tubes_(tubes) {
    for (std::size_t i = 0; i < tubes.size(); ++i) {
      if (std::max(tubes[i].a.x, tubes[i].b.x) < x0 || std::min(tubes[i].a.x, tubes[i].b.x) > x1) continue;
      geom::Box3 box;
      box.add(tubes[i].a);
      box.add(tubes[i].b);
      walk(box, [&](std::vector<std::size_t>& cell) { cell.push_back(i); });
    }
  }
  /// Distance to the nearest, at most `within`.
  double nearest(Point3 p, double within) {
    double least = within;
    walk(geom::Box3{p, p}.grown(within), [&](std::vector<std::size_t>& cell) {
      for (const std::size_t i : cell) least = std::min(least, distance_to(p, tubes_[i]));
    });
    return least;
  }

 private:
  template <class Visit>
  void walk(const geom::Box3& box, const Visit& visit) {
    for (int x = at(box.lo.x); x <= at(box.hi.x); ++x) {
      for (int y = at(box.lo.y); y <= at(box.hi.y); ++y) {
        for (int z = at(box.lo.z); z <= at(box.hi.z); ++z) visit(cells_[{x, y, z}]);
      }
    }
  }
  static int at(double v) { return int(std::floor(v / 1.5)); }

  const std::vector<Tube>& tubes_;
  std::map<std::array<int, 3>, std::vector<std::size_t>> cells_;
};

/// The largest distance of points of the surface from the union of the balls, over a window of X; 1 mm and
/// more is 1.
inline double measured_cusp(const SweptSection& s, const PatternResult& result, double x0, double x1, int nu,
                            int nx) {
  const std::vector<Tube> tubes = tubes_of(result);
  TubeGrid grid(tubes, x0 - 3 * kBall, x1 + 3 * kBall);
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
        const double reach = kBall + worst + 0.02;  // usually that near: else a wider look
        double least = grid.nearest(p, reach);
        if (least >= reach) least = grid.nearest(p, kBall + 1);
        worst = std::max(worst, least - kBall);
      }
    }
  }
  return worst;
}

}  // namespace burin::rotary::cases
