// SPDX-License-Identifier: Apache-2.0
// The NURBS forms against the closed forms that they stand for.
#include "burin/io/step/exact.h"

#include <gtest/gtest.h>

#include "burin/io/step/step_test_util.h"

namespace burin::io::step {
namespace {

using geom::Interval;
using geom::Point3;
using geom::Vec3;
using test::evaluate;

/// The curve as a surface of one row, to be evaluated.
Point3 evaluate(const MappedCurve& c, double t) {
  geom::NurbsSurface s = extrude(c, {0, 0, 1}, {0, 1}).surface;
  return test::evaluate(s, c.map(t), 0);
}

TEST(Exact, ArcRunsWithTheAngle) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-7, 7), sweep(1e-3, 4 * geom::kPi);
  for (int i = 0; i < 300; ++i) {
    const double lo = any(random);
    const Interval angles{lo, lo + (i % 10 == 0 ? 2 * geom::kPi : sweep(random))};
    const Vec3 x{3, 1, -2}, y{0.5, -4, 1};  // an ellipse in skew half axes
    const MappedCurve arc = ellipse_arc({1, 2, 3}, x, y, angles);
    EXPECT_EQ(arc.map(angles.lo), angles.lo);
    EXPECT_EQ(arc.map(angles.hi), angles.hi);
    double before = -1e9;
    for (int k = 0; k <= 40; ++k) {
      const double t = k == 40 ? angles.hi : angles.lo + angles.length() * k / 40;
      EXPECT_LT(before, arc.map(t));
      before = arc.map(t);
      const Point3 want = Point3{1, 2, 3} + std::cos(t) * x + std::sin(t) * y;
      EXPECT_LT(distance(evaluate(arc, t), want), 1e-12) << angles.lo << " " << angles.hi << " " << t;
    }
  }
}

TEST(Exact, RevolvedArcIsASphere) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-4, 4), part(0, 1);
  const double r = 25;
  for (int i = 0; i < 100; ++i) {
    const double lo = any(random);
    const Interval u{lo, lo + 0.01 + 6 * part(random)}, v{-0.5 * geom::kPi, 0.5 * geom::kPi};
    const MappedCurve meridian = ellipse_arc({7, 0, 0}, {r, 0, 0}, {0, 0, r}, v);
    const MappedSurface s = revolve(meridian, {7, 0, 0}, {0, 0, 1}, u, 1e-10);
    for (int k = 0; k < 20; ++k) {
      const double a = u.lo + u.length() * part(random), b = v.lo + v.length() * part(random);
      const Point3 want{7 + r * std::cos(b) * std::cos(a), r * std::cos(b) * std::sin(a), r * std::sin(b)};
      EXPECT_LT(distance(test::evaluate(s.surface, s.u(a), s.v(b)), want), 1e-12 * r);
    }
    // Poles are one point, up to the rounding of the weights.
    for (int k = 0; k < s.surface.count_u; ++k) {
      EXPECT_LT(distance(project(s.surface.at(k, s.surface.count_v - 1)), {7, 0, r}), 1e-14 * r);
    }
  }
}

TEST(Exact, ExtrusionAndPlane) {
  const MappedCurve arc = ellipse_arc({0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0.3, 2});
  const MappedSurface wall = extrude(arc, {0.6, 0, 0.8}, {-5, 4});
  const Point3 want{2 * std::cos(1.1) + 0.6 * 2.5, 3 * std::sin(1.1), 0.8 * 2.5};
  EXPECT_LT(distance(test::evaluate(wall.surface, wall.u(1.1), 2.5), want), 1e-13);
  const geom::NurbsSurface flat = plane({1, 1, 1}, {1, 0, 0}, {0, 0, 1}, {-2, 5}, {3, 4});
  EXPECT_LT(distance(test::evaluate(flat, 2.25, 3.5), {3.25, 1, 4.5}), 1e-14);
}

}  // namespace
}  // namespace burin::io::step
