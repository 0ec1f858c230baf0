// SPDX-License-Identifier: Apache-2.0
// MeshIndex against brute force: distances found another way (long double, edges and plane), insideness from
// closed forms and solid angles, the ball by stepping.
#include "burin/geom/mesh/mesh_index.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "burin/geom/mesh/mesh_cases.h"
#include "burin/geom/mesh/mesh_tree.h"

namespace burin::geom {
namespace {

using L = long double;
struct V {
  L x, y, z;
};
V operator-(V a, V b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
V operator+(V a, V b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
V operator*(L s, V a) {
  return {s * a.x, s * a.y, s * a.z};
}
L dot(V a, V b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
V cross(V a, V b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
V wide(Point3 p) {
  return {p.x, p.y, p.z};
}

L to_segment(V c, V a, V b) {
  const V e = b - a;
  const L ee = dot(e, e);
  const L t = ee > 0 ? std::clamp<L>(dot(c - a, e) / ee, 0, 1) : 0;
  const V d = c - (a + t * e);
  return std::sqrt(dot(d, d));
}

/// Distance to one triangle: its edges, and its plane where the foot is inside of all three edges.
L to_triangle(const Mesh& mesh, std::size_t i, Point3 at) {
  const auto& t = mesh.triangles[i];
  const V a = wide(mesh.vertices[t[0]]), b = wide(mesh.vertices[t[1]]), c = wide(mesh.vertices[t[2]]),
          p = wide(at);
  L best = std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
  const V n = cross(b - a, c - a);
  const L nn = dot(n, n);
  if (nn > 0 && dot(cross(n, b - a), p - a) >= 0 && dot(cross(n, c - b), p - b) >= 0 &&
      dot(cross(n, a - c), p - c) >= 0)
    best = std::min(best, std::abs(dot(n, p - a)) / std::sqrt(nn));
  return best;
}

L brute(const Mesh& mesh, Point3 at) {
  L best = std::numeric_limits<L>::infinity();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) best = std::min(best, to_triangle(mesh, i, at));
  return best;
}

Point3 random_point(std::mt19937& random, double reach) {
  std::uniform_real_distribution<double> u(-reach, reach);
  return {u(random), u(random), u(random)};
}
Vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> n;
  return unit(Vec3{n(random), n(random), n(random)});
}

void expect_nearest(const Mesh& mesh, const MeshIndex& index, Point3 at, double tolerance) {
  const auto hit = index.nearest(at, 1e9);
  ASSERT_TRUE(hit.has_value());
  const L truth = brute(mesh, at);
  EXPECT_NEAR(hit->distance, static_cast<double>(truth), tolerance);
  EXPECT_NEAR(distance(at, hit->p), hit->distance, tolerance);
  EXPECT_NEAR(static_cast<double>(to_triangle(mesh, hit->triangle, at)), hit->distance, tolerance);
  EXPECT_NEAR(static_cast<double>(to_triangle(mesh, hit->triangle, hit->p)), 0, tolerance);
}

TEST(MeshIndex, NearestAgreesWithBruteForceOnSoups) {
  std::mt19937 random(1);
  for (const std::size_t count : {1U, 2U, 4U, 5U, 9U, 40U, 300U, 2000U}) {
    for (const double size : {0.01, 3.0, 80.0}) {
      const Mesh mesh = cases::soup(random, count, size);
      const MeshIndex index(mesh);
      for (int i = 0; i < 30; ++i) expect_nearest(mesh, index, random_point(random, 70), 1e-12);
      expect_nearest(mesh, index, random_point(random, 1e6), 1e-8);
    }
  }
}

TEST(MeshIndex, PointsOfTheMeshAreOnIt) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(0, 1);
  const Mesh mesh = cases::soup(random, 1500, 20);
  const MeshIndex index(mesh);
  for (const auto& t : mesh.triangles) {
    double a = u(random), b = u(random);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    const Point3 p = mesh.vertices[t[0]] + a * (mesh.vertices[t[1]] - mesh.vertices[t[0]]) +
                     b * (mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    for (const Point3 q : {p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}) {
      const auto hit = index.nearest(q, 1);
      ASSERT_TRUE(hit.has_value());
      EXPECT_LE(hit->distance, 1e-12);
    }
  }
}

TEST(MeshIndex, FarFromTheOriginOnlyItsOwnRoundingCounts) {
  std::mt19937 random(3);
  Mesh mesh = cases::soup(random, 400, 5);
  for (Point3& p : mesh.vertices) p = p + Vec3{1e6, -3e6, 2e6};
  const MeshIndex index(mesh);
  for (int i = 0; i < 100; ++i)
    expect_nearest(mesh, index, random_point(random, 70) + Vec3{1e6, -3e6, 2e6}, 1e-8);
}

TEST(MeshIndex, OnlyWhatIsNearerThanAskedFor) {
  const Mesh mesh = cases::box({0, 0, 0}, {10, 10, 10});
  const MeshIndex index(mesh);
  EXPECT_FALSE(index.nearest({5, 5, 13}, 3).has_value());
  EXPECT_TRUE(index.nearest({5, 5, 13}, 3.0000001).has_value());
  EXPECT_FALSE(index.nearest({5, 5, 13}, 0).has_value());
  EXPECT_FALSE(index.nearest({5, 5, 13}, -1).has_value());
  EXPECT_FALSE(index.nearest({5, 5, 13}, std::nan("")).has_value());
  EXPECT_TRUE(index.nearest({5, 5, 13}, std::numeric_limits<double>::infinity()).has_value());
}

TEST(MeshIndex, OfEquallyNearTrianglesTheLowest) {
  Mesh mesh;
  for (int i = 0; i < 100; ++i) {
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}});
    mesh.triangles.push_back({n, n + 1, n + 2});
  }
  const MeshIndex index(mesh);
  for (const Point3 at : {Point3{1, 1, 2}, Point3{-1, -1, 0}, Point3{9, 0, 0}}) {
    const auto hit = index.nearest(at, 100);
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->triangle, 0U);
  }
}

