// SPDX-License-Identifier: Apache-2.0
#include "burin/job/curve_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "burin/geom/surface/evaluate.h"

namespace burin::job {
namespace {

using geom::homogeneous;
using geom::NurbsCurve;

/// Full circle of radius 10 from four quarters: C1 at best at its double knots.
NurbsCurve circle() {
  const double w = std::sqrt(0.5);
  NurbsCurve c;
  c.degree = 2;
  c.knots = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
  const double p[9][3] = {{1, 0, 1},   {1, 1, w},  {0, 1, 1},  {-1, 1, w}, {-1, 0, 1},
                          {-1, -1, w}, {0, -1, 1}, {1, -1, w}, {1, 0, 1}};
  for (const auto& q : p) c.points.push_back(homogeneous({10 * q[0], 10 * q[1], 3}, q[2]));
  return c;
}

TEST(CurvePath, FollowsTheCurveAtEqualParameters) {
  const std::vector<CurvePiece> pieces = curve_path(circle(), 1e-6);
  EXPECT_EQ(pieces.size(), 4u);
  for (const CurvePiece& piece : pieces) {
    ASSERT_EQ(piece.path.nodes.size(), piece.parameter.nodes.size());
    for (std::size_t i = 0; i + 1 < piece.path.nodes.size(); ++i) {
      for (double x = 0; x <= 1; x += 0.05) {
        const geom::Point3 p = evaluate_piece(piece.path, i, x).p;
        EXPECT_NEAR(std::hypot(p.x, p.y), 10, 2e-6);
        const double t = piece.path.nodes[i].t + x * (piece.path.nodes[i + 1].t - piece.path.nodes[i].t);
        EXPECT_LT(distance(p, geom::point(circle(), t)), 2e-6);
      }
    }
    EXPECT_TRUE(std::isnan(piece.parameter.nodes[0].p.y));
  }
}

TEST(CurvePath, SmoothCurveStaysOnePiece) {
  NurbsCurve c;
  c.degree = 3;
  c.knots = geom::clamped_uniform_knots(9, 3);
  for (int i = 0; i < 9; ++i) c.points.push_back(homogeneous({5.0 * i, i % 2 ? 8.0 : 0.0, 0}, i % 3 ? 1 : 4));
  EXPECT_EQ(curve_path(c, 1e-6).size(), 1u);
}

}  // namespace
}  // namespace burin::job
