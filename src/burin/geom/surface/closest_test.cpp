// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/closest.h"

#include <gtest/gtest.h>

#include <limits>

#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/surface_cases.h"

namespace burin::geom {
namespace {

using cases::Random;
using cases::random_surface;

Point3 random_point(Random& r, double lo, double hi) {
  return {r.between(lo, hi), r.between(lo, hi), r.between(lo, hi)};
}

void expect_on_surface(const NurbsSurface& s, Point3 p, const SurfacePoint& c) {
  EXPECT_LT(distance(point(s, c.u, c.v), c.point), 1e-11);
  EXPECT_NEAR(distance(p, c.point), c.distance, 1e-11);
}

TEST(Closest, ClosedForms) {
  Random r(1);
  const ClosestPointFinder sphere(cases::sphere(10)), cylinder(cases::cylinder(10, 50)),
      torus(cases::torus(20, 5));
  for (int i = 0; i < 40; ++i) {
    const Point3 p = random_point(r, -30, 30);
    const double out = norm(p - Point3{});
    const SurfacePoint s = sphere.find(p);
    EXPECT_NEAR(s.distance, std::abs(out - 10), 1e-9 + 1e-12);
    expect_on_surface(cases::sphere(10), p, s);
    const double radial = std::hypot(p.x, p.y);
    const double beyond = std::max({0.0, -p.z, p.z - 50});
    EXPECT_NEAR(cylinder.find(p).distance, std::hypot(beyond, radial - 10), 1e-9 + 1e-12);
    EXPECT_NEAR(torus.find(p).distance, std::abs(std::hypot(radial - 20, p.z) - 5), 1e-9 + 1e-12);
  }
}

TEST(Closest, EquallyFarEverywhere) {
  EXPECT_NEAR(ClosestPointFinder(cases::sphere(10)).find({0, 0, 0}).distance, 10, 1e-9);
  EXPECT_NEAR(ClosestPointFinder(cases::cylinder(10, 50)).find({0, 0, 20}).distance, 10, 1e-9);
  EXPECT_NEAR(ClosestPointFinder(cases::torus(20, 5)).find({0, 0, 0}).distance, 15, 1e-9);
  EXPECT_NEAR(ClosestPointFinder(cases::sphere(10)).find({1e-7, 0, -2e-9}).distance, 10 - 1e-7, 2e-9);
}

TEST(Closest, NotFartherThanDenseSampling) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const NurbsSurface s = random_surface(
        seed,
        {.count_u = 7, .count_v = 5, .degree_u = 1 + int(seed) % 3, .repeats = seed % 2 == 0, .height = 40});
    const ClosestPointFinder finder(s);
    SurfaceEvaluator e(s);
    constexpr int kSteps = 150;
    std::vector<Point3> samples;
    for (int j = 0; j <= kSteps; ++j) {
      for (int i = 0; i <= kSteps; ++i) {
        samples.push_back(e.point(double(i) / kSteps, -2 + 7.0 * j / kSteps));
      }
    }
    Random r(seed + 50);
    for (int k = 0; k < 15; ++k) {
      const Point3 p = random_point(r, -50, 150);
      double least = std::numeric_limits<double>::infinity();
      for (const Point3 q : samples) least = std::min(least, distance(p, q));
      const SurfacePoint c = finder.find(p);
      expect_on_surface(s, p, c);
      EXPECT_LE(c.distance, least + 1e-9);
      EXPECT_GE(c.distance, least - 4);  // samples are about 1 mm apart, some legs are longer
    }
  }
}

TEST(Closest, PointsOfTheSurface) {
  const NurbsSurface s = random_surface(3, {.count_u = 12, .count_v = 9, .height = 30});
  const ClosestPointFinder finder(s);
  Random r(8);
  for (int i = 0; i < 40; ++i) {
    EXPECT_LT(finder.find(point(s, r.between(0, 1), r.between(-2, 5))).distance, 1e-9);
  }
  for (const double u : {0.0, 1.0}) {
    for (const double v : {-2.0, 5.0}) EXPECT_LT(finder.find(point(s, u, v)).distance, 1e-9);
  }
}

TEST(Closest, LooserToleranceIsWithinIt) {
  const NurbsSurface s = random_surface(4, {.count_u = 8, .count_v = 8, .height = 60});
  const ClosestPointFinder finder(s);
  Random r(2);
  for (int i = 0; i < 30; ++i) {
    const Point3 p = random_point(r, -20, 120);
    const double exact = finder.find(p).distance, loose = finder.find(p, 0.5).distance;
    EXPECT_GE(loose, exact - 1e-9);
    EXPECT_LE(loose, exact + 0.5);
  }
}

TEST(Closest, RefineNeverLeavesTheDomainNorLoses) {
  for (const bool repeats : {false, true}) {
    const NurbsSurface s = random_surface(
        5, {.count_u = 12, .count_v = 11, .weight_lo = 0.05, .weight_hi = 20, .repeats = repeats});
    const ClosestPointFinder finder(s);
    Random r(6);
    for (int i = 0; i < 200; ++i) {
      const Point3 p = random_point(r, -20, 120);
      const double u = r.between(-0.2, 1.2), v = r.between(-3, 6);
      const SurfacePoint c = finder.refine(p, u, v);
      expect_on_surface(s, p, c);
      EXPECT_TRUE(c.u >= 0 && c.u <= 1 && c.v >= -2 && c.v <= 5);
      EXPECT_LE(c.distance, distance(p, point(s, u, v)) + 1e-12);
    }
  }
}

TEST(Closest, RefineGoesDownIntoACrease) {
  // A roof: degree 1 in u with the ridge at u = 1; seen from below the valley side, the ridge is the nearest.
  NurbsSurface s;
  s.degree_u = s.degree_v = 1;
  s.count_u = 3, s.count_v = 2;
  s.knots_u = {0, 0, 1, 2, 2};
  s.knots_v = {0, 0, 1, 1};
  for (const double y : {0.0, 10.0}) {
    for (const double x : {-10.0, 0.0, 10.0}) s.points.push_back(homogeneous({x, y, 5 - std::abs(x) / 2}, 1));
  }
  const ClosestPointFinder finder(s);
  const SurfacePoint c = finder.refine({0.1, 4, 9}, 0.2, 0.9);
  EXPECT_NEAR(c.u, 1, 1e-9);
  EXPECT_NEAR(c.v, 0.4, 1e-9);
  EXPECT_NEAR(c.distance, std::hypot(0.1, 4), 1e-12);
}

TEST(Closest, BadPointsGiveNoCrash) {
  const ClosestPointFinder finder(cases::sphere(10));
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const Point3 p : {Point3{nan, 0, 0}, Point3{inf, 0, 0}, Point3{0, -inf, nan}}) {
    EXPECT_FALSE(std::isfinite(finder.find(p).distance));
    EXPECT_FALSE(std::isfinite(finder.refine(p, 1, 1).distance));
  }
  EXPECT_FALSE(std::isfinite(finder.refine({0, 0, 0}, nan, 1).distance));
  EXPECT_NEAR(finder.find({1e6, 0, 0}).distance, 1e6 - 10, 1e-6);
}

}  // namespace
}  // namespace burin::geom
