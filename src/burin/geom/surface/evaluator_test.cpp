// SPDX-License-Identifier: Apache-2.0
// SurfaceEvaluator against the plain functions and a reference in long double.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "burin/geom/surface/axis.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/kernels.h"
#include "burin/geom/surface/surface_cases.h"

namespace burin::geom {
namespace {

using cases::Random;
using cases::random_surface;
using cases::Shape;

using Long = long double;
using Long4 = std::array<Long, 4>;

/// De Boor's algorithm: all combinations convex, in long double.
Long4 de_boor(const std::vector<double>& knots, int p, int span, std::vector<Long4> d, double t) {
  for (int level = 1; level <= p; ++level) {
    for (int i = p; i >= level; --i) {
      const Long a = knots[static_cast<std::size_t>(span - p + i)];
      const Long b = knots[static_cast<std::size_t>(span + 1 + i - level)];
      const Long f = (t - a) / (b - a);
      const auto k = static_cast<std::size_t>(i);
      for (std::size_t c = 0; c < 4; ++c) d[k][c] = (1 - f) * d[k - 1][c] + f * d[k][c];
    }
  }
  return d[static_cast<std::size_t>(p)];
}

Point3 reference(const NurbsSurface& s, double u, double v) {
  const int iu = find_span(s.knots_u, s.degree_u, s.count_u, u);
  const int iv = find_span(s.knots_v, s.degree_v, s.count_v, v);
  std::vector<Long4> column;
  for (int j = 0; j <= s.degree_v; ++j) {
    std::vector<Long4> row;
    for (int i = 0; i <= s.degree_u; ++i) {
      const HPoint& h = s.at(iu - s.degree_u + i, iv - s.degree_v + j);
      row.push_back({h.x, h.y, h.z, h.w});
    }
    column.push_back(de_boor(s.knots_u, s.degree_u, iu, row, u));
  }
  const Long4 h = de_boor(s.knots_v, s.degree_v, iv, column, v);
  return {double(h[0] / h[3]), double(h[1] / h[3]), double(h[2] / h[3])};
}

std::vector<double> distinct(std::vector<double> knots) {
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  return knots;
}

std::vector<Point2> places(const NurbsSurface& s, unsigned seed, int n) {
  Random r(seed);
  std::vector<Point2> uv;
  const Interval u = s.domain(Direction::u), v = s.domain(Direction::v);
  for (int i = 0; i < n; ++i) uv.push_back({r.between(u.lo, u.hi), r.between(v.lo, v.hi)});
  const std::vector<double> a = distinct(s.knots_u), b = distinct(s.knots_v);
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    uv.push_back({a[i % a.size()], b[i % b.size()]});
    uv.push_back({a[i % a.size()], b[(i + 1) % b.size()]});
  }
  return uv;
}

std::vector<NurbsSurface> all_kinds() {
  std::vector<NurbsSurface> all;
  unsigned seed = 1;
  for (int p = 1; p <= 7; ++p) {
    for (int q = 1; q <= 7; ++q) {
      const bool repeats = seed % 2 == 0;
      all.push_back(random_surface(
          seed++, {.count_u = p + 4, .count_v = q + 3, .degree_u = p, .degree_v = q, .repeats = repeats}));
    }
  }
  for (const double w : {30.0, 1000.0}) {
    for (const bool repeats : {false, true}) {
      all.push_back(random_surface(
          seed++, {.count_u = 9, .count_v = 12, .weight_lo = 1 / w, .weight_hi = w, .repeats = repeats}));
    }
  }
  all.push_back(random_surface(
      seed++,
      {.count_u = 30, .count_v = 27, .degree_u = 25, .degree_v = 20, .weight_lo = 1e-3, .weight_hi = 1e3}));
  all.push_back(cases::sphere(40));
  all.push_back(cases::torus(40, 10));
  all.push_back(cases::saddle(0.3));
  return all;
}

template <class T>
std::string bits(const T& value) {
  std::string s(sizeof value, '\0');
  std::memcpy(s.data(), &value, sizeof value);
  return s;
}

TEST(Evaluator, PositionsAgainstLongDouble) {
  // Relative to the size of the net.
  for (const NurbsSurface& s : all_kinds()) {
    ASSERT_TRUE(validate(s)) << validate(s).error().message;
    SurfaceEvaluator e(s);
    const double size = bounds(s).diagonal();
    double plain = 0, fast = 0;
    for (const Point2 q : places(s, 5, 100)) {
      const Point3 p = reference(s, q.x, q.y);
      plain = std::max(plain, distance(point(s, q.x, q.y), p));
      fast = std::max(fast, distance(e.point(q.x, q.y), p));
    }
    EXPECT_LT(plain, 1e-14 * size) << s.degree_u << " " << s.degree_v;
    EXPECT_LT(fast, 2e-14 * size) << s.degree_u << " " << s.degree_v;
  }
}

/// Largest magnitudes that derivatives can have: the scale of their rounding.
struct Scale {
  double h_u = 1e300, h_v = 1e300, size = 0, ratio = 1;
  explicit Scale(const NurbsSurface& s) {
    for (std::size_t i = 1; i < s.knots_u.size(); ++i) {
      if (s.knots_u[i] > s.knots_u[i - 1]) h_u = std::min(h_u, s.knots_u[i] - s.knots_u[i - 1]);
    }
    for (std::size_t i = 1; i < s.knots_v.size(); ++i) {
      if (s.knots_v[i] > s.knots_v[i - 1]) h_v = std::min(h_v, s.knots_v[i] - s.knots_v[i - 1]);
    }
    size = bounds(s).diagonal();
    double lo = 1e300, hi = 0;
    for (const HPoint& h : s.points) lo = std::min(lo, h.w), hi = std::max(hi, h.w);
    ratio = hi / lo;
  }
  /// Of a derivative k times in u and l times in v: each brings a factor degree * ratio / h.
  double of(const NurbsSurface& s, int k, int l) const {
    return size * std::pow(s.degree_u * ratio / h_u, k) * std::pow(s.degree_v * ratio / h_v, l);
  }
};

void expect_same(const NurbsSurface& s, const Scale& scale, const SurfaceDerivatives& a,
                 const SurfaceDerivatives& b) {
  const double t = 1e-13;
  EXPECT_LE(norm(a.p - b.p), t * scale.size);
  EXPECT_LE(norm(a.du - b.du), t * scale.of(s, 1, 0));
  EXPECT_LE(norm(a.dv - b.dv), t * scale.of(s, 0, 1));
  EXPECT_LE(norm(a.duu - b.duu), t * scale.of(s, 2, 0));
  EXPECT_LE(norm(a.duv - b.duv), t * scale.of(s, 1, 1));
  EXPECT_LE(norm(a.dvv - b.dvv), t * scale.of(s, 0, 2));
}

TEST(Evaluator, AgreesWithPlainFunctionsOnBothSides) {
  for (const NurbsSurface& s : all_kinds()) {
    SurfaceEvaluator e(s);
    const Scale scale(s);
    for (const Point2 q : places(s, 6, 20)) {
      for (const Side a : {Side::right, Side::left}) {
        for (const Side b : {Side::right, Side::left}) {
          const SurfaceDerivatives3 x = e.derivatives3(q.x, q.y, a, b), y = derivatives3(s, q.x, q.y, a, b);
          expect_same(s, scale, x, y);
          expect_same(s, scale, e.derivatives(q.x, q.y, a, b), derivatives(s, q.x, q.y, a, b));
          EXPECT_LE(norm(x.duuu - y.duuu), 1e-13 * scale.of(s, 3, 0));
          EXPECT_LE(norm(x.duuv - y.duuv), 1e-13 * scale.of(s, 2, 1));
          EXPECT_LE(norm(x.duvv - y.duvv), 1e-13 * scale.of(s, 1, 2));
          EXPECT_LE(norm(x.dvvv - y.dvvv), 1e-13 * scale.of(s, 0, 3));
        }
      }
    }
  }
}

TEST(Evaluator, RunsGiveTheBitsOfSinglePlaces) {
  for (const NurbsSurface& s : all_kinds()) {
    const Interval du = s.domain(Direction::u), dv = s.domain(Direction::v);
    std::vector<Point2> uv = places(s, 7, 30);
    for (int i = 0; i <= 51; ++i) {  // neighbours, and beyond the domain
      const double f = -0.02 + 0.021 * i;
      uv.push_back({du.lo + f * du.length(), dv.lo + (0.3 + 0.1 * f) * dv.length()});
    }
    uv.push_back({std::numeric_limits<double>::quiet_NaN(), dv.lo});
    std::vector<Point3> points(uv.size());
    std::vector<SurfaceDerivatives> sets(uv.size());
    SurfaceEvaluator e(s);
    e.points(uv, points);
    e.derivatives(uv, sets);
    for (std::size_t i = uv.size(); i-- > 0;) {
      SurfaceEvaluator fresh(e);  // nothing kept
      if (std::isnan(uv[i].x)) {
        EXPECT_TRUE(std::isnan(points[i].x) && std::isnan(sets[i].p.x));
        continue;
      }
      EXPECT_EQ(bits(points[i]), bits(fresh.point(uv[i].x, uv[i].y)));
      EXPECT_EQ(bits(points[i]), bits(e.point(uv[i].x, uv[i].y)));
      EXPECT_EQ(bits(sets[i]), bits(fresh.derivatives(uv[i].x, uv[i].y)));
      EXPECT_EQ(bits(sets[i]), bits(e.derivatives(uv[i].x, uv[i].y)));
    }
  }
}

TEST(Evaluator, IsoCurvesAgreeAndDoNotDependOnNeighbours) {
  for (const NurbsSurface& s : all_kinds()) {
    const Scale scale(s);
    for (const Direction d : {Direction::u, Direction::v}) {
      const Interval along = s.domain(d), across = s.domain(other(d));
      std::vector<double> t;
      for (int i = 0; i <= 40; ++i) t.push_back(along.lo + (-0.05 + i * (1.1 / 40)) * along.length());
      for (const double k : distinct(s.knots(d))) t.push_back(k);
      std::swap(t[3], t[30]);
      for (const double f : {0.37, 1.0, 2.0}) {
        const double fixed = across.lo + f * across.length();
        SurfaceEvaluator e(s);
        std::vector<Point3> points(t.size());
        std::vector<SurfaceDerivatives> sets(t.size());
        e.iso_points(d, fixed, t, points);
        e.iso_derivatives(d, fixed, t, sets);
        for (std::size_t i = 0; i < t.size(); ++i) {
          const double u = d == Direction::u ? t[i] : fixed, v = d == Direction::u ? fixed : t[i];
          EXPECT_LE(distance(points[i], point(s, u, v)), 1e-13 * scale.size);
          expect_same(s, scale, sets[i], derivatives(s, u, v));
          Point3 p;
          SurfaceDerivatives set;
          SurfaceEvaluator fresh(e);
          fresh.iso_points(d, fixed, std::span(&t[i], 1), std::span(&p, 1));
          fresh.iso_derivatives(d, fixed, std::span(&t[i], 1), std::span(&set, 1));
          EXPECT_EQ(bits(p), bits(points[i]));
          EXPECT_EQ(bits(set), bits(sets[i]));
        }
      }
    }
  }
}

TEST(Evaluator, CopiesAndAssignments) {
  const NurbsSurface a = random_surface(1, {}), b = random_surface(2, {.count_u = 20, .degree_v = 2});
  SurfaceEvaluator x(a), y(b);
  const Point3 pa = x.point(0.3, 1), pb = y.point(0.3, 1);
  SurfaceEvaluator z(x);
  EXPECT_EQ(z.point(0.3, 1), pa);
  z = y;
  EXPECT_EQ(z.point(0.3, 1), pb);
  EXPECT_EQ(y.point(0.3, 1), pb);
  y = std::move(x);
  EXPECT_EQ(y.point(0.3, 1), pa);
  SurfaceEvaluator w(std::move(z));
  EXPECT_EQ(w.point(0.3, 1), pb);
}

TEST(Evaluator, NotANumberAndInfinity) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const NurbsSurface& s :
       {random_surface(1, {}), random_surface(1, {.weight_lo = 1e-3, .weight_hi = 1e3})}) {
    SurfaceEvaluator e(s);
    for (const Point2 q : {Point2{nan, 0}, Point2{0, nan}, Point2{nan, nan}}) {
      EXPECT_TRUE(std::isnan(point(s, q.x, q.y).x));
      EXPECT_TRUE(std::isnan(e.point(q.x, q.y).x));
      EXPECT_TRUE(std::isnan(e.derivatives(q.x, q.y, Side::left, Side::left).du.x));
      EXPECT_TRUE(std::isnan(derivatives3(s, q.x, q.y).p.z));
      Point3 p;
      e.iso_points(Direction::u, q.y, std::span(&q.x, 1), std::span(&p, 1));
      EXPECT_TRUE(std::isnan(p.x));
    }
    EXPECT_EQ(e.point(inf, -inf), e.point(1, -2));
    EXPECT_EQ(point(s, -inf, inf), point(s, 0, 5));
  }
}

