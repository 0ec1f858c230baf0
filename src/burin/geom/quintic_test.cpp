// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/quintic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace burin::geom {
namespace {

double at(const std::array<double, 6>& c, double x, int derivative) {
  double sum = 0;
  for (int k = derivative; k < 6; ++k) {
    double f = c[static_cast<std::size_t>(k)] * std::pow(x, k - derivative);
    for (int d = 0; d < derivative; ++d) f *= k - d;
    sum += f;
  }
  return sum;
}

TEST(Quintic, CoefficientsTakeTheValuesOfBothEnds) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> value(-5, 5), step(0.01, 3);
  for (int i = 0; i < 1000; ++i) {
    const double h = step(random);
    double w[6];
    for (double& v : w) v = value(random);
    const auto c = quintic_coefficients(h, w[0], w[1], w[2], w[3], w[4], w[5]);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(at(c, 0, k), w[k] * std::pow(h, k), 1e-12);
      EXPECT_NEAR(at(c, 1, k), w[3 + k] * std::pow(h, k), 1e-10);
    }
  }
}

/// A polynomial curve of degree 5 with three pieces cut from it: reproduced, with its derivatives.
TEST(Quintic, ReproducesPolynomialsOfDegreeFive) {
  const double k[3][6] = {{1, 2, -1, 0.5, 0.2, -0.1}, {0, -1, 3, 0.1, -0.4, 0.05}, {4, 0, 0, 1, 1, -0.3}};
  const auto f = [&k](double t, int d) {
    Vec3 v;
    double* out[3] = {&v.x, &v.y, &v.z};
    for (int axis = 0; axis < 3; ++axis) {
      std::array<double, 6> c{};
      for (std::size_t i = 0; i < 6; ++i) c[i] = k[axis][i];
      *out[axis] = at(c, t, d);
    }
    return v;
  };
  QuinticPath path;
  for (const double t : {-1.0, -0.2, 0.7, 2.0}) {
    const Vec3 p = f(t, 0);
    path.nodes.push_back({t, {p.x, p.y, p.z}, f(t, 1), f(t, 2)});
  }
  for (double t = -1; t <= 2; t += 0.01) {
    const QuinticDerivatives e = evaluate(path, t);
    EXPECT_LT(norm(e.p - (Point3{} + f(t, 0))), 1e-11);
    EXPECT_LT(norm(e.d1 - f(t, 1)), 1e-10);
    EXPECT_LT(norm(e.d2 - f(t, 2)), 1e-9);
    EXPECT_LT(norm(e.d3 - f(t, 3)), 1e-8);
  }
  EXPECT_EQ(evaluate(path, -7).p, path.start());
  EXPECT_LT(distance(evaluate(path, 7).p, path.end()), 1e-12);
}

TEST(Quintic, StraightHasUnitSpeed) {
  const QuinticPath path = straight({1, 2, 3}, {4, 6, 3});
  EXPECT_DOUBLE_EQ(path.nodes[1].t, 5);
  EXPECT_NEAR(length(path), 5, 1e-14);
  const auto e = evaluate(path, 2.5);
  EXPECT_LT(distance(e.p, {2.5, 4, 3}), 1e-14);
  EXPECT_LT(norm(e.d1 - Vec3{0.6, 0.8, 0}), 1e-14);
  EXPECT_LT(norm(e.d2), 1e-14);
  const QuinticPath nothing = straight({1, 1, 1}, {1, 1, 1});
  EXPECT_EQ(nothing.nodes[1].t, 1);
  EXPECT_EQ(length(nothing), 0);
  EXPECT_EQ(evaluate(nothing, 0.5).p, (Point3{1, 1, 1}));
}

TEST(Quintic, ArcsAndHelicesStayOnTheCircle) {
  for (const double sweep : {0.001, 0.3, 2.0, 6.283185307179586, 40.0}) {
    for (const double rise : {0.0, -3.0}) {
      const Vec3 n = unit(Vec3{1, 2, -1});
      const Point3 center{10, -5, 2}, start = center + 7.0 * unit(cross(n, Vec3{0, 0, 1})) + 0.5 * n;
      const QuinticPath path = arc(start, center, n, sweep, rise);
      EXPECT_EQ(path.start(), start);
      for (int i = 0; i <= 500; ++i) {
        const double t = sweep * i / 500;
        const Vec3 arm = evaluate(path, t).p - center;
        const double h = dot(arm, n);
        EXPECT_NEAR(norm(arm - h * n), 7, 7e-8);
        EXPECT_NEAR(h, 0.5 + rise * t / sweep, 1e-10);
        // Counter-clockwise by t from the start.
        const Vec3 a = start - center - 0.5 * n, b = arm - h * n;
        EXPECT_NEAR(std::remainder(std::atan2(dot(cross(a, b), n), dot(a, b)) - t, 2 * kPi), 0, 2e-8);
      }
      EXPECT_NEAR(length(path), std::hypot(7 * sweep, rise), 1e-8 * length(path));
    }
  }
}

TEST(Quintic, ArcsThatCannotBeAreEmpty) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(arc({1, 0, 0}, {}, {0, 0, 1}, 0, 0).empty());
  EXPECT_TRUE(arc({1, 0, 0}, {}, {0, 0, 1}, nan, 0).empty());
  EXPECT_TRUE(arc({1, 0, 0}, {}, {0, 0, 1}, 1e300, 0).empty());
  EXPECT_EQ(evaluate(QuinticPath{}, 1).p, Point3{});
}

/// x = t^3, y = t^2 has a cusp at 0; its length is known: ((4 + 9 t^2)^(3/2) - 8) / 27 on each side.
TEST(Quintic, LengthOfACusp) {
  QuinticPath path;
  for (const double t : {-1.0, 0.5, 1.0})
    path.nodes.push_back({t, {t * t * t, t * t, 0}, {3 * t * t, 2 * t, 0}, {6 * t, 2, 0}});
  const double side = (std::pow(13.0, 1.5) - 8) / 27;
  EXPECT_NEAR(length(path), 2 * side, 1e-9);
  EXPECT_NEAR(piece_length(path, 0) + piece_length(path, 1), length(path), 1e-14);
}

TEST(Quintic, ReversedIsTheSameCurve) {
  const QuinticPath path = arc({1, 0, 0}, {}, {0, 0, 1}, 2, 0.3), back = reversed(path);
  EXPECT_EQ(reversed(back).nodes, path.nodes);
  EXPECT_DOUBLE_EQ(back.nodes.front().t, -2);
  for (double t = 0; t <= 2; t += 0.05) {
    const auto a = evaluate(path, t), b = evaluate(back, -t);
    EXPECT_LT(distance(a.p, b.p), 1e-14);
    EXPECT_LT(norm(a.d1 + b.d1), 1e-12);
    EXPECT_LT(norm(a.d2 - b.d2), 1e-11);
  }
}

}  // namespace
}  // namespace burin::geom
