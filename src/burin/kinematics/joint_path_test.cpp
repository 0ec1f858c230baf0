// SPDX-License-Identifier: Apache-2.0
#include "burin/kinematics/joint_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace burin::kinematics {
namespace {

using geom::Point3;
using geom::Vec3;

Kinematics preset(const std::string& name) {
  return *Kinematics::make(*model::find_machine(name));
}

Vec3 direction(double tilt, double yaw) {
  return {std::sin(tilt) * std::cos(yaw), std::sin(tilt) * std::sin(yaw), std::cos(tilt)};
}

/// Distance of p from the segment a b.
double off_line(Point3 p, Point3 a, Point3 b) {
  const Vec3 ab = b - a;
  const double t = dot(ab, ab) > 0 ? std::clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0) : 0;
  return geom::distance(p, lerp(a, b, t));
}

// Dense samples of every joint move stay within the tolerance of the straight line the CL data asks for.
TEST(JointPath, KeepsTheTipOnItsLine) {
  std::mt19937 engine(3);
  const auto in = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine()) / 4294967296.0;
  };
  for (const std::string name :
       {"xyzac-trunnion", "xyzbc-trunnion", "xyzbc-head-table", "propeller-head-head"}) {
    const Kinematics k = preset(name);
    for (int n = 0; n < 20; ++n) {
      cl::Program program;
      std::vector<cl::Pose> poses;
      for (int i = 0; i < 4; ++i)
        poses.push_back({{in(-80, 80), in(-80, 80), in(-80, 80)}, direction(in(0.05, 1.2), in(-3, 3))});
      program.add(cl::FeedRate{500});
      program.add(cl::Rapid{poses[0]});
      for (int i = 1; i < 4; ++i) program.add(cl::Feed{poses[static_cast<std::size_t>(i)]});
      JointPathOptions options;
      const auto path = make_joint_path(k, program, options);
      ASSERT_TRUE(path.ok()) << name << ": " << path.error().to_string();
      Joints at = path->moves[0].to;
      for (std::size_t m = 1; m < path->moves.size(); ++m) {
        const JointMove& move = path->moves[m];
        const std::size_t leg = move.record - 1;  // feed rate and rapid stand before
        for (int s = 0; s <= 16; ++s) {
          const Point3 tip = k.forward(between(at, move.to, s / 16.0)).tip;
          ASSERT_LT(off_line(tip, poses[leg - 1].tip, poses[leg].tip), 1.05 * options.tolerance_mm);
        }
        at = move.to;
      }
      for (std::size_t i = 1; i < 4; ++i) {
        bool met = false;
        for (const JointMove& move : path->moves)
          met |= geom::distance(k.forward(move.to).tip, poses[i].tip) < 1e-9;
        ASSERT_TRUE(met);
      }
    }
  }
}

// The time of a move times the feed is the tip's way on the part, and its speed is even within the share.
TEST(JointPath, TipKeepsTheFeed) {
  const Kinematics k = preset("xyza");
  cl::Program program;
  program.add(cl::FeedRate{600});
  const auto pose = [](double turn, double radius, double x) {
    return cl::Pose{{x, radius * std::sin(turn + 0.3), radius * std::cos(turn + 0.3)},
                    {0, std::sin(turn), std::cos(turn)}};
  };
  program.add(cl::Rapid{pose(0, 20, 0)});
  for (int i = 1; i <= 60; ++i) program.add(cl::Feed{pose(0.1 * i, 20 + 4 * std::sin(0.7 * i), 0.2 * i)});
  JointPathOptions options;
  options.joint_linear = true;
  const auto path = make_joint_path(k, program, options);
  ASSERT_TRUE(path.ok()) << path.error().to_string();
  EXPECT_EQ(path->feed_limited, 0u);
  Joints at = path->moves[0].to;
  for (std::size_t m = 1; m < path->moves.size(); ++m) {
    const JointMove& move = path->moves[m];
    constexpr int kParts = 200;
    for (int s = 0; s < kParts; ++s) {
      const double way = geom::distance(k.forward(between(at, move.to, static_cast<double>(s) / kParts)).tip,
                                        k.forward(between(at, move.to, (s + 1.0) / kParts)).tip);
      ASSERT_NEAR(way * kParts / move.minutes, 600, 6.01);
    }
    at = move.to;
  }
  // The table turned on and on, by nearly a whole turn.
  EXPECT_NEAR(at.rotary[0], 6.0, 1e-9);
}