TEST(Evaluator, NoOutputForNoPlaces) {
  SurfaceEvaluator e(random_surface(1, {}));
  e.points({}, {});
  e.derivatives({}, {});
  e.iso_points(Direction::u, 0, {}, {});
  e.iso_derivatives(Direction::v, 0, {}, {});
}

TEST(Evaluator, ManyPieces) {
  // More pieces than are kept, knots that crowd, tables too large to keep.
  NurbsSurface s = random_surface(3, {.count_u = 6000, .count_v = 12});
  for (std::size_t i = 0; i < s.knots_u.size(); ++i) s.knots_u[i] = std::pow(s.knots_u[i], 6);
  ASSERT_TRUE(validate(s)) << validate(s).error().message;
  SurfaceEvaluator e(s);
  const double size = bounds(s).diagonal();
  Random r(9);
  for (int i = 0; i < 2000; ++i) {
    const double u = std::pow(r.between(0, 1), 6), v = r.between(-2, 5);
    EXPECT_LT(distance(e.point(u, v), reference(s, u, v)), 1e-13 * size);
  }
}

TEST(Axis, PiecesOfCrowdedKnots) {
  Random r(4);
  for (int test = 0; test < 20; ++test) {
    std::vector<double> knots = cases::random_knots(r, 60, 3, true);
    const double power = r.between(1, 12);
    for (double& k : knots) k = std::pow(k, power);
    const detail::Axis axis(knots, 3);
    for (int i = 0; i < 500; ++i) {
      const double t = i < 60 ? knots[static_cast<std::size_t>(i)] : std::pow(r.between(0, 1), power);
      const int piece = axis.piece(t);
      EXPECT_EQ(axis.first_point(piece) + 3, find_span(knots, 3, 60, t));
    }
  }
}

