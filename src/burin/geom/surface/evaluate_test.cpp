// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/evaluate.h"

#include <gtest/gtest.h>

namespace burin::geom {
namespace {

/// Quarter of a sphere's upper half: u along the meridian from the equator to the pole, v about z.
NurbsSurface octant(double r) {
  const double h = std::sqrt(0.5);
  NurbsSurface s;
  s.degree_u = s.degree_v = 2;
  s.count_u = s.count_v = 3;
  s.knots_u = s.knots_v = {0, 0, 0, 1, 1, 1};
  const Vec2 arc[3] = {{1, 0}, {1, 1}, {0, 1}};
  const double w[3] = {1, h, 1};
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      s.points.push_back(
          homogeneous({r * arc[i].x * arc[j].x, r * arc[i].x * arc[j].y, r * arc[i].y}, w[i] * w[j]));
    }
  }
  return s;
}

TEST(Evaluate, Sphere) {
  const NurbsSurface s = octant(10);
  ASSERT_TRUE(validate(s));
  for (double u = 0; u <= 1; u += 0.125) {
    for (double v = 0; v <= 1; v += 0.125) {
      const SurfaceDerivatives d = derivatives(s, u, v);
      EXPECT_NEAR(norm(d.p - Point3{}), 10, 1e-13);
      const Vec3 n = normal(s, u, v), radial = unit(d.p - Point3{});
      EXPECT_LT(norm(n + radial), u < 1 ? 1e-12 : 1e-6) << u << " " << v;
      if (u == 1) continue;
      const Curvature c = curvature(d);
      EXPECT_NEAR(c.k_min, 0.1, 1e-12);
      EXPECT_NEAR(c.k_max, 0.1, 1e-12);
      EXPECT_NEAR(normal_curvature(d, 0.3, -2), 0.1, 1e-12);
    }
  }
}

TEST(Evaluate, DerivativesByDifferences) {
  const NurbsSurface s = octant(10);
  const double u = 0.3, v = 0.6, h = 1e-5;
  const SurfaceDerivatives3 d = derivatives3(s, u, v);
  const auto near = [](Vec3 a, Vec3 b) { EXPECT_LT(norm(a - b), 1e-6); };
  const auto du0 = derivatives(s, u - h, v), du1 = derivatives(s, u + h, v);
  const auto dv0 = derivatives(s, u, v - h), dv1 = derivatives(s, u, v + h);
  near((du1.p - du0.p) / (2 * h), d.du);
  near((dv1.p - dv0.p) / (2 * h), d.dv);
  near((du1.du - du0.du) / (2 * h), d.duu);
  near((dv1.du - dv0.du) / (2 * h), d.duv);
  near((dv1.dv - dv0.dv) / (2 * h), d.dvv);
  near((du1.duu - du0.duu) / (2 * h), d.duuu);
  near((dv1.duu - dv0.duu) / (2 * h), d.duuv);
  near((du1.dvv - du0.dvv) / (2 * h), d.duvv);
  near((dv1.dvv - dv0.dvv) / (2 * h), d.dvvv);
}

}  // namespace
}  // namespace burin::geom
