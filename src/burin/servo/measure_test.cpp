// SPDX-License-Identifier: Apache-2.0
#include "burin/servo/measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include "burin/servo/random_curves.h"

namespace burin::servo {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Plan planned(const std::vector<Stretch>& stretches, const Limits& limits = {}) {
  Diagnostics diagnostics;
  auto made = plan(stretches, limits, diagnostics);
  EXPECT_TRUE(made.ok());
  return made.ok() ? *made : Plan{};
}

/// x = c t^3 / 6 has jerk c and acceleration c t, whatever the period.
TEST(Measure, DifferencesOfAKnownMotion) {
  Plan p;
  p.limits.period_s = 0.002;
  std::vector<Setpoint> s;
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.002 * i;
    s.push_back({t, 0, -6000 * t * t * t / 6, 0, 0, kNone, kNone});
  }
  const Quality q = measure(p, s);
  EXPECT_GT(q.jerk_max_mm_s3, 1e6);
  EXPECT_EQ(q.setpoints, 101u);
  // The abrupt stop at the end is what is measured. Without it: the largest of the differences inside, by
  // hand.
  double jerk = 0, accel = 0;
  for (std::size_t i = 3; i < s.size(); ++i) {
    jerk = std::max(jerk, std::abs(s[i].y - 3 * s[i - 1].y + 3 * s[i - 2].y - s[i - 3].y) / 8e-9);
    accel = std::max(accel, std::abs(s[i].y - 2 * s[i - 1].y + s[i - 2].y) / 4e-6);
  }
  EXPECT_NEAR(jerk, 6000, 1e-3);
  EXPECT_NEAR(accel, 6000 * 0.198, 1e-3);
  EXPECT_GE(q.accel_max_mm_s2, accel);
}

TEST(Measure, SeesAMovedSetpoint) {
  const Plan p = planned({{geom::straight({0, 0, 0}, {30, 0, 0}), {}, 1200}});
  auto s = run(p);
  const Quality before = measure(p, s);
  EXPECT_LT(before.feed_fluctuation_max, 1e-9);
  EXPECT_LT(before.feed_fluctuation_rms, 1e-9);
  EXPECT_LE(before.jerk_max_mm_s3, 50000);
  EXPECT_LT(before.chord_error_max_mm, 1e-12);
  const std::size_t i = s.size() / 2;
  s[i].y += 1e-3;  // sideways: third differences 1, -3, 3, -1 times 1e-3 / T^3; second 2 at most
  const Quality after = measure(p, s);
  EXPECT_NEAR(after.jerk_max_mm_s3, 3e-3 / 1e-9, 1);
  EXPECT_NEAR(after.accel_max_mm_s2, 2e-3 / 1e-6, 1e-3);
  // The chord's end is off the path by that; seen from the path, at the slope of 1e-3 in 0.02.
  EXPECT_NEAR(after.chord_error_max_mm, 1e-3 * std::cos(std::atan(0.05)), 1e-8);
  s[i].y -= 1e-3;
  s[i].x += 1e-5;  // along: one chord of 0.02 mm longer, the next shorter
  EXPECT_NEAR(measure(p, s).feed_fluctuation_max, 5e-4, 1e-6);
}

/// Chord error of a circle: the sagitta, r - sqrt(r^2 - (c/2)^2).
TEST(Measure, ChordErrorOfACircle) {
  Limits limits;
  limits.chord_error_mm = 0.01;
  limits.jerk_mm_s3 = 1e6;
  const double r = 5, v = 100;
  const Plan p = planned({{geom::arc({r, 0, 0}, {0, 0, 0}, {0, 0, 1}, 6, 0), {}, v * 60}}, limits);
  const Quality q = measure(p, run(p));
  const double c = v * limits.period_s;
  EXPECT_NEAR(q.chord_error_max_mm, r - std::sqrt(r * r - c * c / 4), 1e-7);
}

double little_endian(const std::string& bytes, std::size_t at) {
  std::uint64_t bits = 0;
  for (int i = 7; i >= 0; --i)
    bits = bits << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
  double value;
  std::memcpy(&value, &bits, 8);
  return value;
}

