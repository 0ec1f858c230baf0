// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/extend.h"

#include <gtest/gtest.h>

#include <random>

#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/modify.h"
#include "burin/plan/cycle/cycle_cases.h"

namespace burin::cycle {
namespace {

using geom::Direction;
using geom::NurbsSurface;

/// One rational polynomial piece of degree p x q.
NurbsSurface piece(std::mt19937& random, int p, int q) {
  std::uniform_real_distribution<double> number(-1, 1);
  NurbsSurface s = cases::net(p, q, p + 1, q + 1, [&](double u, double v) {
    return cases::Point3{20 * u + number(random), 20 * v + number(random), number(random)};
  });
  for (geom::HPoint& h : s.points) h = geom::homogeneous(geom::project(h), 1 + 0.2 * number(random));
  return s;
}

TEST(Extended, GoesOnAsTheSurfaceItWasCutFrom) {
  std::mt19937 random(3);
  for (int i = 0; i < 24; ++i) {
    NurbsSurface whole = piece(random, 1 + i % 4, 1 + i % 3);
    // Knots inside the part, so that only the end pieces go on.
    const double knots[] = {0.4, 0.6, 0.6};
    whole = geom::insert_knots(whole, Direction::u, knots);
    whole = geom::insert_knots(whole, Direction::v, knots);
    for (const Direction d : {Direction::u, Direction::v}) {
      const geom::Interval all{0, 1}, some{0.2, 0.9};
      const NurbsSurface part =
          d == Direction::u ? geom::sub_surface(whole, some, all) : geom::sub_surface(whole, all, some);
      const auto again = extended(part, d, all);
      ASSERT_TRUE(again.has_value());
      EXPECT_EQ(again->domain(d), all);
      for (int k = 0; k <= 10; ++k)
        for (int j = 0; j <= 10; ++j)
          EXPECT_LT(distance(point(*again, 0.1 * k, 0.1 * j), point(whole, 0.1 * k, 0.1 * j)), 1e-9);
    }
  }
}

TEST(Extended, NothingWhereAWeightWouldVanish) {
  NurbsSurface s = cases::plane({0, 0, 0}, {10, 0, 0}, {0, 10, 0});
  s.at(1, 0) = geom::homogeneous({10, 0, 0}, 3);  // w = 1 + 2 u at v = 0: 0 at u = -1/2
  EXPECT_TRUE(extended(s, Direction::u, {-0.4, 1}).has_value());
  EXPECT_FALSE(extended(s, Direction::u, {-0.6, 1}).has_value());
}

TEST(Continued, WinsTheDistanceSquareToTheEdgeAndStopsAtPoles) {
  // A sheared parallelogram: 0.5 mm square to the edge are more along the lines.
  const NurbsSurface s = continued(cases::plane({0, 0, 0}, {10, 5, 0}, {0, 20, 0}), Direction::u, 0.5);
  EXPECT_NEAR(s.domain(Direction::u).lo, -0.05, 1e-12);
  EXPECT_NEAR(s.domain(Direction::u).hi, 1.05, 1e-12);
  const NurbsSurface ball = cases::ball_part({0, 0, 0}, 10, geom::radians(30), geom::radians(90));
  const NurbsSurface more = continued(ball, Direction::v, 0.5);
  EXPECT_EQ(more.domain(Direction::v).hi, 1.0);
  EXPECT_LT(more.domain(Direction::v).lo, -0.04);
  for (const double v : {more.domain(Direction::v).lo, -0.02, 0.3})
    EXPECT_NEAR(norm(point(more, 0.4, v) - cases::Point3{}), 10, 1e-9);
}

}  // namespace
}  // namespace burin::cycle
