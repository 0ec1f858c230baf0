// SPDX-License-Identifier: Apache-2.0
// Holes, sense and normals on solids whose answers are known.
#include "burin/geom/mesh/check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "burin/geom/mesh/mesh_cases.h"

namespace burin::geom {
namespace {

/// Every triangle with corners of its own, moved by up to `noise`.
Mesh torn(const Mesh& mesh, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-noise, noise);
  Mesh out;
  for (const auto& t : mesh.triangles) {
    const auto n = static_cast<std::uint32_t>(out.vertices.size());
    for (const std::uint32_t i : t)
      out.vertices.push_back(mesh.vertices[i] + Vec3{u(random), u(random), u(random)});
    out.triangles.push_back({n, n + 1, n + 2});
  }
  return out;
}

void append(Mesh& mesh, const Mesh& other, bool turned) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (auto t : other.triangles) {
    if (turned) std::swap(t[1], t[2]);
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
}

/// The strip of `n` quads with half a turn.
Mesh moebius(std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * kPi * i / n;
    for (const double s : {-1.0, 1.0}) {
      const double r = 10 + s * std::cos(a / 2);
      mesh.vertices.push_back({r * std::cos(a), r * std::sin(a), s * std::sin(a / 2)});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1;
    const bool last = i + 1 == n;  // the ends meet crosswise
    const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : b + 2;
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({b, d, c});
  }
  return mesh;
}

TEST(MeshCheck, ClosedSolidsHaveNoHoles) {
  for (const Mesh& mesh : {cases::sphere(24, 12, {3, 4, 5}, 2), cases::box({0, 0, 0}, {1, 2, 3}),
                           cases::torus(12, 20, 5, 1), cases::cutter(800, 20, 10, 6, 5, 0.2)}) {
    const MeshReport report = examine(mesh);
    EXPECT_TRUE(report.holes.empty());
    EXPECT_EQ(report.shared_by_many, 0U);
    EXPECT_EQ(report.against_sense, 0U);
    EXPECT_EQ(report.degenerate, 0U);
    EXPECT_GT(report.signed_volume, 0);
  }
  EXPECT_NEAR(examine(cases::box({-1, -1, -1}, {1, 2, 3})).signed_volume, 24, 1e-12);
  EXPECT_NEAR(examine(cases::sphere(400, 200, {100, 0, 0}, 3)).signed_volume, 36 * kPi, 0.02);
  EXPECT_EQ(examine(Mesh{}).bounds.empty(), true);
}

TEST(MeshCheck, HolesWithTheirPlaces) {
  Mesh tube = cases::tube(16, 10, [](double u, double v) {
    return Point3{30 * v, 5 * std::cos(2 * kPi * u), 5 * std::sin(2 * kPi * u)};
  });
  MeshReport report = examine(tube);
  ASSERT_EQ(report.holes.size(), 2U);
  for (const MeshHole& hole : report.holes) {
    EXPECT_EQ(hole.points.size(), 16U);
    EXPECT_EQ(hole.box.lo.x, hole.box.hi.x);
    EXPECT_EQ(hole.box.hi.y, 5);
  }
  EXPECT_EQ(report.holes[0].box.lo.x, 0);
  EXPECT_EQ(report.holes[1].box.lo.x, 30);

  // Two neighbours at a corner only: two holes of three edges each, though their chains meet.
  Mesh ball = cases::sphere(20, 10, {}, 5);
  const auto at = ball.triangles[100];
  std::vector<std::size_t> go{100};
  for (std::size_t i = 0; i < ball.triangles.size() && go.size() < 2; ++i) {
    const auto& t = ball.triangles[i];
    const auto shared =
        std::count_if(t.begin(), t.end(), [&](auto v) { return std::count(at.begin(), at.end(), v); });
    if (shared == 1) go.push_back(i);
  }
  ball.triangles.erase(ball.triangles.begin() + std::ptrdiff_t(std::max(go[0], go[1])));
  ball.triangles.erase(ball.triangles.begin() + std::ptrdiff_t(std::min(go[0], go[1])));
  report = examine(ball);
  ASSERT_EQ(report.holes.size(), 2U);
  EXPECT_EQ(report.holes[0].points.size(), 3U);
  EXPECT_EQ(report.holes[1].points.size(), 3U);
}

TEST(MeshCheck, WhatIsWrongIsCounted) {
  Mesh mesh = cases::box({0, 0, 0}, {1, 1, 1});
  std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
  EXPECT_EQ(examine(mesh).against_sense, 3U);

  mesh = cases::box({0, 0, 0}, {1, 1, 1});
  mesh.triangles.push_back({0, 7, 1});  // a fin on the edge 0-1
  const MeshReport fin = examine(mesh);
  EXPECT_EQ(fin.shared_by_many, 1U);
  ASSERT_EQ(fin.holes.size(), 1U);
  EXPECT_EQ(fin.holes[0].points.size(), 3U);

  mesh = cases::box({0, 0, 0}, {1, 1, 1});
  mesh.vertices.push_back({0.5, 0, 0});
  mesh.triangles.push_back({0, 8, 1});
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({0, 99, 1});
  EXPECT_EQ(examine(mesh).degenerate, 3U);
}

TEST(MeshWeld, TornMeshesGrowTogether) {
  for (const Mesh& mesh : {cases::sphere(24, 12, {300, 4, 5}, 2), cases::torus(12, 20, 5, 1),
                           cases::cutter(800, 20, 10, 6, 5, 0.2)}) {
    for (const double noise : {0.0, 1e-5}) {
      const Mesh whole = welded(torn(mesh, noise, 3), 4 * noise);
      EXPECT_EQ(whole.vertices.size(), mesh.vertices.size());
      EXPECT_EQ(whole.triangles.size(), mesh.triangles.size());
      const MeshReport report = examine(whole);
      EXPECT_TRUE(report.holes.empty());
      EXPECT_EQ(report.shared_by_many + report.against_sense, 0U);
      EXPECT_NEAR(report.signed_volume, examine(mesh).signed_volume, 1e-2 * std::abs(report.signed_volume));
    }
  }
}

TEST(MeshWeld, NoVertexMovesFartherThanTheTolerance) {
  std::mt19937 random(9);
  const Mesh mesh = cases::soup(random, 3000, 4);
  const double tolerance = 3;
  const Mesh out = welded(mesh, tolerance);
  for (std::size_t i = 0; i < out.vertices.size(); ++i) {
    // All that stay are vertices of the mesh, farther than the tolerance from each other.
    EXPECT_NE(std::find(mesh.vertices.begin(), mesh.vertices.end(), out.vertices[i]), mesh.vertices.end());
    for (std::size_t k = 0; k < i; ++k) EXPECT_GT(distance(out.vertices[i], out.vertices[k]), tolerance);
  }
  EXPECT_LT(out.triangles.size(), mesh.triangles.size());
}

TEST(MeshWeld, RepeatedTrianglesAndSheetsOfNoThickness) {
  Mesh mesh = cases::box({0, 0, 0}, {1, 1, 1});
  const Mesh box = mesh;
  mesh.triangles.push_back(mesh.triangles[3]);
  mesh.triangles.push_back({mesh.triangles[5][1], mesh.triangles[5][2], mesh.triangles[5][0]});
  EXPECT_EQ(welded(mesh, 0).triangles, welded(box, 0).triangles);
  // Both sides of a sheet beside it.
  mesh.vertices.insert(mesh.vertices.end(), {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}});
  mesh.triangles.push_back({8, 9, 10});
  mesh.triangles.push_back({8, 10, 9});
  EXPECT_EQ(welded(mesh, 0).triangles, welded(box, 0).triangles);
  EXPECT_EQ(welded(mesh, 0).vertices.size(), 8U);
}

