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
  for (int i = 0; i < 300; ++i) {
    const Point3 q{number(random), number(random), number(random)};
    const Vec3 n = unit(Vec3{number(random), number(random), number(random)});
    const auto h = sweep.entry(q, n, -2, 5);
    double first = 1e9;
    for (double x = -2; x <= 5; x += 1e-3)
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
    EXPECT_NEAR(*h, first, 1.001e-3);
  }
  EXPECT_GT(hits, 50);
}

TEST(Scallop, PlaneHasTheClosedForm) {
  for (const double slope : {0.0, 0.5}) {
    for (const double step : {0.2, 1.0, 3.0}) {
      const double radius = 4, expected = radius - std::sqrt(radius * radius - step * step / 4);
      const ScallopReport report = measure_scallop(
          plane(20, slope), parallel_on_plane(radius, slope, step, 5, 20), {.radius_mm = radius});
      ASSERT_EQ(report.ridges.size(), 4u);
      for (const auto& ridge : report.ridges) {
        EXPECT_NEAR(ridge.min_mm, expected, 1e-7);
        EXPECT_NEAR(ridge.max_mm, expected, 1e-7);
      }
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
  for (const auto& ridge : report.ridges) {
    // The feet are found within 1e-6 mm, the ridge within 2e-5 of the side step.
    EXPECT_NEAR(ridge.min_mm, expected, 3e-6);
    EXPECT_NEAR(ridge.max_mm, expected, 3e-6);
  }
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