TEST(SetpointText, NpyIsVersionOne) {
  std::vector<Setpoint> s(3);
  s[1] = {0.001, 1.5, -2.25, 1e-9, 1200, 0.25, 0.75, 4, 7};
  s[2].u = s[2].v = kNone;
  const std::string npy = to_npy(s);
  ASSERT_EQ(npy.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t header = static_cast<unsigned char>(npy[8]) + 256u * static_cast<unsigned char>(npy[9]);
  EXPECT_EQ((10 + header) % 64, 0u);
  EXPECT_EQ(npy[10 + header - 1], '\n');
  EXPECT_NE(npy.find("'shape': (3, 9)"), std::string::npos);
  ASSERT_EQ(npy.size(), 10 + header + 3 * 9 * 8);
  const double wanted[] = {0.001, 1.5, -2.25, 1e-9, 1200, 4, 7, 0.25, 0.75};
  for (std::size_t k = 0; k < 9; ++k) EXPECT_EQ(little_endian(npy, 10 + header + 8 * (9 + k)), wanted[k]);
  EXPECT_TRUE(std::isnan(little_endian(npy, 10 + header + 8 * 26)));
}

TEST(SetpointText, CsvKeepsTwelveDecimals) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> exponent(-13, 6), unit(-1, 1);
  std::vector<Setpoint> s(2000);
  for (Setpoint& p : s) {
    for (double* value : {&p.x, &p.y, &p.z, &p.t_s, &p.feed_mm_min, &p.u, &p.v})
      *value = unit(random) * std::pow(10, exponent(random));
    p.surface = static_cast<std::int32_t>(random() % 10) - 1;
  }
  s[0].x = 0.9999999999998;  // carries into the whole part
  s[1].x = -1e-14;           // never "-0"
  s[2].x = 1e17;
  s[3].x = 2.5;
  s[4].u = s[4].v = kNone;
  std::istringstream text(to_csv(s));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "t_s,x_mm,y_mm,z_mm,feed_mm_min,surface,path,u,v");
  for (std::size_t i = 0; i < s.size(); ++i) {
    ASSERT_TRUE(std::getline(text, line));
    std::vector<std::string> cells(1);
    for (const char c : line) {
      if (c == ',')
        cells.emplace_back();
      else
        cells.back() += c;
    }
    ASSERT_EQ(cells.size(), 9u);
    const double wanted[] = {s[i].t_s, s[i].x, s[i].y, s[i].z, s[i].feed_mm_min, 0, 0, s[i].u, s[i].v};
    for (const std::size_t k : {0u, 1u, 2u, 3u, 4u, 7u, 8u}) {
      if (std::isnan(wanted[k])) {
        EXPECT_EQ(cells[k], "");
        continue;
      }
      const double read = std::stod(cells[k]);
      EXPECT_NEAR(read, wanted[k], 0.51e-12 + 1e-16 * std::abs(wanted[k])) << cells[k];
      const std::size_t point = cells[k].find('.');
      EXPECT_GE(cells[k].size() - point - 1, 9u) << cells[k];
    }
    EXPECT_EQ(cells[5], std::to_string(s[i].surface));
    const std::map<std::size_t, std::string> exactly{
        {0, "1.000000000"}, {1, "0.000000000"}, {3, "2.500000000"}};
    if (exactly.count(i) > 0) {
      EXPECT_EQ(cells[1], exactly.at(i));
    }
  }
  EXPECT_FALSE(std::getline(text, line));
}

/// For tests/servo_npy_test.py, which opens both files with numpy: names in BURIN_SETPOINTS (.npy, .csv
/// added).
TEST(SetpointText, FilesForNumpy) {
  const char* name = std::getenv("BURIN_SETPOINTS");
  if (!name) GTEST_SKIP() << "BURIN_SETPOINTS names no files";
  test::RandomCurves random(3);
  const auto s = run(planned(random.curve()));
  std::ofstream(std::string(name) + ".npy", std::ios::binary) << to_npy(s);
  std::ofstream(std::string(name) + ".csv", std::ios::binary) << to_csv(s);
}

}  // namespace
}  // namespace burin::servo
