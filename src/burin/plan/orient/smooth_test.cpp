// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/smooth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "burin/plan/orient/contact_cases.h"
#include "burin/plan/orient/layers.h"

namespace burin::orient {
namespace {

using geom::Vec3;
using kinematics::Kinematics;

constexpr double kDegree = geom::kPi / 180;

/// Every way through the layers, every solution in each.
double by_trying_all(const std::vector<Layer>& layers, const std::vector<double>& ways, const EdgeCost& cost,
                     std::size_t i, std::size_t before, int branch_before) {
  if (i == layers.size()) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < layers[i].size(); ++c)
    for (int b = 0; b < std::max(1, layers[i][c].rotary.count); ++b) {
      double sum = layers[i][c].loss + by_trying_all(layers, ways, cost, i + 1, c, b);
      if (i > 0) sum += edge_cost(cost, layers[i - 1][before], branch_before, layers[i][c], b, ways[i - 1]);
      least = std::min(least, sum);
    }
  return least;
}

TEST(Layers, CheapestOfAllWays) {
  std::mt19937 engine(4);
  const auto in = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine()) / 4294967296.0;
  };
  const Kinematics trunnion = *Kinematics::make(*model::find_machine("xyzac-trunnion"));
  for (int n = 0; n < 40; ++n) {
    const AxisMotion motion(n % 2 == 0 ? &trunnion : nullptr, 500);
    std::vector<Layer> layers(4);
    std::vector<double> ways;
    for (Layer& layer : layers) {
      for (int c = 0; c < 3; ++c) {
        const double tilt = in(0.01, 0.6), yaw = in(-3, 3);
        Choice choice;
        choice.loss = in(0, 4);
        choice.pose = {{in(-9, 9), in(-9, 9), 0},
                       {std::sin(tilt) * std::cos(yaw), std::sin(tilt) * std::sin(yaw), std::cos(tilt)}};
        choice.rotary = motion.rotary(choice.pose);
        layer.push_back(choice);
      }
      ways.push_back(in(0, 3));
    }
    const EdgeCost cost{&motion, 3, 20};
    const std::vector<std::size_t> way = cheapest_way(layers, ways, cost);
    // The cost of the way found, with its best solutions: layers of one choice each.
    std::vector<Layer> found;
    for (std::size_t i = 0; i < layers.size(); ++i) found.push_back({layers[i][way[i]]});
    ASSERT_NEAR(by_trying_all(found, ways, cost, 0, 0, 0), by_trying_all(layers, ways, cost, 0, 0, 0), 1e-9);
  }
}

/// A plane between two walls, one on either side, which do not stand beside the same places: the mill has to
/// lean away from the first, then from the second.
struct Gate {
  model::Mill mill{model::MillKind::flat, 10, 0, 30, {}};
  cases::Shape shape{"gate", cases::flat, {{{-60, 5, -5}, {-20, 20, 40}}, {{20, -20, -5}, {60, -5, 40}}}, 60};
  geom::Mesh mesh = cases::triangles(shape, 5);
  Scene scene{mesh, mill, tool_body(mill, 0.01, 1)};
  MachineLimits limits;
  Setting setting{&scene, &limits, {2 * kDegree, 25 * kDegree, -geom::kPi / 2, geom::kPi / 2}};
  RadiusGoal goal{mill};
  std::vector<CcPoint> points;
  std::vector<Optimum> best;

  explicit Gate(double step) {
    Scene::Memory memory;
    Experience experience;
    for (double x = -45; x <= 45; x += step) {
      points.push_back(cases::contact(shape, x, 0, 0));
      best.push_back(find_optimal(setting, goal, points.back(), memory, experience));
    }
  }
  cl::Pose at(std::size_t i, const Angles& angles) const { return pose(points[i], angles, mill); }
};

/// The largest speed share of the rotary axes along poses, by the kinematics' own nearest solutions.
double speed_share(const Kinematics& machine, const std::vector<cl::Pose>& poses, double feed) {
  double share = 0;
  kinematics::Joints at;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const kinematics::Joints to = *machine.inverse(poses[i], at);
    if (i > 0) {
      const double minutes = geom::distance(poses[i].tip, poses[i - 1].tip) / feed;
      for (std::size_t k = 0; k < 2; ++k)
        share = std::max(share, std::abs(geom::degrees(to.rotary[k] - at.rotary[k])) / minutes /
                                    machine.rotary_axis(static_cast<int>(k)).speed);
    }
    at = to;
  }
  return share;
}