TEST(MeshWeld, WhereTheToleranceMakesNoSense) {
  const Mesh box = cases::box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(welded(box, -1).triangles.size(), 12U);
  EXPECT_EQ(welded(box, std::nan("")).triangles.size(), 12U);
  EXPECT_TRUE(welded(box, 100).triangles.empty());
  Mesh far = box;
  for (Point3& p : far.vertices) p.x *= 1e300;
  EXPECT_EQ(welded(far, 1e-6).triangles.size(), 12U);
}

TEST(MeshStitch, SeamsOfOtherCornersAreClosed) {
  // Two pieces of a cylinder that share a circle, each with corners of its own on it, and a gap besides.
  for (const std::uint32_t n : {32U, 33U, 47U, 64U}) {
    const auto piece = [](std::uint32_t around, double from, double to) {
      return cases::tube(around, 4, [=](double u, double v) {
        const double a = 2 * kPi * u + 0.003;
        return Point3{from + (to - from) * v, 10 * std::cos(a), 10 * std::sin(a)};
      });
    };
    Mesh mesh = piece(32, 0, 15);
    append(mesh, piece(n, 15.001, 30), false);
    const double sag = 10 * (1 - std::cos(kPi / 32));
    EXPECT_EQ(examine(mesh).holes.size(), 4U);
    const Mesh closed = stitched(mesh, 1.1 * sag);
    const MeshReport report = examine(closed);
    ASSERT_EQ(report.holes.size(), 2U) << n;
    EXPECT_EQ(report.holes[0].box.hi.x, 0);
    EXPECT_EQ(report.holes[1].box.lo.x, 30);
    EXPECT_EQ(report.shared_by_many + report.against_sense, 0U) << n;
    // Not with less than the gap.
    EXPECT_GT(examine(stitched(mesh, 1e-4)).holes.size(), 2U);
  }
}