TEST(MeshIndex, WhatIsNoTriangleIsLeftAside) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {nan, 0, 0}, {inf, 0, 0}, {1e300, 0, 0}};
  mesh.triangles = {{0, 1, 3}, {0, 1, 4}, {0, 1, 5}, {0, 1, 77}, {0, 1, 2}};
  const MeshIndex index(mesh);
  const auto hit = index.nearest({0.2, 0.2, 1}, 10);
  ASSERT_TRUE(hit.has_value());
  EXPECT_EQ(hit->triangle, 4U);
  EXPECT_EQ(index.bounds().hi.x, 1);

  const MeshIndex none{Mesh{}};
  EXPECT_FALSE(none.nearest({}, 10).has_value());
  EXPECT_FALSE(none.inside({}));
  EXPECT_TRUE(none.bounds().empty());
  EXPECT_EQ(none.ball_out({}, {1, 0, 0}, 1, 0, 10, 1e-6), 0.0);
}

TEST(MeshIndex, QuestionsThatAreNoPlaces) {
  const Mesh mesh = cases::sphere(20, 10, {}, 5);
  const MeshIndex index(mesh);
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(index.nearest({nan, 0, 0}, inf).has_value());
  EXPECT_FALSE(index.nearest({0, inf, 0}, inf).has_value());
  EXPECT_FALSE(index.inside({nan, 0, 0}));
  EXPECT_FALSE(index.ball_out({nan, 0, 0}, {1, 0, 0}, 1, 0, 10, 1e-6).has_value());
  EXPECT_FALSE(index.ball_out({}, {nan, 0, 0}, 1, 0, 10, 1e-6).has_value());
  EXPECT_FALSE(index.ball_out({}, {1, 0, 0}, nan, 0, 10, 1e-6).has_value());
  EXPECT_FALSE(index.ball_out({}, {1, 0, 0}, 1, 0, -1, 1e-6).has_value());
  EXPECT_FALSE(index.ball_out({}, {1, 0, 0}, 1, 0, nan, 1e-6).has_value());
  for (const double far : {1e14, 1e16, 1e40, 1e150}) {
    const auto hit = index.nearest({far, 0, 0}, inf);
    ASSERT_TRUE(hit.has_value()) << far;
    EXPECT_NEAR(hit->distance / far, 1, 1e-12);
  }
}

