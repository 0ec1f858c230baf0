// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "burin/geom/surface/surface_cases.h"
#include "burin/geom/vec.h"
#include "burin/plan/rotary/reach.h"

namespace burin::rotary {
namespace {

using geom::kPi;

/// Disjoint, ascending, often across the seam.
AngleSet random_set(geom::cases::Random& r) {
  const int n = r.integer(1, 4);
  std::vector<double> cuts;
  for (int i = 0; i < 2 * n; ++i) cuts.push_back(r.between(-kPi, kPi));
  std::sort(cuts.begin(), cuts.end());
  AngleSet set;
  const bool seam = r.integer(0, 1) == 1;
  for (int i = seam ? 1 : 0; i + 1 < 2 * n; i += 2)
    set.push_back({cuts[static_cast<std::size_t>(i)], cuts[static_cast<std::size_t>(i) + 1]});
  if (seam) set.push_back({cuts.back(), cuts.front() + 2 * kPi});
  return set;
}

TEST(AngleSet, NearestIsInTheSetAndNoneIsNearer) {
  geom::cases::Random r(1);
  for (int k = 0; k < 300; ++k) {
    const AngleSet set = random_set(r);
    const double theta = r.between(-30, 30), found = nearest(set, theta), way = std::abs(found - theta);
    EXPECT_LE(way, kPi + 1e-12);
    bool on = false;
    for (const AngleInterval& i : set) {
      const double half = 0.5 * (i.hi - i.lo);
      on = on || std::abs(std::remainder(found - i.lo - half, 2 * kPi)) <= half + 1e-12;
    }
    EXPECT_TRUE(on);
    for (int j = -1000; j <= 1000; ++j) {
      const double step = way * j / 1001.0;
      EXPECT_FALSE(contains(set, theta + step) && std::abs(step) < way - 1e-9);
    }
  }
}

TEST(AngleSet, ContainsItsEndsAndWholeTurnsFromThem) {
  const AngleSet set{{-1, 0.5}, {3, 4}};
  for (const double theta : {-1.0, 0.5, 3.0, 4.0, 3.5 - 2 * kPi, 0.1 + 8 * kPi, 3.9 - 20 * kPi})
    EXPECT_TRUE(contains(set, theta)) << theta;
  for (const double theta : {-1.01, 0.51, 2.99, 4.01, 4.01 - 2 * kPi, 0.6 + 8 * kPi})
    EXPECT_FALSE(contains(set, theta)) << theta;
  EXPECT_FALSE(contains(set, std::nan("")));
  EXPECT_FALSE(contains({}, 0));
  EXPECT_TRUE(contains({{-kPi, kPi}}, 100));
}

TEST(AngleSet, NarrowedKeepsTheClearanceWhereThereIsRoom) {
  const AngleSet out = narrowed({{-1, 1}, {2, 2.1}, {3, 3.5}}, 0.2);
  ASSERT_EQ(out.size(), 3u);
  // The last begins beyond the seam now, so it comes first.
  EXPECT_NEAR(out[0].lo, 3.2 - 2 * kPi, 1e-12);
  EXPECT_NEAR(out[0].hi, 3.3 - 2 * kPi, 1e-12);
  EXPECT_NEAR(out[1].lo, -0.8, 1e-12);
  EXPECT_NEAR(out[1].hi, 0.8, 1e-12);
  EXPECT_NEAR(out[2].lo, 2.045, 1e-12);
  EXPECT_NEAR(out[2].hi, 2.055, 1e-12);
  const AngleSet whole{{-kPi, kPi}};
  EXPECT_EQ(narrowed(whole, 0.2), whole);
  EXPECT_NEAR(total(out), 0.1 + 1.6 + 0.01, 1e-12);
  EXPECT_EQ(total({}), 0);
}

}  // namespace
}  // namespace burin::rotary
