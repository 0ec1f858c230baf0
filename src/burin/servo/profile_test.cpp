// SPDX-License-Identifier: Apache-2.0
#include "burin/servo/profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace burin::servo {
namespace {

struct State {
  double s, v, a, j;
};
State at(const ProfilePiece& p, double t) {
  const double d = t - p.time;
  return {p.s + d * (p.v + d * (p.a / 2 + d * p.j / 6)), p.v + d * (p.a + d * p.j / 2), p.a + d * p.j, p.j};
}

/// Smallest limit of the spans that hold s, but for `edge` at their ends: where a span ends the jerk jumps.
double limit_at(const std::vector<LimitSpan>& spans, double s, double LimitSpan::*what, double edge = 0) {
  double least = 1e300;
  for (const LimitSpan& l : spans)
    if (l.begin + edge <= s && s <= l.end - edge) least = std::min(least, l.*what);
  return least;
}

std::vector<LimitSpan> random_spans(std::mt19937_64& random, double& total) {
  std::uniform_real_distribution<double> length(0.01, 2), exponent(-1, 2);
  std::vector<LimitSpan> spans;
  total = 0;
  const int n = 1 + static_cast<int>(random() % 30);
  for (int i = 0; i < n; ++i) {
    const double l = length(random);
    spans.push_back({total, total + l, std::pow(10, exponent(random)), 50 * std::pow(10, exponent(random))});
    total += l;
    if (random() % 4 == 0)
      spans.push_back({total, total, std::pow(10, exponent(random)), 50 * std::pow(10, exponent(random))});
  }
  return spans;
}

/// What docs/servo.md proves: speed, acceleration and jerk of the smoothed motion keep the limits of the
/// place where it is, and it is continuous up to the acceleration.
TEST(Profile, SmoothedMotionKeepsTheLimitsOfItsPlace) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> window(0.002, 0.05);
  for (int round = 0; round < 500; ++round) {
    double total;
    const auto spans = random_spans(random, total);
    const double tau = window(random);
    const auto raw = raw_profile(spans, total, tau);
    const auto profile = smooth_profile(raw, total, tau);
    ASSERT_GE(profile.size(), 2u);
    EXPECT_EQ(profile.front().s, 0);
    EXPECT_EQ(profile.front().v, 0);
    EXPECT_EQ(profile.back().s, total);
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
      const double dt = profile[i + 1].time - profile[i].time;
      ASSERT_GT(dt, 0);
      const State end = at(profile[i], profile[i + 1].time);
      EXPECT_NEAR(end.s, profile[i + 1].s, 1e-9);
      EXPECT_NEAR(end.v, profile[i + 1].v, 1e-7);
      EXPECT_NEAR(end.a, profile[i + 1].a, 1e-5);
      for (int k = 0; k <= 10; ++k) {
        const State now = at(profile[i], profile[i].time + dt * k / 10);
        const double v = limit_at(spans, now.s, &LimitSpan::v),
                     a = limit_at(spans, now.s, &LimitSpan::a, 1e-9);
        ASSERT_GE(now.v, -1e-9);
        ASSERT_LE(now.v, v * (1 + 1e-6)) << "round " << round << " s " << now.s;
        ASSERT_LE(std::abs(now.a), a * (1 + 1e-6)) << "round " << round << " s " << now.s;
        // Within 1 %: a plateau between speeding up and slowing down takes tau to rounding, not more.
        ASSERT_LE(std::abs(now.j), a / tau * 1.01) << "round " << round << " s " << now.s << " of " << total;
      }
    }
  }
}

TEST(Profile, LongWaysReachTheLimit) {
  const auto raw = raw_profile({{0, 100, 10, 500}}, 100, 0.02);
  // Up in 0.02 s, along, down.
  EXPECT_NEAR(raw.back().t, 100.0 / 10 + 0.02, 1e-9);
  const auto profile = smooth_profile(raw, 100, 0.02);
  double top = 0;
  for (const ProfilePiece& p : profile) top = std::max(top, p.v);
  EXPECT_NEAR(top, 10, 1e-9);
  EXPECT_NEAR(profile.back().time, 100.0 / 10 + 0.04, 1e-9);
}

}  // namespace
}  // namespace burin::servo
