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
TEST(JointPath, KeepsTipAndAxisOnTheirWays) {
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
          const cl::Pose is = k.forward(between(at, move.to, s / 16.0));
          ASSERT_LT(off_line(is.tip, poses[leg - 1].tip, poses[leg].tip), 1.05 * options.tolerance_mm);
          const Vec3 circle = unit(cross(poses[leg - 1].axis, poses[leg].axis));
          ASSERT_LT(std::abs(dot(is.axis, circle)), 1.05 * options.axis_tolerance_rad);
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

/// A trunnion that tilts to one side only: through the pole its table has to turn half round.
Kinematics one_sided() {
  model::Machine machine = *model::find_machine("xyzac-trunnion");
  for (model::Axis& axis : machine.axes)
    if (axis.letter == 'A') axis.min = 0, axis.max = 100;
  return *Kinematics::make(machine);
}

/// Largest distance of the tip from its lines and of the axis from its great circles (radians), sampled
/// densely. The axis runs in the plane of `normal`.
std::pair<double, double> measured(const Kinematics& k, const JointPath& path,
                                   const std::vector<cl::Pose>& poses, Vec3 normal, bool tip_straight) {
  double tip_off = 0, axis_off = 0;
  for (std::size_t m = 1; m < path.moves.size(); ++m) {
    const std::size_t leg = path.moves[m].record - 1;
    for (int s = 0; s <= 40; ++s) {
      const cl::Pose at = k.forward(between(path.moves[m - 1].to, path.moves[m].to, s / 40.0));
      if (!tip_straight) tip_off = std::max(tip_off, off_line(at.tip, poses[leg - 1].tip, poses[leg].tip));
      axis_off = std::max(axis_off, std::abs(dot(at.axis, normal)));
    }
  }
  return {tip_off, axis_off};
}

// Through the pole and nearly through it, on a machine that cannot tilt to the other side.
TEST(JointPath, TurnsTheTableAtAPole) {
  const Kinematics k = one_sided();
  for (const double beside : {0.0, 2e-4}) {
    const Vec3 aside{std::sin(0.9), -std::cos(0.9), 0};
    std::vector<cl::Pose> poses{{{-30, 5, 0}, direction(0.3, 0.9)},
                                {{30, 25, 0}, direction(0.3, 0.9 + geom::kPi)}};
    for (cl::Pose& pose : poses) pose.axis = unit(pose.axis + beside * aside);
    const Vec3 normal = unit(cross(poses[0].axis, poses[1].axis));
    for (const bool tool_centre : {false, true}) {
      cl::Program program;
      program.add(cl::FeedRate{500});
      program.add(cl::Rapid{poses[0]});
      program.add(cl::Feed{poses[1]});
      JointPathOptions options;
      options.tool_centre = tool_centre;
      const auto path = make_joint_path(k, program, options);
      ASSERT_TRUE(path.ok()) << path.error().to_string();
      for (const JointMove& move : path->moves) ASSERT_FALSE(k.violation(move.to));
      EXPECT_NEAR(std::abs(path->moves.back().to.rotary[0] - path->moves[0].to.rotary[0]), geom::kPi, 0.01);
      const auto [tip_off, axis_off] = measured(k, *path, poses, normal, tool_centre);
      EXPECT_LE(tip_off, 1.05 * options.tolerance_mm);
      EXPECT_LE(axis_off, 1.05 * options.axis_tolerance_rad);
      EXPECT_LE(rotary_shares(k, path->moves, options.axis_tolerance_rad).speed[0], 1 + 1e-9);
      EXPECT_LT(path->moves.size(), 4000u);
    }
  }
}

// Under tool-centre-point control only the axis asks for points between.
TEST(JointPath, ToolCentreNeedsFewerPoints) {
  const Kinematics k = preset("xyzac-trunnion");
  std::vector<cl::Pose> poses{{{60, 0, 10}, direction(0.2, -1)}, {{-20, 50, 0}, direction(0.7, 0.8)}};
  cl::Program program;
  program.add(cl::FeedRate{800});
  program.add(cl::Rapid{poses[0]});
  program.add(cl::Feed{poses[1]});
  JointPathOptions options;
  const auto joints = make_joint_path(k, program, options);
  options.tool_centre = true;
  const auto path = make_joint_path(k, program, options);
  ASSERT_TRUE(joints.ok() && path.ok());
  EXPECT_LT(path->moves.size(), joints->moves.size() / 2);
  EXPECT_GT(path->moves.size(), 3u);
  const Vec3 normal = unit(cross(poses[0].axis, poses[1].axis));
  EXPECT_LE(measured(k, *path, poses, normal, true).second, 1.05 * options.axis_tolerance_rad);
  double minutes = 0;
  for (const JointMove& move : path->moves) minutes += move.minutes;
  EXPECT_NEAR(minutes, geom::distance(poses[0].tip, poses[1].tip) / 800, 1e-9);
}

// A table that starts and stops abruptly: moves take longer until it can follow, and nothing else changes.
TEST(JointPath, KeepsTheAccelerationOfATable) {
  const Kinematics k = preset("xyza");
  cl::Program program;
  program.add(cl::FeedRate{4000});
  const auto pose = [](double x, double turn) {
    return cl::Pose{{x, 30 * std::sin(turn), 30 * std::cos(turn)}, {0, std::sin(turn), std::cos(turn)}};
  };
  program.add(cl::Rapid{pose(0, 0)});
  double turn = 0;
  for (int i = 1; i <= 90; ++i) {
    if (i > 30 && i <= 60) turn += 0.02;
    program.add(cl::Feed{pose(0.5 * i, turn)});
  }
  JointPathOptions options;
  options.joint_linear = true;
  const auto quick = make_joint_path(k, program, options);
  options.keep_acceleration = true;
  const auto kept = make_joint_path(k, program, options);
  ASSERT_TRUE(quick.ok() && kept.ok());
  ASSERT_EQ(quick->moves.size(), kept->moves.size());
  const auto share = [&](const JointPath& path) {
    return rotary_shares(k, path.moves, options.axis_tolerance_rad).acceleration[0];
  };
  EXPECT_GT(share(*quick), 1.5);
  EXPECT_LE(share(*kept), 1.002);
  EXPECT_EQ(quick->acceleration_limited, 0u);
  std::size_t changed = 0;
  double slower = 0;
  for (std::size_t m = 1; m < kept->moves.size(); ++m) {
    EXPECT_EQ(kept->moves[m].to, quick->moves[m].to);
    EXPECT_GE(kept->moves[m].minutes, quick->moves[m].minutes);
    changed += kept->moves[m].minutes > quick->moves[m].minutes ? 1 : 0;
    slower += kept->moves[m].minutes - quick->moves[m].minutes;
  }
  EXPECT_EQ(changed, kept->acceleration_limited);
  EXPECT_GT(changed, 1u);
  EXPECT_LT(slower, 0.02);
  // Apart from the library: an axis that follows with its speed averaged twice over tau never asks for more
  // than its acceleration, and stays within the tolerance. Degrees, seconds.
  const double tau = std::sqrt(8 * geom::degrees(options.axis_tolerance_rad) / 500);
  const auto place = [&](double time) {
    double from = 0;
    for (std::size_t m = 1; m < kept->moves.size(); ++m) {
      const double by = 60 * kept->moves[m].minutes;
      const double a = geom::degrees(kept->moves[m - 1].to.rotary[0]),
                   b = geom::degrees(kept->moves[m].to.rotary[0]);
      if (time <= from + by) return a + (b - a) * std::max(0.0, time - from) / by;
      from += by;
    }
    return geom::degrees(kept->moves.back().to.rotary[0]);
  };
  double end = 0, worst = 0;
  for (const JointMove& move : kept->moves) end += 60 * move.minutes;
  for (double time = tau; time < end - tau; time += 0.002)
    worst = std::max(worst, std::abs(place(time + tau) - 2 * place(time) + place(time - tau)) / (tau * tau));
  EXPECT_LE(worst, 500 * 1.01);
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
