// SPDX-License-Identifier: Apache-2.0
// Normals and curvatures against closed forms; poles and collapsed edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/surface_cases.h"

namespace burin::geom {
namespace {

using cases::Random;
using cases::random_surface;

Vec3 from_origin(Point3 p) {
  return p - Point3{};
}

TEST(Normal, SphereWithBothPoles) {
  const NurbsSurface s = cases::sphere(25);
  for (int i = 0; i <= 16; ++i) {
    for (int j = 0; j <= 32; ++j) {
      const double u = i / 8.0, v = j / 8.0;
      const Vec3 inwards = -unit(from_origin(point(s, u, v)));
      EXPECT_LT(norm(normal(s, u, v) - inwards), 1e-12) << u << " " << v;
    }
  }
}

TEST(Normal, NearThePole) {
  // The derivative across has 1e-16 / distance of relative rounding.
  const NurbsSurface s = cases::sphere(25);
  for (double step = 1e-2; step > 1e-17; step /= 10) {
    for (const double v : {0.0, 0.3, 1.7, 4.0}) {
      for (const double u : {step, 2 - step}) {
        const Vec3 inwards = -unit(from_origin(point(s, u, v)));
        EXPECT_LT(norm(normal(s, u, v) - inwards), std::min(1e-2, 1e-12 + 1e-14 / step)) << u << " " << v;
      }
    }
  }
}

TEST(Normal, ApexOfACone) {
  const NurbsSurface s = cases::cone(10, 10);
  for (const double v : {0.0, 0.5, 1.0, 2.3, 4.0}) {
    const Point3 rim = point(s, 1, v);
    const Vec3 expected = unit(Vec3{-rim.x, -rim.y, 10});
    EXPECT_LT(norm(normal(s, 0, v) - expected), 1e-12);
    EXPECT_LT(norm(normal(s, 0.6, v) - expected), 1e-12);
  }
}

/// One edge of a random surface becomes a point.
NurbsSurface collapsed(unsigned seed, Direction d, bool far, Point3 to) {
  NurbsSurface s = random_surface(seed, {.count_u = 5, .count_v = 6, .height = 25});
  const Direction along = other(d);
  for (int k = 0; k < s.count(along); ++k) {
    const int edge = far ? s.count(d) - 1 : 0;
    HPoint& h = d == Direction::u ? s.at(edge, k) : s.at(k, edge);
    h = homogeneous(to, h.w);
  }
  return s;
}

TEST(Normal, CollapsedEdgesAreTheLimitFromInside) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    for (const Direction d : {Direction::u, Direction::v}) {
      for (const bool far : {false, true}) {
        const NurbsSurface s = collapsed(seed, d, far, {50, 37, 4});
        const Interval a = s.domain(d), b = s.domain(other(d));
        const double edge = far ? a.hi : a.lo;
        for (int k = 0; k <= 8; ++k) {
          const double t = b.lo + k / 8.0 * b.length();
          const auto at = [&](double e) { return d == Direction::u ? normal(s, e, t) : normal(s, t, e); };
          const Vec3 n = at(edge);
          EXPECT_NEAR(norm(n), 1, 1e-12);
          const double step = (far ? -1 : 1) * a.length();
          const Vec3 near = at(edge + 1e-6 * step), less_near = at(edge + 2e-6 * step);
          EXPECT_LT(norm(n - near), 1e-6 + 3 * norm(near - less_near));
        }
      }
    }
  }
}

TEST(Normal, CornerWithParallelEdges) {
  // A half disc as one patch: at two corners the edges go on straight.
  const double h = std::sqrt(0.5);
  NurbsSurface s;
  s.degree_u = s.degree_v = 2;
  s.count_u = s.count_v = 3;
  s.knots_u = s.knots_v = {0, 0, 0, 1, 1, 1};
  const Point3 p[9] = {{-h, -h, 0},   {0, -2 * h, 0}, {h, -h, 0},    {-2 * h, 0, 0}, {0, 0, 0},
                       {2 * h, 0, 0}, {-h, h, 0},     {0, 2 * h, 0}, {h, h, 0}};
  const double w[9] = {1, h, 1, h, 1, h, 1, h, 1};
  for (int i = 0; i < 9; ++i) s.points.push_back(homogeneous(p[i], w[i]));
  for (const double u : {0.0, 0.4, 1.0}) {
    for (const double v : {0.0, 0.7, 1.0}) EXPECT_LT(norm(normal(s, u, v) - Vec3{0, 0, 1}), 1e-12) << u << v;
  }
}

TEST(Normal, NoAreaNoNormalButNoNan) {
  NurbsSurface s = random_surface(1, {});
  for (HPoint& h : s.points) h = homogeneous({3, 4, 5}, h.w);
  EXPECT_EQ(normal(s, 0.3, 1), Vec3{});
  for (int j = 0; j < s.count_v; ++j) {
    for (int i = 0; i < s.count_u; ++i) s.at(i, j) = homogeneous({double(i + 2 * j), 0, 0}, 1);
  }
  EXPECT_EQ(normal(s, 0.3, 1), Vec3{});
  EXPECT_EQ(normal(SurfaceDerivatives{}), Vec3{});
  const Curvature c = curvature(SurfaceDerivatives{});
  EXPECT_EQ(c.k_min, 0);
  EXPECT_EQ(c.k_max, 0);
  EXPECT_EQ(normal_curvature(SurfaceDerivatives{}, 1, 1), 0);
  EXPECT_TRUE(std::isnan(normal(s, std::numeric_limits<double>::quiet_NaN(), 0).x));
}

