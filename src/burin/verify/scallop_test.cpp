// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/scallop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "burin/geom/surface/evaluate.h"
#include "burin/verify/sweep.h"

namespace burin::verify {
namespace {

using geom::NurbsSurface;
using geom::Point3;
using geom::Vec3;

NurbsSurface plane(double size, double slope) {
  NurbsSurface s;
  s.degree_u = s.degree_v = 1;
  s.count_u = s.count_v = 2;
  s.knots_u = s.knots_v = {0, 0, 1, 1};
  for (const double y : {0.0, size})
    for (const double x : {0.0, size}) s.points.push_back({x, y, slope * x, 1});
  return s;
}

/// Half cylinder about Y over z >= 0, exactly; u from +X over the top to -X, normal outwards when v runs
/// along +Y... the test asks the surface itself.
NurbsSurface half_cylinder(double radius, double length) {
  NurbsSurface s;
  s.degree_u = 2;
  s.degree_v = 1;
  s.count_u = 5;
  s.count_v = 2;
  s.knots_u = {0, 0, 0, 1, 1, 2, 2, 2};
  s.knots_v = {0, 0, 1, 1};
  const double w = std::sqrt(0.5);
  const double c[5][3] = {{1, 0, 1}, {1, 1, w}, {0, 1, 1}, {-1, 1, w}, {-1, 0, 1}};
  for (const double y : {0.0, length})
    for (const auto& p : c) s.points.push_back(geom::homogeneous({radius * p[0], y, radius * p[1]}, p[2]));
  return s;
}

std::vector<TipPass> parallel_on_plane(double radius, double slope, double step, int count, double size) {
  // Along y; the contact at x gives the centre x + R n.
  const Vec3 n = unit(Vec3{-slope, 0, 1});
  std::vector<TipPass> passes;
  for (int i = 0; i < count; ++i) {
    const double x = i * step / std::hypot(1, slope);
    const Point3 tip = Point3{x, 0, slope * x} + radius * n - radius * Vec3{0, 0, 1};
    passes.push_back({{{tip, tip + Vec3{0, size, 0}}}});
  }
  return passes;
}

TEST(Sweep, EntersLikeBruteForce) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-10, 10);
  std::vector<Sweep::Segment> segments;
  for (int i = 0; i < 300; ++i) {
    const Point3 a{number(random), number(random), number(random)};
    segments.push_back({a, i % 7 ? a + Vec3{0.3 * number(random), 0.3 * number(random), 0.1} : a});
  }
  const double radius = 0.7;
  const Sweep sweep(segments, radius);
  const auto inside = [&](Point3 p) {
    for (const Sweep::Segment& s : segments) {
      const Vec3 d = s.b - s.a;
      const double l2 = dot(d, d);
      if (distance(p, s.a + (l2 > 0 ? std::clamp(dot(p - s.a, d) / l2, 0.0, 1.0) : 0.0) * d) <= radius)
        return true;
    }
    return false;
  };
  int hits = 0;
  for (int i = 0; i < 40; ++i) {
    const Point3 q{number(random), number(random), number(random)};
    const Vec3 n = unit(Vec3{number(random), number(random), number(random)});
    const auto h = sweep.entry(q, n, -2, 5);
    double first = 1e9;
    for (double x = -2; x <= 5; x += 5e-3)
      if (inside(q + x * n)) {
        first = x;
        break;
      }
    if (!h) {
      EXPECT_EQ(first, 1e9);
      continue;
    }
    ++hits;
    if (first == 1e9) continue;  // grazed between two samples
    EXPECT_NEAR(*h, first, 5.001e-3);
  }
  EXPECT_GT(hits, 8);
}

void expect_ridges(const ScallopReport& report, double height, double within) {
  for (const auto& ridge : report.ridges) {
    EXPECT_NEAR(ridge.min_mm, height, within);
    EXPECT_NEAR(ridge.max_mm, height, within);
  }
}

TEST(Scallop, PlaneHasTheClosedForm) {
  for (const double slope : {0.0, 0.5}) {
    for (const double step : {0.2, 1.0, 3.0}) {
      const double radius = 4, expected = radius - std::sqrt(radius * radius - step * step / 4);
      const ScallopReport report = measure_scallop(
          plane(20, slope), parallel_on_plane(radius, slope, step, 5, 20), {.radius_mm = radius});
      ASSERT_EQ(report.ridges.size(), 4u);
      expect_ridges(report, expected, 1e-7);
      EXPECT_LT(report.gouge_max_mm, 1e-9);
    }
  }
}

