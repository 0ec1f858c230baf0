// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "burin/geom/curve/nurbs.h"

namespace burin::geom {
namespace {

/// Cox-de Boor recursion, straight from the definition.
double basis(const Nurbs2& n, std::size_t i, int p, double u) {
  if (p == 0) {
    const bool last = u == n.knots[n.points.size()] && n.knots[i] < u && n.knots[i + 1] == u;
    return (n.knots[i] <= u && u < n.knots[i + 1]) || last ? 1 : 0;
  }
  const auto q = static_cast<std::size_t>(p);
  const double a = n.knots[i + q] - n.knots[i], b = n.knots[i + q + 1] - n.knots[i + 1];
  double v = 0;
  if (a > 0) v += (u - n.knots[i]) / a * basis(n, i, p - 1, u);
  if (b > 0) v += (n.knots[i + q + 1] - u) / b * basis(n, i + 1, p - 1, u);
  return v;
}

Point2 by_definition(const Nurbs2& n, double t) {
  const double u0 = n.knots[static_cast<std::size_t>(n.degree)], u1 = n.knots[n.points.size()];
  const double u = u0 + t * (u1 - u0);
  double x = 0, y = 0, w = 0;
  for (std::size_t i = 0; i < n.points.size(); ++i) {
    const double b = n.weights[i] * basis(n, i, n.degree, u);
    x += b * n.points[i].x, y += b * n.points[i].y, w += b;
  }
  return {x / w, y / w};
}

Nurbs2 random_nurbs(std::mt19937_64& random, bool clamped = true) {
  std::uniform_int_distribution<int> degree(1, 5), extra(0, 5), repeat(1, 3);
  std::uniform_real_distribution<double> place(-10, 10), weight(0.2, 4), step(0.1, 2);
  Nurbs2 n;
  n.degree = degree(random);
  const int count = n.degree + 1 + extra(random);
  for (int i = 0; i < count; ++i)
    n.points.push_back({place(random), place(random)}), n.weights.push_back(weight(random));
  const std::size_t total = n.points.size() + static_cast<std::size_t>(n.degree) + 1;
  double u = -1;
  if (clamped) n.knots.assign(static_cast<std::size_t>(n.degree) + 1, u);
  while (n.knots.size() < total) {
    u += step(random);
    if (clamped && total - n.knots.size() <= static_cast<std::size_t>(n.degree) + 1) {
      n.knots.resize(total, u);
    } else {
      const int times = clamped ? std::min(repeat(random), n.degree) : 1;
      for (int k = 0;
           k < times && n.knots.size() < total - (clamped ? static_cast<std::size_t>(n.degree) + 1 : 0);
           ++k) {
        n.knots.push_back(u);
      }
    }
  }
  return n;
}

std::vector<Curve2> some_curves(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-10, 10), angle(-6, 6), radius(0.1, 5);
  std::vector<Curve2> out;
  for (int i = 0; i < 40; ++i) {
    out.push_back(Line2{{place(random), place(random)}, {place(random), place(random)}});
    out.push_back(Arc2{{place(random), place(random)}, radius(random), angle(random), angle(random) + 0.01});
    out.push_back(EllipseArc2{{place(random), place(random)},
                              {place(random), place(random)},
                              {place(random), place(random)},
                              angle(random),
                              angle(random) + 0.01});
    out.push_back(random_nurbs(random, i % 3 != 0));
  }
  return out;
}

TEST(Nurbs, EvaluatesAsDefined) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> t(0, 1);
  for (int i = 0; i < 400; ++i) {
    const Nurbs2 n = random_nurbs(random, i % 4 != 0);
    ASSERT_TRUE(validate(Curve2{n}).ok());
    for (int k = 0; k < 8; ++k) {
      const double u = k == 0 ? 0.0 : t(random);
      EXPECT_LT(distance(point_at(Curve2{n}, u), by_definition(n, u)), 1e-9);
    }
  }
}

TEST(Curve, DerivativesAgreeWithDifferences) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> place(0.05, 0.95);
  for (const Curve2& c : some_curves(random)) {
    for (int k = 0; k < 5; ++k) {
      const double t = place(random);
      constexpr double h = 1e-5;
      const Derivatives2 d = derivatives_at(c, t);
      const Derivatives2 before = derivatives_at(c, t - h), after = derivatives_at(c, t + h);
      // Not across a knot, where derivatives jump.
      const double speed = 1 + norm(before.d1) + norm(after.d1), bend = 1 + norm(before.d2) + norm(after.d2);
      if (norm(after.d2 - before.d2) > 1e-2 * bend) continue;
      EXPECT_LT(norm((after.point - before.point) / (2 * h) - d.d1), 1e-4 * speed * bend);
      EXPECT_LT(norm((after.d1 - before.d1) / (2 * h) - d.d2), 2e-2 * bend);
    }
  }
}

