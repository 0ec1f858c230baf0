// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/plan/rotary/cusp_measure.h"
#include "burin/plan/rotary/part.h"
#include "burin/plan/rotary/rotary_cases.h"

namespace burin::rotary {
namespace {

using cases::distance_to;
using cases::measured_cusp;
using cases::part_of;
using cases::paths_of;
using cases::Tube;
using cases::tubes_of;
using geom::kPi;
using geom::Point2;
using geom::Point3;
using geom::Vec3;

constexpr double kRadius = cases::kBall;

struct Case {
  const char* name;
  SweptSection swept;
  /// No convex edges.
  bool smooth;
};
std::vector<Case> all_cases() {
  return {{"circle", cases::swept(cases::circle(10), 6, 0), true},
          {"ellipse", cases::swept(cases::ellipse(12, 7, 90), 8, -0.5), true},
          {"cam", cases::swept(cases::cam(12, 4, 6), 6, 0.3), true},
          {"steep cam", cases::swept(cases::cam(12, 4, 6), 6, 1.5), true},
          {"square", cases::swept(cases::polygon({{9, 9}, {-9, 9}, {-9, -9}, {9, -9}}), 6, 0.4), false},
          {"cutter", cases::swept(cases::cutter(8, 20, 13, 2.5), 6, 6 * kPi / 50), false}};
}

TEST(Rings, StandExactlyOnTheSurface) {
  for (const Case& c : all_cases()) {
    SCOPED_TRACE(c.name);
    const Part part = part_of(c.swept);
    const PatternResult result = paths_of(part, Pattern::rings);
    ASSERT_GE(result.paths.size(), 2u);
    EXPECT_EQ(result.paths.front().points.front().p.x, 0);
    EXPECT_EQ(result.paths.back().points.front().p.x, part.x_max);
    for (const ContactPath& path : result.paths) {
      ASSERT_TRUE(path.closed);
      double before = -1;
      for (const Contact& p : path.points) {
        EXPECT_EQ(p.p.x, path.points.front().p.x);
        EXPECT_NEAR(norm(p.n), 1, 1e-12);
        EXPECT_NEAR(p.w, p.p.x / part.x_max, 1e-12);
        EXPECT_GE(p.u, before);
        before = p.u;
        const double back = -c.swept.turn_at(p.p.x);
        const Point2 q{p.p.y * std::cos(back) - p.p.z * std::sin(back),
                       p.p.y * std::sin(back) + p.p.z * std::cos(back)};
        EXPECT_LT(distance_to(c.swept.section, q), 1e-9);
      }
    }
  }
}

TEST(Rings, NormalsAreAcrossTheSurface) {
  // N is at right angles to the surface by differences along both parameters, outwards.
  for (const Case& c : all_cases()) {
    SCOPED_TRACE(c.name);
    const Part part = part_of(c.swept);
    const PatternResult result = paths_of(part, Pattern::rings);
    const ContactPath& path = result.paths[result.paths.size() / 2];
    for (const Contact& p : path.points) {
      // Along X the point follows the sweep: turn(x) about the axis.
      const double h = 1e-5, da = c.swept.turn_at(p.p.x + h) - c.swept.turn_at(p.p.x - h);
      const Vec3 along{2 * h, -p.p.z * da, p.p.y * da};
      EXPECT_NEAR(dot(unit(along), p.n), 0, 1e-7);
      // A little inwards is inside of the section.
      const Point3 in = p.p - 1e-4 * p.n;
      const double back = -c.swept.turn_at(in.x);
      const Point2 q{in.y * std::cos(back) - in.z * std::sin(back),
                     in.y * std::sin(back) + in.z * std::cos(back)};
      // At the end of a wall the way in may run along the next wall, or, twisted, out of it.
      if (distance_to(c.swept.section, q) < 0.6e-4) continue;
      EXPECT_EQ(winding_number(c.swept.section, q), 1);
    }
  }
}

// Sharp teeth that lean over: the ball rolls about an edge, all of its centres there equally near.
SweptSection undercut_teeth() {
  std::vector<Point2> corners;
  const auto add = [&](double radius, double at) {
    corners.push_back({radius * std::cos(geom::radians(at)), radius * std::sin(geom::radians(at))});
  };
  for (double at = 0; at < 360; at += 72) {
    add(20, at);
    add(12, at - 12);
    add(20, at + 65);
  }
  return cases::swept(cases::polygon(corners), 6, 6 * kPi / 50);
}

TEST(Rings, CuspHoldsAndIsUsed) {
  std::vector<Case> sections = all_cases();
  sections.push_back({"undercut", undercut_teeth(), false});
  for (const Case& c : sections) {
    SCOPED_TRACE(c.name);
    const Part part = part_of(c.swept);
    const PatternResult result = paths_of(part, Pattern::rings);
    EXPECT_LE(result.scallop_max, 0.05 * 1.0001);
    const double x0 = result.paths[1].points[0].p.x, x1 = result.paths[2].points[0].p.x;
    const double worst = measured_cusp(c.swept, result, x0, x1, 250, 8);
    EXPECT_LE(worst, 0.05 * 1.02);
    // One ring fewer would leave more than the scallop, or nearly.
    const double n = double(result.paths.size() - 1);
    const double with_one_less = worst * (n / (n - 1)) * (n / (n - 1));
    // At an edge the cusp is higher, along the normals there, than what points of the surface see.
    EXPECT_GE(with_one_less, (c.smooth ? 0.9 : 0.85) * 0.05) << "worst " << worst << " with " << n << " gaps";
    RecordProperty(c.name, std::to_string(worst));
  }
}

TEST(Rings, AcrossStationsTheCuspHolds) {
  const SweptSection s{cases::ellipse(12, 7, 90), {{0, 0}, {3, 0}, {5, 0.5}, {9, 0.2}}};
  const Part part = part_of(s);
  const PatternResult result = paths_of(part, Pattern::rings);
  EXPECT_EQ(result.paths.back().points.front().p.x, 9);
  const double worst = measured_cusp(s, result, 0, 9, 150, 90);
  EXPECT_LE(worst, 0.05 * 1.02);
  EXPECT_GE(worst, 0.05 * 0.85);
}

TEST(Rings, CentrePathIsDense) {
  // The exact centre half-way in u between two points lies on their chord within the density.
  for (const Case& c : all_cases()) {
    SCOPED_TRACE(c.name);
    const Part part = part_of(c.swept);
    PatternOptions o;
    o.ball_radius = kRadius;
    Diagnostics diagnostics;
    o.density_mm = 1e-3;
    const PatternResult coarse = *make_paths(part, o, diagnostics);
    o.density_mm = 1e-6;
    const PatternResult fine = *make_paths(part, o, diagnostics);
    const std::vector<Tube> chords = tubes_of({{coarse.paths[1]}, 0, 0, 0});
    for (std::size_t i = 0; i < fine.paths[1].points.size(); i += 97) {
      const Contact& p = fine.paths[1].points[i];
      double least = 1e9;
      for (const Tube& t : chords) least = std::min(least, distance_to(p.p + kRadius * p.n, t));
      EXPECT_LE(least, 1.05e-3);
    }
  }
}

TEST(Spiral, IsOnePathWithAFullRingAtEitherEnd) {
  for (const Case& c : all_cases()) {
    SCOPED_TRACE(c.name);
    const Part part = part_of(c.swept);
    const PatternResult result = paths_of(part, Pattern::spiral);
    ASSERT_EQ(result.paths.size(), 1u);
    EXPECT_FALSE(result.paths[0].closed);
    double at_start = 0, at_end = 0, before = 0;
    const auto& points = result.paths[0].points;
    for (std::size_t i = 1; i < points.size(); ++i) {
      EXPECT_GE(points[i].p.x, before);
      before = points[i].p.x;
      const double step = distance(points[i].p, points[i - 1].p);
      if (points[i].p.x == 0) at_start += step;
      if (points[i - 1].p.x == part.x_max) at_end += step;
    }
    EXPECT_NEAR(at_start, length_of(c.swept.section), 1e-3 * length_of(c.swept.section));
    EXPECT_NEAR(at_end, length_of(c.swept.section), 1e-3 * length_of(c.swept.section));
    EXPECT_LE(measured_cusp(c.swept, result, 0, 1.5, 120, 10), 0.05 * 1.02);
  }
}

TEST(Lines, CuspHoldsAndIsUsed) {
  for (const Case& c : all_cases()) {
    SCOPED_TRACE(c.name);
    const Part part = part_of(c.swept);
    const PatternResult result = paths_of(part, Pattern::lines);
    EXPECT_LE(result.scallop_max, 0.05 * 1.0001);
    const double middle = 0.5 * part.x_max;
    const double worst = measured_cusp(c.swept, result, middle - 0.02, middle + 0.02, 2000, 1);
    EXPECT_LE(worst, 0.05 * 1.02);
    if (c.smooth) {
      EXPECT_GE(worst, 0.05 * 0.9);
    }
    // At the ends of a twisted part rings take what lines at a slant leave.
    EXPECT_LE(measured_cusp(c.swept, result, 0, 0.6, 300, 4), 0.05 * 1.02);
    EXPECT_LE(measured_cusp(c.swept, result, part.x_max - 0.6, part.x_max, 300, 4), 0.05 * 1.02);
    std::size_t i = 0;
    for (const ContactPath& path : result.paths) {
      if (path.closed) continue;
      const auto& p = path.points;
      EXPECT_EQ(p.front().p.x, i % 2 == 0 ? 0 : part.x_max);
      EXPECT_EQ(p.back().p.x, i % 2 == 0 ? part.x_max : 0);
      for (const Contact& q : p) EXPECT_EQ(q.u, p.front().u);
      ++i;
    }
    EXPECT_EQ(result.paths.size() - i, c.swept.stations.back().turn != 0 ? 2u : 0u);
  }
}

TEST(Patterns, SideStepIsKept) {
  const Part part = part_of(cases::swept(cases::circle(10), 6, 0));
  PatternOptions o;
  o.ball_radius = kRadius;
  o.side_step = 0.25;
  Diagnostics diagnostics;
  auto rings = make_paths(part, o, diagnostics);
  ASSERT_TRUE(rings);
  EXPECT_EQ(rings->paths.size(), 25u);
  o.pattern = Pattern::lines;
  auto lines = make_paths(part, o, diagnostics);
  ASSERT_TRUE(lines);
  EXPECT_EQ(lines->paths.size(), std::size_t(std::ceil(20 * kPi / 0.25)));
}

TEST(Patterns, TooManyIsSaidBeforeAnythingIsMade) {
  const Part part = part_of(cases::swept(cases::cutter(8, 20, 13, 2.5), 50, kPi));
  for (const Pattern pattern : {Pattern::rings, Pattern::spiral, Pattern::lines}) {
    PatternOptions o;
    o.pattern = pattern;
    o.ball_radius = kRadius;
    Diagnostics diagnostics;
    for (const double scallop : {1e-300, 1e-12, 1e-9}) {
      o.scallop = scallop;
      auto result = make_paths(part, o, diagnostics);
      ASSERT_FALSE(result);
      EXPECT_EQ(result.error().code, ErrorCode::range);
      EXPECT_NE(result.error().message.find("would do"), std::string::npos);
    }
    o.scallop = 0.05;
    o.max_points = 1000;
    EXPECT_FALSE(make_paths(part, o, diagnostics));
    o.max_points = 50'000'000;
    o.scallop = -1;
    EXPECT_FALSE(make_paths(part, o, diagnostics));
    o.scallop = 0.05;
    o.side_step = 0;
    EXPECT_FALSE(make_paths(part, o, diagnostics));
    o.side_step = 1e-12;
    EXPECT_FALSE(make_paths(part, o, diagnostics));
  }
}

}  // namespace
}  // namespace burin::rotary
