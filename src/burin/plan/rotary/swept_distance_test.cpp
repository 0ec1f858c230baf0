// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/swept_distance.h"

#include <gtest/gtest.h>

#include "burin/plan/rotary/rotary_cases.h"

namespace burin::rotary {
namespace {

using geom::Point3;

/// The distance from many points of the part: never less than the true one, by at most half a spacing more.
double sampled(const SweptSection& swept, Point3 c, double spacing) {
  double best = 1e300;
  const double length = swept.stations.back().x;
  const int rows = static_cast<int>(length / spacing) + 1;
  std::vector<double> places;
  for (int k = 0; k <= rows; ++k) places.push_back(length * k / rows);
  // The distance has a kink where the twist jumps.
  for (const Station& s : swept.stations) places.push_back(s.x);
  for (const double x : places) {
    const double turn = swept.turn_at(x), co = std::cos(turn), si = std::sin(turn);
    const geom::Point2 back{c.y * co + c.z * si, c.z * co - c.y * si};
    const double d = distance_to(swept.section, back);
    best = std::min(best, std::hypot(d, x - c.x));
  }
  for (const Station& end : {swept.stations.front(), swept.stations.back()}) {
    const double co = std::cos(end.turn), si = std::sin(end.turn);
    const geom::Point2 back{c.y * co + c.z * si, c.z * co - c.y * si};
    if (winding_number(swept.section, back) != 0) best = std::min(best, std::abs(c.x - end.x));
  }
  return best;
}

TEST(SweptDistance, SameAsManyPoints) {
  constexpr double kAccuracy = 1e-4, kSpacing = 1e-3;
  std::mt19937 engine(5);
  const auto in = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine()) / 4294967296.0;
  };
  int asked = 0;
  for (int part = 0; part < 12; ++part) {
    SweptSection swept{part % 3 == 0   ? cases::cutter(5, 16, 9, 1)
                       : part % 3 == 1 ? cases::ellipse(12, 6)
                                       : cases::keyway(12, 4, 3),
                       {{0, 0}, {in(1, 3), in(-1, 1)}}};
    if (part % 2 == 0) swept.stations.push_back({swept.stations.back().x + 2, in(-1, 1)});
    const SweptDistance distance(swept, kAccuracy);
    for (int i = 0; i < 40; ++i) {
      const Point3 c{in(-2, swept.stations.back().x + 2), in(-19, 19), in(-19, 19)};
      const double turn = swept.turn_at(c.x), co = std::cos(turn), si = std::sin(turn);
      const bool beside = c.x < 0 || c.x > swept.stations.back().x;
      if (!beside && winding_number(swept.section, {c.y * co + c.z * si, c.z * co - c.y * si}) != 0) continue;
      ++asked;
      const double truth = sampled(swept, c, kSpacing);
      for (const double more : {0.0, 0.3, 5.0}) {
        const double found = distance.least(c, truth + more, c.x + in(-1, 1));
        EXPECT_LE(found, truth + 1e-12);
        // Along a slope samples are too far by less than spacing^2 (1 + rate^2 r^2) / (8 distance).
        EXPECT_GE(found, truth - kAccuracy - 20 * kSpacing * kSpacing / std::max(truth, 0.05)) << truth;
      }
      // What is asked with less than the distance gets what was asked with.
      EXPECT_LE(distance.least(c, 0.5 * truth, c.x), 0.5 * truth);
      EXPECT_GE(distance.least(c, 0.5 * truth, c.x), 0.5 * truth - kAccuracy);
    }
  }
  EXPECT_GT(asked, 200);
}

}  // namespace
}  // namespace burin::rotary