TEST(Scallop, CylinderHasTheClosedForm) {
  // Paths along the axis at equal angles: centres on the circle rho + R, the cusp where two balls meet.
  const double rho = 15, radius = 5, angle = 0.1;
  std::vector<TipPass> passes;
  for (int i = 0; i < 6; ++i) {
    const double a = 1.2 + i * angle;
    const Point3 center{(rho + radius) * std::cos(a), 0, (rho + radius) * std::sin(a)};
    const Point3 tip = center - radius * Vec3{0, 0, 1};
    passes.push_back({{{tip, tip + Vec3{0, 30, 0}}}});
  }
  const NurbsSurface s = half_cylinder(rho, 30);
  const bool reversed = geom::normal(s, 1.0, 0.5).z < 0;
  const ScallopReport report = measure_scallop(s, passes, {.radius_mm = radius, .normal_reversed = reversed});
  const double half = (rho + radius) * std::sin(angle / 2);
  const double expected =
      (rho + radius) * std::cos(angle / 2) - std::sqrt(radius * radius - half * half) - rho;
  expect_ridges(report, expected, 1e-7);
}

/// Where two balls of radius `ball` meet whose centres lie at half the angle on either side of a circle of
/// radius `rho`, inside or outside of it: height over the circle.
double cusp(double rho, double ball, double angle, bool inside) {
  const double r = inside ? rho - ball : rho + ball, half = r * std::sin(angle / 2);
  const double root = std::sqrt(ball * ball - half * half);
  return inside ? rho - r * std::cos(angle / 2) - root : r * std::cos(angle / 2) - root - rho;
}

TEST(Scallop, InsideOfACylinder) {
  const double rho = 15, radius = 5, angle = 0.1;
  std::vector<TipPass> passes;
  for (int i = 0; i < 6; ++i) {
    const double a = 1.2 + i * angle;
    const Point3 tip =
        Point3{(rho - radius) * std::cos(a), 0, -(rho - radius) * std::sin(a)} + Vec3{0, 0, -radius};
    passes.push_back({{{tip, tip + Vec3{0, 30, 0}}}});
  }
  NurbsSurface s = half_cylinder(rho, 30);
  for (geom::HPoint& h : s.points) h.z = -h.z;
  const bool reversed = geom::normal(s, 1.0, 0.5).z < 0;
  const ScallopReport report = measure_scallop(s, passes, {.radius_mm = radius, .normal_reversed = reversed});
  ASSERT_EQ(report.ridges.size(), 5u);
  expect_ridges(report, cusp(rho, radius, angle, true), 1e-7);
  EXPECT_LT(report.gouge_max_mm, 1e-9);
}

TEST(Scallop, AroundACylinderItIsThatOfAPlane) {
  const double rho = 15, radius = 5, step = 1.5;
  std::vector<TipPass> passes;
  for (int i = 0; i < 5; ++i) {
    std::vector<Point3> tips;
    for (int k = 0; k <= 2000; ++k) {  // chords 6e-6 mm from the arc
      const double a = geom::kPi * k / 2000;
      tips.push_back({(rho + radius) * std::cos(a), 5 + i * step, (rho + radius) * std::sin(a) - radius});
    }
    passes.push_back({{tips}});
  }
  const NurbsSurface s = half_cylinder(rho, 30);
  const bool reversed = geom::normal(s, 1.0, 0.5).z < 0;
  const ScallopReport report = measure_scallop(s, passes, {.radius_mm = radius, .normal_reversed = reversed});
  const double expected = radius - std::sqrt(radius * radius - step * step / 4);
  ASSERT_EQ(report.ridges.size(), 4u);
  EXPECT_NEAR(report.scallop_min_mm, expected, 2e-5);
  EXPECT_NEAR(report.scallop_max_mm, expected, 2e-5);
  EXPECT_LT(report.gouge_max_mm, 1e-5);
}

/// An eighth of a sphere with its pole at the top, where one edge has no length.
NurbsSurface octant(double radius) {
  NurbsSurface s;
  s.degree_u = s.degree_v = 2;
  s.count_u = s.count_v = 3;
  s.knots_u = s.knots_v = {0, 0, 0, 1, 1, 1};
  const double w = std::sqrt(0.5);
  const double c[3][3] = {{1, 0, 1}, {1, 1, w}, {0, 1, 1}};  // a quarter circle
  for (const auto& up : c)
    for (const auto& around : c)
      s.points.push_back(geom::homogeneous(
          {radius * up[0] * around[0], radius * up[0] * around[1], radius * up[1]}, up[2] * around[2]));
  return s;
}

