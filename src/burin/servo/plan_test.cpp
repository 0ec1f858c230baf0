// SPDX-License-Identifier: Apache-2.0
#include "burin/servo/plan.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(Plan, LineArcLine) {
  const Plan p = planned({line({0, 0, 0}, {20, 0, 0}, 3000),
                          {geom::arc({20, 0, 0}, {20, 5, 0}, {0, 0, 1}, geom::kPi, 0), {}, 3000},
                          line({20, 10, 0}, {0, 10, 0}, 3000)});
  const auto s = run(p);
  expect_within(p, s);
  EXPECT_EQ(p.runs.size(), 1u);
  std::printf("duration %g\n", p.duration_s);
}

}  // namespace
}  // namespace burin::servo