TEST(Normal, NeverNanOnDegenerateNets) {
  // Random coincidences of control points, extreme weights, repeated knots.
  Random r(77);
  for (unsigned seed = 0; seed < 60; ++seed) {
    NurbsSurface s = random_surface(seed, {.count_u = 4,
                                           .count_v = 5,
                                           .degree_u = 1 + static_cast<int>(seed) % 3,
                                           .degree_v = 1 + static_cast<int>(seed / 3) % 4,
                                           .weight_lo = 1e-3,
                                           .weight_hi = 1e3,
                                           .repeats = seed % 2 == 0});
    for (HPoint& h : s.points) {
      const HPoint& other_one = s.points[static_cast<std::size_t>(r.integer(0, 19))];
      if (r.between(0, 1) < 0.6) h = homogeneous(project(other_one), h.w);
    }
    for (const double u : {0.0, 1e-9, 0.5, 1.0}) {
      for (const double v : {-2.0, 0.3, 5.0 - 1e-12, 5.0}) {
        const Vec3 n = normal(s, u, v);
        EXPECT_TRUE(n == Vec3{} || std::abs(norm(n) - 1) < 1e-12);
        const Curvature c = curvature(derivatives(s, u, v));
        EXPECT_TRUE(std::isfinite(c.k_min) && std::isfinite(c.k_max));
        EXPECT_TRUE(std::isfinite(norm(c.direction_min)) && std::isfinite(norm(c.direction_max)));
      }
    }
  }
}

TEST(Curvature, Sphere) {
  const NurbsSurface s = cases::sphere(25);
  for (double u = 0.05; u < 1.9; u += 0.15) {
    const Curvature c = curvature(derivatives(s, u, 1.3));
    EXPECT_NEAR(c.k_min, 1 / 25.0, 1e-11);
    EXPECT_NEAR(c.k_max, 1 / 25.0, 1e-11);
  }
}

TEST(Curvature, Cylinder) {
  // Su x Sv points inwards: the surface bends towards it.
  for (double v = 0; v <= 4; v += 0.3) {
    const SurfaceDerivatives d = derivatives(cases::cylinder(8, 30), 0.4, v);
    const Curvature c = curvature(d);
    EXPECT_NEAR(c.k_min, 0, 1e-13);
    EXPECT_NEAR(c.k_max, 1 / 8.0, 1e-13);
    EXPECT_NEAR(std::abs(c.direction_min.z), 1, 1e-12);
    EXPECT_NEAR(c.direction_max.z, 0, 1e-12);
    EXPECT_NEAR(normal_curvature(d, 1, 0), 0, 1e-13);
    EXPECT_NEAR(normal_curvature(d, 0, -3), 1 / 8.0, 1e-13);
  }
}

TEST(Curvature, TorusAgainstClosedForm) {
  const double big = 40, r = 10;
  const NurbsSurface s = cases::torus(big, r);
  for (double u = 0.05; u < 4; u += 0.2) {
    for (const double v : {0.2, 2.9}) {
      const SurfaceDerivatives d = derivatives(s, u, v);
      const double x = std::hypot(d.p.x, d.p.y);
      const double across = (x - big) / (r * x);  // negative on the inside
      const Curvature c = curvature(d);
      EXPECT_NEAR(c.k_max, std::max(1 / r, across), 1e-12);
      EXPECT_NEAR(c.k_min, std::min(1 / r, across), 1e-12);
      EXPECT_NEAR(c.gaussian(), across / r, 1e-12);
      EXPECT_NEAR(c.mean(), 0.5 * (across + 1 / r), 1e-12);
      EXPECT_NEAR(dot(c.direction_min, c.direction_max), 0, 1e-12);
      EXPECT_LT(norm(normal(s, u, v) - normal(d)), 1e-13);
    }
  }
}

TEST(Curvature, Saddle) {
  // z = x y / a: in the origin +-1/a along the diagonals.
  const SurfaceDerivatives d = derivatives(cases::saddle(0.5), 0, 0);
  const Curvature c = curvature(d);
  EXPECT_NEAR(c.k_max, 2, 1e-13);
  EXPECT_NEAR(c.k_min, -2, 1e-13);
  EXPECT_NEAR(std::abs(dot(c.direction_max, Vec3{std::sqrt(0.5), std::sqrt(0.5), 0})), 1, 1e-13);
  EXPECT_NEAR(normal_curvature(d, 1, 1), 2, 1e-13);
  EXPECT_NEAR(normal_curvature(d, 1, -1), -2, 1e-13);
  EXPECT_NEAR(normal_curvature(d, 0, 1), 0, 1e-13);
}

TEST(Curvature, EulersFormulaAndDirectionsOnRandomSurfaces) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const NurbsSurface s = random_surface(seed, {.height = 40});
    Random r(seed);
    for (int k = 0; k < 20; ++k) {
      const SurfaceDerivatives d = derivatives(s, r.between(0, 1), r.between(-2, 5));
      const Curvature c = curvature(d);
      const double a = r.between(-1, 1), b = r.between(-1, 1);
      const Vec3 t = unit(a * d.du + b * d.dv);
      const double cosine = dot(t, c.direction_max), sine = dot(t, c.direction_min);
      const double scale = std::abs(c.k_max) + std::abs(c.k_min);
      EXPECT_NEAR(cosine * cosine + sine * sine, 1, 1e-11);
      EXPECT_NEAR(normal_curvature(d, a, b), c.k_max * cosine * cosine + c.k_min * sine * sine,
                  1e-10 * scale);
    }
  }
}

}  // namespace
}  // namespace burin::geom
