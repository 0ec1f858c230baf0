// SPDX-License-Identifier: Apache-2.0
// Closed forms, dense sampling of random scenes, clean cases just clear, and what must not blow up.
#include "burin/verify/collisions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>


namespace burin::verify {
namespace {

using geom::Mesh;
using geom::Point3;
using geom::Vec3;

const Vec3 kUp{0, 0, 1};

Mesh box(Point3 lo, Point3 hi) {
  Mesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices.push_back({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

/// Each pose after the first is a move of its own; `rapid` says which are rapids.
CheckedPath path_of(const CheckedMill& tool, const std::vector<cl::Pose>& poses,
                    const std::vector<bool>& rapid = {}) {
  CheckedPath path;
  path.tools.push_back({tool, 1, poses.front(), {}});
  path.moves.resize(poses.size());
  for (std::size_t i = 1; i < poses.size(); ++i) {
    path.moves[i].rapid = i < rapid.size() && rapid[i];
    path.tools[0].pieces.push_back({poses[i], static_cast<std::uint32_t>(i), path.moves[i].rapid});
  }
  return path;
}

CollisionReport found(const Mesh& part, const Mesh& obstacles, const CheckedPath& path,
                      const CollisionOptions& options = {}) {
  const auto report = find_collisions(part, obstacles, path, options);
  if (!report) {
    ADD_FAILURE() << report.error().message;
    return {};
  }
  return *report;
}

const CheckedMill kTool{10, 2, 40, {{8, 40, 90, false}, {30, 90, 150, true}}};

// Down beside a wall x >= 0: the holder of radius 30 first, on every move that stands low enough.
TEST(Collisions, HolderPassesAWall) {
  const Mesh wall = box({-50, -100, 0}, {0, 100, 300});
  for (const double clearance : {1.0, 0.011, -0.0115, -0.5, -5.0}) {
    SCOPED_TRACE(clearance);
    const double x = 30 + clearance;
    const auto report = found(
        wall, {},
        path_of(kTool, {{{x, 0, 500}, kUp}, {{x, 0, 400}, kUp}, {{x, 0, 10}, kUp}, {{x, 20, 10}, kUp}}));
    EXPECT_EQ(report.bound_mm, 0.001);
    if (clearance > 0) {
      EXPECT_EQ(report.count, 0U);
      continue;
    }
    ASSERT_EQ(report.count, 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      const Collision& c = report.collisions[i];
      EXPECT_EQ(c.move, i + 2);
      EXPECT_EQ(c.body, Body::holder);
      EXPECT_EQ(c.against, Against::part);
      EXPECT_NEAR(c.depth_mm, -clearance, report.bound_mm);
      EXPECT_NEAR(c.at.x, 0, 1e-9);
      EXPECT_GE(c.at.z, 10 + 90);
    }
  }
}

// The same block as part and as obstacle: the cutter may go into the part when it feeds, never into
// obstacles.
TEST(Collisions, RapidThroughABlock) {
  const Mesh block = box({-20, -20, -5}, {20, 20, 0});
  const CheckedMill tool{3, 0, 200, {}};
  const std::vector<cl::Pose> poses{{{-50, 0, -1}, kUp}, {{50, 0, -1}, kUp}, {{-50, 0, -1}, kUp}};
  const auto on_part = found(block, {}, path_of(tool, poses, {false, false, true}));
  ASSERT_EQ(on_part.count, 1U);
  EXPECT_EQ(on_part.collisions[0].move, 2U);
  EXPECT_EQ(on_part.collisions[0].body, Body::cutter);
  // The top of the block goes through 1 above the bottom of the cutter.
  EXPECT_NEAR(on_part.collisions[0].depth_mm, 1, on_part.bound_mm);
  const auto on_obstacle = found({}, block, path_of(tool, poses, {false, false, true}));
  ASSERT_EQ(on_obstacle.count, 2U);
  for (const Collision& c : on_obstacle.collisions) {
    EXPECT_EQ(c.against, Against::obstacle);
    EXPECT_NEAR(c.depth_mm, 1, on_obstacle.bound_mm);
  }
  // Above it by less than the tolerance allows, and by more.
  const auto at = [&](double z) {
    return found(block, {}, path_of(tool, {{{-50, 0, z}, kUp}, {{50, 0, z}, kUp}}, {false, true})).count;
  };
  EXPECT_EQ(at(0), 0U);
  EXPECT_EQ(at(-0.01), 0U);
  EXPECT_EQ(at(-0.0115), 1U);
}

// A shank wider than the cutter rubs on a boss (a prism of many sides) that the cutter goes round.
TEST(Collisions, ShankRubsOnABoss) {
  Mesh boss;
  constexpr std::uint32_t kSides = 720;
  const double radius = 25;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double a = 2 * geom::kPi * i / kSides;
    boss.vertices.push_back({radius * std::cos(a), radius * std::sin(a), 0});
    boss.vertices.push_back({radius * std::cos(a), radius * std::sin(a), 50});
    const std::uint32_t j = (i + 1) % kSides;
    boss.triangles.push_back({2 * i, 2 * j, 2 * j + 1});
    boss.triangles.push_back({2 * i, 2 * j + 1, 2 * i + 1});
  }
  const CheckedMill tool{6, 0, 20, {{6.3, 20, 60, false}}};
  const double round = radius + 6.05;
  std::vector<cl::Pose> poses;
  for (int i = 0; i <= 90; ++i) {
    const double a = geom::radians(4.0 * i);
    poses.push_back({{round * std::cos(a), round * std::sin(a), 5}, kUp});
  }
  const auto report = found(boss, {}, path_of(tool, poses));
  ASSERT_EQ(report.count, 90U);
  // On the chords between the poses the tool comes nearer by the sagitta.
  const double want = 0.25 + round * (1 - std::cos(geom::radians(2.0)));
  for (const Collision& c : report.collisions) {
    EXPECT_EQ(c.body, Body::shank);
    EXPECT_LE(c.depth_mm, want + 1e-9);
    EXPECT_GE(c.depth_mm,
              want - report.bound_mm - 2 * radius * geom::kPi * geom::kPi / (2.0 * kSides * kSides));
    EXPECT_GE(c.at.z, 25);
  }
}

// The tip stands, the axis turns towards a wall: the upper rim of the holder reaches farthest, in the middle
// of the turn if that is where the axis leans most.
TEST(Collisions, AxisTurnsIntoAWall) {
  const CheckedMill tool{5, 0, 30, {{20, 30, 80, true}}};
  const double lean = geom::radians(20.0), reach = 80 * std::sin(lean) + 20 * std::cos(lean);
  for (const double depth : {0.2, 3.0}) {
    const Mesh wall = box({reach - depth, -200, -200}, {reach + 100, 200, 200});
    const auto turn = [&](double a) {
      return std::vector<cl::Pose>{{{0, 0, 0}, kUp}, {{0, 0, 0}, {std::sin(a), 0, std::cos(a)}}};
    };
    const auto report = found({}, wall, path_of(tool, turn(lean)));
    ASSERT_EQ(report.count, 1U);
    EXPECT_EQ(report.collisions[0].body, Body::holder);
    // A sharp rim: deepest where side and top are equally near.
    const double want = depth / (std::sin(lean) + std::cos(lean));
    EXPECT_NEAR(report.collisions[0].depth_mm, want, report.bound_mm);
    EXPECT_EQ(found({}, wall, path_of(tool, turn(-lean))).count, 0U);
  }
  // Over the top from one side to the other: nearest the wall half way.
  const Vec3 side{0, std::sin(1.0), std::cos(1.0)}, back{0, -side.y, side.z};
  const Mesh roof = box({-200, -200, 79.7}, {200, 200, 300});
  const auto report = found({}, roof, path_of(tool, {{{0, 0, 0}, side}, {{0, 0, 0}, back}}));
  ASSERT_EQ(report.count, 1U);
  EXPECT_GE(report.collisions[0].depth_mm, 0.3 - report.bound_mm);
}

}  // namespace
}  // namespace burin::verify
