// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/plan/rotary/center_path.h"
#include "burin/plan/rotary/rotary_cases.h"

namespace burin::rotary {
namespace {

using geom::ArcSpline;
using geom::kPi;
using geom::Point3;
using geom::Vec3;

CenterPath ring_of(const ArcSpline& section, double radius, double density = 1e-4) {
  auto part = make_swept(cases::swept(section, 1, 0), {});
  EXPECT_TRUE(part) << part.error().message;
  PatternOptions o;
  o.ball_radius = radius;
  o.side_step = 10;
  o.density_mm = density;
  Diagnostics diagnostics;
  auto paths = make_paths(*part, o, diagnostics);
  EXPECT_TRUE(paths);
  CenterPath path;
  path.closed = true;
  for (const Contact& c : paths->paths[0].points)
    path.places.push_back({c, c.p + radius * c.n, State::ok, 0});
  return path;
}

double distance_to(Point3 p, Point3 a, Point3 b) {
  const Vec3 ab = b - a, ap = p - a;
  const double l2 = dot(ab, ab);
  const double f = l2 > 0 ? std::clamp(dot(ap, ab) / l2, 0.0, 1.0) : 0;
  return norm(ap - f * ab);
}

/// Error of the step from i to j (j > i, may run through the seam) over every contact between.
double step_error(const CenterPath& path, std::size_t i, std::size_t j, double radius, double limit) {
  const std::size_t n = path.places.size();
  const Point3 a = path.places[i % n].center, b = path.places[j % n].center;
  double worst = 0;
  for (std::size_t k = i; k <= j && worst <= limit; ++k) {
    worst = std::max(worst, std::abs(distance_to(path.places[k % n].contact.p, a, b) - radius));
  }
  return worst;
}

/// Fewest points by dynamic programming over all dense places, from every start in the first longest step (or
/// `starts` of them).
std::size_t fewest(const CenterPath& path, double radius, double tolerance, std::size_t starts) {
  const std::size_t n = path.places.size();
  // How far a step can reach at all, over all places: bounds the inner loop.
  std::size_t longest = 1;
  std::vector<std::size_t> reach(n);
  std::vector<std::vector<std::uint8_t>> good(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t misses = 0;
    for (std::size_t d = 1; d < n && misses < 40; ++d) {
      const bool holds = step_error(path, i, i + d, radius, tolerance) <= tolerance;
      good[i].push_back(holds);
      misses = holds ? 0 : misses + 1;
      if (holds) reach[i] = d;
    }
    longest = std::max(longest, reach[i]);
  }
  std::size_t best = std::numeric_limits<std::size_t>::max();
  const std::size_t step = std::max<std::size_t>(1, reach[0] / starts);
  for (std::size_t s = 0; s <= reach[0]; s += step) {
    std::vector<std::size_t> count(n + 1, std::numeric_limits<std::size_t>::max() / 2);
    count[0] = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const auto& from = good[(s + i) % n];
      for (std::size_t d = 1; d <= from.size() && i + d <= n; ++d) {
        if (from[d - 1]) count[i + d] = std::min(count[i + d], count[i] + 1);
      }
    }
    best = std::min(best, count[n]);
  }
  return best;
}

/// The steps between the points hold: checked against dense places of their own.
double measured_error(const CenterPath& path, const std::vector<Place>& points, double radius) {
  double worst = 0;
  for (const Place& p : path.places) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < points.size() + (path.closed ? 1 : 0); ++k) {
      least =
          std::min(least, distance_to(p.contact.p, points[k].center, points[(k + 1) % points.size()].center));
    }
    worst = std::max(worst, std::abs(least - radius));
  }
  return worst;
}

TEST(Thin, CircleOfThirtyTakesOneHundredAndTwentyTwo) {
  const CenterPath path = ring_of(cases::circle(28), 2);
  const SsiResult r = thin(path, 2, 0.01);
  EXPECT_EQ(r.points.size(), 122u);
  EXPECT_EQ(r.halving_points, 128u);
  EXPECT_EQ(r.split, 127u);
  EXPECT_LE(r.error_max_mm, 0.01);
  EXPECT_GE(r.error_max_mm, 0.0095);
}

TEST(Thin, CirclesTakeTheFewestByTheClosedForm) {
  for (const double r : {3.0, 10.0, 47.0}) {
    for (const double radius : {0.5, 2.0, 6.0}) {
      const double tolerance = 0.01;
      const SsiResult result = thin(ring_of(cases::circle(r), radius, 1e-5), radius, tolerance);
      // Sagitta of the centre's chord within the tolerance.
      const double fewest_ever = std::ceil(kPi / std::acos(1 - tolerance / (r + radius)));
      EXPECT_LE(double(result.points.size()), std::ceil(1.02 * fewest_ever)) << r << " " << radius;
      EXPECT_GE(double(result.points.size()), fewest_ever);
    }
  }
}

