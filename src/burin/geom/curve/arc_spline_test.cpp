// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/arc_spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace burin::geom {
namespace {

ArcSpline circle(Point2 c, double r, bool ccw = true) {
  const Point2 e{c.x + r, c.y}, w{c.x - r, c.y};
  return {{make_arc(e, w, c, ccw), make_arc(w, e, c, ccw)}, true};
}

Segment random_arc(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-10, 10), angle(-6.2, 6.2), radius(0.01, 20);
  const Point2 c{place(random), place(random)};
  const double r = radius(random), u = angle(random);
  double sweep = angle(random);
  if (std::abs(sweep) < 1e-3) sweep = 1;
  const Point2 a = c + r * Vec2{std::cos(u), std::sin(u)};
  const Point2 b = c + r * Vec2{std::cos(u + sweep), std::sin(u + sweep)};
  return make_arc(a, b, c, sweep > 0);
}

TEST(Segment, BulgeRoundTripKeepsTheArc) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 5000; ++i) {
    const Segment s = random_arc(random);
    if (std::abs(std::abs(sweep_of(s)) - 2 * kPi) < 1e-2)
      continue;  // the chord of a nearly full turn says little
    const Segment t = from_bulge(s.a, s.b, bulge_of(s));
    EXPECT_NEAR(t.radius, s.radius, 1e-7 * std::abs(s.radius));
    EXPECT_LT(distance(t.center, s.center), 1e-7 * (1 + std::abs(s.radius)));
  }
}

TEST(Segment, LengthBoundsTangentsAndNearestAgreeWithSampling) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-30, 30);
  for (int i = 0; i < 300; ++i) {
    const Segment s = random_arc(random);
    const Point2 p{place(random), place(random)};
    const Box2 box = bounds_of(s);
    double length = 0, nearest = 1e9;
    Box2 sampled;
    constexpr int kSteps = 2000;
    for (int k = 0; k <= kSteps; ++k) {
      const Point2 q = point_on(s, k / double(kSteps));
      if (k > 0) length += distance(q, point_on(s, (k - 1) / double(kSteps)));
      nearest = std::min(nearest, distance(p, q));
      sampled.add(q);
      EXPECT_TRUE(box.grown(1e-9).contains(q));
    }
    EXPECT_NEAR(length, length_of(s), 1e-4 * length_of(s));
    EXPECT_NEAR(nearest, nearest_on(s, p).distance, 2e-3 * (1 + length_of(s)));
    EXPECT_NEAR(sampled.width(), box.width(), 1e-4 * (1 + length_of(s)));
    EXPECT_NEAR(sampled.height(), box.height(), 1e-4 * (1 + length_of(s)));
    const Vec2 t0 = unit(point_on(s, 1e-6) - s.a), t1 = unit(s.b - point_on(s, 1 - 1e-6));
    EXPECT_GT(dot(t0, start_tangent(s)), 1 - 1e-5);
    EXPECT_GT(dot(t1, end_tangent(s)), 1 - 1e-5);
    const Segment back = reversed(s);
    EXPECT_NEAR(sweep_of(back), -sweep_of(s), 1e-12);
  }
}

TEST(ArcSpline, AreaAndWindingOfACircle) {
  EXPECT_NEAR(signed_area(circle({5, 7}, 3)), kPi * 9, 1e-12);
  EXPECT_NEAR(signed_area(circle({5, 7}, 3, false)), -kPi * 9, 1e-12);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> place(-5, 5);
  for (int i = 0; i < 10000; ++i) {
    const Point2 p{place(random), place(random)};
    const double d = distance(p, {0, 0});
    if (std::abs(d - 3) < 1e-9) continue;
    EXPECT_EQ(winding_number(circle({0, 0}, 3), p), d < 3 ? 1 : 0);
    EXPECT_EQ(winding_number(circle({0, 0}, 3, false), p), d < 3 ? -1 : 0);
  }
  // Points on the chord between the two half circles count as inside as well.
  EXPECT_EQ(winding_number(circle({0, 0}, 3), {1, 0}), 1);
  EXPECT_EQ(winding_number(circle({0, 0}, 3, false), {1, 0}), -1);
  EXPECT_EQ(winding_number(circle({0, 0}, 3), {0, 0}), 1);
}

TEST(ArcSpline, WindingAgreesWithTheAngleSwept) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-5, 5), bulge(-1.5, 1.5);
  for (int i = 0; i < 400; ++i) {
    ArcSpline s;
    s.closed = true;
    std::vector<Point2> v(5);
    for (Point2& p : v) p = {place(random), place(random)};
    for (std::size_t k = 0; k < v.size(); ++k)
      s.segments.push_back(from_bulge(v[k], v[(k + 1) % v.size()], bulge(random)));
    const Point2 p{place(random), place(random)};
    double angle = 0;
    for (const Segment& seg : s.segments) {
      Vec2 before = seg.a - p;
      for (int k = 1; k <= 2000; ++k) {
        const Vec2 now = point_on(seg, k / 2000.0) - p;
        angle += std::atan2(cross(before, now), dot(before, now));
        before = now;
      }
    }
    if (distance_to(s, p) < 0.02) continue;  // the sampled angle is unsure there
    EXPECT_EQ(winding_number(s, p), std::lround(angle / (2 * kPi)));
  }
}

TEST(ArcSpline, CountsG1Breaks) {
  EXPECT_EQ(count_g1_breaks(circle({0, 0}, 3), 1e-6), 0);
  ArcSpline square{{make_line({0, 0}, {1, 0}), make_line({1, 0}, {1, 1}), make_line({1, 1}, {0, 1}),
                    make_line({0, 1}, {0, 0})},
                   true};
  EXPECT_EQ(count_g1_breaks(square, 1e-3), 4);
  EXPECT_NEAR(length_of(reversed(square)), 4, 1e-15);
  EXPECT_NEAR(signed_area(reversed(square)), -1, 1e-15);
}

}  // namespace
}  // namespace burin::geom
