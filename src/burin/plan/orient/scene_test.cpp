// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/scene.h"

#include <gtest/gtest.h>

#include <cstring>

#include "burin/plan/orient/scene_cases.h"
#include "burin/plan/orient/scene_piece.h"

namespace burin::orient {
namespace {

using namespace cases;

constexpr double kDegree = geom::kPi / 180;

/// What is neither clearly blocked nor clearly free by the slow way is not compared.
constexpr double kUnsure = 1e-4;

TEST(ScenePiece, AsBySubdivision) {
  Random r(1);
  int blocked = 0, free = 0;
  for (int n = 0; n < 6000; ++n) {
    BodyPiece p;
    p.radius = r.between(0, 1) < 0.1 ? 0 : r.between(0.1, 5);
    p.from = r.between(-3, 3);
    p.to = r.between(0, 1) < 0.2 ? p.from : p.from + r.between(0, 6);
    p.grow = n % 2 ? r.between(0.05, 2) : 0;
    const double size = std::pow(10, r.between(-1, 1.2));
    std::array<Point3, 3> t;
    const Point3 middle = Point3{} + r.vector(6);
    for (Point3& q : t) q = middle + r.vector(size);
    if (n % 7 == 0) t[2] = lerp(t[0], t[1], r.between(0, 1));
    if (n % 11 == 0) t[2].z = t[1].z = t[0].z;
    const cl::Pose pose{{0, 0, 0}, {0, 0, 1}};
    const detail::Piece piece{p.radius, p.from, p.to, p.grow};
    const detail::Corners corners{
        {{t[0].x, t[0].y, t[0].z}, {t[1].x, t[1].y, t[1].z}, {t[2].x, t[2].y, t[2].z}}};
    const detail::Deepest d = detail::deepest(corners, piece);
    EXPECT_EQ(d.value < 0, detail::meets(corners, piece));
    if (d.value < 0) {
      EXPECT_LE(detail::excess(d.at, piece), 0);
    }
    // Nothing else of the triangle is nearer: around the place found, and all over.
    for (int k = 0; k < 40 && (p.grow > 0 || d.value > 0); ++k) {
      double u = r.between(0, 1), v = r.between(0, 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Point3 q = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]), at{d.at.x, d.at.y, d.at.h};
      for (const double share : {1.0, 0.1, 1e-3}) {
        const double value = std::max(outside(lerp(at, q, share), pose, p), -p.grow);
        EXPECT_GE(value, (p.grow > 0 ? d.value : 0) - 1e-9) << n;
      }
    }
    const int expected = decide(t, pose, p, kUnsure);
    if (expected == 0) continue;
    (expected < 0 ? blocked : free) += 1;
    ASSERT_EQ(detail::meets(corners, piece), expected < 0) << n;
  }
  EXPECT_GT(blocked, 500);
  EXPECT_GT(free, 1000);
}

struct Situation {
  Mesh mesh;
  model::Mill mill;
  std::vector<BodyPiece> body;
  CcPoint at;
};

Situation situation(Random& r, int kind) {
  Situation s;
  const double radius = r.between(3, 8);
  s.mill = r.between(0, 1) < 0.5 ? flat(radius, 8) : bull(radius, r.between(0.3, 1) * radius * 0.6, 8);
  s.mill.holder = {{r.between(2, 9), 10}, {r.between(4, 15), 15}};
  s.body = tool_body(s.mill, 0.01, 0.5);
  const auto wave = [a = r.between(0, 0.5), b = r.between(0.1, 0.5), c = r.between(0, 6)](double x,
                                                                                          double y) {
    return a * std::sin(b * x + c) * std::cos(b * y) + 0.01 * x * y;
  };
  switch (kind % 4) {
    case 0:
      s.mesh = soup(r, 60, 25, 6);
      break;
    case 1:
      s.mesh = height_field(20, 14, wave);
      break;
    case 2:  // a wall on a wavy ground
      s.mesh = height_field(20, 10, wave);
      add_quad(s.mesh, {r.between(4, 12), -20, -1}, {0, 40, 0}, {r.between(-2, 2), 0, 25}, 3, 4);
      break;
    default:  // a slot
      add_quad(s.mesh, {-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, 5, 5);
      add_quad(s.mesh, {-20, r.between(-14, -6), 0}, {40, 0, 0}, {0, 0, 30}, 4, 3);
      add_quad(s.mesh, {-20, r.between(6, 14), 0}, {40, 0, 0}, {0, 0, 30}, 4, 3);
  }
  const double x = r.between(-6, 6), y = r.between(-4, 4);
  Point3 c{x, y, 0};
  Vec3 n{0, 0, 1};
  if (kind % 4 == 1 || kind % 4 == 2) {
    c.z = wave(x, y);
    const double h = 1e-5;
    n = {(wave(x - h, y) - wave(x + h, y)) / (2 * h), (wave(x, y - h) - wave(x, y + h)) / (2 * h), 1};
  }
  s.at = contact(c, n, {std::cos(r.between(0, 6)), std::sin(r.between(0, 6)), 0});
  return s;
}

TEST(Scene, BlockedAsBySubdivision) {
  Random r(2);
  int blocked = 0, free = 0;
  for (int n = 0; n < 60; ++n) {
    const Situation s = situation(r, n);
    const Scene scene(s.mesh, s.mill, s.body);
    Scene::Memory memory;
    for (int k = 0; k < 12; ++k) {
      const Angles angles{r.between(0, 60) * kDegree, r.between(-90, 90) * kDegree};
      cl::Pose pose = orient::pose(s.at, angles, s.mill);
      if (n % 4 == 0) pose.tip = pose.tip + r.vector(10);
      const int expected = decide(s.mesh, pose, s.body, kUnsure);
      if (expected == 0) continue;
      (expected < 0 ? blocked : free) += 1;
      const auto b = scene.blocker(pose, memory);
      ASSERT_EQ(b.has_value(), expected < 0) << n << " " << k;
      if (b) {
        const auto& t = s.mesh.triangles[b->triangle];
        const auto& v = s.mesh.vertices;
        EXPECT_LE(decide({v[t[0]], v[t[1]], v[t[2]]}, pose, s.body[b->piece], kUnsure), 0);
      }
      const auto cutter = s.body.begin() + (s.mill.corner_radius > 0 ? 2 : 1);
      const int gouge = decide(s.mesh, pose, {s.body.begin(), cutter}, kUnsure);
      if (gouge == 0) continue;
      EXPECT_EQ(scene.cause(pose, memory), gouge < 0 ? Cause::gouge : b ? Cause::collision : Cause::none);
    }
  }
  EXPECT_GT(blocked, 80);
  EXPECT_GT(free, 80);
}

/// First free tilt against stepping over the tilts; the tilt just before it is blocked.
TEST(Scene, FirstFreeAsByStepping) {
  Random r(3);
  int moved = 0, never = 0;
  for (int n = 0; n < 400; ++n) {
    const Situation s = situation(r, n);
    const Scene scene(s.mesh, s.mill, s.body);
    const double beta = r.between(-90, 90) * kDegree, from = r.between(0, 5) * kDegree, to = 40 * kDegree;
    Scene::Memory memory, other;
    const auto found = scene.first_free(s.at, beta, from, to, memory);
    const auto is_free = [&](double a) {
      return !scene.blocker(orient::pose(s.at, {a, beta}, s.mill), other).has_value();
    };
    constexpr double kStep = 1e-3;
    double a = from;
    for (; a < found.alpha - 1e-9; a += kStep) ASSERT_FALSE(is_free(a)) << n << " " << a - found.alpha;
    if (!found.found) {
      ++never;
      EXPECT_EQ(found.alpha, to);
      EXPECT_FALSE(is_free(to));
      EXPECT_NE(found.cause, Cause::none);
      EXPECT_TRUE(found.witness.has_value());
      continue;
    }
    EXPECT_TRUE(is_free(found.alpha));
    EXPECT_EQ(found.alpha > from, found.witness.has_value());
    if (found.alpha == from) continue;
    ++moved;
    EXPECT_FALSE(is_free(found.alpha - 1e-9)) << n;
    const auto& w = *found.witness;
    EXPECT_EQ(s.body[w.piece].cause, found.cause);
    EXPECT_FALSE(scene.blocks(w, orient::pose(s.at, {found.alpha + 1e-8, beta}, s.mill)));
    EXPECT_NEAR(scene.blocked_until(w, s.at, beta, found.alpha - 2e-9, to), found.alpha, 3e-9);
  }
  EXPECT_GT(moved, 60);
  EXPECT_GT(never, 5);
}

/// Answers do not depend on what was asked before.
TEST(Scene, MemoryChangesNothing) {
  Random r(4);
  for (int n = 0; n < 40; ++n) {
    const Situation s = situation(r, n);
    const Scene scene(s.mesh, s.mill, s.body);
    Scene::Memory used;
    for (int k = 0; k < 10; ++k) {
      const double beta = r.between(-90, 90) * kDegree, from = r.between(0, 20) * kDegree;
      Scene::Memory fresh;
      const auto a = scene.first_free(s.at, beta, from, 1, used),
                 b = scene.first_free(s.at, beta, from, 1, fresh);
      EXPECT_EQ(a.found, b.found);
      EXPECT_EQ(a.alpha, b.alpha);
      const cl::Pose pose = orient::pose(s.at, {from, beta}, s.mill);
      EXPECT_EQ(scene.cause(pose, used), scene.cause(pose, fresh));
      EXPECT_GT(used.tests, fresh.tests - 1);
    }
  }
}

TEST(Scene, WitnessAsByStepping) {
  Random r(5);
  int ends = 0;
  for (int n = 0; n < 400; ++n) {
    const double radius = r.between(3, 8);
    const model::Mill mill = n % 2 ? flat(radius, 8) : bull(radius, r.between(0.2, 1) * radius, 8);
    BodyPiece p{r.between(0, 6), 0, 0, n % 3 ? r.between(0.1, 3) : 0, Cause::gouge};
    p.from = r.between(-2, 6);
    p.to = p.from + (n % 5 ? r.between(0.1, 8) : 0);
    const Scene scene({}, mill, {p});
    const CcPoint at = contact(Point3{} + r.vector(20), r.direction(), r.direction());
    const double beta = r.between(-1.5, 1.5), alpha = r.between(0.001, 1);
    const cl::Pose pose = orient::pose(at, {alpha, beta}, mill);
    const Vec3 side = geom::unit(cross(pose.axis, r.direction()));
    const Witness w{pose.tip + r.between(p.from - p.grow, p.to + p.grow) * pose.axis +
                        r.between(0, p.radius + p.grow) * side,
                    0};
    const double value = outside(w.q, pose, p);
    if (std::abs(value) < 1e-8) continue;
    EXPECT_EQ(scene.blocks(w, pose), value < 0);
    const double until = scene.blocked_until(w, at, beta, alpha, 1.2);
    const auto value_at = [&](double a) { return outside(w.q, orient::pose(at, {a, beta}, mill), p); };
    if (value > 0) {
      EXPECT_EQ(until, alpha);
      continue;
    }
    EXPECT_GE(until, alpha);
    EXPECT_LE(until, 1.2);
    for (double a = alpha; a < until - 1e-7; a += 1e-3) ASSERT_LT(value_at(a), 1e-9) << n;
    if (until < 1.2) {
      ++ends;
      EXPECT_NEAR(value_at(until), 0, 1e-7) << n;
      EXPECT_GT(value_at(until + 1e-6), -1e-7) << n;
    }
  }
  EXPECT_GT(ends, 60);
}

TEST(Scene, Plane) {
  Mesh mesh;
  add_quad(mesh, {-100, -100, 0}, {200, 0, 0}, {0, 200, 0}, 3, 3);
  for (const double corner : {0.0, 2.0, 10.0}) {
    const model::Mill mill = corner > 0 ? bull(10, corner, 20) : flat(10, 20);
    const CcPoint at = contact({3, 4, 0}, {0, 0, 1}, {1, 0, 0});
    Scene::Memory memory;
    for (const double tol : {0.0, 0.01}) {
      const Scene scene(mesh, mill, tool_body(mill, tol, 1));
      for (double a = 0; a < 89 * kDegree; a += 0.05) {
        cl::Pose pose = orient::pose(at, {a, 0.3}, mill);
        EXPECT_FALSE(scene.blocker(pose, memory)) << corner << " " << a;
        pose.tip.z -= tol + 1e-6;
        EXPECT_TRUE(corner == 0 && tol > 0 && a > 0 ? true : scene.blocker(pose, memory).has_value());
        pose.tip.z -= tol + 1e-6;
        EXPECT_TRUE(scene.blocker(pose, memory)) << corner << " " << a;
      }
    }
  }
}

/// The rim of a disc in a bowl: the farthest place of the rim from the bowl's centre.
TEST(Scene, Bowl) {
  const double bowl = 100, radius = 20, tol = 0.01;
  const Mesh mesh = height_field(
      60, 120, [&](double x, double y) { return bowl - std::sqrt(bowl * bowl - x * x - y * y); });
  const model::Mill mill = flat(radius, 10);
  const Scene scene(mesh, mill, tool_body(mill, tol, 1));
  Scene::Memory memory;
  const CcPoint at = contact({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  const auto tilt_for = [&](double sphere) {
    double lo = 0, hi = 0.5;
    for (int i = 0; i < 60; ++i) {
      const double a = 0.5 * (lo + hi);
      const double far =
          std::hypot(std::abs(bowl * std::sin(a) - radius) + radius - tol, bowl * std::cos(a) - tol);
      (far > sphere ? lo : hi) = a;
    }
    return lo;
  };
  const double sag =
      1.01 * 0.5 / (2 * bowl);  // a cell's half diagonal, 0.71, squared; steeper cells are longer
  for (const double beta : {-1.5, -0.7, 0.0, 0.4, 1.2}) {
    const auto found = scene.first_free(at, beta, 0.01, 0.5, memory);
    ASSERT_TRUE(found.found);
    EXPECT_EQ(found.cause, Cause::gouge);
    EXPECT_GE(found.alpha, tilt_for(bowl) - 1e-6);
    EXPECT_LE(found.alpha, tilt_for(bowl - sag * 1.3));
  }
}

/// A wall beside the path: the side of a cutter that leans against it, first tilt at which it is blocked.
TEST(Scene, WallLimitsTheLean) {
  const double radius = 10, length = 30, wall = 14;
  Mesh mesh;
  add_quad(mesh, {-200, wall, -50}, {400, 0, 0}, {0, 0, 400}, 1, 1);
  const model::Mill mill = flat(radius, length);
  const Scene scene(mesh, mill, tool_body(mill, 0, 0));
  Scene::Memory memory;
  // f along x, t = y: yaw 90 degrees leans to +y. The tool stands on the contact point at its far side:
  // y of the top rim: sin(a) length - cos(a) R + cos(a) R.
  const CcPoint at = contact({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  const double limit = std::asin(wall / length);
  const auto free_at = [&](double a) {
    return !scene.blocker(orient::pose(at, {a, geom::kPi / 2}, mill), memory);
  };
  EXPECT_TRUE(free_at(0.1));
  EXPECT_TRUE(free_at(limit - 1e-9));
  EXPECT_FALSE(free_at(limit + 1e-9));
  EXPECT_EQ(scene.cause(orient::pose(at, {limit + 1e-3, geom::kPi / 2}, mill), memory), Cause::gouge);
  const auto found = scene.first_free(at, geom::kPi / 2, limit + 0.01, 1.2, memory);
  EXPECT_FALSE(found.found);
}

TEST(Scene, NothingBlocksNothing) {
  const model::Mill mill = flat(5, 10);
  const CcPoint at = contact({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  Scene::Memory memory;
  Mesh point;
  add(point, {0, 0, 5}, {0, 0, 5}, {0, 0, 5});
  const Scene no_mesh({}, mill, tool_body(mill, 0.01, 1)), no_body(point, mill, {}),
      both(point, mill, tool_body(mill, 0.01, 1));
  EXPECT_FALSE(no_mesh.blocker(pose(at, {0.1, 0}, mill), memory));
  EXPECT_FALSE(no_body.blocker(pose(at, {0.1, 0}, mill), memory));
  EXPECT_TRUE(no_mesh.first_free(at, 0, 0.1, 0.2, memory).found);
  EXPECT_EQ(no_mesh.first_free(at, 0, 0.1, 0.2, memory).alpha, 0.1);
  EXPECT_TRUE(both.blocker({{0, 0, 0}, {0, 0, 1}}, memory));
  EXPECT_EQ(both.triangle_count(), 1u);
  EXPECT_TRUE(tool_body(mill, 6, 1).empty());
  EXPECT_EQ(tool_body(mill, 0.5, 1).size(), 1u);
}

/// Large coordinates lose digits, no more.
TEST(Scene, FarFromTheOrigin) {
  Random r(7);
  const Vec3 far{1e6, -7e5, 3e5};
  for (int n = 0; n < 20; ++n) {
    const Situation s = situation(r, n);
    Mesh moved = s.mesh;
    for (Point3& q : moved.vertices) q = q + far;
    const Scene scene(s.mesh, s.mill, s.body), away(moved, s.mill, s.body);
    Scene::Memory a, b;
    for (int k = 0; k < 20; ++k) {
      cl::Pose pose = orient::pose(s.at, {r.between(0, 1), r.between(-1.5, 1.5)}, s.mill);
      const bool near = scene.blocker(pose, a).has_value();
      // Clearly one or the other: also when raised and lowered a little.
      cl::Pose up = pose, down = pose;
      up.tip = up.tip + 1e-4 * s.at.n;
      down.tip = down.tip - 1e-4 * s.at.n;
      if (scene.blocker(up, a).has_value() != near || scene.blocker(down, a).has_value() != near) continue;
      pose.tip = pose.tip + far;
      EXPECT_EQ(away.blocker(pose, b).has_value(), near);
    }
  }
}

}  // namespace
}  // namespace burin::orient
