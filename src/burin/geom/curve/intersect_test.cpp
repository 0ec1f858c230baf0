// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/intersect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace burin::geom {
namespace {

Segment random_segment(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-5, 5), bulge(-2, 2);
  const Point2 a{place(random), place(random)}, b{place(random), place(random)};
  return random() % 2 ? make_line(a, b) : from_bulge(a, b, bulge(random));
}

/// Sign changes of the distance to t's carrier along s, taken where t is hit: counts transversal crossings.
int count_by_sampling(const Segment& s, const Segment& t) {
  const auto side = [&](Point2 p) {
    return t.is_line() ? cross(t.b - t.a, p - t.a) : distance(p, t.center) - std::abs(t.radius);
  };
  int count = 0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const Point2 p = point_on(s, i / double(kSteps)), q = point_on(s, (i + 1) / double(kSteps));
    if ((side(p) > 0) == (side(q) > 0)) continue;
    const Point2 m = lerp(p, q, 0.5);
    if (nearest_on(t, m).distance < 1e-3) ++count;
  }
  return count;
}

TEST(Intersect, AgreesWithSampling) {
  std::mt19937_64 random(21);
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const Segment s = random_segment(random), t = random_segment(random);
    const Intersection found = intersect(s, t, 1e-9);
    int count = 0;
    if (const auto* points = std::get_if<PointIntersections>(&found)) {
      count = points->count;
      for (int k = 0; k < count; ++k) {
        EXPECT_LT(nearest_on(s, points->point[static_cast<std::size_t>(k)]).distance, 1e-8);
        EXPECT_LT(nearest_on(t, points->point[static_cast<std::size_t>(k)]).distance, 1e-8);
      }
    }
    // Ends that come near the other segment make the sampled count unsure.
    double near = 1;
    for (const Point2 p : {s.a, s.b}) near = std::min(near, nearest_on(t, p).distance);
    for (const Point2 p : {t.a, t.b}) near = std::min(near, nearest_on(s, p).distance);
    if (near < 5e-3) continue;
    EXPECT_EQ(count, count_by_sampling(s, t));
    met += count > 0;
  }
  EXPECT_GT(met, 300);
}

TEST(Intersect, TouchesAndOverlaps) {
  const Segment line = make_line({0, 0}, {10, 0});
  EXPECT_TRUE(std::holds_alternative<Overlap>(intersect(line, make_line({4, 0}, {20, 0}), 1e-7)));
  EXPECT_TRUE(std::holds_alternative<Overlap>(intersect(line, make_line({6, 5e-8}, {2, 5e-8}), 1e-7)));
  EXPECT_TRUE(std::holds_alternative<NoIntersection>(intersect(line, make_line({6, 5e-6}, {2, 5e-6}), 1e-7)));
  const Intersection corner = intersect(line, make_line({10, 0}, {10, 5}), 1e-7);
  ASSERT_TRUE(std::holds_alternative<PointIntersections>(corner));
  EXPECT_EQ(std::get<PointIntersections>(corner).count, 1);
  const Intersection tangent = intersect(line, make_arc({3, 2}, {7, 2}, {5, 2}, true), 1e-7);
  ASSERT_TRUE(std::holds_alternative<PointIntersections>(tangent));
  EXPECT_EQ(std::get<PointIntersections>(tangent).count, 1);
  EXPECT_TRUE(
      std::holds_alternative<NoIntersection>(intersect(line, make_arc({7, 2}, {3, 2}, {5, 2}, true), 1e-7)));
  // Two arcs of one circle that share both ends' surroundings: two stretches.
  const Segment wide = make_arc({1, 0}, {0, -1}, {0, 0}, true),
                other = make_arc({-1, 0}, {0, 1}, {0, 0}, true);
  const Intersection twice = intersect(wide, other, 1e-7);
  ASSERT_TRUE(std::holds_alternative<Overlap>(twice));
  EXPECT_TRUE(std::get<Overlap>(twice).twice);
}

}  // namespace
}  // namespace burin::geom
