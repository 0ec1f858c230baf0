// SPDX-License-Identifier: Apache-2.0
#include "burin/servo/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "burin/servo/measure.h"

namespace burin::servo {
namespace {

using geom::Point3;
using geom::Vec3;

Stretch line(Point3 a, Point3 b, double feed) {
  return {geom::straight(a, b), {}, feed, -1, -1};
}

Plan planned(const std::vector<Stretch>& stretches, const Limits& limits = {}) {
  Diagnostics diagnostics;
  auto result = plan(stretches, limits, diagnostics);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
  return result.ok() ? *result : Plan{};
}

void expect_within(const Plan& p, const std::vector<Setpoint>& s) {
  const Quality q = measure(p, s);
  const double t = p.limits.period_s;
  EXPECT_LE(q.accel_max_mm_s2, p.limits.accel_mm_s2 * (1 + 1e-9) + 1e-12 / (t * t));
  EXPECT_LE(q.jerk_max_mm_s3, p.limits.jerk_mm_s3 * (1 + 1e-9) + 1e-12 / (t * t * t));
  EXPECT_LE(q.chord_error_max_mm, p.limits.chord_error_mm * (1 + 1e-9) + 1e-12);
  EXPECT_LT(q.feed_fluctuation_max, 1e-6);
}

/// Time of the fastest motion from rest to rest over `s` with jerk j, acceleration a, speed v.
double fastest(double s, double v, double a, double j) {
  const auto ramp = [a, j](double speed) {
    return speed <= a * a / j ? 2 * std::sqrt(speed / j) : speed / a + a / j;
  };
  if (ramp(v) * v <= s) return s / v + ramp(v);
  double lo = 0, hi = v;
  for (int i = 0; i < 100; ++i) {
    const double mid = 0.5 * (lo + hi);
    (ramp(mid) * mid < s ? lo : hi) = mid;
  }
  return 2 * ramp(lo);
}

TEST(Plan, StraightLineIsAsFastAsPossible) {
  const Limits limits;
  for (const double length : {1e-6, 1e-3, 0.3, 2.0, 30.0, 500.0}) {
    for (const double feed : {60.0, 3000.0, 30000.0, 120000.0}) {
      const Plan p = planned({line({1, 2, 3}, {1 + length, 2, 3}, feed)});
      const auto s = run(p);
      expect_within(p, s);
      EXPECT_EQ(s.front().x, 1);
      EXPECT_EQ(s.back().x, 1 + length);
      const double best = fastest(length, feed / 60, limits.accel_mm_s2, limits.jerk_mm_s3);
      EXPECT_LE(p.duration_s, best * 1.002 + 2 * limits.period_s) << length << " " << feed;
      EXPECT_GE(p.duration_s, best * 0.999) << length << " " << feed;
    }
  }
}

TEST(Plan, CircleRunsAtItsFeed) {
  const Plan p = planned({{geom::arc({10, 0, 0}, {0, 0, 0}, {0, 0, 1}, 2 * geom::kPi, 0), {}, 1200, 0, 3}});
  const auto s = run(p);
  expect_within(p, s);
  EXPECT_EQ(p.runs.size(), 1u);
  double top = 0;
  for (const Setpoint& x : s) top = std::max(top, x.feed_mm_min);
  EXPECT_NEAR(top, 1200, 1e-3);
  EXPECT_NEAR(p.duration_s, 2 * geom::kPi * 10 / 20, 0.1);
  EXPECT_EQ(s[100].pass, 3);
}

TEST(Plan, CornersAreSetpoints) {
  const Plan p = planned({line({0, 0, 0}, {10, 0, 0}, 3000), line({10, 0, 0}, {10, 10, 0}, 3000),
                          line({10, 10, 0}, {10, 10, -5}, 0)});
  const auto s = run(p);
  expect_within(p, s);
  ASSERT_EQ(p.runs.size(), 3u);
  const auto& corner = s[static_cast<std::size_t>(p.runs[0].end_tick)];
  EXPECT_EQ(corner.x, 10);
  EXPECT_EQ(corner.y, 0);
  EXPECT_EQ(corner.feed_mm_min, 0);
}

/// Tangent arcs: the curvature jumps, and with it the acceleration within one period; v^2 / (r T) <= J.
TEST(Plan, ArcsBetweenLinesSlowDownWhereTheCurvatureJumps) {
  const Plan p = planned({line({0, 0, 0}, {20, 0, 0}, 3000),
                          {geom::arc({20, 0, 0}, {20, 5, 0}, {0, 0, 1}, geom::kPi, 0), {}, 3000},
                          line({20, 10, 0}, {0, 10, 0}, 3000)});
  const auto s = run(p);
  expect_within(p, s);
  EXPECT_EQ(p.runs.size(), 1u);
  const double allowed = std::sqrt(50000 * 5 * 1e-3);  // 15.8 mm/s at the joint, 50 elsewhere
  double at_joint = 1e9, top = 0;
  for (const Setpoint& x : s) {
    top = std::max(top, x.feed_mm_min / 60);
    if (std::abs(x.x - 20) < 0.02 && x.y < 1) at_joint = std::min(at_joint, x.feed_mm_min / 60);
  }
  EXPECT_NEAR(top, 50, 1e-3);
  EXPECT_GT(at_joint, 0.8 * allowed);
  EXPECT_LE(at_joint, 1.001 * allowed);
  EXPECT_LT(p.duration_s, 1.4);
}

TEST(Plan, FeedsChangeWithinARunWithoutAStop) {
  const Plan p = planned({line({0, 0, 0}, {10, 0, 0}, 600), line({10, 0, 0}, {20, 0, 0}, 6000),
                          line({20, 0, 0}, {30, 0, 0}, 1200), line({30, 0, 0}, {40, 0, 0}, 0)});
  const auto s = run(p);
  expect_within(p, s);
  EXPECT_EQ(p.runs.size(), 1u);
  for (const Setpoint& x : s) {
    const double feed = x.x < 10 ? 600 : x.x < 20 ? 6000 : x.x < 30 ? 1200 : 10000;
    EXPECT_LE(x.feed_mm_min, feed * (1 + 1e-6)) << x.x;
  }
}

TEST(Plan, AxisVelocityAndChordErrorBind) {
  Limits limits;
  limits.axis_velocity_mm_s = 20;
  const Plan p = planned({line({0, 0, 0}, {30, 30, 0}, 6000)}, limits);
  double top = 0;
  for (const Setpoint& x : run(p)) top = std::max(top, x.feed_mm_min / 60);
  EXPECT_NEAR(top, 20 * std::sqrt(2.0), 1e-3);

  Limits coarse;
  coarse.period_s = 0.01;
  coarse.chord_error_mm = 0.002;
  const Plan circle = planned({{geom::arc({10, 0, 0}, {0, 0, 0}, {0, 0, 1}, 6, 0), {}, 6000}}, coarse);
  const auto s = run(circle);
  expect_within(circle, s);
  const double bound = std::sqrt(8 * 0.002 * 10 - 4 * 0.002 * 0.002) / 0.01;
  top = 0;
  for (const Setpoint& x : s) top = std::max(top, x.feed_mm_min / 60);
  EXPECT_LE(top, bound);
  EXPECT_GT(top, 0.98 * bound);
}

/// Surface parameters come from their own polynomials at the same place.
TEST(Plan, SurfaceParametersFollow) {
  geom::QuinticPath path, uv;
  for (int i = 0; i <= 10; ++i) {
    const double t = i;  // x = t^2 / 4 + t, u = t / 10, v = 1 - t^2 / 100
    path.nodes.push_back({t, {t * t / 4 + t, 0, 0}, {t / 2 + 1, 0, 0}, {0.5, 0, 0}});
    uv.nodes.push_back({t, {t / 10, 1 - t * t / 100, 0}, {0.1, -t / 50, 0}, {0, -0.02, 0}});
  }
  const Plan p = planned({line({-5, 0, 0}, {0, 0, 0}, 3000), {path, uv, 3000, 2, 5}});
  const auto s = run(p);
  EXPECT_EQ(p.runs.size(), 1u);
  EXPECT_EQ(s.front().surface, -1);
  EXPECT_TRUE(std::isnan(s.front().u));
  for (const Setpoint& x : s) {
    if (x.surface != 2) continue;
    EXPECT_EQ(x.pass, 5);
    const double t = 2 * (std::sqrt(1 + x.x) - 1);
    EXPECT_NEAR(x.u, t / 10, 1e-12);
    EXPECT_NEAR(x.v, 1 - t * t / 100, 1e-12);
  }
  EXPECT_NEAR(s.back().u, 1, 1e-12);
}

TEST(Plan, NodesWithoutSpeedAndCusps) {
  // Straight with t^3 (no stop needed), a true cusp in the middle of a piece, one at a node.
  geom::QuinticPath cubic, cusp, node;
  for (const double t : {-1.0, 0.0, 1.0}) {
    cubic.nodes.push_back({t, {t * t * t, 0, 0}, {3 * t * t, 0, 0}, {6 * t, 0, 0}});
    node.nodes.push_back({t, {t * t, t * t * t, 0}, {2 * t, 3 * t * t, 0}, {2, 6 * t, 0}});
  }
  for (const double t : {-1.0, 0.7})
    cusp.nodes.push_back({t, {t * t, t * t * t, 0}, {2 * t, 3 * t * t, 0}, {2, 6 * t, 0}});
  for (const auto& path : {cubic, cusp, node}) {
    const Plan p = planned({{path, {}, 1200}});
    const auto s = run(p);
    expect_within(p, s);
    EXPECT_LT(p.duration_s, 3);
    for (const Setpoint& x : s) EXPECT_TRUE(std::isfinite(x.x) && std::isfinite(x.y));
    // The middle, where the tip of a cusp is, is reached.
    double nearest = 1;
    for (const Setpoint& x : s) nearest = std::min(nearest, std::hypot(x.x, x.y));
    EXPECT_LT(nearest, 0.011);
  }
}

TEST(Plan, TurningBackOnItselfBetweenNodes) {
  // A path that is raised where it would run under an overhang comes back the way it went, all but exactly:
  // hairpins far smaller than the slowest step (5e-6 mm), anywhere in a piece.
  for (int i = 0; i < 200; ++i) {
    const double tip = 0.2 + 0.6 * std::fmod(0.618034 * i, 1.0),
                 wide = i % 4 == 0 ? 0 : std::pow(10, -4 - i % 7);
    geom::QuinticPath path;
    for (const double t : {0.0, 1.0}) {
      const double d = t - tip;
      path.nodes.push_back(
          {t, {3 - 5 * d * d, 10 + 2 * d * d, wide * d}, {-10 * d, 4 * d, wide}, {-10, 4, 0}});
    }
    Diagnostics diagnostics;
    const std::vector<Stretch> stretches{{path, {}, 2000}};
    const auto made = plan(stretches, {}, diagnostics);
    ASSERT_TRUE(made.ok()) << "tip at " << tip << ", " << wide << " mm wide: " << made.error().message;
    EXPECT_EQ(diagnostics.count("servo_slowed"), 0u) << "tip at " << tip << ", " << wide << " mm wide";
    const auto s = run(*made);
    expect_within(*made, s);
    double nearest = 1;
    for (const Setpoint& x : s) nearest = std::min(nearest, std::hypot(x.x - 3, x.y - 10, x.z));
    EXPECT_LT(nearest, 1e-3) << "tip at " << tip << ", " << wide << " mm wide";
  }
}

TEST(Plan, NothingToMove) {
  EXPECT_EQ(planned({}).setpoints, 0u);
  const Plan p = planned({line({1, 2, 3}, {1, 2, 3}, 100)});
  ASSERT_EQ(p.setpoints, 1u);
  const auto s = run(p);
  EXPECT_EQ(s[0].x, 1);
  EXPECT_EQ(s[0].z, 3);
  // Zero-length stretches between others are passed over.
  const Plan q = planned(
      {line({0, 0, 0}, {5, 0, 0}, 600), line({5, 0, 0}, {5, 0, 0}, 600), line({5, 0, 0}, {9, 0, 0}, 600)});
  EXPECT_EQ(q.runs.size(), 1u);
}

TEST(Plan, RefusesWithAReason) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto refused = [](const std::vector<Stretch>& stretches, const Limits& limits, const char* word) {
    Diagnostics diagnostics;
    const auto made = plan(stretches, limits, diagnostics);
    ASSERT_FALSE(made.ok()) << word;
    EXPECT_NE(made.error().message.find(word), std::string::npos) << made.error().message;
    EXPECT_NE(made.error().message.find('('), std::string::npos) << made.error().message;
  };
  const std::vector<Stretch> good{line({0, 0, 0}, {1, 0, 0}, 100)};
  for (double Limits::*limit : {&Limits::period_s, &Limits::chord_error_mm, &Limits::accel_mm_s2,
                                &Limits::jerk_mm_s3, &Limits::axis_velocity_mm_s, &Limits::rapid_mm_min}) {
    for (const double value : {0.0, -1.0, nan, inf, 1e-300}) {
      Limits limits;
      limits.*limit = value;
      refused(good, limits, "not possible");
    }
  }
  refused({{{}, {}, 100}}, {}, "two nodes");
  refused({line({0, 0, 0}, {1, 0, 0}, -5)}, {}, "feed");
  refused({line({0, 0, 0}, {1, 0, 0}, nan)}, {}, "feed");
  refused({line({0, 0, 0}, {1, 0, 0}, 100), line({1, 1e-6, 0}, {2, 0, 0}, 100)}, {}, "mm from the end");
  refused({line({0, 0, 0}, {1e8, 0, 0}, 100)}, {}, "too large");
  auto broken = good;
  broken[0].path.nodes[1].d2.y = nan;
  refused(broken, {}, "not finite");
  broken = good;
  broken[0].path.nodes[1].d1.y = 1e200;
  refused(broken, {}, "range");
  broken = good;
  broken[0].path.nodes[1].t = 0;
  refused(broken, {}, "increase");
  broken = good;
  broken[0].uv.nodes.resize(3);
  refused(broken, {}, "one for each");
  refused({line({0, 0, 0}, {1e6, 0, 0}, 1e-3)}, {}, "at most");  // 2000 years
}

}  // namespace
}  // namespace burin::servo
