// SPDX-License-Identifier: Apache-2.0
#include "burin/cl/fit_moves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace burin::cl {
namespace {

using geom::Point3;
using geom::QuinticPath;
using geom::Vec3;

/// Distance of a point from one move, closed form.
double distance_to_move(Point3 p, Point3 from, const FittedMove& m) {
  if (m.radius == 0) {
    const Vec3 d = m.to - from;
    const double l2 = dot(d, d);
    return distance(p, from + (l2 > 0 ? std::clamp(dot(p - from, d) / l2, 0.0, 1.0) : 0.0) * d);
  }
  const Arc arc{m.center, m.normal, m.radius, Pose{m.to}};
  const double sweep = arc_sweep(from, arc);
  const Vec3 e = unit(from - m.center), g = cross(m.normal, e);
  const double rise = dot(m.to - from, m.normal);
  // Nearest by angle; exact enough for the slight rises that are fitted.
  double angle = std::atan2(dot(p - m.center, g), dot(p - m.center, e));
  if (angle < 0) angle = angle > -0.5 * (2 * geom::kPi - sweep) ? 0 : angle + 2 * geom::kPi;
  angle = std::clamp(angle, 0.0, sweep);
  const Point3 q =
      m.center + m.radius * (std::cos(angle) * e + std::sin(angle) * g) + (rise * angle / sweep) * m.normal;
  return distance(p, q);
}

/// Largest distance of dense samples of the path from the moves. The moves are in order, so a sample is
/// compared with all of them (brute force).
double deviation(const QuinticPath& path, const FitMoves& fit, int per_piece = 40) {
  double worst = 0;
  for (std::size_t i = 0; i + 1 < path.nodes.size(); ++i) {
    for (int k = 0; k <= per_piece; ++k) {
      const Point3 p = evaluate_piece(path, i, double(k) / per_piece).p;
      double best = 1e300;
      Point3 from = path.start();
      for (const FittedMove& m : fit.moves) {
        best = std::min(best, distance_to_move(p, from, m));
        from = m.to;
      }
      worst = std::max(worst, best);
    }
  }
  return worst;
}

QuinticPath random_path(std::mt19937& random, bool plane) {
  std::uniform_real_distribution<double> number(-1, 1);
  QuinticPath path;
  Point3 p;
  for (int i = 0; i < 6; ++i) {
    const auto vec = [&](double size) {
      return Vec3{size * number(random), size * number(random), plane ? 0 : size * number(random)};
    };
    path.nodes.push_back({double(i), p, vec(10), vec(20)});
    p = p + vec(20);
  }
  return path;
}

TEST(FitMoves, StraightIsOneLine) {
  const FitMoves fit = fit_moves(geom::straight({1, 2, 3}, {40, -5, 7}), {});
  ASSERT_EQ(fit.moves.size(), 1u);
  EXPECT_EQ(fit.moves[0].radius, 0);
  EXPECT_EQ(fit.moves[0].to, (Point3{40, -5, 7}));
}

TEST(FitMoves, CircleIsFewArcsInEveryPlane) {
  for (const Vec3 normal : {Vec3{0, 0, 1}, Vec3{0, 1, 0}, Vec3{1, 0, 0}, Vec3{0, 0, -1}}) {
    const Point3 center{3, 4, 5};
    const Vec3 e = std::abs(normal.z) > 0 ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
    const QuinticPath path = geom::arc(center + 20.0 * e, center, normal, 6.0, 0);  // rad
    const FitMoves fit = fit_moves(path, {.tolerance_mm = 1e-3});
    EXPECT_LE(fit.moves.size(), 3u);
    for (const FittedMove& m : fit.moves) {
      EXPECT_NEAR(m.radius, 20, 1e-2);
      EXPECT_GT(dot(m.normal, normal), 0.999);
    }
    EXPECT_LE(deviation(path, fit), 1e-3);
  }
}

TEST(FitMoves, CircleAcrossThePlanes) {
  const Vec3 normal = unit(Vec3{1, 1, 1});
  const QuinticPath path = geom::arc(Point3{} + 10.0 * unit(Vec3{1, -1, 0}), {}, normal, 3.0, 0);
  const FitMoves lines = fit_moves(path, {.tolerance_mm = 0.01, .arcs = false});
  for (const FittedMove& m : lines.moves) EXPECT_EQ(m.radius, 0);
  // A chord of sagitta 0.01 on a radius of 10 spans 2 acos(1 - 0.001) = 0.0894 rad.
  EXPECT_LE(lines.moves.size(), std::size_t(3.0 / 0.0894 * 1.2));
  // Helices of the three planes follow it further than lines do.
  const FitMoves helices = fit_moves(path, {.tolerance_mm = 0.01});
  EXPECT_LT(helices.moves.size(), lines.moves.size());
  EXPECT_LE(deviation(path, helices), 0.01);
}

TEST(FitMoves, StaysWithinTheToleranceAndSaysSo) {
  std::mt19937 random(7);
  for (int i = 0; i < 60; ++i) {
    const QuinticPath path = random_path(random, i % 2 == 0);
    for (const double tolerance : {0.1, 0.01}) {
      for (const bool arcs : {true, false}) {
        const FitMoves fit = fit_moves(path, {.tolerance_mm = tolerance, .arcs = arcs});
        EXPECT_EQ(fit.moves.back().to, path.end());
        EXPECT_LE(fit.deviation_mm, tolerance);
        EXPECT_LE(deviation(path, fit), fit.deviation_mm + 1e-9) << i;
      }
    }
  }
}

TEST(FitMoves, ArcsNeedFewerMovesInThePlane) {
  std::mt19937 random(11);
  std::size_t with = 0, without = 0;
  for (int i = 0; i < 20; ++i) {
    const QuinticPath path = random_path(random, true);
    with += fit_moves(path, {.tolerance_mm = 0.005}).moves.size();
    without += fit_moves(path, {.tolerance_mm = 0.005, .arcs = false}).moves.size();
  }
  EXPECT_LT(2 * with, without);
}

TEST(FitMoves, MakesValidRecords) {
  std::mt19937 random(3);
  Program program;
  program.from = Pose{};
  program.add(FeedRate{500});
  append(program, fit_moves(random_path(random, true), {.tolerance_mm = 0.01}), 4);
  EXPECT_TRUE(validate(program).ok()) << validate(program).error().to_string();
  EXPECT_EQ(program.source.back(), 4u);
}

}  // namespace
}  // namespace burin::cl
