// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace burin::orient {
namespace {

using geom::Vec3;
using kinematics::Joints;
using kinematics::Kinematics;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double in(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(engine_()) / 4294967296.0); }
  Vec3 direction() {
    const double z = in(-1, 1), turn = in(-geom::kPi, geom::kPi), r = std::sqrt(1 - z * z);
    return {r * std::cos(turn), r * std::sin(turn), z};
  }

 private:
  std::mt19937 engine_;
};

model::Machine tightened(const std::string& name, double linear, std::pair<double, double> first,
                         std::pair<double, double> second) {
  model::Machine machine = *model::find_machine(name);
  int rotary = 0;
  for (model::Axis& axis : machine.axes) {
    if (axis.kind == model::AxisKind::linear) {
      axis.min = -linear, axis.max = linear;
    } else {
      std::tie(axis.min, axis.max) = rotary++ == 0 ? first : second;
    }
  }
  return machine;
}

std::vector<Kinematics> machines() {
  std::vector<model::Machine> list;
  for (const char* name :
       {"xyz", "xyza", "xyzac-trunnion", "xyzbc-trunnion", "xyzbc-head-table", "propeller-head-head"})
    list.push_back(*model::find_machine(name));
  list.push_back(tightened("xyzac-trunnion", 99999, {-50, 200}, {-30, 110}));
  list.push_back(tightened("xyzac-trunnion", 120, {-720, 720}, {-30, 110}));
  list.push_back(tightened("xyzbc-head-table", 300, {10, 20}, {-5, 60}));
  list.push_back(tightened("propeller-head-head", 450, {-170, 170}, {5, 45}));
  // A nutating head: the second axis leans by 45 degrees, so that the tool does not reach below the horizon.
  model::Machine nutating = tightened("propeller-head-head", 99999, {-200, 100}, {-20, 180});
  for (model::Axis& axis : nutating.axes)
    if (axis.letter == 'B') axis.direction = unit(Vec3{0, 1, 1});
  list.push_back(nutating);
  std::vector<Kinematics> made;
  for (const model::Machine& machine : list) made.push_back(*Kinematics::make(machine));
  return made;
}

Joints random_within(const Kinematics& k, Random& random) {
  Joints j;
  for (std::size_t i = 0; i < 3; ++i) {
    const model::Axis& axis = *k.machine().axis(static_cast<char>('X' + i));
    j.linear[i] = random.in(std::max(axis.min, -500.0), std::min(axis.max, 500.0));
  }
  for (int i = 0; i < k.rotary_count(); ++i) {
    const model::Axis& axis = k.rotary_axis(i);
    j.rotary[static_cast<std::size_t>(i)] =
        geom::radians(random.in(std::max(axis.min, -900.0), std::min(axis.max, 900.0)));
  }
  return j;
}

TEST(MachineLimits, NoMachineAllowsEverything) {
  const MachineLimits limits;
  EXPECT_TRUE(limits.unlimited());
  EXPECT_TRUE(limits.within({{1e9, 0, 0}, {0, 0, -1}}));
}

// What joints within the travel bring about is within.
TEST(MachineLimits, TakesEveryPoseThatJointsWithinTheTravelMake) {
  Random random(3);
  for (const Kinematics& k : machines()) {
    const MachineLimits limits(k);
    ASSERT_FALSE(limits.unlimited());
    for (int n = 0; n < 20000; ++n) {
      const cl::Pose pose = k.forward(random_within(k, random));
      ASSERT_TRUE(limits.within(pose)) << k.machine().name << " case " << n;
    }
  }
}

