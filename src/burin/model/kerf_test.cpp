// SPDX-License-Identifier: Apache-2.0
#include "burin/model/kerf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "burin/model/permissible.h"

namespace burin::model {
namespace {

struct Row {
  double thickness, lambda1, lambda2, r;
  double ranges[4][2];  // at 1200, 1400, 1600, 1800 W
};
/// Tables 2 and 3 of the paper, typed a second time.
constexpr Row kPaper[] = {
    {0.5, 0.0097, 0.398, 0.93, {{4000, 10000}, {4000, 10000}, {5000, 9000}, {5000, 9000}}},
    {1.0, 0.0085, 0.441, 0.94, {{4000, 6000}, {4000, 7000}, {4000, 7000}, {4000, 7000}}},
    {1.6, 0.0053, 0.546, 0.91, {{2000, 5000}, {2000, 5000}, {3000, 5000}, {3000, 5000}}},
    {2.0, 0.0061, 0.560, 0.90, {{3000, 4000}, {3000, 5000}, {3000, 5000}, {3000, 5000}}},
};

KerfQuery query(double thickness, double power, double speed) {
  KerfQuery q;
  q.thickness_mm = thickness;
  q.power_w = power;
  q.speed_mm_min = speed;
  return q;
}

class BuiltIn : public ::testing::Test {
 protected:
  Result<KerfDatabase> opened = KerfDatabase::built_in();
  KerfDatabase& database() { return opened.value(); }
  std::string refusal(const KerfQuery& q) {
    const auto result = database().predict(q);
    if (result.ok()) return "accepted";
    EXPECT_EQ(result.error().code, ErrorCode::range);
    return result.error().message;
  }
};

TEST_F(BuiltIn, HoldsEveryValueOfThePaper) {
  const auto models = database().models();
  ASSERT_TRUE(models.ok());
  ASSERT_EQ(models->size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const KerfModel& m = (*models)[i];
    EXPECT_EQ(m.laser, "ndyag-cw");
    EXPECT_EQ(m.material, "CSP1N");
    EXPECT_EQ(m.version, 1);
    EXPECT_EQ(m.thickness_mm, kPaper[i].thickness);
    EXPECT_EQ(m.lambda1, kPaper[i].lambda1);
    EXPECT_EQ(m.lambda2, kPaper[i].lambda2);
    EXPECT_EQ(m.r, kPaper[i].r);
    EXPECT_FALSE(m.statistics);
    ASSERT_EQ(m.permissible.size(), 4u);
    for (int p = 0; p < 4; ++p) {
      EXPECT_EQ(m.permissible[p].power_w, 1200 + 200 * p);
      EXPECT_EQ(m.permissible[p].speed_min, kPaper[i].ranges[p][0]);
      EXPECT_EQ(m.permissible[p].speed_max, kPaper[i].ranges[p][1]);
    }
  }
}

TEST_F(BuiltIn, PredictsInsideAndRefusesOutsideEveryRange) {
  for (const Row& row : kPaper) {
    for (int p = 0; p < 4; ++p) {
      const double power = 1200 + 200 * p;
      const auto [low, high] = row.ranges[p];
      for (const double speed : {low, (low + high) / 2, high}) {
        const auto result = database().predict(query(row.thickness, power, speed));
        ASSERT_TRUE(result.ok());
        EXPECT_DOUBLE_EQ(result->kerf_mm, row.lambda1 * power / speed + row.lambda2);
        EXPECT_DOUBLE_EQ(result->offset_mm, result->kerf_mm / 2);
        EXPECT_TRUE(result->permissible);
        EXPECT_TRUE(result->note.empty());
        EXPECT_FALSE(result->prediction_interval_mm);
      }
      EXPECT_FALSE(database().predict(query(row.thickness, power, low - 1)).ok());
      EXPECT_FALSE(database().predict(query(row.thickness, power, high + 1)).ok());
    }
  }
}

TEST_F(BuiltIn, TheCheckOfThePaper) {
  const auto result = database().predict(query(2.0, 1800, 4000));
  ASSERT_TRUE(result.ok());
  EXPECT_NEAR(result->kerf_mm, 0.562745, 1e-12);
  EXPECT_NEAR(result->offset_mm, 0.2813725, 1e-12);
}

TEST_F(BuiltIn, NamesTheNearestPermissibleSetting) {
  EXPECT_NE(refusal(query(2.0, 1800, 9000)).find("nearest permissible setting: 1800 W at 5000 mm/min"),
            std::string::npos);
  EXPECT_NE(refusal(query(2.0, 1800, 100)).find("nearest permissible setting: 1800 W at 3000 mm/min"),
            std::string::npos);
  EXPECT_NE(refusal(query(2.0, 2500, 4000)).find("nearest permissible setting: 1800 W at 4000 mm/min"),
            std::string::npos);
  EXPECT_NE(refusal(query(2.0, 1000, 4500)).find("nearest permissible setting: 1200 W at 4000 mm/min"),
            std::string::npos);
}

TEST_F(BuiltIn, RangesAreInterpolatedBetweenPowers) {
  // T 2.0: the limit rises from 4000 at 1200 W to 5000 at 1400 W.
  EXPECT_TRUE(database().predict(query(2.0, 1300, 4500)).ok());
  EXPECT_FALSE(database().predict(query(2.0, 1300, 4501)).ok());
  EXPECT_TRUE(database().predict(query(2.0, 1250, 4250)).ok());
  EXPECT_FALSE(database().predict(query(2.0, 1250, 4251)).ok());
}

TEST_F(BuiltIn, WhatIsNamedAsNearestIsAccepted) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> power(800, 2400), speed(500, 12000);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    auto q = query(i % 2 == 0 ? 2.0 : 1.8, power(random), speed(random));
    q.interpolate = true;
    const auto result = database().predict(q);
    if (result.ok()) continue;
    ++refused;
    const std::string& message = result.error().message;
    const auto at = message.find("nearest permissible setting: ");
    ASSERT_NE(at, std::string::npos) << message;
    ASSERT_EQ(std::sscanf(message.c_str() + at, "nearest permissible setting: %lf W at %lf", &q.power_w,
                          &q.speed_mm_min),
              2);
    // The printed power has three decimals: ask at exactly that setting.
    EXPECT_TRUE(database().predict(q).ok()) << message;
  }
  EXPECT_GT(refused, 100);
}

