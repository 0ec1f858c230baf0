// SPDX-License-Identifier: Apache-2.0
// Surfaces with known shape, and measurements of tool paths by brute force that share nothing with the
// planner but the evaluation of surfaces. For tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <vector>

#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/join.h"
#include "burin/plan/cycle/cycle.h"

namespace burin::cycle::cases {

using geom::HPoint;
using geom::NurbsSurface;
using geom::Point3;
using geom::Vec3;

/// Points with weight 1, clamped uniform knots.
inline NurbsSurface net(int degree_u, int degree_v, int count_u, int count_v,
                        const std::function<Point3(double, double)>& at) {
  NurbsSurface s;
  s.degree_u = degree_u;
  s.degree_v = degree_v;
  s.count_u = count_u;
  s.count_v = count_v;
  s.knots_u = geom::clamped_uniform_knots(count_u, degree_u);
  s.knots_v = geom::clamped_uniform_knots(count_v, degree_v);
  for (int j = 0; j < count_v; ++j)
    for (int i = 0; i < count_u; ++i)
      s.points.push_back(geom::homogeneous(
          at(static_cast<double>(i) / (count_u - 1), static_cast<double>(j) / (count_v - 1)), 1));
  return s;
}

/// Parallelogram from `at` over a (u) and b (v).
inline NurbsSurface plane(Point3 at, Vec3 a, Vec3 b) {
  return net(1, 1, 2, 2, [&](double u, double v) { return at + u * a + v * b; });
}

/// Arc of less than 180 degrees about the axis through `centre` along y, from angle a0 to a1 (from +x towards
/// +z), times `length` in y. u along the arc.
inline NurbsSurface cylinder(Point3 centre, double radius, double a0, double a1, double length) {
  const double half = 0.5 * (a1 - a0), mid = 0.5 * (a0 + a1), w = std::cos(half);
  NurbsSurface s;
  s.degree_u = 2;
  s.degree_v = 1;
  s.count_u = 3;
  s.count_v = 2;
  s.knots_u = {0, 0, 0, 1, 1, 1};
  s.knots_v = {0, 0, 1, 1};
  for (const double y : {0.0, length}) {
    const auto p = [&](double a, double r) {
      return Point3{centre.x + r * std::cos(a), centre.y + y, centre.z + r * std::sin(a)};
    };
    s.points.push_back(geom::homogeneous(p(a0, radius), 1));
    s.points.push_back(geom::homogeneous(p(mid, radius / w), w));
    s.points.push_back(geom::homogeneous(p(a1, radius), 1));
  }
  return s;
}

/// Surface of revolution about +Z: a meridian arc from angle a0 to a1 (from the horizontal upwards; at 90
/// degrees a pole), a quarter turn. u around, v along the meridian.
inline NurbsSurface ball_part(Point3 centre, double radius, double a0, double a1) {
  const double half = 0.5 * (a1 - a0), mid = 0.5 * (a0 + a1), w = std::cos(half), q = std::sqrt(0.5);
  NurbsSurface s;
  s.degree_u = s.degree_v = 2;
  s.count_u = s.count_v = 3;
  s.knots_u = s.knots_v = {0, 0, 0, 1, 1, 1};
  const double angle[3] = {a0, mid, a1}, scale[3] = {1, 1 / w, 1}, weight[3] = {1, w, 1};
  const double cx[3] = {1, 1, 0}, cy[3] = {0, 1, 1}, wu[3] = {1, q, 1};
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      double r = radius * scale[j] * std::cos(angle[j]);
      if (std::abs(r) < 1e-12 * radius) r = 0;
      s.points.push_back(geom::homogeneous(
          {centre.x + r * cx[i], centre.y + r * cy[i], centre.z + radius * scale[j] * std::sin(angle[j])},
          weight[j] * wu[i]));
    }
  return s;
}

/// A smooth hilly bicubic surface over w x h mm.
inline NurbsSurface hills(double w, double h, double height, int count) {
  return net(3, 3, count, count, [&](double u, double v) {
    return Point3{w * u, h * v, height * std::sin(2.2 * u + 0.3) * std::cos(3.1 * v) + 0.1 * w * u * v};
  });
}

inline geom::Composite composite(const std::vector<NurbsSurface>& surfaces) {
  geom::Composite c;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    geom::JoinedSurface s;
    s.surface = surfaces[i];
    geom::Member m;
    m.patch = i;
    m.u = surfaces[i].domain(geom::Direction::u);
    m.v = surfaces[i].domain(geom::Direction::v);
    m.pu = {0, 1, 0};
    m.pv = {0, 0, 1};
    s.members.push_back(m);
    c.surfaces.push_back(s);
  }
  return c;
}

/// Ball centres of the motions that cut, about `spacing` apart.
inline std::vector<Point3> centres(const SurfacePlan& plan, double radius, double spacing,
                                   const std::function<bool(const Motion&)>& wanted) {
  std::vector<Point3> out;
  for (const Motion& m : plan.motions) {
    if (!wanted(m)) continue;
    for (std::size_t i = 0; i + 1 < m.path.nodes.size(); ++i) {
      const int n = 1 + static_cast<int>(geom::piece_length(m.path, i) / spacing);
      for (int k = 0; k <= n; ++k) {
        const Point3 p = geom::evaluate_piece(m.path, i, static_cast<double>(k) / n).p;
        out.push_back({p.x, p.y, p.z + radius});
      }
    }
  }
  return out;
}

/// The paths, with what they run over the edges of the surface.
inline bool cuts(const Motion& m) {
  return m.pass >= 0;
}

/// How much stands above q along n after balls at all centres have cut.
class Remains {
 public:
  Remains(std::vector<Point3> balls, double radius) : balls_(std::move(balls)), radius_(radius) {
    for (std::size_t i = 0; i < balls_.size(); ++i) grid_[key(balls_[i])].push_back(i);
  }
  double height(Point3 q, Vec3 n) const {
    const Point3 c = q + radius_ * n;
    double best = std::numeric_limits<double>::infinity();
    const auto [kx, ky, kz] = key(c);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto it = grid_.find({kx + x, ky + y, kz + z});
          if (it == grid_.end()) continue;
          for (const std::size_t i : it->second) {
            const Vec3 e = balls_[i] - q;
            const double b = dot(e, n), off2 = dot(e, e) - b * b;
            if (off2 < radius_ * radius_) best = std::min(best, b - std::sqrt(radius_ * radius_ - off2));
          }
        }
    return best;
  }

 private:
  using Key = std::array<long, 3>;
  Key key(Point3 p) const {
    constexpr double kCell = 0.7;
    return {std::lround(p.x / kCell), std::lround(p.y / kCell), std::lround(p.z / kCell)};
  }
  std::vector<Point3> balls_;
  double radius_;
  std::map<Key, std::vector<std::size_t>> grid_;
};

/// Deepest cut into a surface by the balls: R - distance, over samples of the surface.
inline double deepest(const NurbsSurface& s, const std::vector<Point3>& balls, double reach, int samples) {
  std::vector<Point3> points;
  const auto u = s.domain(geom::Direction::u), v = s.domain(geom::Direction::v);
  for (int j = 0; j <= samples; ++j)
    for (int i = 0; i <= samples; ++i)
      points.push_back(geom::point(s, u.lo + u.length() * i / samples, v.lo + v.length() * j / samples));
  double most = 0;
  for (const Point3 c : balls)
    for (const Point3 q : points) {
      const double across = std::hypot(q.x - c.x, q.y - c.y);
      most = std::max(most, reach - (q.z > c.z ? across : distance(q, c)));
    }
  return most;
}

}  // namespace burin::cycle::cases
