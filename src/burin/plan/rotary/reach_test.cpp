// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "burin/plan/rotary/reach.h"
#include "burin/plan/rotary/reach_cases.h"

namespace burin::rotary {
namespace {

using namespace cases;
using geom::kPi;
using geom::radians;

const double kEnd = radians(0.05);  // what the interval ends may be off, by the issue

/// The distance of an angle from the nearest end of an interval.
double from_ends(const AngleSet& set, double theta) {
  double least = 10;
  for (const AngleInterval& i : set) {
    if (i.hi - i.lo >= 2 * kPi) continue;
    for (const double end : {i.lo, i.hi})
      least = std::min(least, std::abs(std::remainder(theta - end, 2 * kPi)));
  }
  return least;
}

/// Every end to +-0.05 degrees, and a grid between.
void expect_as_measured(const AngleSet& set, const Mesh& m, Point3 center, const model::BallTool& tool,
                        int grid) {
  const auto check = [&](double theta) {
    if (from_ends(set, theta) < 0.99 * kEnd) return;
    const double d = depth(m, center, theta, tool);
    if (std::abs(d) < 1e-9) return;  // slides along the part: both answers are right
    EXPECT_EQ(contains(set, theta), d < 0) << geom::degrees(theta) << " degrees, depth " << d;
  };
  for (const AngleInterval& i : set) {
    EXPECT_LT(i.lo, i.hi);
    EXPECT_GE(i.lo, -kPi);
    EXPECT_LT(i.lo, kPi);
    for (const double end : {i.lo, i.hi}) {
      check(end - kEnd);
      check(end + kEnd);
    }
  }
  for (int k = 0; k < grid; ++k) check(-kPi + 2 * kPi * (k + 0.31) / grid);
}

model::BallTool random_tool(Random& r) {
  model::BallTool tool;
  tool.radius = r.between(0.4, 2);
  const int shank = r.integer(0, 3);
  tool.shank_radius = shank == 0   ? tool.radius * r.between(0.5, 0.95)
                      : shank == 1 ? tool.radius * r.between(1.05, 1.6)
                                   : tool.radius;
  tool.shank_length = r.between(3, 15);
  for (int pieces = r.integer(0, 2); pieces > 0; --pieces)
    tool.holder.push_back({r.between(2, 9), r.between(2, 12)});
  return tool;
}

TEST(Reach, EndsAsMeasuredOnRandomParts) {
#ifdef NDEBUG
  constexpr int kParts = 1000;
#else
  constexpr int kParts = 60;
#endif
  Random r(42);
  int touching = 0, several = 0, none = 0;
  for (int k = 0; k < kParts && !testing::Test::HasFailure(); ++k) {
    SCOPED_TRACE(k);
    const Mesh m = random_part(r, 30, 6);
    const model::BallTool tool = random_tool(r);
    const ReachIndex index(m, tool);
    const Touch touch = random_touch(r, m, tool.radius);
    std::vector<Point3> centers;
    if (touch.radius > 0) {
      ++touching;
      centers.push_back(touch.center);
      centers.push_back(touch.center + r.between(0.1, 2) * touch.normal);
    } else {
      centers.push_back({r.between(0, 20), r.between(-25, 25), r.between(-25, 25)});
    }
    for (const Point3 center : centers) {
      const AngleSet set = index.reachable(center);
      several += set.size() > 1;
      none += set.empty();
      expect_as_measured(set, m, center, tool, 24);
    }
  }
  // The parts are what they should be.
  EXPECT_GT(touching, kParts / 2);
  EXPECT_GT(several, kParts / 200);
  EXPECT_GT(none, kParts / 50);
}

/// Ends of two sets, matched in order; one may be the other across the seam.
void expect_near(const AngleSet& a, const AngleSet& b, double turned, double within) {
  ASSERT_EQ(a.size(), b.size());
  if (total(a) >= 2 * kPi) turned = 0;  // the whole circle begins at -pi
  for (const AngleInterval& i : a) {
    double best = 10;
    for (const AngleInterval& j : b) {
      best = std::min(best, std::max(std::abs(std::remainder(i.lo + turned - j.lo, 2 * kPi)),
                                     std::abs(std::remainder(i.hi + turned - j.hi, 2 * kPi))));
    }
    EXPECT_LT(best, within);
  }
}

TEST(Reach, TurningThePartTurnsTheSet) {
  Random r(7);
  for (int k = 0; k < 40; ++k) {
    const Mesh m = random_part(r, 30, 6);
    const model::BallTool tool = random_tool(r);
    const Touch touch = random_touch(r, m, tool.radius);
    if (touch.radius == 0) continue;
    // theta is the angle of (y, z) from Z towards Y: a turn about X by `by` (Y towards Z) lowers it.
    const double by = r.between(-3, 3), c = std::cos(by), s = std::sin(by);
    const auto turned = [c, s](Point3 p) { return Point3{p.x, p.y * c - p.z * s, p.y * s + p.z * c}; };
    Mesh other = m;
    for (Point3& p : other.vertices) p = turned(p);
    expect_near(ReachIndex(m, tool).reachable(touch.center),
                ReachIndex(other, tool).reachable(turned(touch.center)), -by, 1e-5);
  }
}

TEST(Reach, GrowingShrinksAndGrownIsTheLargerTool) {
  Random r(8);
  for (int k = 0; k < 60; ++k) {
    const Mesh m = random_part(r, 30, 6);
    const model::BallTool tool = random_tool(r);
    const ReachIndex index(m, tool);
    const Touch touch = random_touch(r, m, tool.radius);
    if (touch.radius == 0) continue;
    const Point3 center = touch.center + 0.05 * touch.normal;
    AngleSet before = index.reachable(center, {.grow_mm = -0.05});
    for (const double grow : {-0.01, 0.0, 0.02, 0.3}) {
      const AngleSet now = index.reachable(center, {.grow_mm = grow});
      for (const AngleInterval& i : now) {
        EXPECT_TRUE(contains(before, i.lo + 1e-5) || i.hi - i.lo < 2e-5);
        EXPECT_TRUE(contains(before, i.hi - 1e-5) || i.hi - i.lo < 2e-5);
      }
      EXPECT_LE(total(now), total(before) + 1e-5);
      before = now;
      model::BallTool larger = tool;  // the shank alone: the holder's lower faces move too
      larger.holder.clear();
      larger.shank_radius += grow;
      EXPECT_EQ(ReachIndex(m, larger).reachable(center),
                index.reachable(center, {.grow_mm = grow, .holder = false}));
    }
    const AngleSet both = index.reachable(center);
    EXPECT_LE(total(both), total(index.reachable(center, {.holder = false})) + 1e-9);
    EXPECT_LE(total(both), total(index.reachable(center, {.shank = false})) + 1e-9);
  }
}

TEST(Reach, SameBitsInAnyOrderOfTriangles) {
  Random r(9);
  for (int k = 0; k < 40; ++k) {
    const Mesh m = random_part(r, 30, 6);
    const model::BallTool tool = random_tool(r);
    Mesh other = m;
    for (std::size_t i = other.triangles.size() - 1; i > 0; --i) {
      std::swap(other.triangles[i], other.triangles[static_cast<std::size_t>(r.integer(0, int(i)))]);
      std::rotate(other.triangles[i].begin(), other.triangles[i].begin() + r.integer(0, 2),
                  other.triangles[i].end());
    }
    const Touch touch = random_touch(r, m, tool.radius);
    const Point3 center = touch.radius > 0 ? touch.center : Point3{5, 12, 3};
    EXPECT_EQ(ReachIndex(m, tool).reachable(center), ReachIndex(other, tool).reachable(center));
  }
}

/// A mesh that is off by a little where the ball touches moves the ends by no more than the noise's own
/// angle.
TEST(Reach, NoiseAtTheContactCostsItsOwnAngle) {
  Random r(10);
  const double delta = 1e-3, radius = 2;
  // The place that the noise moves may be up to a facet away from the contact.
  const double bound = 2 * std::sqrt(2 * delta / radius);
  for (int k = 0; k < 40; ++k) {
    Mesh m = swept(star(200, [](double) { return 15.0; }), 20, 0, 40);
    model::BallTool tool;
    tool.radius = tool.shank_radius = radius;
    const double phi = r.between(-3, 3);
    const Point3 center{10.1, (15 + radius) * std::sin(phi), (15 + radius) * std::cos(phi)};
    for (Point3& p : m.vertices) {
      const double f = 1 + r.between(-delta, delta) / 15;
      p = {p.x, p.y * f, p.z * f};
    }
    const AngleSet set = ReachIndex(m, tool).reachable(center);
    ASSERT_EQ(set.size(), 1u);
    EXPECT_NEAR(std::remainder(set[0].lo - (phi - kPi / 2), 2 * kPi), 0, bound);
    EXPECT_NEAR(std::remainder(set[0].hi - (phi + kPi / 2), 2 * kPi), 0, bound);
  }
}

TEST(Reach, ABarAndAWallInNumbers) {
  // A bar 20 x 20; the ball stands on its upper side, 4 from a wall that rises to z = 16.
  const Mesh m = swept({{10, -10}, {10, 16}, {6, 16}, {6, 10}, {-10, 10}, {-10, -10}}, 40, 0, 4);
  model::BallTool tool;
  tool.radius = tool.shank_radius = 2;
  const AngleSet set = ReachIndex(m, tool).reachable({20, 2, 12});
  ASSERT_EQ(set.size(), 1u);
  // Towards +Y the shank leans until it touches the wall's edge, 4 aside and 4 up.
  EXPECT_NEAR(set[0].hi, std::atan2(4, 4) - std::asin(2 / std::hypot(4, 4)), 1e-6);
  EXPECT_NEAR(set[0].lo, -kPi / 2, 1e-6);
  // A holder's lower rim, 3.5 aside and 5 up, comes down on the wall's upper side behind the edge.
  tool.shank_length = 5;
  tool.holder = {{3.5, 50}};
  const AngleSet held = ReachIndex(m, tool).reachable({20, 2, 12});
  ASSERT_EQ(held.size(), 1u);
  EXPECT_NEAR(held[0].hi, std::atan2(std::sqrt(25 + 3.5 * 3.5 - 16), 4) - std::atan2(3.5, 5), 1e-6);
}

TEST(Reach, WhateverComesIn) {
  model::BallTool tool;
  tool.radius = tool.shank_radius = 2;
  const AngleSet whole{{-kPi, kPi}};
  EXPECT_EQ(ReachIndex({}, tool).reachable({0, 0, 0}), whole);
  Mesh bad;
  const double nan = std::nan(""), far = 1e300;
  bad.vertices = {{0, 5, 0}, {nan, 0, 0}, {0, 5, 0}, {1, 6, 0}, {far, far, -far}};
  bad.triangles = {{0, 1, 2}, {0, 2, 99}, {0, 2, 2}, {0, 0, 0}, {0, 3, 4}};
  const ReachIndex index(bad, tool);
  EXPECT_TRUE(index.reachable({nan, 0, 0}).empty());
  EXPECT_TRUE(index.reachable({0, 0, 0}, {.grow_mm = nan}).empty());
  const AngleSet set = index.reachable({0, 0, 0});  // the point at Y = 5 is there
  EXPECT_FALSE(contains(set, kPi / 2));
  index.reachable({far, -far, far});
}

}  // namespace
}  // namespace burin::rotary
