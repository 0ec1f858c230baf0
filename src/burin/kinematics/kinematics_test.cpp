// SPDX-License-Identifier: Apache-2.0
#include "burin/kinematics/kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace burin::kinematics {
namespace {

using geom::Point3;
using geom::Vec3;

const std::vector<std::string> kPresets{
    "xyz", "xyza", "xyzac-trunnion", "xyzbc-trunnion", "xyzbc-head-table", "propeller-head-head"};

Kinematics preset(const std::string& name) {
  auto machine = model::find_machine(name);
  EXPECT_TRUE(machine.ok());
  auto k = Kinematics::make(*machine);
  EXPECT_TRUE(k.ok()) << name;
  return *k;
}

/// Plain rotation matrices, not the library's formula.
Vec3 rx(double a, Vec3 v) {
  return {v.x, v.y * std::cos(a) - v.z * std::sin(a), v.y * std::sin(a) + v.z * std::cos(a)};
}
Vec3 ry(double b, Vec3 v) {
  return {v.x * std::cos(b) + v.z * std::sin(b), v.y, -v.x * std::sin(b) + v.z * std::cos(b)};
}
Vec3 rz(double c, Vec3 v) {
  return {v.x * std::cos(c) - v.y * std::sin(c), v.x * std::sin(c) + v.y * std::cos(c), v.z};
}
Vec3 vec(Point3 p) {
  return p - Point3{};
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double in(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(engine_()) / 4294967296.0); }

 private:
  std::mt19937 engine_;
};

Joints random_joints(const Kinematics& k, Random& random) {
  Joints j;
  for (double& value : j.linear) value = random.in(-300, 300);
  for (int i = 0; i < k.rotary_count(); ++i) {
    const model::Axis& axis = k.rotary_axis(i);
    j.rotary[static_cast<std::size_t>(i)] =
        geom::radians(random.in(std::max(axis.min, -900.0), std::min(axis.max, 900.0)));
  }
  return j;
}

double distance(const cl::Pose& a, const cl::Pose& b) {
  return std::max(geom::distance(a.tip, b.tip), norm(a.axis - b.axis));
}

TEST(Kinematics, ForwardUndoesInverseOnEveryPreset) {
  for (const std::string& name : kPresets) {
    const Kinematics k = preset(name);
    Random random(7);
    for (int n = 0; n < 20000; ++n) {
      const Joints joints = random_joints(k, random);
      const cl::Pose pose = k.forward(joints);
      ASSERT_NEAR(norm(pose.axis), 1, 1e-12);
      const auto back = k.inverse(pose, random_joints(k, random));
      ASSERT_TRUE(back.ok()) << name << ": " << back.error().to_string();
      ASSERT_LT(distance(k.forward(*back), pose), 1e-9) << name << " case " << n;
      ASSERT_FALSE(k.violation(*back)) << name << ": " << k.violation(*back)->text();
      // Near the truth the truth itself comes back, but where the first axis does not matter.
      if (k.rotary_count() == 2 && norm(cross(pose.axis, k.rotary_axis(0).direction)) < 1e-3) continue;
      const auto same = k.inverse(pose, joints);
      for (std::size_t i = 0; i < 2; ++i) ASSERT_NEAR(same->rotary[i], joints.rotary[i], 1e-6) << name;
    }
  }
}

