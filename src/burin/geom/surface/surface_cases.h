// SPDX-License-Identifier: Apache-2.0
// Surfaces for tests and benchmarks.
#pragma once

#include <cmath>
#include <random>

#include "burin/geom/surface/nurbs.h"

namespace burin::geom::cases {

/// The same numbers on every standard library (std distributions are not).
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double a, double b) { return a + (b - a) * (double(engine_() >> 11) * 0x1p-53); }
  int integer(int a, int b) { return a + static_cast<int>(engine_() % static_cast<unsigned>(b - a + 1)); }

 private:
  std::mt19937_64 engine_;
};

/// Clamped, not uniform, over [lo, hi]; `repeats`: inner knots may be repeated up to degree times.
inline std::vector<double> random_knots(Random& r, int count, int degree, bool repeats, double lo = 0,
                                        double hi = 1) {
  std::vector<double> k(static_cast<std::size_t>(degree) + 1, 0.0);
  double at = 0;
  for (int left = count - degree - 1; left > 0;) {
    at += r.between(0.1, 1);
    const int times = repeats ? std::min(left, r.integer(1, degree)) : 1;
    k.insert(k.end(), static_cast<std::size_t>(times), at);
    left -= times;
  }
  at += r.between(0.1, 1);
  k.insert(k.end(), static_cast<std::size_t>(degree) + 1, at);
  for (double& x : k) x = lo + (hi - lo) * (x / at);
  return k;
}

struct Shape {
  int count_u = 6, count_v = 6, degree_u = 3, degree_v = 3;
  double weight_lo = 0.5, weight_hi = 2;  ///< logarithmically uniform
  bool repeats = false;
  double size = 100, height = 10;
};

/// A wavy plate of about size x size.
inline NurbsSurface random_surface(unsigned seed, const Shape& shape) {
  Random r(seed);
  NurbsSurface s;
  s.degree_u = shape.degree_u, s.degree_v = shape.degree_v;
  s.count_u = shape.count_u, s.count_v = shape.count_v;
  s.knots_u = random_knots(r, s.count_u, s.degree_u, shape.repeats);
  s.knots_v = random_knots(r, s.count_v, s.degree_v, shape.repeats, -2, 5);
  for (int j = 0; j < s.count_v; ++j) {
    for (int i = 0; i < s.count_u; ++i) {
      const Point3 p{shape.size * (i + r.between(-0.3, 0.3)) / (s.count_u - 1),
                     shape.size * (j + r.between(-0.3, 0.3)) / (s.count_v - 1),
                     r.between(-shape.height, shape.height)};
      s.points.push_back(
          homogeneous(p, std::exp(r.between(std::log(shape.weight_lo), std::log(shape.weight_hi)))));
    }
  }
  return s;
}

/// Surface of revolution about z of a quadratic rational profile (x, z, weight), by the whole turn in v
/// (v in [0, 4], a quarter each). Su x Sv points to the left of the profile's direction, seen with x right, z
/// up
/// ... towards the axis for a profile that runs upwards outside of it.
struct ProfilePoint {
  double x = 0, z = 0, w = 1;
};
inline NurbsSurface revolved(const std::vector<ProfilePoint>& profile, std::vector<double> knots) {
  const double h = std::sqrt(0.5);
  const Vec2 circle[9] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
  NurbsSurface s;
  s.degree_u = s.degree_v = 2;
  s.count_u = static_cast<int>(profile.size());
  s.count_v = 9;
  s.knots_u = std::move(knots);
  s.knots_v = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
  for (int j = 0; j < 9; ++j) {
    for (const ProfilePoint& p : profile) {
      s.points.push_back(
          homogeneous({p.x * circle[j].x, p.x * circle[j].y, p.z}, p.w * (j % 2 == 1 ? h : 1)));
    }
  }
  return s;
}

/// Whole sphere about the origin, u from the south pole to the north pole; Su x Sv points inwards.
inline NurbsSurface sphere(double r) {
  const double h = std::sqrt(0.5);
  return revolved({{0, -r, 1}, {r, -r, h}, {r, 0, 1}, {r, r, h}, {0, r, 1}}, {0, 0, 0, 1, 1, 2, 2, 2});
}

inline NurbsSurface cylinder(double r, double height) {
  return revolved({{r, 0, 1}, {r, height / 2, 1}, {r, height, 1}}, {0, 0, 0, 1, 1, 1});
}

/// Cone with its apex at u = 0 in the origin, opening upwards.
inline NurbsSurface cone(double r, double height) {
  return revolved({{0, 0, 1}, {r / 2, height / 2, 1}, {r, height, 1}}, {0, 0, 0, 1, 1, 1});
}

/// u runs round the tube (radius r), starting on the outside, upwards; R is the radius of the centre line.
inline NurbsSurface torus(double big, double r) {
  const double h = std::sqrt(0.5);
  return revolved({{big + r, 0, 1},
                   {big + r, r, h},
                   {big, r, 1},
                   {big - r, r, h},
                   {big - r, 0, 1},
                   {big - r, -r, h},
                   {big, -r, 1},
                   {big + r, -r, h},
                   {big + r, 0, 1}},
                  {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4});
}

/// z = x y / a over [-1, 1]^2, u = x, v = y.
inline NurbsSurface saddle(double a) {
  NurbsSurface s;
  s.degree_u = s.degree_v = 1;
  s.count_u = s.count_v = 2;
  s.knots_u = s.knots_v = {-1, -1, 1, 1};
  for (const double y : {-1.0, 1.0}) {
    for (const double x : {-1.0, 1.0}) s.points.push_back(homogeneous({x, y, x * y / a}, 1));
  }
  return s;
}

}  // namespace burin::geom::cases
