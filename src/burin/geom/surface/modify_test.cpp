// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/modify.h"

#include <gtest/gtest.h>

#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/random_surface.h"
#include "burin/geom/surface/rows.h"

namespace burin::geom {
namespace {

using test::at_fraction;
using test::by_definition;
using test::integer;
using test::Random;
using test::random_surface;
using test::uniform;

constexpr int kCases = 60;
constexpr Direction kDirections[] = {Direction::u, Direction::v};

/// Largest distance of a(u, v) and b(map(u, v)) at random places and the corners of a's domain; both from the
/// definition.
template <class Map>
double distance_of(Random& random, const NurbsSurface& a, const NurbsSurface& b, Map map) {
  double most = 0;
  for (int k = 0; k < 12; ++k) {
    const double fu = k < 4 ? k % 2 : uniform(random, 0, 1), fv = k < 4 ? k / 2 : uniform(random, 0, 1);
    const Point2 at{at_fraction(a.domain(Direction::u), fu), at_fraction(a.domain(Direction::v), fv)};
    const Point2 to = map(at);
    most = std::max(most, distance(by_definition(a, at.x, at.y), by_definition(b, to.x, to.y)));
  }
  return most;
}
double distance_of(Random& random, const NurbsSurface& a, const NurbsSurface& b) {
  return distance_of(random, a, b, [](Point2 p) { return p; });
}

constexpr double kExact = 1e-10;  // of surfaces of 100 mm: rounding only

TEST(Modify, InsertionKeepsTheShape) {
  Random random(1);
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random);
    for (const Direction d : kDirections) {
      std::vector<double> values;
      for (int i = integer(random, 1, 6); i > 0; --i) {
        const double value = at_fraction(s.domain(d), uniform(random, -0.1, 1.1));
        values.insert(values.end(), static_cast<std::size_t>(integer(random, 1, 6)), value);
      }
      for (const Knot& knot : inner_knots(s.knots(d), s.degree(d))) values.push_back(knot.value);
      std::sort(values.begin(), values.end());
      const NurbsSurface t = insert_knots(s, d, values);
      ASSERT_TRUE(validate(t));
      EXPECT_LT(distance_of(random, s, t), kExact);
      for (const double value : values) {
        const auto has = std::count(t.knots(d).begin(), t.knots(d).end(), value);
        const auto had = std::count(s.knots(d).begin(), s.knots(d).end(), value);
        const auto asked = std::count(values.begin(), values.end(), value);
        const bool inside = value > s.domain(d).lo && value < s.domain(d).hi;
        EXPECT_EQ(has, inside ? std::min<std::ptrdiff_t>(had + asked, s.degree(d)) : had);
      }
    }
  }
}

TEST(Modify, ElevationKeepsTheShape) {
  Random random(2);
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random);
    for (const Direction d : kDirections) {
      const int by = integer(random, 0, 3);
      const auto t = elevate_degree(s, d, by);
      ASSERT_TRUE(t);
      ASSERT_TRUE(validate(*t));
      EXPECT_EQ(t->degree(d), s.degree(d) + by);
      EXPECT_EQ(t->degree(other(d)), s.degree(other(d)));
      EXPECT_LT(distance_of(random, s, *t), kExact);
    }
  }
}

TEST(Modify, ElevationToTheHighestDegreeAndNotBeyond) {
  Random random(3);
  const NurbsSurface s = random_surface(random, 3, 3);
  const auto t = elevate_degree(s, Direction::u, kMaxSurfaceDegree - s.degree_u);
  ASSERT_TRUE(t);
  ASSERT_TRUE(validate(*t));
  for (double f = 0; f <= 1; f += 0.05) {
    const double u = at_fraction(s.domain(Direction::u), f), v = at_fraction(s.domain(Direction::v), 0.4);
    EXPECT_LT(distance(point(s, u, v), point(*t, u, v)), kExact);
  }
  const auto no = elevate_degree(*t, Direction::u, 1);
  ASSERT_FALSE(no);
  EXPECT_EQ(no.error().code, ErrorCode::range);
}

