// SPDX-License-Identifier: Apache-2.0
// What a line sweep says against the tool at many moments of the true motion.
#include "burin/removal/line_sweep.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "burin/geom/point_tools.h"

namespace burin::removal {
namespace {

using geom::Point3;
using geom::Vec3;

struct Case {
  verify::MillBody body;
  verify::Stretch stretch;
  std::size_t along = 0;
};

class Cases {
 public:
  explicit Cases(unsigned seed) : random_(seed) {}

  double in(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random_); }
  bool one_in(int n) { return std::uniform_int_distribution<int>(1, n)(random_) == 1; }
  Vec3 direction() {
    if (one_in(4)) {  // along a coordinate axis: what 3 axes do
      const int i = std::uniform_int_distribution<int>(0, 2)(random_);
      return {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
    }
    return unit(Vec3{in(-1, 1), in(-1, 1), in(-1, 1)});
  }
  Case next(double turn) {
    Case c;
    const double r = in(1, 4);
    const int end = std::uniform_int_distribution<int>(0, 2)(random_);
    c.body = {r, one_in(2) ? 0 : in(0, 3), in(5, 12), end == 0 ? 0 : end == 1 ? r : in(0.05, 0.95) * r};
    c.body.high += c.body.low;
    const Vec3 axis = direction();
    Vec3 way = in(0, 3) * direction();
    if (one_in(8)) way = in(-15, 15) * axis;
    if (one_in(8)) way = {};
    const Point3 tip{in(-2, 2), in(-2, 2), in(-2, 2)};
    const Vec3 other = unit(axis + turn * direction());
    c.stretch = verify::Stretch::between({tip, axis}, {tip + way, other});
    c.along = std::uniform_int_distribution<std::size_t>(0, 2)(random_);
    return c;
  }

 private:
  std::mt19937 random_;
};

Point3 on_line(std::size_t along, double u, double v, double h) {
  Point3 p;
  geom::set_component(p, along, h);
  geom::set_component(p, (along + 1) % 3, u);
  geom::set_component(p, (along + 2) % 3, v);
  return p;
}

/// The most that the place is inside the tool at any of many moments.
double deepest(const Case& c, Point3 p) {
  double best = -1e9;
  constexpr int kMoments = 300;
  for (int i = 0; i <= kMoments; ++i) {
    const verify::Placed at = c.stretch.at(i / double(kMoments));
    best = std::max(best, verify::body_at(c.body, at.tip, at.axis, p).f);
  }
  return best;
}

/// Lines that hit and lines that miss, against the tool at many moments: what is deeper inside than `slack`
/// must be covered, both ends must lie on the surface to within `slack`.
void compare(unsigned seed, double turn, double tolerance, double slack, int count) {
  Cases cases(seed);
  int hits = 0;
  for (int n = 0; n < count; ++n) {
    const Case c = cases.next(turn);
    const double span = std::hypot(c.body.radius, c.body.high);
    const int parts = Motion::parts(c.stretch, span, tolerance);
    const Point3 near = c.stretch.at(cases.in(0, 1)).tip + cases.in(0, 12) * c.stretch.middle.axis;
    const double u = geom::component(near, (c.along + 1) % 3) + cases.in(-4, 4),
                 v = geom::component(near, (c.along + 2) % 3) + cases.in(-4, 4);
    std::vector<Covered> covered;
    for (int k = 0; k < parts; ++k) {
      LineSweep sweep(c.body, Motion::part(c.stretch, k / double(parts), (k + 1) / double(parts)), c.along,
                      tolerance, span);
      const Covered found = sweep.line(u, v);
      if (found.empty()) continue;
      const LineSweep::Bounds outer = sweep.around(u, v);
      ASSERT_TRUE(outer.a <= found.a && found.b <= outer.b)
          << "case " << n << ": " << outer.a << " " << outer.b << ", " << found.a << " " << found.b;
      covered.push_back(found);
      ++hits;
      for (const double h : {found.a, found.b}) {
        ASSERT_GE(deepest(c, on_line(c.along, u, v, h)), -slack)
            << "case " << n << " h " << h << " of " << found.a << " " << found.b;
      }
      for (const Vec3 normal : {sweep.normal_a(found), sweep.normal_b(found)})
        ASSERT_NEAR(norm(normal), 1, 1e-9);
      ASSERT_LE(geom::component(sweep.normal_a(found), c.along), 0.05) << "case " << n;
      ASSERT_GE(geom::component(sweep.normal_b(found), c.along), -0.05) << "case " << n;
    }
    for (double h = -20; h < 20; h += 0.1) {
      bool in = false;
      for (const Covered& f : covered) in = in || (f.a <= h && h <= f.b);
      if (!in) {
        ASSERT_LE(deepest(c, on_line(c.along, u, v, h)), slack) << "case " << n << " h " << h;
      }
    }
  }
  EXPECT_GT(hits, count / 4);
}

TEST(LineSweep, ConstantAxisIsTheEnvelope) {
  // Moments of up to 15 mm of way are 0.04 mm apart.
  compare(1, 0, 0.002, 0.02, 400);
}
TEST(LineSweep, TurningAxisStaysWithinTheTolerance) {
  for (const double turn : {0.002, 0.02, 0.1, 0.5}) compare(2, turn, 0.01, 0.03, 60);
}

}  // namespace
}  // namespace burin::removal