TEST_F(BuiltIn, ForcePredictsOutsideAndSaysSo) {
  auto q = query(2.0, 1800, 9000);
  q.force = true;
  const auto result = database().predict(q);
  ASSERT_TRUE(result.ok());
  EXPECT_FALSE(result->permissible);
  EXPECT_NEAR(result->kerf_mm, 0.0061 * 0.2 + 0.56, 1e-12);
  EXPECT_NE(result->note.find("forced"), std::string::npos);
}

TEST_F(BuiltIn, BetweenThicknessesOnlyWhenAsked) {
  auto q = query(1.8, 1800, 4000);
  EXPECT_NE(refusal(q).find("--interpolate"), std::string::npos);
  q.interpolate = true;
  const auto result = database().predict(q);
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(result->interpolated);
  EXPECT_FALSE(result->note.empty());
  EXPECT_NEAR(result->model.lambda1, 0.0057, 1e-12);
  EXPECT_NEAR(result->model.lambda2, 0.553, 1e-12);
  EXPECT_NEAR(result->kerf_mm, 0.0057 * 0.45 + 0.553, 1e-12);
  // 1.6: 2000-5000, 2.0: 3000-4000 at 1200 W: only what both permit.
  EXPECT_FALSE(database()
                   .predict([&] {
                     auto x = q;
                     x.power_w = 1200;
                     x.speed_mm_min = 2500;
                     return x;
                   }())
                   .ok());
  EXPECT_FALSE(database()
                   .predict([&] {
                     auto x = q;
                     x.power_w = 1200;
                     x.speed_mm_min = 4500;
                     return x;
                   }())
                   .ok());
  EXPECT_TRUE(database()
                  .predict([&] {
                    auto x = q;
                    x.power_w = 1200;
                    x.speed_mm_min = 3500;
                    return x;
                  }())
                  .ok());
  // A known thickness is not interpolated, and nothing is extrapolated.
  EXPECT_FALSE(database()
                   .predict([&] {
                     auto x = q;
                     x.thickness_mm = 2.0;
                     return x;
                   }())
                   ->interpolated);
  EXPECT_NE(refusal([&] {
              auto x = q;
              x.thickness_mm = 3;
              return x;
            }())
                .find("extrapolated"),
            std::string::npos);
  EXPECT_FALSE(database()
                   .predict([&] {
                     auto x = q;
                     x.thickness_mm = 0.4;
                     return x;
                   }())
                   .ok());
}