TEST(MeshIndex, TheSameBitsWithAndWithoutAvx2) {
  std::mt19937 random(4);
  const Mesh mesh = cases::soup(random, 3000, 10);
  const detail::MeshTree tree = detail::build_tree(mesh);
  const detail::TreeView view{tree.nodes.data(), tree.packets.data(), &mesh.vertices.data()->x,
                              mesh.triangles.data()->data()};
  for (int i = 0; i < 500; ++i) {
    const auto at = detail::place_in(tree, random_point(random, 70));
    detail::TreeNearest a{1e30, 0, 0, -1}, b = a;
    detail::tree_kernels_any().nearest(view, at, a);
    detail::tree_kernels_avx2().nearest(view, at, b);
    EXPECT_EQ(std::memcmp(&a.distance2, &b.distance2, sizeof(double)), 0);
    EXPECT_EQ(a.triangle, b.triangle);
    EXPECT_EQ(detail::tree_kernels_any().turns_above(view, at),
              detail::tree_kernels_avx2().turns_above(view, at));
  }
}

TEST(MeshIndex, LopsidedMeshesDoNotMakeDeepTrees) {
  // Each triangle is a tenth nearer to the origin than the one before: splits that cut off one at a time.
  Mesh mesh;
  double x = 1e11;
  for (std::uint32_t i = 0; i < 3000; ++i, x *= 0.9) {
    mesh.vertices.insert(mesh.vertices.end(), {{x, 0, 0}, {x * 1.01, 0, 0}, {x, x * 0.01, 0}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  for (std::uint32_t i = 0; i < 3000; ++i)
    mesh.triangles.push_back(mesh.triangles[2999]);  // all in one place
  const MeshIndex index(mesh);
  for (const double at : {1e10, 1.0, 1e-6, 0.0, -1.0}) {
    const auto hit = index.nearest({at, 0, 0}, std::numeric_limits<double>::infinity());
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR(hit->distance, static_cast<double>(brute(mesh, {at, 0, 0})), 1e-5 * std::abs(at) + 1e-12);
  }
}

TEST(MeshIndex, InsideOfSolids) {
  std::mt19937 random(5);
  const Mesh ball = cases::sphere(60, 30, {1, 2, 3}, 10), ring = cases::torus(40, 80, 10, 3);
  const MeshIndex in_ball(ball), in_ring(ring);
  for (int i = 0; i < 3000; ++i) {
    const Point3 p = random_point(random, 14);
    const double r = distance(p, {1, 2, 3});
    // Between the polyhedron and the sphere nothing is said.
    if (r < 9.9 || r > 10) {
      EXPECT_EQ(in_ball.inside(p), r < 10) << p.x << ' ' << p.y << ' ' << p.z;
    }
    const double q = std::hypot(std::hypot(p.y, p.z) - 10, p.x);
    if (q < 2.9 || q > 3) {
      EXPECT_EQ(in_ring.inside(p), q < 3);
    }
  }
}

TEST(MeshIndex, InsideAtEdgesAndCornersOfTheMesh) {
  // Lines up through corners and along edges: never counted twice or not at all.
  Mesh mesh;
  constexpr std::uint32_t n = 6;
  for (std::uint32_t k = 0; k < 2; ++k) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      for (std::uint32_t i = 0; i <= n; ++i) mesh.vertices.push_back({double(i), double(j), k ? 4.0 : 0.0});
    }
  }
  const std::uint32_t row = n + 1, top = row * row;
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * row + i;
      mesh.triangles.push_back({a, a + row, a + 1});
      mesh.triangles.push_back({a + 1, a + row, a + row + 1});
      mesh.triangles.push_back({top + a, top + a + 1, top + a + row});
      mesh.triangles.push_back({top + a + 1, top + a + row + 1, top + a + row});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (const auto& [a, b] : {std::pair{i, i + 1}, std::pair{n + row * i, n + row * (i + 1)},
                               std::pair{row * n + i + 1, row * n + i}, std::pair{row * (i + 1), row * i}}) {
      mesh.triangles.push_back({a, b, top + b});
      mesh.triangles.push_back({a, top + b, top + a});
    }
  }
  const MeshIndex index(mesh);
  for (int i = -2; i <= 14; ++i) {
    for (int j = -2; j <= 14; ++j) {
      for (const double z : {-1.0, 1.0, 2.0, 5.0}) {
        const double x = 0.5 * i, y = 0.5 * j;
        if (x == 0 || x == 6 || y == 0 || y == 6) continue;  // on the surface
        EXPECT_EQ(index.inside({x, y, z}), x > 0 && x < 6 && y > 0 && y < 6 && z > 0 && z < 4)
            << x << ' ' << y << ' ' << z;
      }
    }
  }
}