TEST(MeshStitch, WhatIsClosedStays) {
  const Mesh mesh = cases::cutter(800, 20, 10, 6, 5, 0.2);
  EXPECT_EQ(stitched(mesh, 1).triangles, welded(mesh, 0).triangles);
  EXPECT_EQ(stitched(Mesh{}, 1).triangles.size(), 0U);
}

std::vector<std::array<std::uint32_t, 3>> turned_to_lowest(const Mesh& mesh) {
  auto out = mesh.triangles;
  for (auto& t : out) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return out;
}

TEST(MeshOrient, AnySenseIsPutRight) {
  std::mt19937 random(11);
  for (const Mesh& mesh : {cases::sphere(24, 12, {3, 4, 5}, 2), cases::torus(12, 20, 5, 1),
                           cases::cutter(800, 20, 10, 6, 5, 0.2)}) {
    for (const double share : {0.0, 0.3, 0.5, 1.0}) {
      Mesh mixed = mesh;
      for (auto& t : mixed.triangles) {
        if (std::bernoulli_distribution(share)(random)) std::swap(t[0], t[1]);
      }
      ASSERT_TRUE(orient(mixed));
      EXPECT_EQ(turned_to_lowest(mixed), turned_to_lowest(mesh));
    }
  }
}

TEST(MeshOrient, HollowsStayHollowAndBodiesStayBodies) {
  Mesh hollow = cases::sphere(24, 12, {}, 10);
  append(hollow, cases::sphere(24, 12, {1, 1, 1}, 4), true);
  append(hollow, cases::sphere(24, 12, {30, 0, 0}, 4), false);
  const auto right = turned_to_lowest(hollow);
  ASSERT_TRUE(orient(hollow));
  EXPECT_EQ(turned_to_lowest(hollow), right);
  for (auto& t : hollow.triangles) std::swap(t[0], t[1]);
  ASSERT_TRUE(orient(hollow));
  EXPECT_EQ(turned_to_lowest(hollow), right);

  Mesh twice = cases::sphere(24, 12, {}, 10);
  append(twice, cases::sphere(24, 12, {1, 1, 1}, 4), false);
  const auto bodies = turned_to_lowest(twice);
  ASSERT_TRUE(orient(twice));
  EXPECT_EQ(turned_to_lowest(twice), bodies);
}