TEST(Smooth, TurnsEarlyWhereTheSideChanges) {
  const Gate gate(1.5);
  double jump = 0;
  std::vector<cl::Pose> poses_before;
  for (std::size_t i = 0; i < gate.points.size(); ++i) {
    ASSERT_TRUE(gate.best[i].found);
    poses_before.push_back(gate.at(i, gate.best[i].angles));
    if (i > 0) jump = std::max(jump, std::abs(gate.best[i].angles.beta - gate.best[i - 1].angles.beta));
  }
  EXPECT_GT(jump, 5 * kDegree);  // the optima leap
  EXPECT_GT(gate.best.front().angles.beta, 25 * kDegree);
  EXPECT_LT(gate.best.back().angles.beta, -25 * kDegree);

  model::Machine slow = *model::find_machine("xyzac-trunnion");
  for (model::Axis& axis : slow.axes)
    if (axis.kind == model::AxisKind::rotary) axis.speed = 3500;
  const Kinematics machine = *Kinematics::make(slow);
  SmoothOptions options;
  options.machine = &machine;
  Scene::Memory memory;
  const SmoothPath path = smooth_path(gate.setting, gate.goal, gate.points, gate.best, options, memory);
  ASSERT_EQ(path.points.size(), gate.points.size());
  std::vector<cl::Pose> poses;
  double smooth_jump = 0, loss = 0;
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const SmoothPoint& point = path.points[i];
    ASSERT_TRUE(point.found);
    Scene::Memory fresh;
    ASSERT_EQ(cause_at(gate.setting, gate.points[i], point.angles, fresh), Cause::none) << i;
    EXPECT_EQ(point.value, gate.goal.value(gate.points[i], point.angles));
    poses.push_back(gate.at(i, point.angles));
    loss += 1 - point.value / gate.best[i].value;
    if (i > 0)
      smooth_jump = std::max(smooth_jump, std::abs(point.angles.beta - path.points[i - 1].angles.beta));
    // Far from the change of sides nothing is given up.
    if (std::abs(gate.points[i].c.x) > 38) {
      EXPECT_GT(point.value, 0.999 * gate.best[i].value) << i;
    }
  }
  EXPECT_LT(smooth_jump, 0.8 * jump);
  EXPECT_GT(speed_share(machine, poses_before, options.feed_mm_min), 1);
  EXPECT_LE(speed_share(machine, poses, options.feed_mm_min), 1 + 1e-9);
  EXPECT_NEAR(speed_share(machine, poses, options.feed_mm_min), path.speed_share, 1e-9);
  EXPECT_NEAR(path.value_loss, loss / static_cast<double>(poses.size()), 1e-12);
  EXPECT_LT(path.value_loss, 0.06);
  EXPECT_LE(path.turn, 1.05 * path.turn_before);
}

/// The largest change of a rotary axis' speed over the mean time of two steps, as a share of its
/// acceleration; deg, s.
double acceleration_share(const Kinematics& machine, const std::vector<cl::Pose>& poses, double feed) {
  std::vector<kinematics::Joints> joints;
  for (const cl::Pose& pose : poses)
    joints.push_back(*machine.inverse(pose, joints.empty() ? kinematics::Joints{} : joints.back()));
  double share = 0;
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const double s0 = 60 * geom::distance(poses[i].tip, poses[i - 1].tip) / feed;
    const double s1 = 60 * geom::distance(poses[i + 1].tip, poses[i].tip) / feed;
    for (std::size_t k = 0; k < 2; ++k) {
      const double v0 = geom::degrees(joints[i].rotary[k] - joints[i - 1].rotary[k]) / s0;
      const double v1 = geom::degrees(joints[i + 1].rotary[k] - joints[i].rotary[k]) / s1;
      share = std::max(share, std::abs(v1 - v0) / (0.5 * (s0 + s1)) /
                                  machine.rotary_axis(static_cast<int>(k)).acceleration);
    }
  }
  return share;
}

TEST(Smooth, EasesAccelerations) {
  const Gate gate(1.5);
  std::vector<cl::Pose> before, after;
  for (std::size_t i = 0; i < gate.points.size(); ++i) before.push_back(gate.at(i, gate.best[i].angles));
  model::Machine slow = *model::find_machine("xyzac-trunnion");
  for (model::Axis& axis : slow.axes)
    if (axis.kind == model::AxisKind::rotary) axis.acceleration = 250;
  const Kinematics machine = *Kinematics::make(slow);
  SmoothOptions options;
  options.machine = &machine;
  Scene::Memory memory;
  const SmoothPath path = smooth_path(gate.setting, gate.goal, gate.points, gate.best, options, memory);
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    Scene::Memory fresh;
    ASSERT_EQ(cause_at(gate.setting, gate.points[i], path.points[i].angles, fresh), Cause::none) << i;
    after.push_back(gate.at(i, path.points[i].angles));
  }
  EXPECT_GT(acceleration_share(machine, before, options.feed_mm_min), 2);
  EXPECT_LE(acceleration_share(machine, after, options.feed_mm_min), 1 + 1e-9);
  EXPECT_NEAR(acceleration_share(machine, after, options.feed_mm_min), path.acceleration_share, 1e-9);
  EXPECT_LT(path.value_loss, 0.08);
}

TEST(Smooth, LeavesEvenOptimaAlone) {
  const Gate gate(3);
  // Points beside the first wall only: one optimum for all.
  const std::vector<CcPoint> points(gate.points.begin(), gate.points.begin() + 5);
  std::vector<Optimum> best(gate.best.begin(), gate.best.begin() + 5);
  Scene::Memory memory;
  const SmoothPath path = smooth_path(gate.setting, gate.goal, points, best, {}, memory);
  EXPECT_LT(path.value_loss, 1e-3);

  // A point without allowed angles stays so, and splits the path.
  best[2].found = false;
  const SmoothPath split = smooth_path(gate.setting, gate.goal, points, best, {}, memory);
  EXPECT_FALSE(split.points[2].found);
  EXPECT_TRUE(split.points[1].found && split.points[3].found);
  EXPECT_TRUE(smooth_path(gate.setting, gate.goal, {}, {}, {}, memory).points.empty());
}

}  // namespace
}  // namespace burin::orient
