// SPDX-License-Identifier: Apache-2.0
// Pieces against the motion itself, densely sampled, at the tip and at the far end of the tool.
#include "burin/verify/path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "burin/kinematics/joint_path.h"
#include "burin/model/machine.h"

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

constexpr double kLength = 60, kHolder = 25;  // the far end of the tool: radius and height

Result<CheckedMill> mill(const cl::ToolChange&) {
  return CheckedMill{5, 1, 30, {{kHolder, 30, kLength, true}}};
}
double uniform(std::mt19937& random, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(random);
}
Vec3 direction(std::mt19937& random) {
  while (true) {
    const Vec3 v{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    if (norm(v) > 0.1 && norm(v) < 1) return unit(v);
  }
}
Vec3 slerp(Vec3 a, Vec3 b, double t) {
  const double angle = std::atan2(norm(cross(a, b)), dot(a, b));
  if (angle < 1e-12) return a;
  return (std::sin((1 - t) * angle) / std::sin(angle)) * a + (std::sin(t * angle) / std::sin(angle)) * b;
}

/// The greatest distance of a place of the tool from where it is on the pieces at the same share of the move:
/// tip, and the rim of the holder's end after the least turn that takes one axis to the other.
double apart(const cl::Pose& a, const cl::Pose& b) {
  const double angle = std::atan2(norm(cross(a.axis, b.axis)), dot(a.axis, b.axis));
  return distance(a.tip, b.tip) + std::hypot(kHolder, kLength) * 2 * std::sin(angle / 2);
}
/// `truth(t)` against the pieces of move `m`, which share the move evenly.
template <class Truth>
double worst(const ToolPath& path, std::uint32_t m, Truth&& truth) {
  std::vector<cl::Pose> nodes;
  cl::Pose before = path.from;
  for (const PathPiece& piece : path.pieces) {
    if (piece.move == m && nodes.empty()) nodes.push_back(before);
    if (piece.move == m) nodes.push_back(piece.to);
    before = piece.to;
  }
  double most = 0;
  const int samples = 997;
  for (int i = 0; i <= samples; ++i) {
    const double t = double(i) / samples, s = t * double(nodes.size() - 1);
    const auto k = std::min(std::size_t(s), nodes.size() - 2);
    const cl::Pose on{lerp(nodes[k].tip, nodes[k + 1].tip, s - double(k)),
                      unit(slerp(unit(nodes[k].axis), unit(nodes[k + 1].axis), s - double(k)))};
    most = std::max(most, apart(truth(t), on));
  }
  return most;
}

CheckedPath made(Result<CheckedPath> path) {
  if (path) return *std::move(path);
  ADD_FAILURE() << path.error().to_string();
  return {};
}
std::string failure(const Result<CheckedPath>& path) {
  return path ? "" : path.error().message;
}

TEST(CheckedPath, FollowsRandomArcsAndHelices) {
  std::mt19937 random(1);
  for (int n = 0; n < 300; ++n) {
    const double r = std::exp(uniform(random, std::log(0.01), std::log(500.0)));
    const double sweep = n % 10 == 0 ? 2 * geom::kPi : uniform(random, 0.001, 6.28);
    const double rise = n % 2 ? 0 : uniform(random, -20, 20);
    const Vec3 normal = direction(random), x = unit(cross(normal, direction(random))), y = cross(normal, x);
    const Point3 center{uniform(random, -50, 50), uniform(random, -50, 50), uniform(random, -50, 50)};
    const Vec3 from = direction(random), to = n % 3 ? direction(random) : from;
    const auto tip = [&](double t) {
      return center + (r * std::cos(t * sweep)) * x + (r * std::sin(t * sweep)) * y + (t * rise) * normal;
    };
    cl::Program program;
    program.from = cl::Pose{tip(0), from};
    program.add(cl::FeedRate{100});
    program.add(cl::Arc{center, normal, r, {tip(1), to}});
    const double motion = n % 4 ? 0.0005 : 0.02;
    const CheckedPath path = made(make_checked_path(program, mill, {motion, 20'000'000}));
    ASSERT_EQ(path.tools.size(), 1u);
    EXPECT_LE(path.motion_mm, motion);
    const double most = worst(path.tools[0], 0, [&](double t) {
      return cl::Pose{tip(t), unit(slerp(from, to, t))};
    });
    EXPECT_LE(most, path.motion_mm + 1e-9) << n;
    // Not many more pieces than needed: half as many would not do.
    if (path.tools[0].pieces.size() > 8) {
      EXPECT_GT(path.motion_mm, motion / 2) << n;
    }
    EXPECT_EQ(path.tools[0].pieces.back().to, (cl::Pose{tip(1), to}));
  }
}

kinematics::Joints random_joints(std::mt19937& random, double turn, const kinematics::Joints& near) {
  kinematics::Joints j = near;
  for (double& x : j.linear) x += uniform(random, -20, 20);
  for (double& x : j.rotary) x += uniform(random, -turn, turn);
  return j;
}

TEST(CheckedPath, FollowsJointsOfAllMachines) {
  std::mt19937 random(2);
  int machines = 0;
  for (const std::string& name : model::machine_names()) {
    const auto machine = kinematics::Kinematics::make(*model::find_machine(name));
    ASSERT_TRUE(machine) << name;
    if (machine->rotary_count() == 0) continue;
    ++machines;
    for (const bool tip_straight : {false, true}) {
      for (int n = 0; n < 60; ++n) {
        // Whole turns as well: the piece's ends then say nothing.
        const double turn = n % 6 == 0 ? 7 : n % 2 ? 0.05 : 0.7;
        std::vector<kinematics::Joints> joints{random_joints(random, 3, {{100, 0, 30}, {}})};
        joints.push_back(random_joints(random, turn, joints[0]));
        if (machine->rotary_count() == 1) joints[0].rotary[1] = joints[1].rotary[1] = 0;
        if (n % 6 == 0) joints[1].rotary = {joints[0].rotary[0] + 2 * geom::kPi, joints[0].rotary[1]};
        cl::Program program;
        program.add(cl::Rapid{machine->forward(joints[0])});
        program.add(cl::Feed{machine->forward(joints[1])});
        const CheckedPath path = made(make_checked_path(program, joints, {tip_straight, tip_straight},
                                                        *machine, mill, {0.001, 5'000'000}));
        ASSERT_EQ(path.tools.size(), 1u);
        EXPECT_LE(path.motion_mm, 0.001);
        EXPECT_EQ(path.tools[0].pieces[0].to, path.tools[0].from);
        const Point3 a = machine->forward(joints[0]).tip, b = machine->forward(joints[1]).tip;
        const double most = worst(path.tools[0], 1, [&](double t) {
          cl::Pose pose = machine->forward(kinematics::between(joints[0], joints[1], t));
          if (tip_straight) pose.tip = lerp(a, b, t);
          return pose;
        });
        EXPECT_LE(most, path.motion_mm + 1e-9) << name << ' ' << n << ' ' << tip_straight;
        // (One axis across the tool turns it along a great circle anyway.)
        if (path.tools[0].pieces.size() > 20 && !tip_straight) {
          EXPECT_GT(most, 0.0002) << name << ' ' << n;
        }
      }
    }
  }
  EXPECT_GE(machines, 4);
}

TEST(CheckedPath, StraightMovesAreOnePieceAndKnowWhereTheyComeFrom) {
  cl::Program program;
  program.add(cl::ToolChange{3, 10, 1}, 4);
  program.add(cl::Rapid{{{0, 0, 10}}}, 5);
  program.add(cl::FeedRate{100}, 6);
  program.add(cl::Feed{{{10, 0, 0}, {0.6, 0, 0.8}}}, 7);
  program.add(cl::ToolChange{3, 10, 1}, 8);  // in the spindle already
  program.add(cl::Feed{{{20, 0, 0}}}, 9);
  program.add(cl::ToolChange{4, 6, 3}, 10);
  program.add(cl::Rapid{{{50, 0, 10}}}, 11);
  program.add(cl::Feed{{{50, 0, 5}}}, 12);
  const CheckedPath path = made(make_checked_path(program, mill, {}));
  ASSERT_EQ(path.tools.size(), 2u);
  EXPECT_EQ(path.tools[0].tool_number, 3);
  EXPECT_EQ(path.tools[1].tool_number, 4);
  EXPECT_EQ(path.tools[0].pieces.size(), 3u);
  EXPECT_EQ(path.tools[1].from.tip, (Point3{50, 0, 10}));
  EXPECT_EQ(path.tools[1].pieces[0].move, 3u);
  EXPECT_TRUE(path.tools[1].pieces[0].rapid);
  EXPECT_EQ(path.tools[1].pieces[1].move, 4u);
  EXPECT_EQ(path.motion_mm, 0);
  // Where move 1 ends nobody knows: the motion begins again in move 2.
  PathOptions gap;
  gap.unknown = {false, true, false, false, false};
  const CheckedPath broken = made(make_checked_path(program, mill, gap));
  ASSERT_EQ(broken.tools.size(), 3u);
  EXPECT_EQ(broken.tools[0].pieces.size(), 1u);
  EXPECT_EQ(broken.tools[1].tool_number, 3);
  EXPECT_EQ(broken.tools[1].from.tip, (Point3{20, 0, 0}));
  EXPECT_EQ(broken.moves.size(), 5u);
  ASSERT_EQ(path.moves.size(), 5u);
  EXPECT_EQ(path.moves[2].line, 9u);
  EXPECT_EQ(path.moves[2].record, 5u);
  EXPECT_TRUE(path.moves[3].rapid);
}

TEST(CheckedPath, NamesTheMoveThatCannotBe) {
  cl::Program program;
  program.add(cl::Rapid{{{0, 0, 10}}}, 1);
  program.add(cl::Feed{{{1, 0, 0}, {0, 0, -1}}}, 2);
  EXPECT_NE(failure(make_checked_path(program, mill, {})).find("move 1: the axis turns by half a turn"),
            std::string::npos);
  EXPECT_EQ(make_checked_path(program, mill, {}).error().where.line, 2);
  program.records[1] = cl::Rapid{{{1, 0, 0}, {0, 0, -1}}};
  EXPECT_EQ(made(make_checked_path(program, mill, {})).piece_count(), 3u);
  program.records[1] = cl::Feed{{{std::nan(""), 0, 0}}};
  EXPECT_NE(failure(make_checked_path(program, mill, {})).find("move 1: a pose that is not finite"),
            std::string::npos);
  program.records[1] = cl::Feed{{{0, 0, 0}, {0, 0, 0.5}}};
  EXPECT_NE(failure(make_checked_path(program, mill, {})).find("move 1: the tool axis"), std::string::npos);
  program.records[1] = cl::Arc{{0, 0, 10}, {0, 0, 1}, 1, {{1, 0, 10}}};
  EXPECT_NE(failure(make_checked_path(program, mill, {})).find("move 1: the ends of the arc"),
            std::string::npos);
  program.records[1] = cl::Arc{{1000, 0, 10}, {0, 0, 1}, 1000, {{0, 0, 10}}};
  EXPECT_NE(failure(make_checked_path(program, mill, {0.0005, 100})).find("move 1: more than 100"),
            std::string::npos);
  const auto none = [](const cl::ToolChange&) -> Result<CheckedMill> {
    return Error{ErrorCode::usage, "no tool", {}};
  };
  EXPECT_EQ(failure(make_checked_path(program, none, {})), "no tool");
}

TEST(CheckedPath, RefusesJointMovesThatNeedTooManyPieces) {
  const auto machine = kinematics::Kinematics::make(*model::find_machine("xyza"));
  cl::Program program;
  const std::vector<kinematics::Joints> joints{{{0, 0, 50}, {}}, {{0, 0, 50}, {6e6, 0}}};
  for (const auto& j : joints) program.add(cl::Rapid{machine->forward(j)});
  EXPECT_NE(failure(make_checked_path(program, joints, {}, *machine, mill, {})).find("move 1: more than"),
            std::string::npos);
}

}  // namespace
}  // namespace burin::verify