TEST(Axis, BezierRowsAreConvex) {
  Random r(4);
  for (int p = 1; p <= 12; ++p) {
    const detail::Axis axis(cases::random_knots(r, p + 9, p, true), p);
    std::vector<double> space;
    for (int piece = 0; piece < axis.pieces(); ++piece) {
      const double* m = axis.bezier(piece, space);
      for (int i = 0; i <= p; ++i) {
        double sum = 0;
        for (int k = 0; k <= p; ++k) {
          EXPECT_GE(m[i * (p + 1) + k], 0);
          sum += m[i * (p + 1) + k];
        }
        EXPECT_NEAR(sum, 1, 1e-13);
      }
    }
  }
}

TEST(Kernels, TheSameBitsWithAndWithoutAvx2) {
  // Random coefficients of one piece; where there is no AVX2 this compares a thing with itself.
  const detail::KernelSet any = detail::kernels_any(), fast = detail::kernels_avx2();
  Random r(12);
  for (int p = 1; p <= 5; ++p) {
    for (int q = 1; q <= 5; ++q) {
      alignas(32) double c[36 * 4];
      for (double& x : c) x = r.between(-1, 1);
      c[3] = 9;  // keeps w away from 0
      detail::Piece piece{-1, 1, -1, 1, 0.01, -0.02, 1, 1, p, q, c};
      double uv[16];
      for (double& x : uv) x = r.between(-0.99, 0.99);
      double a[8 * 18] = {}, b[8 * 18] = {};
      const auto same = [&](const char* what) {
        EXPECT_EQ(std::memcmp(a, b, sizeof a), 0) << what << " " << p << " " << q;
      };
      const detail::Kernels &x = any.surface(p, q), &y = fast.surface(p, q);
      x.point(piece, uv[0], uv[1], a), y.point(piece, uv[0], uv[1], b), same("point");
      x.derivatives(piece, uv[0], uv[1], a), y.derivatives(piece, uv[0], uv[1], b), same("derivatives");
      x.derivatives3(piece, uv[0], uv[1], a), y.derivatives3(piece, uv[0], uv[1], b), same("derivatives3");
      EXPECT_EQ(x.points(piece, uv, 8, a), 8u);
      EXPECT_EQ(y.points(piece, uv, 8, b), 8u);
      same("points");
      EXPECT_EQ(x.derivatives_run(piece, uv, 8, a), 8u);
      EXPECT_EQ(y.derivatives_run(piece, uv, 8, b), 8u);
      same("run");
      const detail::IsoKernels &i = any.iso(p), &j = fast.iso(p);
      double along[36], across[18];
      for (double& t : along) t = r.between(-1, 1);
      for (double& t : across) t = r.between(0, 1);
      alignas(32) double ca[6 * 48] = {}, cb[6 * 48] = {};
      i.fix(along, across, c, 4, 4 * (p + 1), p, q, ca);
      j.fix(along, across, c, 4, 4 * (p + 1), p, q, cb);
      EXPECT_EQ(std::memcmp(ca, cb, sizeof ca), 0);
      for (int k = 0; k < 4; ++k) ca[12 + k] = 50;  // w
      const detail::IsoPiece iso{-1, 1, 0.03, p, ca};
      EXPECT_EQ(i.points(iso, uv, 8, a), 8u);
      EXPECT_EQ(j.points(iso, uv, 8, b), 8u);
      same("iso points");
      for (const bool moving_u : {false, true}) {
        EXPECT_EQ(i.derivatives(iso, moving_u, uv, 8, a), 8u);
        EXPECT_EQ(j.derivatives(iso, moving_u, uv, 8, b), 8u);
        same("iso derivatives");
      }
    }
  }
}

}  // namespace
}  // namespace burin::geom