TEST(JointPath, SlowsDownForTheTable) {
  const Kinematics k = preset("xyza");
  cl::Program program;
  program.add(cl::FeedRate{5000});
  program.add(cl::Rapid{{{0, 0, 5}, {0, 0, 1}}});
  program.add(cl::Feed{{{0, 5, 0}, {0, 1, 0}}});
  JointPathOptions options;
  options.joint_linear = true;
  const auto path = make_joint_path(k, program, options);
  ASSERT_TRUE(path.ok());
  EXPECT_GT(path->feed_limited, 0u);
  double minutes = 0;
  for (const JointMove& move : path->moves) minutes += move.minutes;
  EXPECT_NEAR(minutes, 90.0 / 5000, 1e-9);  // 90 degrees at the table's 5000 deg/min
}

TEST(JointPath, PassesThroughAPole) {
  for (const std::string name : {"xyzac-trunnion", "xyzbc-head-table", "propeller-head-head"}) {
    const Kinematics k = preset(name);
    cl::Program program;
    program.add(cl::FeedRate{500});
    program.add(cl::Rapid{{{0, 0, 0}, direction(0.4, 0.9)}});
    program.add(cl::Feed{{{20, 10, 0}, direction(0, 0)}});
    program.add(cl::Feed{{{40, 20, 0}, direction(0.4, 0.9 + geom::kPi)}});
    const auto path = make_joint_path(k, program, {});
    ASSERT_TRUE(path.ok()) << name << ": " << path.error().to_string();
    EXPECT_LE(path->deviation_mm, 0.01);
  }
}

TEST(JointPath, ErrorsNameMoveAndAxis) {
  auto machine = *model::find_machine("xyzac-trunnion");
  const auto k = Kinematics::make(machine);
  cl::Program program;
  program.add(cl::FeedRate{500});
  program.add(cl::Rapid{{{0, 0, 0}, {0, 0, 1}}});
  program.add(cl::Feed{{{1, 0, 0}, direction(2.5, 0)}});
  const auto path = make_joint_path(*k, program, {});
  ASSERT_FALSE(path.ok());
  EXPECT_EQ(path.error().code, ErrorCode::range);
  EXPECT_NE(path.error().message.find("move 1"), std::string::npos) << path.error().message;
  EXPECT_NE(path.error().message.find("axis A"), std::string::npos) << path.error().message;

  cl::Program headless;
  headless.add(cl::FeedRate{500});
  headless.add(cl::Feed{{{1, 0, 0}, {0, 0, 1}}});
  EXPECT_EQ(make_joint_path(*k, headless, {}).error().code, ErrorCode::usage);
}

TEST(JointPath, ArcsKeepTheirShape) {
  const Kinematics k = preset("xyzac-trunnion");
  cl::Program program;
  program.add(cl::FeedRate{500});
  const Vec3 tilt = direction(0.3, 1.0);
  program.add(cl::Rapid{{{10, 0, 0}, tilt}});
  program.add(cl::Arc{{0, 0, 0}, {0, 0, 1}, 10, {{0, 10, 4}, tilt}});
  const auto path = make_joint_path(k, program, {});
  ASSERT_TRUE(path.ok()) << path.error().to_string();
  Joints at = path->moves[0].to;
  for (std::size_t m = 1; m < path->moves.size(); ++m) {
    for (int s = 0; s <= 8; ++s) {
      const Point3 tip = k.forward(between(at, path->moves[m].to, s / 8.0)).tip;
      ASSERT_NEAR(std::hypot(tip.x, tip.y), 10, 0.01);
      ASSERT_NEAR(tip.z, 4 * std::atan2(tip.y, tip.x) / (geom::kPi / 2), 0.01);
    }
    at = path->moves[m].to;
  }
}

}  // namespace
}  // namespace burin::kinematics