TEST(MeshOrient, OpenTubes) {
  Mesh tube = cases::tube(16, 10, [](double u, double v) {
    return Point3{30 * v + 7, 5 * std::cos(2 * kPi * u) + 1, 5 * std::sin(2 * kPi * u)};
  });
  const auto right = turned_to_lowest(tube);
  for (auto& t : tube.triangles) std::swap(t[0], t[1]);
  ASSERT_TRUE(orient(tube));
  EXPECT_EQ(turned_to_lowest(tube), right);
}

TEST(MeshOrient, OneSidedOrSharedByManyCannot) {
  Mesh strip = moebius(20);
  const auto before = strip.triangles;
  EXPECT_EQ(examine(strip).holes.size(), 1U);
  EXPECT_FALSE(orient(strip));
  EXPECT_EQ(strip.triangles, before);
  Mesh fin = cases::box({0, 0, 0}, {1, 1, 1});
  fin.triangles.push_back({0, 7, 1});
  EXPECT_FALSE(orient(fin));
}

TEST(MeshNormals, SphereAndCylinder) {
  const Point3 c{1, 2, 3};
  const Mesh ball = cases::sphere(200, 100, c, 5);
  const auto normals = corner_normals(ball, 0.5);
  for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 out = unit(ball.vertices[ball.triangles[t][k]] - c);
      EXPECT_LT(norm(normals[t][k] - out), 2e-3);
    }
  }
  const Mesh shaft = cases::shaft(36, 5, 20, [](double, double) { return 4.0; });
  const auto at = corner_normals(shaft, 0.5);
  for (std::size_t t = 0; t < shaft.triangles.size(); ++t) {
    const bool end = t >= 2 * 36 * 5;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point3 p = shaft.vertices[shaft.triangles[t][k]];
      const Vec3 out = end ? Vec3{p.x > 10 ? 1.0 : -1.0, 0, 0} : unit(Vec3{0, p.y, p.z});
      // The ends of the side have fans of one and of two triangles, which lean by a part of a step.
      const bool rim = !end && (p.x == 0 || p.x == 20);
      EXPECT_LT(norm(at[t][k] - out), rim ? 0.05 : 1e-12);
    }
  }
}

TEST(MeshNormals, TheEdgesOfABoxAreCreases) {
  const Mesh box = cases::box({0, 0, 0}, {1, 2, 3});
  const auto sharp = corner_normals(box, 1.5), soft = corner_normals(box, 1.6);
  for (std::size_t t = 0; t < box.triangles.size(); ++t) {
    const auto& c = box.triangles[t];
    const Vec3 face =
        unit(cross(box.vertices[c[1]] - box.vertices[c[0]], box.vertices[c[2]] - box.vertices[c[0]]));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT(norm(sharp[t][k] - face), 1e-15);
      // One normal a corner: by angle each face counts the same, however it is cut.
      EXPECT_NEAR(dot(soft[t][k], face), 1 / std::sqrt(3), 1e-12);
    }
  }
}

TEST(MeshNormals, TrianglesWithoutAreaAreLookedThrough) {
  // A cylinder, an edge of which is split on one side only: a triangle of no height closes the T.
  Mesh mesh = cases::shaft(36, 5, 20, [](double, double) { return 4.0; });
  const auto t = mesh.triangles[80];
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(lerp(mesh.vertices[t[0]], mesh.vertices[t[1]], 0.5));
  mesh.triangles[80] = {t[0], middle, t[2]};
  mesh.triangles.push_back({middle, t[1], t[2]});
  mesh.triangles.push_back({t[0], t[1], middle});
  ASSERT_TRUE(examine(mesh).holes.empty());
  const auto normals = corner_normals(mesh, 0.5);
  for (const std::size_t i : {std::size_t{80}, mesh.triangles.size() - 2, mesh.triangles.size() - 1}) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Point3 p = mesh.vertices[mesh.triangles[i][k]];
      EXPECT_LT(norm(normals[i][k] - unit(Vec3{0, p.y, p.z})), 0.05) << i << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace burin::geom