TEST(Thin, EllipsesAndCamsTakeWithinTwoPercentOfTheFewest) {
  struct Case {
    const char* name;
    ArcSpline section;
    double radius, tolerance;
  };
  for (const Case& c :
       {Case{"ellipse", cases::ellipse(20, 12, 200), 2, 0.01},
        Case{"flat ellipse", cases::ellipse(30, 6, 300), 1.5, 0.01},
        Case{"cam", cases::cam(20, 6, 10), 3, 0.01}, Case{"cam", cases::cam(12, 4, 6), 2, 0.002}}) {
    SCOPED_TRACE(c.name);
    const CenterPath path = ring_of(c.section, c.radius, 2e-4 * c.tolerance / 0.01);
    const SsiResult r = thin(path, c.radius, c.tolerance);
    const std::size_t least = fewest(path, c.radius, c.tolerance, 5);
    EXPECT_LE(double(r.points.size()), 1.02 * double(least) + 0.999) << least;
    EXPECT_LE(measured_error(path, r.points, c.radius), c.tolerance);
    EXPECT_GT(r.halving_points, r.points.size());
    RecordProperty(c.name, std::to_string(r.points.size()) + " of " + std::to_string(least) + ", halving " +
                               std::to_string(r.halving_points));
  }
}

TEST(Thin, HollowSectionsKeepTheTolerance) {
  // Undercut: a wide hollow, and sharp convex corners.
  const ArcSpline section =
      cases::rounded({{{15, -10}, 0}, {{15, 10}, 0}, {{0, 4}, 9}, {{-15, 10}, 2}, {{-15, -10}, 0}});
  const CenterPath path = ring_of(section, 2);
  const SsiResult r = thin(path, 2, 0.01);
  EXPECT_LE(measured_error(path, r.points, 2), 0.01);
  EXPECT_LE(double(r.points.size()), 1.02 * double(fewest(path, 2, 0.01, 5)) + 0.999);
}

TEST(Thin, OpenPathsKeepTheirEnds) {
  CenterPath path = ring_of(cases::ellipse(20, 12, 200), 2);
  path.closed = false;
  const SsiResult r = thin(path, 2, 0.01);
  EXPECT_EQ(r.points.front().center, path.places.front().center);
  EXPECT_EQ(r.points.back().center, path.places.back().center);
  EXPECT_LE(measured_error(path, r.points, 2), 0.01);
}

TEST(Thin, NoStepLeadsAcrossAJump) {
  // Two stretches of a ring with the middle missing.
  CenterPath path = ring_of(cases::circle(20), 2);
  const std::size_t n = path.places.size();
  path.closed = false;
  path.places.erase(path.places.begin() + std::ptrdiff_t(n / 3), path.places.begin() + std::ptrdiff_t(n / 2));
  const Point3 before = path.places[n / 3 - 1].center, after = path.places[n / 3].center;
  const SsiResult r = thin(path, 2, 0.01);
  bool found = false;
  for (std::size_t k = 0; k + 1 < r.points.size(); ++k) {
    found = found || (r.points[k].center == before && r.points[k + 1].center == after);
  }
  EXPECT_TRUE(found);
  EXPECT_LE(r.error_max_mm, 0.01);
}

TEST(Thin, StraightLinesTakeTheirEndsOnly) {
  CenterPath path;
  for (int i = 0; i <= 1; ++i) {
    path.places.push_back({{{50.0 * i, 3, 0}, {0, 1, 0}, 0, double(i)}, {50.0 * i, 5, 0}, State::ok, 0});
  }
  EXPECT_EQ(thin(path, 2, 0.01).points.size(), 2u);
  path.places.resize(1);
  EXPECT_EQ(thin(path, 2, 0.01).points.size(), 1u);
  path.places.clear();
  EXPECT_TRUE(thin(path, 2, 0.01).points.empty());
}

TEST(Thin, WhatIsLeftIsNotLost) {
  CenterPath path = ring_of(cases::circle(20), 2);
  path.places[40].state = path.places[41].state = path.places[42].state = State::moved;
  path.places[40].excess_mm = 0.1;
  path.places[41].excess_mm = 0.4;
  path.places[200].excess_mm = 0.002;
  const SsiResult r = thin(path, 2, 0.01);
  double most = 0;
  for (const Place& p : r.points) {
    if (p.excess_mm < 0.05) continue;
    EXPECT_EQ(p.state, State::moved);
    most = std::max(most, p.excess_mm);
  }
  EXPECT_EQ(most, 0.4);
}

}  // namespace
}  // namespace burin::rotary
