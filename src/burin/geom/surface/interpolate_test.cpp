// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/interpolate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/surface_cases.h"

namespace burin::geom {
namespace {

PointGrid wavy(int nu, int nv, unsigned seed) {
  cases::Random r(seed);
  PointGrid grid{nu, nv, {}};
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i)
      grid.points.push_back({10 * i + r.between(-3, 3), 7 * j + r.between(-2, 2), r.between(-5, 5)});
  return grid;
}

/// The place of the surface at the data parameters; they are not kept, but the surface is found there by
/// Newton from the knots: here simply the parameters given.
TEST(Interpolate, PassesThroughEveryPoint) {
  for (const auto& [nu, nv] : {std::pair{2, 2}, {3, 5}, {4, 4}, {7, 12}, {40, 9}}) {
    const PointGrid grid = wavy(nu, nv, 7);
    std::vector<double> u, v;
    for (int i = 0; i < nu; ++i) u.push_back(i + 0.3 * std::sin(i));
    for (int j = 0; j < nv; ++j) v.push_back(std::pow(j + 1.0, 1.3));
    const auto s = interpolate(grid, u, v);
    ASSERT_TRUE(s.ok()) << s.error().to_string();
    EXPECT_EQ(s->degree_u, std::min(3, nu - 1));
    for (int j = 0; j < nv; ++j) {
      for (int i = 0; i < nu; ++i) {
        const Point3 p = point(*s, u[static_cast<std::size_t>(i)], v[static_cast<std::size_t>(j)]);
        EXPECT_LT(distance(p, grid.points[static_cast<std::size_t>(i + j * nu)]), 1e-11);
      }
    }
  }
}

TEST(Interpolate, GivesTheSurfaceThatThePointsComeFrom) {
  // A bicubic polynomial at even parameters is reproduced everywhere (no knots fall out of it).
  const auto truth = [](double u, double v) {
    return Point3{3 * u + u * u * u, 2 * v - v * v, u * v * v * v - 2 * u * u};
  };
  PointGrid grid{9, 6, {}};
  std::vector<double> u, v;
  for (int i = 0; i < 9; ++i) u.push_back(i / 8.0);
  for (int j = 0; j < 6; ++j) v.push_back(j / 5.0);
  for (const double b : v)
    for (const double a : u) grid.points.push_back(truth(a, b));
  const auto s = interpolate(grid, u, v);
  ASSERT_TRUE(s.ok());
  for (double a = 0; a <= 1; a += 0.037)
    for (double b = 0; b <= 1; b += 0.041) EXPECT_LT(distance(point(*s, a, b), truth(a, b)), 1e-12);
}

TEST(Interpolate, ApproachesASphereWithTheFourthPower) {
  double before = 0;
  for (const int n : {9, 17, 33}) {
    PointGrid grid{n, n, {}};
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const double a = i / (n - 1.0), b = j / (n - 1.0);  // a patch of a quarter turn each way
        grid.points.push_back(
            {50 * std::cos(a) * std::cos(b), 50 * std::sin(a) * std::cos(b), 50 * std::sin(b)});
      }
    }
    const auto s = interpolate(grid);
    ASSERT_TRUE(s.ok());
    double worst = 0;
    for (double u = 0; u <= 1; u += 0.013)
      for (double v = 0; v <= 1; v += 0.017)
        worst = std::max(worst, std::abs(norm(point(*s, u, v) - Point3{}) - 50));
    if (before > 0) {
      EXPECT_LT(worst, before / 10) << n;
    }
    before = worst;
  }
  EXPECT_LT(before, 1e-5);
}

TEST(Interpolate, OneRowMayBeAPole) {
  PointGrid grid{5, 5, {}};
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 5; ++i)
      grid.points.push_back({j * std::cos(0.3 * i), j * std::sin(0.3 * i), 0.1 * j * j});
  const auto s = interpolate(grid);
  ASSERT_TRUE(s.ok()) << s.error().to_string();
  EXPECT_LT(distance(point(*s, 0.37, 0), {0, 0, 0}), 1e-13);
}

TEST(Interpolate, RefusesWhatIsNoGrid) {
  const auto message = [](const PointGrid& grid) {
    const auto s = interpolate(grid);
    return s.ok() ? std::string("fine") : s.error().message;
  };
  EXPECT_NE(message({1, 5, std::vector<Point3>(5)}).find("at least 2 x 2"), std::string::npos);
  EXPECT_NE(message({3, 3, std::vector<Point3>(8)}).find("8 points (9"), std::string::npos);
  EXPECT_NE(message({2, 2, std::vector<Point3>(4)}).find("no length"), std::string::npos);
  PointGrid grid = wavy(4, 4, 1);
  grid.points[5].y = std::nan("");
  EXPECT_NE(message(grid).find("not finite"), std::string::npos);
  grid = wavy(4, 4, 1);
  for (std::size_t i = 0; i < 4; ++i) grid.points[4 + i] = {1, 2, 3};  // an inner row is one place
  EXPECT_NE(message(grid).find("no length"), std::string::npos);
  grid = wavy(4, 4, 1);
  for (std::size_t j = 0; j < 4; ++j) grid.points[4 * j + 2] = grid.points[4 * j + 1];
  EXPECT_NE(message(grid).find("are the same"), std::string::npos);
  EXPECT_FALSE(interpolate(wavy(3, 3, 1), {0, 1, 1}, {0, 1, 2}).ok());
}

}  // namespace
}  // namespace burin::geom
