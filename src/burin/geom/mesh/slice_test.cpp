// SPDX-License-Identifier: Apache-2.0
// Sections of solids: closed whatever the plane, of the area that they must have.
#include "burin/geom/mesh/slice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/mesh_cases.h"

namespace burin::geom {
namespace {

double area(const SliceLoop& loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    const Point3 a = loop.points[i].p, b = loop.points[(i + 1) % loop.points.size()].p;
    sum += 0.5 * (a.y * b.z - b.y * a.z);
  }
  return sum;
}

double total_area(const std::vector<SliceLoop>& loops) {
  double sum = 0;
  for (const SliceLoop& loop : loops) sum += area(loop);
  return sum;
}

void expect_closed(const std::vector<SliceLoop>& loops, double x) {
  for (const SliceLoop& loop : loops) {
    EXPECT_TRUE(loop.closed) << x;
    EXPECT_GE(loop.points.size(), 3U);
    for (std::size_t i = 0; i < loop.points.size(); ++i) {
      const SlicePoint& p = loop.points[i];
      EXPECT_EQ(p.p.x, x);
      EXPECT_FALSE(p.p == loop.points[(i + 1) % loop.points.size()].p);
      EXPECT_NEAR(norm(p.normal), 1, 1e-9);
      EXPECT_NEAR(norm(p.normal_before), 1, 1e-9);
    }
  }
}

bool same(const std::vector<SliceLoop>& a, const std::vector<SliceLoop>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const SliceLoop& p, const SliceLoop& q) {
    return p.closed == q.closed && std::equal(p.points.begin(), p.points.end(), q.points.begin(),
                                              q.points.end(), [](const SlicePoint& s, const SlicePoint& t) {
                                                return s.p == t.p && s.normal == t.normal &&
                                                       s.normal_before == t.normal_before &&
                                                       s.triangle == t.triangle;
                                              });
  });
}

TEST(Slice, SphereAtAnyHeight) {
  const Mesh mesh = cases::sphere(120, 60, {1, 2, 3}, 10);
  const auto normals = corner_normals(mesh, 0.5);
  const Slicer slicer(mesh, normals);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-9.3, 11.3);
  std::vector<double> places;
  for (int i = 0; i < 60; ++i) places.push_back(u(random));
  for (const Point3& v : mesh.vertices) places.push_back(v.x);  // vertices exactly in the plane
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  for (const double x : places) {
    const auto loops = slicer.at(x);
    EXPECT_TRUE(same(loops, slice_x(mesh, normals, x)));
    if (x < -9 || x >= 11) {
      EXPECT_TRUE(loops.empty());
      continue;
    }
    expect_closed(loops, x);
    if (x - 1 < -9.99 || x - 1 > 9.99) continue;
    ASSERT_EQ(loops.size(), 1U) << x;
    const double disc = kPi * (100 - (x - 1) * (x - 1));
    EXPECT_NEAR(area(loops[0]), disc, 0.6);
    for (const SlicePoint& p : loops[0].points) EXPECT_LT(norm(p.normal - unit(p.p - Point3{1, 2, 3})), 5e-3);
  }
}

TEST(Slice, PlanesThroughFacesEdgesAndCorners) {
  const Mesh box = cases::box({0, 0, 0}, {4, 2, 3});
  const auto normals = corner_normals(box, 0.5);
  // Vertices in the plane lie above: nothing at the lower face, the loop just inside at the upper one.
  EXPECT_TRUE(slice_x(box, normals, 0).empty());
  EXPECT_TRUE(slice_x(box, normals, 4.0000001).empty());
  for (const double x : {1e-9, 1.0, 2.5, 4.0}) {
    const auto loops = slice_x(box, normals, x);
    expect_closed(loops, x);
    ASSERT_EQ(loops.size(), 1U);
    EXPECT_NEAR(area(loops[0]), 6, 1e-9);
    for (const SlicePoint& p : loops[0].points) {
      // Corners have the normals of both sides, points on a side one.
      const bool corner = (p.p.y == 0 || p.p.y == 2) && (p.p.z == 0 || p.p.z == 3);
      EXPECT_NEAR(norm(p.normal - p.normal_before), corner ? std::sqrt(2) : 0, 1e-12)
          << p.p.y << ' ' << p.p.z;
    }
  }
  // A tip that just touches the plane from below.
  Mesh tip = cases::shaft(12, 6, 10, [](double, double x) { return 5 - 0.5 * x; });
  tip = welded(tip, 0);
  const auto n = corner_normals(tip, 0.5);
  EXPECT_TRUE(slice_x(tip, n, 10).empty());
  ASSERT_EQ(slice_x(tip, n, 9.99).size(), 1U);
}

