// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "burin/plan/rotary/reach.h"
#include "burin/plan/rotary/reach_cases.h"

namespace burin::rotary {
namespace {

using namespace cases;
using geom::kPi;
using geom::radians;

const double kEnd = radians(0.05);  // what the interval ends may be off, by the issue

/// The distance of an angle from the nearest end of an interval.
double from_ends(const AngleSet& set, double theta) {
  double least = 10;
  for (const AngleInterval& i : set) {
    if (i.hi - i.lo >= 2 * kPi) continue;
    for (const double end : {i.lo, i.hi})
      least = std::min(least, std::abs(std::remainder(theta - end, 2 * kPi)));
  }
  return least;
}

/// Every end to +-0.05 degrees, and a grid between.
void expect_as_measured(const AngleSet& set, const Mesh& m, Point3 center, const model::BallTool& tool,
                        int grid) {
  const auto check = [&](double theta) {
    if (from_ends(set, theta) < 0.99 * kEnd) return;
    const double d = depth(m, center, theta, tool);
    if (std::abs(d) < 1e-9) return;  // slides along the part: both answers are right
    EXPECT_EQ(contains(set, theta), d < 0) << geom::degrees(theta) << " degrees, depth " << d;
  };
  for (const AngleInterval& i : set) {
    EXPECT_LT(i.lo, i.hi);
    EXPECT_GE(i.lo, -kPi);
    EXPECT_LT(i.lo, kPi);
    for (const double end : {i.lo, i.hi}) {
      check(end - kEnd);
      check(end + kEnd);
    }
  }
  for (int k = 0; k < grid; ++k) check(-kPi + 2 * kPi * (k + 0.31) / grid);
}

model::BallTool random_tool(Random& r) {
  model::BallTool tool;
  tool.radius = r.between(0.4, 2);
  const int shank = r.integer(0, 3);
  tool.shank_radius = shank == 0   ? tool.radius * r.between(0.5, 0.95)
                      : shank == 1 ? tool.radius * r.between(1.05, 1.6)
                                   : tool.radius;
  tool.shank_length = r.between(3, 15);
  for (int pieces = r.integer(0, 2); pieces > 0; --pieces)
    tool.holder.push_back({r.between(2, 9), r.between(2, 12)});
  return tool;
}

TEST(Reach, EndsAsMeasuredOnRandomParts) {
#ifdef NDEBUG
  constexpr int kParts = 1000;
#else
  constexpr int kParts = 60;
#endif
  Random r(42);
  int touching = 0, several = 0, none = 0;
  for (int k = 0; k < kParts && !testing::Test::HasFailure(); ++k) {
    SCOPED_TRACE(k);
    const Mesh m = random_part(r, 30, 6);
    const model::BallTool tool = random_tool(r);
    const ReachIndex index(m, tool);
    const Touch touch = random_touch(r, m, tool.radius);
    std::vector<Point3> centers;
    if (touch.radius > 0) {
      ++touching;
      centers.push_back(touch.center);
      centers.push_back(touch.center + r.between(0.1, 2) * touch.normal);
    } else {
      centers.push_back({r.between(0, 20), r.between(-25, 25), r.between(-25, 25)});
    }
    for (const Point3 center : centers) {
      const AngleSet set = index.reachable(center);
      several += set.size() > 1;
      none += set.empty();
      expect_as_measured(set, m, center, tool, 24);
    }
  }
  // The parts are what they should be.
  EXPECT_GT(touching, kParts / 2);
  EXPECT_GT(several, kParts / 200);
  EXPECT_GT(none, kParts / 50);
}

}  // namespace
}  // namespace burin::rotary