TEST(Scallop, CirclesOfLatitudeOnASphere) {
  const double rho = 20, radius = 4, angle = 0.07;
  std::vector<TipPass> passes;
  for (int i = 0; i < 8; ++i) {
    const double up = 0.6 + i * angle, r = (rho + radius) * std::cos(up);
    std::vector<Point3> tips;
    for (int k = 0; k <= 2000; ++k) {
      const double a = geom::kPi / 2 * k / 2000;
      tips.push_back({r * std::cos(a), r * std::sin(a), (rho + radius) * std::sin(up) - radius});
    }
    passes.push_back({{tips}});
  }
  const NurbsSurface s = octant(rho);
  const bool reversed = geom::normal(s, 0.5, 0.5).z < 0;
  const ScallopReport report = measure_scallop(s, passes, {.radius_mm = radius, .normal_reversed = reversed});
  ASSERT_EQ(report.ridges.size(), 7u);
  expect_ridges(report, cusp(rho, radius, angle, false), 1e-5);
  EXPECT_LT(report.gouge_max_mm, 1e-5);
}

// A wall thinner than the ball: the tool on its other side does not cut this one.
TEST(Scallop, TheOtherSideOfAThinWallIsNoGouge) {
  const double rho = 0.5, radius = 3;
  std::vector<TipPass> passes;
  for (int i = 0; i <= 40; ++i) {
    const double a = geom::kPi * i / 40;
    const Point3 tip{(rho + radius) * std::cos(a), 0, (rho + radius) * std::sin(a) - radius};
    passes.push_back({{{tip, tip + Vec3{0, 5, 0}}}});
  }
  const NurbsSurface s = half_cylinder(rho, 5);
  const bool reversed = geom::normal(s, 1.0, 0.5).z < 0;
  EXPECT_LT(measure_scallop(s, passes, {.radius_mm = radius, .normal_reversed = reversed}).gouge_max_mm,
            1e-9);
}

// A cut between the passes, where no contact lies: a short dip of the first pass alone would be one, this is
// a link driven through the surface.
TEST(Scallop, SeesACutAnywhereOnTheSurface) {
  const double radius = 4;
  std::vector<TipPass> passes = parallel_on_plane(radius, 0, 1, 3, 20);  // x from 0 to 2
  passes.push_back({{{{15.3, 7.1, 0.5}, {15.3, 7.1, -0.08}, {15.3, 7.1, 0.5}}}});
  const ScallopReport report =
      measure_scallop(plane(20, 0), passes, {.radius_mm = radius, .spacing_mm = 0.1});
  EXPECT_NEAR(report.gouge_max_mm, 0.08, 1e-3);
  EXPECT_LT(distance(report.gouge_at, {15.3, 7.1, 0}), 0.2);
}

TEST(Scallop, NothingFromNothing) {
  const auto passes = parallel_on_plane(4, 0, 1, 3, 20);
  EXPECT_EQ(measure_scallop(plane(20, 0), {}, {.radius_mm = 4}).samples, 0u);
  EXPECT_EQ(measure_scallop(plane(20, 0), passes, {.radius_mm = 0}).samples, 0u);
  EXPECT_EQ(measure_scallop(plane(20, 0), passes, {.radius_mm = std::nan("")}).samples, 0u);
  EXPECT_EQ(measure_scallop({}, passes, {.radius_mm = 4}).samples, 0u);
  const auto few =
      measure_scallop(plane(20, 0), passes, {.radius_mm = 4, .spacing_mm = 1e-6, .max_samples = 20'000});
  EXPECT_GT(few.samples, 1000u);
  EXPECT_LT(few.samples, 25'000u);
}

TEST(Scallop, StockMovesTheSurface) {
  const double radius = 3, stock = 0.4;
  std::vector<TipPass> passes = parallel_on_plane(radius, 0, 1, 4, 20);
  for (TipPass& pass : passes)
    for (Point3& tip : pass.stretches[0]) tip.z += stock;
  const ScallopReport report =
      measure_scallop(plane(20, 0), passes, {.radius_mm = radius, .stock_mm = stock});
  EXPECT_NEAR(report.scallop_max_mm, radius - std::sqrt(radius * radius - 0.25), 1e-7);
  EXPECT_LT(report.gouge_max_mm, 1e-9);
}

TEST(Scallop, SeesPlantedFaults) {
  const double radius = 4;
  std::vector<TipPass> deep = parallel_on_plane(radius, 0, 1, 5, 20);
  for (Point3& tip : deep[2].stretches[0]) tip.z -= 0.05;
  EXPECT_NEAR(measure_scallop(plane(20, 0), deep, {.radius_mm = radius}).gouge_max_mm, 0.05, 1e-7);
  std::vector<TipPass> missing = parallel_on_plane(radius, 0, 1, 5, 20);
  missing.erase(missing.begin() + 2);
  const ScallopReport report = measure_scallop(plane(20, 0), missing, {.radius_mm = radius});
  EXPECT_NEAR(report.ridges[1].max_mm, radius - std::sqrt(radius * radius - 1), 1e-7);
}

}  // namespace
}  // namespace burin::verify
