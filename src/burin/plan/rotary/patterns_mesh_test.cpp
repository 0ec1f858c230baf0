// SPDX-License-Identifier: Apache-2.0
// Paths on parts of which only the mesh is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "burin/plan/rotary/cusp_measure.h"
#include "burin/plan/rotary/rotary_cases.h"

namespace burin::rotary {
namespace {

using cases::measured_cusp;
using cases::paths_of;
using geom::distance_to;
using geom::kPi;
using geom::Point2;

struct Case {
  const char* name;
  SweptSection swept;
};
std::vector<Case> all_cases() {
  return {{"circle", cases::swept(cases::circle(10), 8, 0)},
          {"ellipse", cases::swept(cases::ellipse(12, 7, 90), 8, -0.5)},
          {"cam", cases::swept(cases::cam(12, 4, 6), 8, 0.3)},
          {"cutter", cases::swept(cases::cutter(8, 20, 13, 2.5), 8, 8 * kPi / 50)}};
}

Part meshed(const SweptSection& s) {
  Part part = cases::part_of(s);
  part.swept.reset();
  return part;
}

Point2 turned_back(const SweptSection& s, geom::Point3 p) {
  const double back = -s.turn_at(p.x);
  return {p.y * std::cos(back) - p.z * std::sin(back), p.y * std::sin(back) + p.z * std::cos(back)};
}

TEST(MeshRings, AreNearTheExactOnes) {
  for (const Case& c : all_cases()) {
    SCOPED_TRACE(c.name);
    const PatternResult exact = paths_of(cases::part_of(c.swept), Pattern::rings);
    const PatternResult result = paths_of(meshed(c.swept), Pattern::rings);
    EXPECT_LE(double(result.paths.size()), 1.15 * double(exact.paths.size()) + 1);
    EXPECT_GE(double(result.paths.size()), 0.9 * double(exact.paths.size()));
    EXPECT_EQ(result.paths.front().points.front().p.x, 0);
    EXPECT_EQ(result.paths.back().points.front().p.x, 8);
    for (const ContactPath& path : result.paths) {
      ASSERT_TRUE(path.closed);
      double u = -1, length = 0;
      for (const Contact& p : path.points) {
        EXPECT_EQ(p.p.x, path.points.front().p.x);
        EXPECT_LT(distance_to(c.swept.section, turned_back(c.swept, p.p)), 0.01);
        EXPECT_GE(p.u, u);
        EXPECT_LE(p.u, 1);
        u = p.u;
      }
      for (std::size_t i = 0; i < path.points.size(); ++i) {
        length += distance(path.points[i].p, path.points[(i + 1) % path.points.size()].p);
      }
      EXPECT_NEAR(length, length_of(c.swept.section), 0.01 * length);
      // The start is at angle 0.
      EXPECT_NEAR(path.points.front().p.z, 0, 1e-9);
      EXPECT_GT(path.points.front().p.y, 0);
    }
    const double worst = measured_cusp(c.swept, result, 3, 4.5, 150, 12);
    EXPECT_LE(worst, 0.05 * 1.02 + 0.002);
    // At edges the cusp is higher, along the normals there, than what points of the surface see.
    EXPECT_GE(worst, 0.6 * 0.05);
  }
}

TEST(MeshSpiral, ClimbsWithAFullRingAtEitherEnd) {
  for (const Case& c : all_cases()) {
    SCOPED_TRACE(c.name);
    const PatternResult result = paths_of(meshed(c.swept), Pattern::spiral);
    ASSERT_EQ(result.paths.size(), 1u);
    const auto& points = result.paths[0].points;
    double before = 0, at_start = 0, at_end = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      EXPECT_GE(points[i].p.x, before);
      before = points[i].p.x;
      EXPECT_LT(distance_to(c.swept.section, turned_back(c.swept, points[i].p)), 0.02);
      const double step = distance(points[i].p, points[i - 1].p);
      if (points[i].p.x == 0) at_start += step;
      if (points[i - 1].p.x == 8) at_end += step;
    }
    EXPECT_NEAR(at_start, length_of(c.swept.section), 0.02 * length_of(c.swept.section));
    EXPECT_NEAR(at_end, length_of(c.swept.section), 0.02 * length_of(c.swept.section));
    EXPECT_LE(measured_cusp(c.swept, result, 3, 4, 100, 8), 0.05 * 1.05 + 0.002);
  }
}

TEST(MeshLines, CuspHolds) {
  for (const Case& c : all_cases()) {
    SCOPED_TRACE(c.name);
    const PatternResult result = paths_of(meshed(c.swept), Pattern::lines);
    ASSERT_GT(result.paths.size(), 3u);
    EXPECT_EQ(result.paths[0].points.front().p.x, 0);
    EXPECT_EQ(result.paths[1].points.front().p.x, 8);
    // Edges along X are not known: only smooth sections hold the cusp everywhere.
    if (std::string(c.name) == "cutter") continue;
    EXPECT_LE(measured_cusp(c.swept, result, 3.9, 4.1, 1500, 2), 0.05 * 1.05 + 0.002);
  }
}

TEST(MeshPaths, StepsAcrossTheAxisAreSaid) {
  // A shaft with a shoulder: its face has no section.
  Part part = meshed(cases::swept(cases::circle(10), 8, 0));
  const Part thin = meshed(cases::swept(cases::circle(6), 8, 0));
  const std::uint32_t offset = std::uint32_t(part.mesh.vertices.size());
  for (geom::Point3 p : thin.mesh.vertices) part.mesh.vertices.push_back({p.x + 8, p.y, p.z});
  for (std::size_t i = 0; i < thin.mesh.triangles.size(); ++i) {
    const auto& t = thin.mesh.triangles[i];
    part.mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    part.corner_normals.push_back(thin.corner_normals[i]);
  }
  part.x_max = 16;
  PatternOptions o;
  o.ball_radius = 2;
  Diagnostics diagnostics;
  auto result = make_paths(part, o, diagnostics);
  ASSERT_TRUE(result);
  EXPECT_EQ(diagnostics.count("steep_faces"), 1u);
}

TEST(MeshPaths, TooManyIsSaidEarly) {
  const Part part = meshed(cases::swept(cases::cutter(8, 20, 13, 2.5), 8, 8 * kPi / 50));
  for (const Pattern pattern : {Pattern::rings, Pattern::spiral, Pattern::lines}) {
    PatternOptions o;
    o.pattern = pattern;
    o.ball_radius = 2;
    Diagnostics diagnostics;
    for (const double scallop : {1e-300, 1e-12}) {
      o.scallop = scallop;
      auto result = make_paths(part, o, diagnostics);
      ASSERT_FALSE(result);
      EXPECT_EQ(result.error().code, ErrorCode::range);
    }
    o.scallop = 0.05;
    o.max_points = 500;
    EXPECT_FALSE(make_paths(part, o, diagnostics));
  }
}

TEST(MeshPaths, SideStepIsKept) {
  const Part part = meshed(cases::swept(cases::ellipse(12, 7, 90), 8, 0));
  PatternOptions o;
  o.ball_radius = 2;
  o.side_step = 0.5;
  Diagnostics diagnostics;
  auto rings = make_paths(part, o, diagnostics);
  ASSERT_TRUE(rings);
  EXPECT_NEAR(double(rings->paths.size()), 17, 1);
  EXPECT_LE(rings->side_step_max, 0.5 * 1.001);
}

}  // namespace
}  // namespace burin::rotary