TEST(MeshIndex, ShellsInEachOther) {
  Mesh mesh = cases::sphere(40, 20, {}, 10);
  Mesh hollow = cases::sphere(40, 20, {}, 5);
  const auto add = [&](const Mesh& other, bool turned) {
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (auto t : other.triangles) {
      if (turned) std::swap(t[1], t[2]);
      mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
    }
  };
  add(hollow, true);
  add(cases::sphere(40, 20, {8, 0, 0}, 10), false);  // runs through the first
  const MeshIndex index(mesh);
  EXPECT_FALSE(index.inside({-3, 0.1, 0}));
  EXPECT_TRUE(index.inside({-7, 0.1, 0}));
  EXPECT_TRUE(index.inside({7, 0.1, 0}));
  EXPECT_TRUE(index.inside({17, 0.1, 0}));
  EXPECT_FALSE(index.inside({19, 0.1, 0}));
}

/// The first t at which the ball is free, by small steps.
std::optional<double> stepped(const Mesh& mesh, const MeshIndex& index, Point3 c, Vec3 d, double need,
                              double limit, double step) {
  for (double t = 0; t <= limit; t += step) {
    if (static_cast<double>(brute(mesh, c + t * d)) >= need && !index.inside(c + t * d)) return t;
  }
  return std::nullopt;
}

TEST(MeshIndex, BallOutAgreesWithSteppingOnSolids) {
  std::mt19937 random(6);
  const Mesh mesh = cases::cutter(450, 20, 12, 6, 7, 0.3);
  const MeshIndex index(mesh);
  int found = 0;
  for (int i = 0; i < 20; ++i) {
    const Point3 c = random_point(random, 10) + Vec3{10, 0, 0};
    const Vec3 d = random_direction(random);
    constexpr double kStep = 0.02;
    const auto truth = stepped(mesh, index, c, d, 1.9, 15, kStep);
    const auto t = index.ball_out(c, d, 2, 0.1, 15, 1e-6);
    if (!t) {
      EXPECT_FALSE(truth.has_value());
      continue;
    }
    ++found;
    // Free where it says, and not between any two steps before. Stepping may pass over a narrow free place.
    EXPECT_GE(static_cast<double>(brute(mesh, c + *t * d)), 1.9 - 1e-9);
    EXPECT_FALSE(index.inside(c + *t * d));
    if (truth) {
      EXPECT_LE(*t, *truth + 1e-6);
    }
    for (double s = 0; s < *t - 2e-6; s += kStep)
      EXPECT_FALSE(static_cast<double>(brute(mesh, c + s * d)) >= 1.9 && !index.inside(c + s * d));
  }
  EXPECT_GT(found, 5);
}