TEST_F(BuiltIn, UnknownNamesNameTheKnown) {
  auto q = query(2.0, 1800, 4000);
  q.laser = "ndyag-cv";
  EXPECT_NE(refusal(q).find("did you mean ndyag-cw?"), std::string::npos);
  q = query(2.0, 1800, 4000);
  q.material = "wood";
  EXPECT_NE(refusal(q).find("CSP1N"), std::string::npos);
  q = query(2.0, 1800, 4000);
  q.version = 2;
  EXPECT_NE(refusal(q).find("known: 1"), std::string::npos);
}

TEST_F(BuiltIn, ImpossibleValuesAreUsageErrors) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, nan, inf}) {
    for (const auto& q : {query(bad, 1800, 4000), query(2, bad, 4000), query(2, 1800, bad)}) {
      const auto result = database().predict(q);
      ASSERT_FALSE(result.ok());
      EXPECT_EQ(result.error().code, ErrorCode::usage);
    }
  }
}

TEST_F(BuiltIn, SuggestionsAreSortedAndPermissible) {
  const auto all = database().suggest(query(1.0, 0, 0));
  ASSERT_TRUE(all.ok());
  ASSERT_EQ(all->size(), 4u);
  EXPECT_EQ(all->front().speed_max, 7000);
  EXPECT_EQ(all->back().speed_max, 6000);
  for (std::size_t i = 0; i < all->size(); ++i) {
    const KerfSuggestion& s = (*all)[i];
    if (i > 0) {
      EXPECT_LE(s.speed_max, (*all)[i - 1].speed_max);
    }
    EXPECT_DOUBLE_EQ(s.kerf_at_max_mm, database().predict(query(1.0, s.power_w, s.speed_max))->kerf_mm);
    EXPECT_DOUBLE_EQ(s.kerf_at_min_mm, database().predict(query(1.0, s.power_w, s.speed_min))->kerf_mm);
  }
  const auto one = database().suggest(query(1.0, 1300, 0));
  ASSERT_TRUE(one.ok());
  ASSERT_EQ(one->size(), 1u);
  EXPECT_NEAR(one->front().speed_max, 6500, 1e-9);
  EXPECT_FALSE(database().suggest(query(1.0, 2000, 0)).ok());
  EXPECT_FALSE(database().suggest(query(1.2, 0, 0)).ok());
}

TEST(PermissibleRegion, IntersectionThatOpensBetweenPowers) {
  // Upper limit of one rises through the lower limit of the other at 150 W.
  const PermissibleRegion region({{{100, 10, 20}, {200, 10, 40}}, {{100, 30, 50}, {200, 30, 50}}});
  EXPECT_FALSE(region.at(100));
  EXPECT_FALSE(region.at(149));
  ASSERT_TRUE(region.at(150));
  EXPECT_TRUE(region.contains(200, 35));
  EXPECT_FALSE(region.contains(200, 41));
  const auto nearest = region.nearest(100, 60);
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->first, 150, 1e-9);
  EXPECT_NEAR(nearest->second, 30, 1e-6);
  EXPECT_EQ(region.table().size(), 1u);
}

TEST(PermissibleRegion, NothingInCommon) {
  const PermissibleRegion region({{{100, 10, 20}}, {{200, 10, 20}}});
  EXPECT_FALSE(region.nearest(150, 15));
  EXPECT_TRUE(region.table().empty());
  EXPECT_FALSE(PermissibleRegion({}).at(1));
}

}  // namespace
}  // namespace burin::model
