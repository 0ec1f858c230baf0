// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "burin/plan/laser/toolpath.h"

namespace burin::laser {
namespace {

constexpr double kA = 3000, kRapid = 20000;
const MotionLimits kLimits{kRapid, kA, 0.3};

cl::Pose at(double x, double y) {
  return {{x, y, 0}, {0, 0, 1}};
}

cl::Program start() {
  cl::Program p;
  p.add(cl::Rapid{at(0, 0)});
  return p;
}

TEST(EstimateTime, ALineIsATrapezoid) {
  const double v = 6000.0 / 60;
  for (const double length : {0.5, 3.0, 10.0, 500.0}) {
    cl::Program p = start();
    p.add(cl::Feed{at(length, 0)});
    const double want = length >= v * v / kA ? length / v + v / kA : 2 * std::sqrt(length / kA);
    EXPECT_NEAR(estimate_time(p, kLimits, 6000), want, 1e-9);
  }
}

TEST(EstimateTime, CutIntoPiecesALineTakesTheSameTime) {
  cl::Program whole = start(), pieces = start();
  whole.add(cl::Feed{at(70, 0)});
  for (int i = 1; i <= 1000; ++i) pieces.add(cl::Feed{at(0.07 * i, 0)});
  EXPECT_NEAR(estimate_time(pieces, kLimits, 9000), estimate_time(whole, kLimits, 9000), 1e-6);
}

TEST(EstimateTime, ASquareCornerIsPassedAtTheSpeedTheChangeAllows) {
  cl::Program p = start();
  p.add(cl::Feed{at(100, 0)});
  p.add(cl::Feed{at(100, 100)});
  const double v = 100, corner = kA * 1e-3 / std::sqrt(2.0);
  // Each leg: one ramp between 0 and v, one between v and the corner speed.
  const double ramps = v / kA + (v - corner) / kA;
  const double distance = v * v / (2 * kA) + (v * v - corner * corner) / (2 * kA);
  EXPECT_NEAR(estimate_time(p, kLimits, 6000), 2 * (ramps + (100 - distance) / v), 1e-9);
}

TEST(EstimateTime, SmallCirclesAreLimitedByCentripetalAcceleration) {
  cl::Program p = start();
  const double r = 0.5, v = std::sqrt(kA * r);
  for (int i = 0; i < 50; ++i) p.add(cl::Arc{{r, 0, 0}, {0, 0, 1}, r, at(0, 0)});
  const double length = 50 * 2 * geom::kPi * r;
  EXPECT_NEAR(estimate_time(p, kLimits, 60000), length / v + v / kA, 1e-9);
}

TEST(EstimateTime, ClockwiseArcsAreAsLongAsTheyAre) {
  // Three quarters of a circle clockwise from (0, 0) about (10, 0) to (10, -10).
  cl::Program p = start();
  p.add(cl::Arc{{10, 0, 0}, {0, 0, -1}, 10, at(10, -10)});
  const double v = 10, length = 1.5 * geom::kPi * 10;
  EXPECT_NEAR(estimate_time(p, kLimits, 600), length / v + v / kA, 1e-9);
}

TEST(EstimateTime, BeamOnCostsAPierceAndAStop) {
  cl::Program p = start();
  p.add(cl::FeedRate{6000});
  p.add(cl::Feed{at(100, 0)});
  const double through = estimate_time(p, kLimits, 1);
  cl::Program q = start();
  q.add(cl::FeedRate{6000});
  q.add(cl::Feed{at(50, 0)});
  q.add(cl::Beam{true, 500});
  q.add(cl::Beam{true, 200});  // another power is no pierce
  q.add(cl::Feed{at(100, 0)});
  q.add(cl::Beam{});
  EXPECT_NEAR(estimate_time(q, kLimits, 1), through + 0.3 + 100 / kA, 1e-9);
  q.add(cl::Dwell{1.5});
  EXPECT_NEAR(estimate_time(q, kLimits, 1), through + 1.8 + 100 / kA, 1e-9);
}

TEST(EstimateTime, RapidsRunAtRapidSpeed) {
  cl::Program p = start();
  p.add(cl::Rapid{at(1000, 0)});
  const double v = kRapid / 60;
  EXPECT_NEAR(estimate_time(p, kLimits, 100), 1000 / v + v / kA, 1e-9);
}

TEST(EstimateTime, TheFirstMoveCountsWhenTheStartIsKnown) {
  cl::Program p = start(), q;
  p.add(cl::Rapid{at(1000, 0)});
  q.from = at(0, 0);
  q.add(cl::Rapid{at(1000, 0)});
  EXPECT_EQ(estimate_time(q, kLimits, 100), estimate_time(p, kLimits, 100));
}

TEST(EstimateTime, NonsenseLimitsDoNotBreakIt) {
  cl::Program p = start();
  p.add(cl::Feed{at(100, 0)});
  p.add(cl::Feed{at(100, 0)});
  p.add(cl::Arc{{100, 0, 0}, {0, 0, 1}, 0, at(100, 0)});
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    const double t = estimate_time(p, {bad, bad, bad}, 6000);
    EXPECT_NEAR(t, 1.0, 1e-9);
    EXPECT_TRUE(std::isfinite(estimate_time(p, kLimits, bad)));
  }
  EXPECT_EQ(estimate_time({}, kLimits, 100), 0);
}

}  // namespace
}  // namespace burin::laser