TEST(Modify, PartsAreParts) {
  Random random(4);
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random);
    for (const Direction d : kDirections) {
      const auto inner = inner_knots(s.knots(d), s.degree(d));
      const bool at_knot = !inner.empty() && k % 2 == 0;
      const double at =
          at_knot ? inner[inner.size() / 2].value : at_fraction(s.domain(d), uniform(random, 0.05, 0.95));
      const auto [a, b] = split(s, d, at);
      ASSERT_TRUE(validate(a));
      ASSERT_TRUE(validate(b));
      EXPECT_EQ(a.domain(d), (Interval{s.domain(d).lo, at}));
      EXPECT_EQ(b.domain(d), (Interval{at, s.domain(d).hi}));
      EXPECT_LT(distance_of(random, a, s), kExact);
      EXPECT_LT(distance_of(random, b, s), kExact);
    }
    const Interval u{at_fraction(s.domain(Direction::u), uniform(random, 0, 0.5)),
                     at_fraction(s.domain(Direction::u), uniform(random, 0.5, 1))};
    const Interval v{s.domain(Direction::v).lo, at_fraction(s.domain(Direction::v), uniform(random, 0.5, 1))};
    const NurbsSurface part = sub_surface(s, u, v);
    ASSERT_TRUE(validate(part));
    EXPECT_EQ(part.domain(Direction::u), u);
    EXPECT_EQ(part.domain(Direction::v), v);
    EXPECT_LT(distance_of(random, part, s), kExact);
    EXPECT_EQ(sub_surface(s, s.domain(Direction::u), s.domain(Direction::v)), s);
  }
}

TEST(Modify, ReversalSwapDomainWeightsTranslation) {
  Random random(5);
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random);
    const Interval u = s.domain(Direction::u), v = s.domain(Direction::v);
    EXPECT_LT(distance_of(random, s, reversed(s, Direction::u),
                          [&](Point2 p) {
                            return Point2{u.lo + u.hi - p.x, p.y};
                          }),
              kExact);
    EXPECT_LT(distance_of(random, s, reversed(s, Direction::v),
                          [&](Point2 p) {
                            return Point2{p.x, v.lo + v.hi - p.y};
                          }),
              kExact);
    EXPECT_LT(distance_of(random, s, swapped(s), [](Point2 p) { return Point2{p.y, p.x}; }), kExact);
    EXPECT_EQ(swapped(swapped(s)), s);
    const Interval to{-7, 0.25};
    EXPECT_LT(distance_of(random, s, with_domain(s, Direction::v, to),
                          [&](Point2 p) {
                            return Point2{p.x, to.lo + (p.y - v.lo) / v.length() * to.length()};
                          }),
              kExact);
    EXPECT_LT(distance_of(random, s, with_weights_scaled(s, 37.5)), kExact);
    const Vec3 by{10, -20, 30};
    const NurbsSurface moved = translated(s, by);
    EXPECT_LT(distance(by_definition(moved, u.lo, v.hi), by_definition(s, u.lo, v.hi) + by), kExact);
  }
}

TEST(Modify, BendingIsAProjectiveReparametrisation) {
  Random random(6);
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random);
    for (const Direction d : kDirections) {
      const double alpha = std::exp(uniform(random, -1.5, 1.5));
      detail::Rows rows = detail::rows_of(s, d);
      detail::bend(rows, alpha);
      const NurbsSurface t = detail::surface_of(rows, d, s);
      ASSERT_TRUE(validate(t));
      const Interval domain = s.domain(d);
      EXPECT_LT(distance_of(random, t, s,
                            [&](Point2 p) {
                              double& x = d == Direction::u ? p.x : p.y;
                              const double f = (x - domain.lo) / domain.length();
                              x = std::min(domain.hi, at_fraction(domain, alpha * f / (1 + (alpha - 1) * f)));
                              return p;
                            }),
                kExact);
    }
  }
}

