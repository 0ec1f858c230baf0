// SPDX-License-Identifier: Apache-2.0
// Limits hold in the setpoints themselves, on random motions. BURIN_CASES=100000 for the long run.
#include "burin/servo/random_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "burin/servo/measure.h"

namespace burin::servo {
namespace {

int cases() {
  const char* text = std::getenv("BURIN_CASES");
  const int n = text ? std::atoi(text) : 0;
#ifdef NDEBUG
  constexpr int kUsual = 5000;
#else
  constexpr int kUsual = 300;
#endif
  return n > 0 ? n : kUsual;
}

/// What rounding alone does to a difference of setpoints: each is right to half a unit in the last place.
double rounding(const std::vector<Setpoint>& s) {
  double largest = 0;
  for (const Setpoint& p : s) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return largest * std::numeric_limits<double>::epsilon();
}

/// Smallest step between setpoints of equal feed: what rounding is compared with in the feed fluctuation.
double smallest_step(const std::vector<Setpoint>& s, double period) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < s.size(); ++i) {
    const double feed = s[i].feed_mm_min;
    if (feed > 0 && std::abs(feed - s[i - 1].feed_mm_min) < 1e-9 * feed)
      least = std::min(least, feed / 60 * period);
  }
  return least;
}

TEST(Plan, RandomCurvesKeepTheirLimits) {
  const int n = cases();
  std::size_t setpoints = 0, slowed = 0;
  double worst_accel = 0, worst_jerk = 0, worst_chord = 0, worst_feed = 0;
  // Seeds beyond the usual number that once failed (chord error between the planner's samples).
  constexpr std::uint64_t kFound[] = {10962, 14711, 20238, 21513};
  for (int i = 0; i < n + static_cast<int>(std::size(kFound)); ++i) {
    const std::uint64_t seed = i < n ? static_cast<std::uint64_t>(i) + 1 : kFound[i - n];
    test::RandomCurves random(seed);
    const auto stretches = random.curve();
    const Limits limits = random.limits();
    Diagnostics diagnostics;
    const auto made = plan(stretches, limits, diagnostics);
    ASSERT_TRUE(made.ok()) << "seed " << seed << ": " << made.error().message;
    slowed += diagnostics.count("servo_slowed");
    const auto s = run(*made);
    if (s.empty()) {  // no motion at all
      for (const Stretch& stretch : stretches) EXPECT_LT(geom::length(stretch.path), 1e-9) << "seed " << seed;
      continue;
    }
    const Quality q = measure(*made, s);
    const double t = limits.period_s, noise = rounding(s);
    ASSERT_LE(q.accel_max_mm_s2, limits.accel_mm_s2 * (1 + 1e-12) + 4 * noise / (t * t)) << "seed " << seed;
    ASSERT_LE(q.jerk_max_mm_s3, limits.jerk_mm_s3 * (1 + 1e-12) + 8 * noise / (t * t * t)) << "seed " << seed;
    EXPECT_LE(q.chord_error_max_mm, limits.chord_error_mm + noise) << "seed " << seed;
    EXPECT_LT(q.feed_fluctuation_max, 1e-6 + 4 * noise / smallest_step(s, t)) << "seed " << seed;
    double top = 0;
    for (const Stretch& stretch : stretches)
      top = std::max(top, stretch.feed_mm_min > 0 ? stretch.feed_mm_min : limits.rapid_mm_min);
    for (const Setpoint& p : s) ASSERT_TRUE(p.feed_mm_min <= top * (1 + 1e-6)) << "seed " << seed;
    if (!stretches.empty()) {
      const geom::Point3 end = stretches.back().path.end();
      EXPECT_LE(geom::distance({s.back().x, s.back().y, s.back().z}, end), 1e-9) << "seed " << seed;
    }
    EXPECT_EQ(s.front().feed_mm_min, 0);
    EXPECT_EQ(s.back().feed_mm_min, 0);
    setpoints += s.size();
    worst_accel = std::max(worst_accel, q.accel_max_mm_s2 / limits.accel_mm_s2);
    worst_jerk = std::max(worst_jerk, q.jerk_max_mm_s3 / limits.jerk_mm_s3);
    worst_chord = std::max(worst_chord, q.chord_error_max_mm / limits.chord_error_mm);
    worst_feed = std::max(worst_feed, q.feed_fluctuation_max);
  }
  RecordProperty("setpoints", std::to_string(setpoints));
  std::printf(
      "%d curves, %zu setpoints: accel %.6f, jerk %.6f, chord %.6f of the limit, fluctuation %.2g, %zu "
      "slowed\n",
      n, setpoints, worst_accel, worst_jerk, worst_chord, worst_feed, slowed);
}

}  // namespace
}  // namespace burin::servo
