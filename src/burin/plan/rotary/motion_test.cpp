// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/plan/rotary/reach.h"
#include "burin/plan/rotary/reach_cases.h"

namespace burin::rotary {
namespace {

using cases::Random;
using geom::Point3;

constexpr double kInf = std::numeric_limits<double>::infinity();

/// How deep the tool stands in the part at one pose (below 0: free), measured triangle by triangle.
double deepest(const geom::Mesh& mesh, const model::BallTool& tool, const AxisPose& pose) {
  double out = tool.radius - cases::distance_to(mesh, pose.center);
  out = std::max(out, cases::depth(mesh, pose.center, pose.theta, 0, kInf, tool.shank_radius));
  double from = tool.shank_length;
  for (const auto& piece : tool.holder) {
    out = std::max(out, cases::depth(mesh, pose.center, pose.theta, from, from + piece.height, piece.radius));
    from += piece.height;
  }
  return out;
}

TEST(Motion, JointsRunLinearly) {
  Random r(1);
  for (int i = 0; i < 100; ++i) {
    const AxisPose a{{r.between(-5, 5), r.between(-5, 5), r.between(-5, 5)}, r.between(-9, 9)};
    const AxisPose b{{r.between(-5, 5), r.between(-5, 5), r.between(-5, 5)}, r.between(-9, 9)};
    const double t = r.between(0, 1);
    const auto machine = [](const AxisPose& p) {
      const Point3 tip = tip_of(p, 2);
      const double c = std::cos(p.theta), s = std::sin(p.theta);
      return Point3{tip.x, tip.y * c - tip.z * s, tip.y * s + tip.z * c};
    };
    const AxisPose m = between(a, b, t);
    EXPECT_NEAR(m.theta, a.theta + t * (b.theta - a.theta), 1e-12);
    EXPECT_LT(geom::distance(machine(m), lerp(machine(a), machine(b), t)), 1e-12);
    EXPECT_LT(geom::distance(between(a, b, 0).center, a.center), 1e-12);
    EXPECT_LT(geom::distance(between(a, b, 1).center, b.center), 1e-12);
  }
}

/// Random moves near random parts: what is said to be clear is, densely sampled, not deeper than the
/// tolerance; where there is room everywhere it is said to be clear; and where it is not, something is near.
TEST(Motion, ProofHolds) {
  Random r(2);
  int clear = 0, blocked = 0;
  for (int part = 0; part < 20; ++part) {
    const geom::Mesh mesh = cases::random_part(r, 32, 5);
    model::BallTool tool;
    tool.radius = r.between(0.8, 2);
    tool.shank_radius = tool.radius * r.between(0.6, 1.1);
    tool.shank_length = r.between(5, 20);
    tool.holder = {{6, 10}, {8, 30}};
    const ReachIndex reach(mesh, tool);
    const geom::MeshIndex index(mesh);
    const BodyIndex body(mesh);
    for (int move = 0; move < 12; ++move) {
      const cases::Touch touch = cases::random_touch(r, mesh, tool.radius);
      if (touch.radius == 0) continue;
      const AngleSet set = reach.reachable(touch.center);
      if (set.empty()) continue;
      const AngleInterval& in = set[static_cast<std::size_t>(r.integer(0, static_cast<int>(set.size()) - 1))];
      const AxisPose from{touch.center, r.between(in.lo, in.hi)};
      const double size = r.integer(0, 2) == 0 ? 6 : 0.5;
      const geom::Vec3 d{r.between(-1, 1), r.between(-1, 1), r.between(-1, 1)};
      const AxisPose to{touch.center + size * (d + r.between(0, 1) * touch.normal),
                        from.theta + r.between(-1, 1) * (size > 1 ? 0.8 : 0.1)};
      MotionOptions options;
      options.tolerance_mm = options.ball_mm = 0.01;
      const MoveCheck check = check_move(from, to, body, index, tool, options);
      double worst = -kInf;
      for (int i = 0; i <= 40; ++i) worst = std::max(worst, deepest(mesh, tool, between(from, to, i / 40.0)));
      if (check.clear) {
        ++clear;
        EXPECT_LE(worst, options.tolerance_mm + 1e-6) << part << " " << move;
      } else {
        ++blocked;
        EXPECT_GT(worst, -0.01) << part << " " << move;
        EXPECT_GT(deepest(mesh, tool, between(from, to, check.at)), -0.01) << part << " " << move;
      }
    }
  }
  EXPECT_GT(clear, 20);
  EXPECT_GT(blocked, 20);
}

TEST(BodyIndex, SameAsMeasuring) {
  Random r(3);
  for (int part = 0; part < 10; ++part) {
    const geom::Mesh mesh = cases::random_part(r, 32, 5);
    const BodyIndex body(mesh);
    for (int i = 0; i < 30; ++i) {
      const Point3 c{r.between(-5, 30), r.between(-15, 15), r.between(-15, 15)};
      const double theta = r.between(-7, 7), low = r.between(-5, 10), high = low + r.between(0.1, 15);
      const double distance = 1e3 - cases::depth(mesh, c, theta, low, high, 1e3);
      EXPECT_NEAR(body.to_axis(c, theta, low, high, 1e3), std::min(distance, 1e3), 1e-9);
      if (distance < 1e3) {
        EXPECT_NEAR(body.to_axis(c, theta, low, high, 0.5 * distance), 0.5 * distance, 1e-9);
      }
    }
  }
}

/// A cylinder turned under the ball: the way is an arc about the axis and the ball sinks nowhere.
TEST(Motion, TurningAboutACylinderIsNotAChord) {
  const geom::Mesh mesh = cases::swept(cases::star(720, [](double) { return 10.0; }), 20, 0, 4);
  model::BallTool tool{2, 2, 60, {}};
  const BodyIndex reach(mesh);
  const geom::MeshIndex index(mesh);
  const auto pose = [](double a) { return AxisPose{{10, 12 * std::sin(a), 12 * std::cos(a)}, a}; };
  MotionOptions options;
  options.tolerance_mm = options.ball_mm = 0.002;
  const MoveCheck check = check_move(pose(0), pose(2), reach, index, tool, options);
  EXPECT_TRUE(check.clear);
  EXPECT_LE(check.ball_depth, 0.002);
  // Without the turn it is a chord, deep in the part.
  AxisPose straight = pose(0.6);
  straight.theta = 0;
  EXPECT_FALSE(check_move(pose(0), straight, reach, index, tool, options).clear);
}

}  // namespace
}  // namespace burin::rotary