// All solutions: each leads back to the pose, they differ, and the one inverse() takes is among them.
TEST(Kinematics, AllSolutionsLeadBack) {
  for (const std::string& name : kPresets) {
    const Kinematics k = preset(name);
    Random random(17);
    for (int n = 0; n < 5000; ++n) {
      const Joints joints = random_joints(k, random), near = random_joints(k, random);
      const cl::Pose pose = k.forward(joints);
      const Solutions all = k.inverse_all(pose);
      ASSERT_EQ(all.count, k.rotary_count() == 2 ? 2 : 1) << name;
      const auto turn_off = [](double a, double b) { return std::abs(std::remainder(a - b, 2 * geom::kPi)); };
      bool truth = false, nearest = false;
      const Joints chosen = *k.inverse(pose, near);
      for (std::size_t i = 0; i < static_cast<std::size_t>(all.count); ++i) {
        const Joints& j = all.joints[i];
        ASSERT_LT(distance(k.forward(j), pose), 1e-9) << name << " case " << n;
        for (std::size_t r = 0; r < 2; ++r) ASSERT_LE(std::abs(j.rotary[r]), geom::kPi);
        const auto same = [&](const Joints& other) {
          return turn_off(j.rotary[0], other.rotary[0]) < 1e-6 &&
                 turn_off(j.rotary[1], other.rotary[1]) < 1e-6;
        };
        truth |= same(joints);
        nearest |= same(chosen);
      }
      ASSERT_TRUE(truth && nearest) << name << " case " << n;
      if (all.count == 2) {
        ASSERT_GT(std::max(turn_off(all.joints[0].rotary[0], all.joints[1].rotary[0]),
                           turn_off(all.joints[0].rotary[1], all.joints[1].rotary[1])),
                  1e-6);
      }
    }
    EXPECT_EQ(k.inverse_all({{0, 0, 0}, {0.6, 0, 0.8}}).count, k.rotary_count() == 2 ? 2 : 0) << name;
    Joints free;
    free.rotary = {0.7, 0.7};
    const Solutions upright = k.inverse_all({{5, 6, 7}, {0, 0, 1}}, free);
    EXPECT_EQ(upright.count, 1) << name;
    if (k.rotary_count() == 2) {
      EXPECT_TRUE(upright.free[0]) << name;
      EXPECT_EQ(upright.joints[0].rotary[0], 0.7) << name;
      EXPECT_LT(distance(k.forward(upright.joints[0]), {{5, 6, 7}, {0, 0, 1}}), 1e-12);
    }
  }
}

// A tool axis that nearly runs along the first rotary axis keeps all its digits.
TEST(Kinematics, NextToAPoleNothingIsLost) {
  Random random(23);
  std::vector<Kinematics> machines;
  for (const char* name : {"xyzac-trunnion", "xyzbc-trunnion", "xyzbc-head-table", "propeller-head-head"})
    machines.push_back(preset(name));
  // A nutating head: its pole is where the second axis has turned half round.
  model::Machine nutating = *model::find_machine("propeller-head-head");
  for (model::Axis& axis : nutating.axes)
    if (axis.letter == 'B') axis.direction = unit(Vec3{0, 1, 1}), axis.min = -200, axis.max = 200;
  machines.push_back(*Kinematics::make(nutating));
  for (const Kinematics& k : machines) {
    for (int n = 0; n < 4000; ++n) {
      const double tilt = std::pow(10.0, random.in(-12, 0)), yaw = random.in(-3, 3);
      const cl::Pose pose{{random.in(-100, 100), random.in(-100, 100), random.in(-100, 100)},
                          {std::sin(tilt) * std::cos(yaw), std::sin(tilt) * std::sin(yaw), std::cos(tilt)}};
      const auto back = k.inverse(pose, random_joints(k, random));
      ASSERT_TRUE(back.ok());
      ASSERT_LT(distance(k.forward(*back), pose), 1.1e-9) << k.machine().name << " tilt " << tilt;
    }
  }
}

// The machines as the specification writes them: p' = Rx(A) Rz(C) p and so on, X, Y, Z = p' + L u' - (0, 0,
// L).
TEST(Kinematics, PresetsAgreeWithTheirFormulas) {
  Random random(11);
  std::map<std::string, Kinematics> presets;
  for (const std::string& name : kPresets) presets.emplace(name, preset(name));
  for (int n = 0; n < 2000; ++n) {
    const double first = random.in(-3, 3), second = random.in(-1.5, 1.5);
    const Point3 tip{random.in(-50, 50), random.in(-50, 50), random.in(-50, 50)};
    const auto expect = [&](const std::string& name, Vec3 turned_tip, Vec3 up, double pivot) {
      const Kinematics& k = presets.at(name);
      Joints j;
      j.rotary = {first, k.rotary_count() == 2 ? second : 0};
      const Vec3 xyz = turned_tip + pivot * up - Vec3{0, 0, pivot};
      j.linear = {xyz.x, xyz.y, xyz.z};
      EXPECT_LT(geom::distance(k.forward(j).tip, tip), 1e-10) << name;
    };
    const Vec3 z{0, 0, 1};
    expect("xyza", rx(first, vec(tip)), z, 0);
    expect("xyzac-trunnion", rx(second, rz(first, vec(tip))), z, 0);
    expect("xyzbc-trunnion", ry(second, rz(first, vec(tip))), z, 0);
    expect("xyzbc-head-table", rz(first, vec(tip)), ry(second, z), 150);
    expect("propeller-head-head", vec(tip), rz(first, ry(second, z)), 300);
  }
}

