// SPDX-License-Identifier: Apache-2.0
// Parts from meshes: sound ones of any sense are taken, others refused with the place.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/mesh_cases.h"
#include "burin/plan/rotary/part.h"

namespace burin::rotary {
namespace {

using geom::Mesh;
using geom::Point3;
namespace cases = geom::cases;

Mesh shaft() {
  return cases::shaft(36, 10, 40, [](double, double x) { return 8 + 2 * std::sin(x / 6); });
}
Mesh tube(double radius, double from, double to, double y = 0) {
  return cases::tube(24, 8, [&](double u, double v) {
    return Point3{from + (to - from) * v, y + radius * std::cos(2 * geom::kPi * u),
                  radius * std::sin(2 * geom::kPi * u)};
  });
}
void append(Mesh& mesh, const Mesh& other) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
}

std::string error_of(const Mesh& mesh, const PartOptions& options = {}) {
  Diagnostics diagnostics;
  const auto part = make_meshed(mesh, "part", options, diagnostics);
  if (part) return "was taken";
  EXPECT_EQ(part.error().code, ErrorCode::geometry);
  return part.error().message;
}
bool says(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

TEST(PartMesh, ClosedSolids) {
  for (const Mesh& mesh : {shaft(), cases::sphere(30, 15, {3, 0, 0}, 10),
                           cases::cutter(2000, 50, 20, 12, 9, 0.5), cases::box({0, -3, -4}, {10, 5, 6})}) {
    Diagnostics diagnostics;
    const auto part = make_meshed(mesh, "a part", {}, diagnostics);
    ASSERT_TRUE(part.ok()) << part.error().message;
    EXPECT_TRUE(diagnostics.empty());
    EXPECT_EQ(part->name, "a part");
    EXPECT_EQ(part->deflection_mm, 0);
    EXPECT_EQ(part->mesh.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(part->corner_normals.size(), mesh.triangles.size());
    const auto report = geom::examine(part->mesh);
    EXPECT_EQ(part->x_min, report.bounds.lo.x);
    EXPECT_EQ(part->x_max, report.bounds.hi.x);
    double farthest = 0;
    for (const Point3& p : mesh.vertices) farthest = std::max(farthest, std::hypot(p.y, p.z));
    EXPECT_EQ(part->radius_max, farthest);
    EXPECT_FALSE(part->swept.has_value());
  }
}

TEST(PartMesh, InsideOutIsTurnedAndSaid) {
  Mesh mesh = shaft();
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
  Diagnostics diagnostics;
  const auto part = make_meshed(mesh, "", {}, diagnostics);
  ASSERT_TRUE(part.ok());
  EXPECT_EQ(diagnostics.count("mesh_turned"), 1U);
  const auto report = geom::examine(part->mesh);
  EXPECT_GT(report.signed_volume, 0);
  EXPECT_EQ(report.against_sense, 0U);
}

TEST(PartMesh, OpenEndsAreFine) {
  Diagnostics diagnostics;
  EXPECT_TRUE(make_meshed(tube(5, 0, 30), "", {}, diagnostics).ok());
  Mesh inwards = tube(5, 0, 30);
  for (auto& t : inwards.triangles) std::swap(t[1], t[2]);
  const auto part = make_meshed(inwards, "", {}, diagnostics);
  ASSERT_TRUE(part.ok());
  EXPECT_GT(geom::examine(part->mesh).signed_volume, 0);
  EXPECT_EQ(diagnostics.count("mesh_turned"), 1U);
}

TEST(PartMesh, HolesAreSaidWithPlaceAndSize) {
  Mesh mesh = shaft();
  const auto gone = mesh.triangles[100];
  const Point3 middle = lerp(mesh.vertices[gone[0]], mesh.vertices[gone[1]], 0.5);
  mesh.triangles.erase(mesh.triangles.begin() + 100);
  const std::string one = error_of(mesh);
  EXPECT_TRUE(says(one, "has 1 hole: 3 edges at (")) << one;
  char x[40];
  std::snprintf(x, sizeof x, "at (%.0f", middle.x + 2);  // the middle of a cell of 4 mm
  EXPECT_TRUE(says(one, x)) << one;
  for (const int i : {200, 300, 400, 500}) mesh.triangles.erase(mesh.triangles.begin() + i);
  EXPECT_TRUE(says(error_of(mesh), "has 5 holes: "));
  EXPECT_TRUE(says(error_of(mesh), ", ... ("));
}

TEST(PartMesh, OnlyTheEndsMayBeOpen) {
  // A step without its shoulder: both rings go round the axis, and the axis is inside all along.
  Mesh mesh = tube(5, 0, 10);
  append(mesh, tube(8, 10, 20));
  EXPECT_TRUE(says(error_of(mesh), "has 2 holes: 24 edges at (10, 0, 0)")) << error_of(mesh);
}

TEST(PartMesh, GapsWithinTheDeflectionAreClosed) {
  PartOptions options;
  Diagnostics diagnostics;
  // A lid cut out and put back in its place, turned into a finer one.
  Mesh lid = shaft();
  const auto t = lid.triangles[100];
  const auto n = static_cast<std::uint32_t>(lid.vertices.size());
  for (const double f : {0.25, 0.5, 0.75})
    lid.vertices.push_back(lerp(lid.vertices[t[0]], lid.vertices[t[1]], f) + geom::Vec3{1e-4, 0, 1e-4});
  lid.triangles[100] = {t[0], n, t[2]};
  lid.triangles.push_back({n, n + 1, t[2]});
  lid.triangles.push_back({n + 1, n + 2, t[2]});
  lid.triangles.push_back({n + 2, t[1], t[2]});
  EXPECT_FALSE(geom::examine(lid).holes.empty());
  options.deflection_mm = 1e-3;
  const auto closed = make_meshed(lid, "", options, diagnostics);
  ASSERT_TRUE(closed.ok()) << closed.error().message;
  EXPECT_EQ(diagnostics.count("mesh_stitched"), 1U);
  EXPECT_EQ(closed->deflection_mm, 1e-3);
  EXPECT_TRUE(geom::examine(closed->mesh).holes.empty());
  options.deflection_mm = 1e-5;
  EXPECT_TRUE(says(error_of(lid, options), "has 1 hole"));
}

TEST(PartMesh, TheAxisRunsInside) {
  EXPECT_TRUE(says(error_of(tube(5, 0, 30, 7)), "hole"));  // its ends do not go round the axis
  Mesh beside = cases::box({0, 2, 2}, {10, 5, 6});
  EXPECT_TRUE(says(error_of(beside), "from x = 0 to 10")) << error_of(beside);
  // A ring: nothing along the axis.
  const Mesh ring = cases::torus(12, 24, 10, 3);
  EXPECT_TRUE(says(error_of(ring), "from x = -3 to 3")) << error_of(ring);
  // Two balls with a gap.
  Mesh two = cases::sphere(30, 15, {0, 0, 0}, 5);
  append(two, cases::sphere(30, 15, {20, 0, 0}, 5));
  EXPECT_TRUE(says(error_of(two), "from x = 5 to 15")) << error_of(two);
  // Two tubes with a gap, whose ends are open.
  Mesh tubes = tube(5, 0, 10);
  append(tubes, tube(6, 12, 30));
  EXPECT_TRUE(says(error_of(tubes), "has 2 holes: 24 edges at (10, 0, 0)")) << error_of(tubes);
  // A crank: the axis leaves through its wall and comes back.
  const Mesh crank = cases::tube(24, 30, [](double u, double v) {
    const double y = 12 * std::pow(std::sin(geom::kPi * v), 2);
    return Point3{60 * v, y + 5 * std::cos(2 * geom::kPi * u), 5 * std::sin(2 * geom::kPi * u)};
  });
  EXPECT_TRUE(says(error_of(crank), "the X axis runs outside of the part from x = ")) << error_of(crank);
}

TEST(PartMesh, WhatIsNoPart) {
  EXPECT_TRUE(says(error_of(Mesh{}), "no triangles"));
  Mesh mesh = shaft();
  mesh.triangles.push_back({0, 1, 9999});
  EXPECT_TRUE(says(error_of(mesh), "does not exist"));
  mesh = shaft();
  mesh.vertices[5].y = std::nan("");
  EXPECT_TRUE(says(error_of(mesh), "not a number"));
  mesh = shaft();
  for (Point3& p : mesh.vertices) p.x *= 1e-6;
  EXPECT_TRUE(says(error_of(mesh), "long along X")) << error_of(mesh);
  mesh = shaft();
  const auto [a, b, c] = mesh.triangles[50];
  mesh.vertices.push_back({20, 30, 0});
  mesh.triangles.push_back({a, b, static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
  EXPECT_TRUE(says(error_of(mesh), "hole") || says(error_of(mesh), "more than two triangles"))
      << error_of(mesh);
  // Two bodies that share an edge.
  mesh = cases::box({0, -1, -1}, {4, 1, 1});
  append(mesh, cases::box({0, 1, 1}, {4, 2, 2}));
  EXPECT_TRUE(
      says(error_of(mesh), "1 edges of the mesh have more than two triangles, the first at (2, 1, 1)"))
      << error_of(mesh);
  PartOptions few;
  few.max_triangles = 11;
  Diagnostics diagnostics;
  EXPECT_EQ(make_meshed(cases::box({0, -1, -1}, {4, 1, 1}), "", few, diagnostics).error().code,
            ErrorCode::range);
  EXPECT_EQ(make_meshed(shaft(), "", {.deflection_mm = 0}, diagnostics).error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace burin::rotary