TEST(Curve, PartsReversalsAndMapsFollowThePoints) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> t(0, 1), m(-2, 2);
  for (const Curve2& c : some_curves(random)) {
    double t0 = t(random), t1 = t(random);
    if (t0 > t1) std::swap(t0, t1);
    if (t1 - t0 < 1e-3) continue;
    const Curve2 piece = part(c, t0, t1), back = reversed(c);
    const Affine2 map{m(random), m(random), m(random), m(random), m(random), m(random)};
    const double w = m(random), k = std::abs(m(random)) + 0.1;
    const Affine2 mirror{k * std::cos(w), k * std::sin(w), k * std::sin(w), -k * std::cos(w), 3, 4};
    const Curve2 mapped = transformed(map, c), mirrored = transformed(mirror, c);
    if (std::holds_alternative<Arc2>(c)) {
      EXPECT_TRUE(std::holds_alternative<Arc2>(mirrored));
    }
    const Box2 box = bounds(c).grown(1e-9);
    EXPECT_TRUE(validate(piece).ok());
    for (int i = 0; i <= 20; ++i) {
      const double s = i / 20.0;
      EXPECT_LT(distance(point_at(piece, s), point_at(c, t0 + s * (t1 - t0))), 1e-8);
      EXPECT_LT(distance(point_at(back, s), point_at(c, 1 - s)), 1e-8);
      EXPECT_LT(distance(point_at(mapped, s), map(point_at(c, s))), 1e-8);
      EXPECT_LT(distance(point_at(mirrored, s), mirror(point_at(c, s))), 1e-8);
      EXPECT_TRUE(box.contains(point_at(c, s)));
    }
  }
}

TEST(Curve, LengthAgreesWithSampling) {
  std::mt19937_64 random(10);
  for (const Curve2& c : some_curves(random)) {
    double sum = 0;
    Point2 before = start_point(c);
    for (int i = 1; i <= 20000; ++i) {
      const Point2 now = point_at(c, i / 20000.0);
      sum += distance(before, now);
      before = now;
    }
    EXPECT_NEAR(length(c), sum, 5e-4 * sum);  // samples cut the corners of degree 1
  }
  EXPECT_NEAR(length(Arc2{{0, 0}, 2, 1, 2 * kPi}), 4 * kPi, 1e-12);
}

TEST(Nurbs, BezierPiecesAreTheCurve) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 200; ++i) {
    const Nurbs2 n = random_nurbs(random, i % 3 != 0);
    const std::vector<Nurbs2> pieces = bezier_pieces(n);
    std::vector<double> breaks{n.knots[static_cast<std::size_t>(n.degree)]};
    const double last = n.knots[n.points.size()];
    for (const double u : n.knots) {
      if (u > breaks.back() && u <= last) breaks.push_back(u);
    }
    ASSERT_EQ(pieces.size(), breaks.size() - 1);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      EXPECT_EQ(pieces[k].points.size(), static_cast<std::size_t>(n.degree) + 1);
      for (int s = 1; s < 10; ++s) {
        const double u = breaks[k] + s / 10.0 * (breaks[k + 1] - breaks[k]);
        const double t = (u - breaks.front()) / (last - breaks.front());
        EXPECT_LT(distance(point_at(Curve2{pieces[k]}, s / 10.0), point_at(Curve2{n}, t)), 1e-8);
      }
    }
  }
}

TEST(Nurbs, CornersAreFoundAtFullKnotsAndCusps) {
  Nurbs2 corner{3,
                {0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2},
                {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {3, 3}},
                std::vector<double>(7, 1.0)};
  ASSERT_EQ(corner_parameters(corner, 1e-3).size(), 1u);
  EXPECT_NEAR(corner_parameters(corner, 1e-3)[0], 0.5, 1e-12);
  corner.points[4] = {4, 0};  // tangent continues
  EXPECT_TRUE(corner_parameters(corner, 1e-3).empty());
  // x = (2t-1)^2-like cusp: control polygon crosses itself so that the hodograph vanishes at t = 1/2.
  const Nurbs2 cusp{
      3, {0, 0, 0, 0, 1, 1, 1, 1}, {{0, 0}, {2, 2}, {0, 2}, {2, 0}}, std::vector<double>(4, 1.0)};
  const Derivatives2 d = derivatives_at(Curve2{cusp}, 0.5);
  ASSERT_NEAR(norm(d.d1), 0, 1e-12);
  ASSERT_EQ(corner_parameters(cusp, 1e-3).size(), 1u);
  EXPECT_NEAR(corner_parameters(cusp, 1e-3)[0], 0.5, 1e-4);
}