TEST(Kinematics, ThetaOfTheRotaryPlannerIsA) {
  const Kinematics k = preset("xyza");
  for (double theta = -10; theta < 10; theta += 0.37) {
    const cl::Pose pose{{5, 3, -2}, {0, std::sin(theta), std::cos(theta)}};
    Joints near;
    near.rotary[0] = theta + 1;
    const auto j = k.inverse(pose, near);
    ASSERT_TRUE(j.ok());
    EXPECT_NEAR(j->rotary[0], theta, 1e-12);
    EXPECT_NEAR(j->linear[1], 3 * std::cos(theta) + 2 * std::sin(theta), 1e-12);
    EXPECT_NEAR(j->linear[2], 3 * std::sin(theta) - 2 * std::cos(theta), 1e-12);
  }
}

TEST(Kinematics, PolesKeepTheAxisThatDoesNotMatter) {
  for (const std::string name :
       {"xyzac-trunnion", "xyzbc-trunnion", "xyzbc-head-table", "propeller-head-head"}) {
    const Kinematics k = preset(name);
    Joints near;
    near.rotary = {2.5, 0.1};
    const auto j = k.inverse({{1, 2, 3}, {0, 0, 1}}, near);
    ASSERT_TRUE(j.ok());
    EXPECT_EQ(j->rotary[0], 2.5) << name;
    EXPECT_NEAR(j->rotary[1], 0, 1e-12) << name;
    EXPECT_LT(distance(k.forward(*j), {{1, 2, 3}, {0, 0, 1}}), 1e-12);
  }
}

TEST(Kinematics, TakesAWholeTurnToStayWithinLimits) {
  auto machine = *model::find_machine("xyza");
  machine.axes[0].min = -10;
  machine.axes[0].max = 400;
  const auto k = Kinematics::make(machine);
  Joints near;
  near.rotary[0] = geom::radians(395);
  const double theta = geom::radians(50);  // 410 is nearer, 50 is within the limits
  const auto j = k->inverse({{0, 0, 10}, {0, std::sin(theta), std::cos(theta)}}, near);
  ASSERT_TRUE(j.ok());
  EXPECT_NEAR(geom::degrees(j->rotary[0]), 50, 1e-9);
  EXPECT_FALSE(k->violation(*j));
}

TEST(Kinematics, ErrorsSayWhatIsWrong) {
  const Kinematics k = preset("xyza");
  const auto tilted = k.inverse({{0, 0, 0}, unit(Vec3{0.1, 0, 1})}, {});
  ASSERT_FALSE(tilted.ok());
  EXPECT_EQ(tilted.error().code, ErrorCode::unsupported);
  EXPECT_FALSE(preset("xyz").inverse({{0, 0, 0}, {0, 1, 0}}, {}).ok());

  Joints far;
  far.linear[0] = 1e6;
  ASSERT_TRUE(k.violation(far));
  EXPECT_EQ(k.violation(far)->text(), "X 1000000 mm (-99999 to 99999)");

  auto machine = *model::find_machine("xyzac-trunnion");
  machine.axes[1].direction = machine.axes[0].direction;
  EXPECT_FALSE(Kinematics::make(machine).ok());
  machine = *model::find_machine("xyza");
  machine.axes.pop_back();
  EXPECT_FALSE(Kinematics::make(machine).ok());
}

}  // namespace
}  // namespace burin::kinematics