TEST(MeshIndex, BallOutOnSoups) {
  std::mt19937 random(7);
  const Mesh mesh = cases::soup(random, 300, 15);
  const MeshIndex index(mesh);
  for (int i = 0; i < 60; ++i) {
    const Point3 c = random_point(random, 50);
    const Vec3 d = random_direction(random);
    const auto t = index.ball_out(c, d, 4, 0, 200, 1e-7);
    ASSERT_TRUE(t.has_value());
    EXPECT_GE(static_cast<double>(brute(mesh, c + *t * d)), 4 - 1e-9);
    EXPECT_FALSE(index.inside(c + *t * d));
  }
}

TEST(MeshIndex, BallOutOfClosedForms) {
  const Mesh mesh = cases::box({-20, -20, -5}, {20, 20, 5});
  const MeshIndex index(mesh);
  const double accuracy = 1e-9;
  // Up from anywhere in the plate: onto its top. Deeper by `allowed`.
  for (const double z : {-4.9, 0.0, 4.9, 5.0, 6.0}) {
    EXPECT_NEAR(index.ball_out({1, 2, z}, {0, 0, 1}, 3, 0, 50, accuracy).value(), 8 - z, 1e-9);
    EXPECT_NEAR(index.ball_out({1, 2, z}, {0, 0, 1}, 3, 0.25, 50, accuracy).value(), 7.75 - z, 1e-9);
    EXPECT_NEAR(index.ball_out({1, 2, z}, {0, 0, 1}, 3, -0.5, 50, accuracy).value(), 8.5 - z, 1e-9);
  }
  EXPECT_EQ(index.ball_out({0, 0, 8}, {0, 0, 1}, 3, 0, 50, accuracy).value(), 0);
  EXPECT_FALSE(index.ball_out({0, 0, 0}, {0, 0, 1}, 3, 0, 7.9, accuracy).has_value());
  // A ball of no size: only out of the solid.
  EXPECT_NEAR(index.ball_out({0, 0, 1}, {0, 0, 1}, 0, 0, 50, accuracy).value(), 4, 1e-8);
  // Obliquely, and against an edge: the line from (0, 0, 0) along (1, 0, 1) leaves the edge's round.
  const double s = std::sqrt(0.5);
  EXPECT_NEAR(index.ball_out({0, 0, 0}, {s, 0, s}, 3, 0, 50, accuracy).value(), 8 / s, 1e-9);
  // From (15, 0, 0): to touch the edge (20, ., 5) along the diagonal.
  EXPECT_NEAR(index.ball_out({15, 0, 0}, {s, 0, s}, 3, 0, 50, accuracy).value(), 5 / s + 3, 1e-9);
}

TEST(MeshIndex, BallAlongAWall) {
  // Sliding along a cylinder at just less than its distance: every triangle of the way stops it again.
  const Mesh mesh = cases::shaft(64, 400, 100, [](double, double) { return 10.0; });
  const MeshIndex index(mesh);
  const double apothem = 10 * std::cos(kPi / 64);
  const double y = (apothem + 2 - 1e-7) * std::cos(kPi / 64), z = (apothem + 2 - 1e-7) * std::sin(kPi / 64);
  const auto t = index.ball_out({5, y, z}, {1, 0, 0}, 2, 0, 200, 1e-6);
  ASSERT_TRUE(t.has_value());
  EXPECT_NEAR(*t, 95 + std::sqrt(4 - (2 - 1e-7) * (2 - 1e-7)), 1e-6);
}

}  // namespace
}  // namespace burin::geom