TEST(Slice, HolesRunClockwise) {
  const Mesh ring = cases::torus(40, 80, 10, 3);
  const auto normals = corner_normals(ring, 0.6);
  for (const double x : {-2.5, -1.0, 0.0, 0.7, 2.5}) {
    const auto loops = slice_x(ring, normals, x);
    expect_closed(loops, x);
    ASSERT_EQ(loops.size(), 2U);
    EXPECT_EQ(std::count_if(loops.begin(), loops.end(), [](const SliceLoop& l) { return area(l) < 0; }), 1);
    const double w = std::sqrt(9 - x * x), annulus = kPi * ((10 + w) * (10 + w) - (10 - w) * (10 - w));
    EXPECT_NEAR(total_area(loops), annulus, 0.02 * annulus);
  }
}

TEST(Slice, VolumeIsTheIntegralOfTheSections) {
  const Mesh mesh = cases::cutter(4000, 30, 12, 6, 7, 0.4);
  const auto normals = corner_normals(mesh, 0.4);
  const Slicer slicer(mesh, normals);
  constexpr int n = 3000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double x = 30 * (i + 0.5) / n;
    const auto loops = slicer.at(x);
    expect_closed(loops, x);
    sum += total_area(loops) * 30 / n;
  }
  const double volume = examine(mesh).signed_volume;
  EXPECT_NEAR(sum, volume, 1e-5 * volume);
}

TEST(Slice, OpenWhereTheMeshHasAHole) {
  Mesh mesh = cases::shaft(24, 10, 20, [](double, double) { return 5.0; });
  mesh.triangles.erase(mesh.triangles.begin() + 2 * 24 * 5 + 7);
  const auto normals = corner_normals(mesh, 0.5);
  const auto loops = slice_x(mesh, normals, 11);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_FALSE(loops[0].closed);
  EXPECT_EQ(loops[0].points.size(), 48U);  // 47 pieces and where the last ends
  const auto whole = slice_x(mesh, normals, 7);
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_TRUE(whole[0].closed);
}

TEST(Slice, LoopsInTheOrderOfTheirLowestTriangles) {
  Mesh mesh;
  for (int i = 0; i < 5; ++i) {
    const Mesh one = cases::box({0, 4.0 * ((i * 3) % 5), 0}, {4, 4.0 * ((i * 3) % 5) + 2, 3});
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), one.vertices.begin(), one.vertices.end());
    for (const auto& t : one.triangles) mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  const auto loops = slice_x(mesh, corner_normals(mesh, 0.5), 1);
  ASSERT_EQ(loops.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(loops[i].points[0].triangle / 12, i);
}

TEST(Slice, NothingOfNothing) {
  const Mesh none;
  EXPECT_TRUE(slice_x(none, {}, 0).empty());
  const std::vector<std::array<Vec3, 3>> normals;
  EXPECT_TRUE(Slicer(none, normals).at(1).empty());
  const Mesh box = cases::box({0, 0, 0}, {4, 2, 3});
  const auto n = corner_normals(box, 0.5);
  EXPECT_TRUE(Slicer(box, n).at(std::nan("")).empty());
  EXPECT_TRUE(Slicer(box, n).at(1e300).empty());
  EXPECT_TRUE(Slicer(box, n).at(-1e300).empty());
}

}  // namespace
}  // namespace burin::geom
