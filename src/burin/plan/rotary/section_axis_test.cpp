// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "burin/geom/mesh/check.h"
#include "burin/plan/rotary/reach.h"
#include "burin/plan/rotary/reach_cases.h"

namespace burin::rotary {
namespace {

using namespace cases;
using geom::kPi;
using geom::radians;

constexpr double kRadius = 1;

SectionReach at(const Mesh& m, Point3 center, Vec3 normal) {
  const auto normals = geom::corner_normals(m, 0.3);
  return SectionAxis(m, normals, kRadius).at(center, normal);
}

TEST(SectionAxis, HalfTheCircleOnAConvexPart) {
  const Mesh m = swept(star(360, [](double) { return 10.0; }), 20, 0, 10);
  for (const double phi : {0.3, 1.7, -2.5}) {  // theta of the normal
    const Vec3 n{0, std::sin(phi), std::cos(phi)};
    const SectionReach r = at(m, Point3{10.3, 0, 0} + 11 * n, n);
    ASSERT_EQ(r.reachable.size(), 1u);
    EXPECT_NEAR(total(r.reachable), kPi, radians(0.2));
    EXPECT_NEAR(std::remainder(r.theta - phi, 2 * kPi), 0, radians(0.1));
  }
}

/// A bar of 20 x 20 with a slot 6 wide and 8 deep in its upper side (+Z).
Mesh slotted() {
  return swept({{10, -10}, {10, 10}, {3, 10}, {3, 2}, {-3, 2}, {-3, 10}, {-10, 10}, {-10, -10}}, 20, 0, 10);
}

TEST(SectionAxis, TheLipsOfASlot) {
  // On the floor, off the middle: the shank leans until it touches the lips at (+-3, 10).
  const Point3 center{10.3, 0.5, 2 + kRadius};
  const SectionReach r = at(slotted(), center, {0, 0, 1});
  ASSERT_EQ(r.reachable.size(), 1u);
  const auto lean = [&](double side) {
    const double h = 7, rho = std::hypot(side, h);
    return std::atan2(side, h) - std::asin(kRadius / rho);
  };
  EXPECT_NEAR(r.reachable[0].hi, lean(2.5), radians(0.05));
  EXPECT_NEAR(r.reachable[0].lo, -lean(3.5), radians(0.05));
  EXPECT_NEAR(r.theta, 0.5 * (lean(2.5) - lean(3.5)), radians(0.05));
}

TEST(SectionAxis, NothingUnderAHook) {
  // A slot whose lips leave 1.6 where the tool is 2 wide.
  const Mesh m = swept({{10, -10},
                        {10, 10},
                        {0.8, 10},
                        {0.8, 8},
                        {4, 8},
                        {4, 2},
                        {-4, 2},
                        {-4, 8},
                        {-0.8, 8},
                        {-0.8, 10},
                        {-10, 10},
                        {-10, -10}},
                       20, 0, 10);
  EXPECT_TRUE(at(m, {10.3, 0.4, 3}, {0, 0, 1}).reachable.empty());
}

TEST(SectionAxis, AsExactOnPrismsWithShankOnly) {
  Random r(5);
  int compared = 0, narrow = 0;
  for (int k = 0; k < 60; ++k) {
    const double depth = r.between(0.5, 2.5), phase = r.between(0, 6);
    const int teeth = r.integer(2, 5);
    const Mesh m =
        swept(star(240, [&](double a) { return 9 - depth * std::sin(teeth * a + phase); }), 20, 0, 10);
    model::BallTool tool;
    tool.radius = tool.shank_radius = kRadius;
    const ReachIndex index(m, tool);
    const auto normals = geom::corner_normals(m, 0.3);
    const SectionAxis section(m, normals, kRadius);
    for (int attempt = 0; attempt < 5; ++attempt) {
      const Touch touch = random_touch(r, m, kRadius);
      if (touch.radius == 0 || touch.center.x < 2 || touch.center.x > 18 || std::abs(touch.normal.x) > 0.01)
        continue;
      const AngleSet exact = index.reachable(touch.center);
      const SectionReach paper = section.at(touch.center, touch.normal);
      if (exact.size() != 1) continue;
      ASSERT_EQ(paper.reachable.size(), 1u) << k;
      ++compared;
      narrow += total(exact) < radians(170);
      // The normals of the mesh and of its facets differ by half a facet's angle (0.75 degrees) where nothing
      // but the touched place limits the axis.
      const double ends[2] = {std::remainder(paper.reachable[0].lo - exact[0].lo, 2 * kPi),
                              std::remainder(paper.reachable[0].hi - exact[0].hi, 2 * kPi)};
      EXPECT_NEAR(ends[0], 0, radians(2.5)) << k;
      EXPECT_NEAR(ends[1], 0, radians(2.5)) << k;
    }
  }
  EXPECT_GT(compared, 100);
  EXPECT_GT(narrow, 20);
}

}  // namespace
}  // namespace burin::rotary
