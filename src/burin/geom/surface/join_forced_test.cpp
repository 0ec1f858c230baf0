// SPDX-License-Identifier: Apache-2.0
// Forced partial joins: Koo & Jee 2007, eq. 15 to 26, and what they cost.
#include "burin/geom/surface/join_forced.h"

#include "burin/geom/surface/closest.h"
#include "burin/geom/surface/join_test_support.h"

namespace burin::geom {
namespace {

using namespace test;

#ifdef NDEBUG
constexpr int kCases = 8;
#else
constexpr int kCases = 1;
#endif

/// A base of 4 x 12 control points, and a partial patch to its right whose edge has the control points of
/// rows first .. last (and 2.5 times the weights).
struct Fixture {
  NurbsSurface base, partial;
};
Fixture fixture(Random& random, int first, int last, double height) {
  Fixture f;
  f.base = {3, 3, 4, 12, clamped_uniform_knots(4, 3), clamped_uniform_knots(12, 3), {}};
  for (int j = 0; j < 12; ++j) {
    for (int i = 0; i < 4; ++i) {
      const Point3 p{10.0 * i, 10.0 * j, uniform(random, -height, height)};
      f.base.points.push_back(homogeneous(p, uniform(random, 0.9, 1.1)));
    }
  }
  const int rows = last - first + 1;
  f.partial = {3, 3, 4, rows, clamped_uniform_knots(4, 3), clamped_uniform_knots(rows, 3), {}};
  for (int j = 0; j < rows; ++j) {
    f.partial.points.push_back(2.5 * f.base.at(3, first + j));
    for (int i = 1; i < 4; ++i) {
      const Point3 p{30 + 10.0 * i, 10.0 * (first + j), uniform(random, -height, height)};
      f.partial.points.push_back(homogeneous(p, 1));
    }
  }
  return f;
}

/// Largest distance of points of any of `from` to the nearest of `to` (proven closest points): a raster with
/// the edges, then random steps uphill that become shorter.
double far_off(Random& random, const std::vector<NurbsSurface>& from, const std::vector<NurbsSurface>& to) {
  std::vector<ClosestPointFinder> finders;
  for (const NurbsSurface& s : to) finders.emplace_back(s);
  double most = 0;
  for (const NurbsSurface& s : from) {
    double here = 0, best_u = 0, best_v = 0;
    constexpr int kColumns = 7, kRows = 60, kUphill = 150;
    for (int k = 0; k < kColumns * kRows + kUphill; ++k) {
      double fu = k % kColumns / (kColumns - 1.0), fv = k / kColumns / (kRows - 1.0);
      if (const int climbed = k - kColumns * kRows; climbed >= 0) {
        const double step = 0.1 * std::exp2(-climbed / 20.0);
        fu = std::clamp(best_u + uniform(random, -step, step), 0.0, 1.0);
        fv = std::clamp(best_v + uniform(random, -step, step), 0.0, 1.0);
      }
      const Point3 p =
          point(s, at_fraction(s.domain(Direction::u), fu), at_fraction(s.domain(Direction::v), fv));
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& finder : finders) nearest = std::min(nearest, finder.find(p, 1e-7).distance);
      if (nearest <= here) continue;
      here = nearest;
      best_u = fu;
      best_v = fv;
    }
    most = std::max(most, here);
  }
  return most;
}

const JoinedSurface* surface_with(const Composite& c, std::size_t members, std::size_t patch) {
  for (const JoinedSurface& s : c.surfaces)
    for (const Member& m : s.members)
      if (s.members.size() == members && m.patch == patch) return &s;
  return nullptr;
}

TEST(ForcedJoin, PartsAreThoseOfThePaper) {
  Random random(1);
  const Fixture f = fixture(random, 4, 7, 5);
  const auto base = detail::source_of(f.base, 0, 1e-4);
  const auto parts = detail::forced_parts(base, 1, {4, 7, false}, f.partial.knots_v, 1e-4);
  ASSERT_EQ(parts.size(), 3u);
  const NurbsSurface &lower = parts[0].surface, &middle = parts[1].surface, &upper = parts[2].surface;
  const auto& v = f.base.knots_v;
  EXPECT_EQ(lower.knots_v, (std::vector<double>{v[0], v[1], v[2], v[3], v[4], v[5], v[5], v[5], v[5]}));
  EXPECT_EQ(middle.knots_v, f.partial.knots_v);
  EXPECT_EQ(upper.knots_v,
            (std::vector<double>{v[10], v[10], v[10], v[10], v[11], v[12], v[13], v[14], v[15]}));
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j <= 4; ++j) EXPECT_EQ(lower.at(i, j), f.base.at(i, j));
    for (int j = 4; j <= 7; ++j) EXPECT_EQ(middle.at(i, j - 4), f.base.at(i, j));
    for (int j = 7; j <= 11; ++j) EXPECT_EQ(upper.at(i, j - 7), f.base.at(i, j));
  }
}

