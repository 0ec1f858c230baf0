// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/evaluate.h"

#include <gtest/gtest.h>

#include "burin/geom/surface/surface_cases.h"

namespace burin::geom {
namespace {

using cases::Random;
using cases::random_surface;

TEST(Evaluate, ClosedForms) {
  const NurbsSurface sphere = cases::sphere(10), torus = cases::torus(40, 7);
  ASSERT_TRUE(validate(sphere) && validate(torus));
  for (double u = 0; u <= 2; u += 0.0625) {
    for (double v = 0; v <= 4; v += 0.125) {
      EXPECT_NEAR(norm(point(sphere, u, v) - Point3{}), 10, 1e-13);
      const Point3 p = point(torus, 2 * u, v);
      EXPECT_NEAR(std::hypot(std::hypot(p.x, p.y) - 40, p.z), 7, 1e-12);
    }
  }
  const Point3 s = point(cases::saddle(0.5), 0.3, -0.7);
  EXPECT_LT(distance(s, {0.3, -0.7, -0.42}), 1e-15);
}

NurbsCurve iso(const NurbsSurface& s, double v) {
  // Control points of the curve v = const: every column of control points evaluated as a curve.
  NurbsCurve c{s.degree_u, s.knots_u, {}};
  for (int i = 0; i < s.count_u; ++i) {
    // Four curves in one: x, y, z and w as coordinates of curves of weight 1.
    NurbsCurve xyz{s.degree_v, s.knots_v, {}}, w = xyz;
    for (int j = 0; j < s.count_v; ++j) {
      const HPoint& h = s.at(i, j);
      xyz.points.push_back({h.x, h.y, h.z, 1});
      w.points.push_back({h.w, 0, 0, 1});
    }
    const Point3 a = point(xyz, v), b = point(w, v);
    c.points.push_back({a.x, a.y, a.z, b.x});
  }
  return c;
}

TEST(Evaluate, CurvesAreLinesOfSurfaces) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const NurbsSurface s = random_surface(seed, {.count_u = 9,
                                                 .count_v = 8,
                                                 .degree_u = 1 + static_cast<int>(seed) % 5,
                                                 .degree_v = 1 + static_cast<int>(seed) % 4,
                                                 .repeats = seed % 2 == 0});
    const double v = -1.3 + 0.4 * seed;
    const NurbsCurve c = iso(s, v);
    ASSERT_TRUE(validate(c));
    for (const double t : {0.0, 0.123, 0.5, 0.77, 1.0, s.knots_u[static_cast<std::size_t>(s.count_u - 1)]}) {
      for (const Side side : {Side::left, Side::right}) {
        const CurveDerivatives a = derivatives(c, t, side);
        const SurfaceDerivatives3 b = derivatives3(s, t, v, side);
        EXPECT_LT(distance(a.p, b.p), 1e-12);
        EXPECT_LT(distance(point(c, t), b.p), 1e-12);
        EXPECT_LT(norm(a.d1 - b.du), 1e-12 * (100 + norm(b.du)));
        EXPECT_LT(norm(a.d2 - b.duu), 1e-11 * (100 + norm(b.duu)));
        EXPECT_LT(norm(a.d3 - b.duuu), 1e-10 * (100 + norm(b.duuu)));
      }
    }
  }
}

TEST(Evaluate, AffineInvariance) {
  // A rotation, a stretch and a shift of the control points do the same to every point and derivative.
  const auto linear = [](Vec3 a) {
    return Vec3{0.6 * a.x - 0.8 * a.y, 1.6 * a.x + 1.2 * a.y, 0.5 * a.z + a.x};
  };
  const Vec3 shift{10, -20, 5};
  for (unsigned seed = 0; seed < 10; ++seed) {
    const NurbsSurface s = random_surface(seed, {.repeats = seed % 2 == 0});
    NurbsSurface m = s;
    for (HPoint& h : m.points) h = homogeneous(Point3{} + linear(project(h) - Point3{}) + shift, h.w);
    SurfaceEvaluator es(s), em(m);
    Random r(seed);
    for (int k = 0; k < 30; ++k) {
      const double u = r.between(0, 1), v = r.between(-2, 5);
      const SurfaceDerivatives a = es.derivatives(u, v), b = em.derivatives(u, v);
      EXPECT_LT(norm(b.p - (Point3{} + linear(a.p - Point3{}) + shift)), 1e-11);
      EXPECT_LT(norm(b.du - linear(a.du)), 1e-11 * (100 + norm(a.du)));
      EXPECT_LT(norm(b.duv - linear(a.duv)), 1e-10 * (100 + norm(a.duv)));
      EXPECT_LT(norm(b.dvv - linear(a.dvv)), 1e-10 * (100 + norm(a.dvv)));
    }
  }
}

TEST(Evaluate, StaysInTheBoxOfTheControlPointsThatAct) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const NurbsSurface s = random_surface(
        seed, {.count_u = 9, .count_v = 9, .weight_lo = 1e-3, .weight_hi = 1e3, .repeats = seed % 2 == 0});
    SurfaceEvaluator e(s);
    Random r(seed);
    for (int k = 0; k < 60; ++k) {
      const double u = r.between(0, 1), v = r.between(-2, 5);
      const int i = find_span(s.knots_u, 3, 9, u), j = find_span(s.knots_v, 3, 9, v);
      Box3 box;
      for (int y = j - 3; y <= j; ++y) {
        for (int x = i - 3; x <= i; ++x) box.add(project(s.at(x, y)));
      }
      EXPECT_TRUE(box.grown(1e-12).contains(point(s, u, v)));
      EXPECT_TRUE(box.grown(1e-11).contains(e.point(u, v)));
    }
  }
}

TEST(Evaluate, CornersAreControlPoints) {
  const NurbsSurface s =
      random_surface(1, {.count_u = 7, .degree_v = 5, .weight_lo = 1e-3, .weight_hi = 1e3});
  SurfaceEvaluator e(s);
  for (const int i : {0, s.count_u - 1}) {
    for (const int j : {0, s.count_v - 1}) {
      const double u = i == 0 ? 0 : 1, v = j == 0 ? -2 : 5;
      EXPECT_LT(distance(point(s, u, v), project(s.at(i, j))), 1e-13);
      EXPECT_LT(distance(e.point(u, v), project(s.at(i, j))), 1e-12);
    }
  }
}

TEST(Evaluate, SidesOfACrease) {
  // Degree 1: the derivative jumps at every knot.
  NurbsCurve c{1, {0, 0, 1, 2, 2}, {{0, 0, 0, 1}, {1, 0, 0, 1}, {1, 3, 0, 1}}};
  EXPECT_EQ(derivatives(c, 1).d1, (Vec3{0, 3, 0}));
  EXPECT_EQ(derivatives(c, 1, Side::left).d1, (Vec3{1, 0, 0}));
  EXPECT_EQ(derivatives(c, 0, Side::left).d1, (Vec3{1, 0, 0}));
  EXPECT_EQ(derivatives(c, 2).d1, (Vec3{0, 3, 0}));
}

TEST(Evaluate, DerivativesByDifferences) {
  const NurbsSurface s = cases::sphere(10);
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