/// Independent of the closed form: second angles at which the tool leans as far to the first axis as u does,
/// by halving between the steps of a scan; for each the first angle that comes nearest, by a scan and ever
/// smaller steps; then whether X, Y and Z are within there.
bool found_by_search(const Kinematics& k, const cl::Pose& pose) {
  const auto lo = [&](int i) { return geom::radians(std::max(k.rotary_axis(i).min, -360.0)); };
  const auto hi = [&](int i) { return geom::radians(std::min(k.rotary_axis(i).max, 360.0)); };
  const auto at = [&](int i, double t) { return lo(i) + (hi(i) - lo(i)) * t; };
  const Vec3 first = k.rotary_axis(0).direction;
  const auto lean = [&](double b) {
    return dot(first, k.forward({{}, {0, b}}).axis) - dot(first, pose.axis);
  };
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    double b0 = at(1, static_cast<double>(i) / kSteps), b1 = at(1, (i + 1.0) / kSteps);
    if (lean(b0) * lean(b1) > 0) continue;
    for (int n = 0; n < 50; ++n) (lean(b0) * lean(0.5 * (b0 + b1)) > 0 ? b0 : b1) = 0.5 * (b0 + b1);
    const auto off = [&](double a) { return norm(k.forward({{}, {a, b0}}).axis - pose.axis); };
    double best = lo(0);
    for (int n = 1; n <= kSteps; ++n)
      if (off(at(0, static_cast<double>(n) / kSteps)) < off(best))
        best = at(0, static_cast<double>(n) / kSteps);
    for (double step = (hi(0) - lo(0)) / kSteps; step > 1e-10; step *= 0.6)
      for (const double to : {std::max(best - step, lo(0)), std::min(best + step, hi(0))})
        if (off(to) < off(best)) best = to;
    if (off(best) > 1e-6) continue;
    Joints j{{}, {best, b0}};
    const Joints zero = j;
    const Vec3 to = pose.tip - k.forward(zero).tip;  // the tip goes with X, Y, Z, turned
    for (std::size_t n = 0; n < 3; ++n) {
      Joints by = zero;
      by.linear[n] = 1;
      j.linear[n] = dot(to, k.forward(by).tip - k.forward(zero).tip);
    }
    if (!k.violation(j)) return true;
  }
  return false;
}

TEST(MachineLimits, AgreesWithASearchOverAngles) {
  Random random(5);
  for (const Kinematics& k : machines()) {
    if (k.rotary_count() < 2) continue;
    const MachineLimits limits(k);
    int within = 0;
    for (int n = 0; n < 60; ++n) {
      const cl::Pose pose{{random.in(-120, 120), random.in(-120, 120), random.in(-120, 120)},
                          random.direction()};
      const bool is = limits.within(pose);
      within += is ? 1 : 0;
      ASSERT_EQ(is, found_by_search(k, pose)) << k.machine().name << " case " << n;
    }
    EXPECT_GT(within, 0) << k.machine().name;
  }
}

// The tool axis along the first rotary axis: any of its angles will do, and some keep X and Y within.
TEST(MachineLimits, TurnsAFreeAxisWhereTheTravelHasRoom) {
  Random random(9);
  const Kinematics k = *Kinematics::make(tightened("xyzac-trunnion", 100, {-40, 75}, {-30, 110}));
  const MachineLimits limits(k);
  int within = 0;
  for (int n = 0; n < 1000; ++n) {
    const cl::Pose pose{{random.in(-140, 140), random.in(-140, 140), random.in(-110, 110)}, {0, 0, 1}};
    bool some = false;
    double nearest = 1e9;  // of all angles: by how much the worst axis is beyond
    for (double c = -40; c <= 75; c += 0.05) {
      Joints near;
      near.rotary[0] = geom::radians(c);
      const Joints j = *k.inverse(pose, near);
      some |= !k.violation(j);
      nearest = std::min(
          nearest, std::max({std::abs(j.linear[0]), std::abs(j.linear[1]), std::abs(j.linear[2])}) - 100);
    }
    if (std::abs(nearest) < 0.2) continue;  // the scan's steps decide
    ASSERT_EQ(limits.within(pose), some) << n;
    within += some ? 1 : 0;
  }
  EXPECT_GT(within, 100);
  EXPECT_LT(within, 900);
}

TEST(MachineLimits, NonsenseIsNotWithin) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Kinematics& k : machines()) {
    const MachineLimits limits(k);
    EXPECT_FALSE(limits.within({{nan, 0, 0}, {0, 0, 1}}));
    EXPECT_FALSE(limits.within({{0, 0, 0}, {nan, 0, 1}}));
    EXPECT_FALSE(limits.within({{1e7, 0, 0}, {0, 0, 1}}));
  }
}

}  // namespace
}  // namespace burin::orient