TEST(Nurbs, TangentWhereControlPointsCoincide) {
  const Nurbs2 n{3, {0, 0, 0, 0, 1, 1, 1, 1}, {{0, 0}, {0, 0}, {1, 1}, {2, 1}}, std::vector<double>(4, 1.0)};
  const Vec2 t = tangent_at(Curve2{n}, 0.0);
  EXPECT_NEAR(t.x, std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(t.y, std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(tangent_at(Curve2{n}, 1.0).x, 1, 1e-9);
}

TEST(Nurbs, InterpolationPassesThroughAndIsSmooth) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> place(-10, 10);
  for (const bool closed : {false, true}) {
    std::vector<Point2> q(9);
    for (Point2& p : q) p = {place(random), place(random)};
    const auto n = interpolate(q, closed);
    ASSERT_TRUE(n.ok());
    std::vector<double> s{0};
    for (std::size_t i = 0; i + 1 < q.size() + (closed ? 1 : 0); ++i)
      s.push_back(s.back() + distance(q[i], q[(i + 1) % q.size()]));
    for (std::size_t i = 0; i < s.size(); ++i) {
      const double t = s[i] / s.back();
      EXPECT_LT(distance(point_at(*n, t), q[i % q.size()]), 1e-9);
      if (i == 0 || i + 1 == s.size()) continue;
      const Derivatives2 a = derivatives_at(*n, t - 1e-9), b = derivatives_at(*n, t + 1e-9);
      EXPECT_LT(norm(a.d2 - b.d2), 1e-4 * (1 + norm(a.d2)));
    }
    if (closed) {
      const Derivatives2 a = derivatives_at(*n, 0), b = derivatives_at(*n, 1);
      EXPECT_LT(norm(a.d1 - b.d1), 1e-8 * norm(a.d1));
      EXPECT_LT(norm(a.d2 - b.d2), 1e-6 * (1 + norm(a.d2)));
    }
  }
  EXPECT_FALSE(interpolate({{1, 1}, {1, 1}}, false).ok());
  const auto clamped = interpolate({{0, 0}, {1, 0}, {2, 1}}, false, {0, 1}, {1, 0});
  ASSERT_TRUE(clamped.ok());
  EXPECT_NEAR(tangent_at(*clamped, 0).y, 1, 1e-9);
  EXPECT_NEAR(tangent_at(*clamped, 1).x, 1, 1e-9);
}

TEST(Nurbs, InterpolationTakesPointsThatDifferByRoundingForOne) {
  // A ring that closes with its first point computed again, as 10 sin(2 pi): -2.4e-15.
  std::vector<Point2> ring;
  for (int i = 0; i <= 24; ++i)
    ring.push_back({10 * std::cos(2 * kPi * i / 24), 10 * std::sin(2 * kPi * i / 24)});
  for (const double shift : {0.0, 1e4}) {
    std::vector<Point2> moved;
    for (const Point2 p : ring) moved.push_back({p.x + shift, p.y - shift});
    moved.insert(moved.begin() + 5, moved[5]);
    moved[5].x += 1e-12;
    for (const bool closed : {true, false}) {
      const auto n = interpolate(moved, closed);
      ASSERT_TRUE(n.ok()) << n.error().message;
      for (int i = 0; i <= 300; ++i) {
        const Point2 p = point_at(*n, i / 300.0);
        // Natural ends are flat: the open curve leaves the circle there, by less than the chord does (sagitta
        // 0.0856).
        EXPECT_NEAR(std::hypot(p.x - shift, p.y + shift), 10, closed ? 0.001 : 0.05);
      }
    }
  }
  EXPECT_FALSE(interpolate({{1, 1}, {1, 1 + 1e-15}}, true).ok());
}

TEST(Curve, ValidateSaysWhatIsWrong) {
  EXPECT_FALSE(validate(Line2{{0, NAN}, {1, 1}}).ok());
  EXPECT_FALSE(validate(Arc2{{0, 0}, 0, 0, 1}).ok());
  EXPECT_FALSE(validate(Arc2{{0, 0}, 1, 0, 7}).ok());
  Nurbs2 n{1, {0, 0, 1, 1}, {{0, 0}, {1, 1}}, {1, 1}};
  EXPECT_TRUE(validate(n).ok());
  n.weights[1] = 0;
  EXPECT_FALSE(validate(n).ok());
  n.weights[1] = 1;
  n.knots = {0, 0, 0, 0};
  EXPECT_FALSE(validate(n).ok());
  n.knots = {0, 1, 0, 1};
  EXPECT_FALSE(validate(n).ok());
  n.knots = {0, 1};
  EXPECT_FALSE(validate(n).ok());
}

}  // namespace
}  // namespace burin::geom