TEST(Modify, RemovalUndoesInsertion) {
  Random random(7);
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random);
    for (const Direction d : kDirections) {
      const int times = integer(random, 1, s.degree(d));
      const double at = at_fraction(s.domain(d), uniform(random, 0.1, 0.9));
      const NurbsSurface more = insert_knots(s, d, std::vector<double>(static_cast<std::size_t>(times), at));
      const KnotRemoval back = remove_knot(more, d, at, times + 3, 1e-6);
      EXPECT_EQ(back.removed, times);
      EXPECT_LT(back.deviation_mm, 1e-8);
      ASSERT_TRUE(validate(back.surface));
      EXPECT_LT(distance_of(random, s, back.surface), 1e-8);
    }
  }
}

TEST(Modify, RemovalStaysWithinItsBound) {
  Random random(8);
  int removed = 0, refused = 0;
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random);
    for (const Direction d : kDirections) {
      const double at = at_fraction(s.domain(d), uniform(random, 0.1, 0.9));
      NurbsSurface rough = insert_knots(s, d, std::vector<double>{at});
      const double noise = uniform(random, 0.01, 0.1);
      for (HPoint& h : rough.points)
        h = h + HPoint{0, 0, uniform(random, -noise, noise), uniform(random, 0, 1e-4)};
      const double tolerance = uniform(random, 0.01, 1);
      const KnotRemoval r = remove_knot(rough, d, at, 1, tolerance);
      EXPECT_LE(r.deviation_mm, tolerance);
      ASSERT_TRUE(validate(r.surface));
      EXPECT_LE(distance_of(random, rough, r.surface), r.deviation_mm + kExact);
      ++(r.removed > 0 ? removed : refused);
    }
  }
  EXPECT_GT(removed, 10);
  EXPECT_GT(refused, 10);
}

TEST(Modify, IsoCurvesAndBezierPieces) {
  Random random(9);
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random);
    const double u = at_fraction(s.domain(Direction::u), uniform(random, 0, 1));
    const double v = at_fraction(s.domain(Direction::v), uniform(random, 0, 1));
    EXPECT_LT(distance(point(iso_curve(s, Direction::u, v), u), by_definition(s, u, v)), kExact);
    EXPECT_LT(distance(point(iso_curve(s, Direction::v, u), v), by_definition(s, u, v)), kExact);
    double area = 0;
    for (const BezierPatch& piece : bezier_patches(s)) {
      ASSERT_TRUE(validate(piece.surface));
      EXPECT_EQ(piece.surface.count_u, s.degree_u + 1);
      EXPECT_EQ(piece.surface.domain(Direction::u), piece.u);
      EXPECT_EQ(piece.surface.domain(Direction::v), piece.v);
      EXPECT_LT(distance_of(random, piece.surface, s), kExact);
      area += piece.u.length() * piece.v.length();
    }
    EXPECT_NEAR(area, s.domain(Direction::u).length() * s.domain(Direction::v).length(), 1e-12);
  }
}

TEST(Modify, Curves) {
  Random random(10);
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random);
    const NurbsCurve c = iso_curve(s, Direction::u, s.domain(Direction::v).lo);
    const Interval d = c.domain(), half{at_fraction(d, 0.25), at_fraction(d, 0.75)};
    const NurbsCurve part = sub_curve(c, half), back = reversed(c), moved = with_domain(c, {0, 1});
    const auto higher = elevate_degree(c, 2);
    const std::vector<double> values{half.lo, half.lo};
    const NurbsCurve more = insert_knots(c, values);
    ASSERT_TRUE(higher && validate(*higher) && validate(part) && validate(back) && validate(moved) &&
                validate(more));
    for (double f = 0.25; f <= 0.75; f += 0.125) {
      const double t = at_fraction(d, f);
      const Point3 p = point(c, t);
      EXPECT_LT(distance(point(part, t), p), kExact);
      EXPECT_LT(distance(point(back, d.lo + d.hi - t), p), kExact);
      EXPECT_LT(distance(point(moved, f), p), kExact);
      EXPECT_LT(distance(point(*higher, t), p), kExact);
      EXPECT_LT(distance(point(more, t), p), kExact);
      const HPoint h = detail::homogeneous_point(c, t);
      EXPECT_LT(distance(project(h), p), kExact);
    }
  }
}

}  // namespace
}  // namespace burin::geom