TEST(ForcedJoin, ThreeSurfacesAndATrueDeviation) {
  Random random(2);
  for (int k = 0; k < kCases; ++k) {
    const Fixture f = fixture(random, 4, 7, uniform(random, 1, 5));
    std::vector<NurbsSurface> patches{f.base, turned(f.partial, integer(random, 0, 7))};
    if (k % 2 == 1) std::swap(patches[0], patches[1]);
    const std::size_t base = k % 2 == 1 ? 1 : 0;
    for (const Grouping rule :
         {Grouping::largest, Grouping::first_block, Grouping::u_first, Grouping::v_first}) {
      const Composite c = joined(patches, {1e-4, 100, rule});
      check(c);
      ASSERT_EQ(c.surfaces.size(), 3u);
      ASSERT_NE(surface_with(c, 2, base), nullptr);
      ASSERT_NE(surface_with(c, 1, base), nullptr);
      if (rule != Grouping::largest) continue;
      // Independently: the proven closest points of random places, base to parts and parts to base.
      const auto parts =
          detail::forced_parts(detail::source_of(f.base, 0, 1e-4), 1, {4, 7, false}, f.partial.knots_v, 1e-4);
      std::vector<NurbsSurface> strips;
      for (const auto& part : parts) strips.push_back(part.surface);
      const double there = far_off(random, {f.base}, strips), back = far_off(random, strips, {f.base});
      const double seen = std::max(there, back);
      EXPECT_GT(seen, 0.01);
      EXPECT_GE(c.report.deviation_max_mm, 0.999 * seen);
      EXPECT_LE(c.report.deviation_max_mm, 1.05 * seen);
    }
  }
}

TEST(ForcedJoin, RefusedWithTheFigure) {
  Random random(3);
  const Fixture f = fixture(random, 4, 7, 5);
  const std::vector<NurbsSurface> patches{f.base, f.partial};
  const Composite allowed = joined(patches, {1e-4, 100, Grouping::largest});
  Diagnostics diagnostics;
  const auto refused = join(patches, {}, diagnostics);
  ASSERT_TRUE(refused);
  check(*refused);
  ASSERT_EQ(refused->surfaces.size(), 2u);
  EXPECT_EQ(refused->surfaces[0].surface.points, f.base.points);
  EXPECT_EQ(diagnostics.count("join_refused"), 1u);
  EXPECT_TRUE(diagnostics.anything_left_out());
  ASSERT_EQ(refused->report.unjoined.size(), 1u);
  EXPECT_NEAR(refused->report.unjoined[0].deviation_mm, allowed.report.deviation_max_mm, 1e-9);
}

TEST(ForcedJoin, AtTheEndOfTheBaseAndWithFewRowsLeft) {
  Random random(4);
  for (const auto& [first, last] : {std::pair{0, 5}, std::pair{5, 11}, std::pair{1, 9}, std::pair{2, 10}}) {
    const Fixture f = fixture(random, first, last, 1);
    const std::vector<NurbsSurface> patches{f.partial, f.base};
    const Composite c = joined(patches, {1e-4, 100, Grouping::largest});
    check(c);
    EXPECT_EQ(c.surfaces.size(), 1u + (first > 0 ? 1 : 0) + (last < 11 ? 1 : 0));
  }
}

/// Flat: the edge curves coincide although their parameters do not. Nothing bends, nothing is refused.
TEST(ForcedJoin, StraightEdgesNeedNoForce) {
  Random random(5);
  const Fixture f = fixture(random, 4, 7, 0);
  Diagnostics diagnostics;
  const auto c = join({f.base, f.partial}, {}, diagnostics);
  ASSERT_TRUE(c);
  check(*c);
  EXPECT_EQ(c->surfaces.size(), 3u);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_LT(c->report.deviation_max_mm, 1e-6);
}

}  // namespace
}  // namespace burin::geom
