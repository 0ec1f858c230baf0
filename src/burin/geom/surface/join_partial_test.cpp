// SPDX-License-Identifier: Apache-2.0
// Contacts that are not whole sides, and the inputs that are meant to break things.
#include "burin/geom/surface/closest.h"
#include "burin/geom/surface/join.h"
#include "burin/geom/surface/join_test_support.h"

namespace burin::geom {
namespace {

using namespace test;

#ifdef NDEBUG
constexpr int kCases = 60;
#else
constexpr int kCases = 8;
#endif

/// Left half of a surface whole, of the right half only what lies between two lines.
TEST(PartialJoin, PartOfASideSplitsTheBase) {
  Random random(11);
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random);
    const auto halves = cut_into(random, s, 2, 1);
    const Interval v = s.domain(Direction::v);
    const bool low = integer(random, 0, 1) == 1, high = !low || integer(random, 0, 1) == 1;
    const Interval part{low ? at_fraction(v, uniform(random, 0.1, 0.4)) : v.lo,
                        high ? at_fraction(v, uniform(random, 0.6, 0.9)) : v.hi};
    std::vector<NurbsSurface> patches{
        disguised(random, halves[0]),
        disguised(random, sub_surface(halves[1], halves[1].domain(Direction::u), part))};
    shuffle(random, patches);
    for (const Composite& c : by_every_rule(patches)) {
      ASSERT_EQ(c.surfaces.size(), 1u + (low ? 1 : 0) + (high ? 1 : 0)) << "case " << k;
      EXPECT_LT(difference(patches, c, random, 12), kExact * 100) << "case " << k;
      EXPECT_LT(c.report.deviation_max_mm, kExact * 100);
      EXPECT_TRUE(c.report.unjoined.empty());
    }
  }
}

/// One patch on the left, n on the right: T-junctions. The base is cut, then everything is one grid.
TEST(PartialJoin, JunctionsBecomeAGrid) {
  Random random(12);
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random);
    const auto halves = cut_into(random, s, 2, 1);
    std::vector<NurbsSurface> patches{disguised(random, halves[0])};
    for (const auto& part : cut_into(random, halves[1], 1, integer(random, 2, 4)))
      patches.push_back(disguised(random, part));
    shuffle(random, patches);
    for (const Composite& c : by_every_rule(patches)) {
      ASSERT_EQ(c.surfaces.size(), 1u) << "case " << k;
      EXPECT_LT(difference(patches, c, random, 12), kExact * 100) << "case " << k;
    }
  }
}

TEST(PartialJoin, ShiftedBricks) {
  const std::vector<NurbsSurface> patches{rectangle(0, 0, 10, 5), rectangle(4, 5, 14, 9)};
  for (const Composite& c : by_every_rule(patches)) {
    ASSERT_EQ(c.surfaces.size(), 3u);
    Random random(1);
    EXPECT_LT(difference(patches, c, random), 1e-12);
  }
}

/// Four rectangles round a fifth, each longer than its side: cuts run from one to the next and end at the
/// rim.
TEST(PartialJoin, Pinwheel) {
  const std::vector<NurbsSurface> patches{rectangle(1, 1, 2, 2), rectangle(0, 0, 2, 1), rectangle(2, 0, 3, 2),
                                          rectangle(1, 2, 3, 3), rectangle(0, 1, 1, 3)};
  for (const Composite& c : by_every_rule(patches)) {
    Random random(1);
    EXPECT_LT(difference(patches, c, random), 1e-12);
    EXPECT_EQ(c.surfaces.size(), 1u);
  }
}

/// Arcs of the same circle in standard form: the parameters of a part differ projectively.
TEST(PartialJoin, ArcsOfOneCircle) {
  Random random(13);
  for (int k = 0; k < kCases; ++k) {
    const double a = uniform(random, 0, 6), from = uniform(random, 0.1, 0.6), to = uniform(random, 0.9, 1.4);
    std::vector<NurbsSurface> patches{
        with_weights_scaled(turned(cylinder(25, a, kPi / 2, 0, 10), integer(random, 0, 7)), 3),
        turned(cylinder(25, a + from, to - from, 10, 15), integer(random, 0, 7))};
    shuffle(random, patches);
    for (const Composite& c : by_every_rule(patches)) {
      ASSERT_EQ(c.surfaces.size(), 3u);
      EXPECT_LT(difference(patches, c, random, 12), kExact * 50);
      EXPECT_LT(c.report.gap_max_mm, kExact * 50);
    }
  }
}

TEST(PartialJoin, ProjectiveParametersInTheSharedDirection) {
  Random random(14);
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random);
    std::vector<NurbsSurface> patches;
    for (const NurbsSurface& part : cut_into(random, s, 2, 2)) {
      NurbsSurface bent = part;
      for (const Direction d : {Direction::u, Direction::v}) {
        detail::Rows rows = detail::rows_of(bent, d);
        detail::bend(rows, std::exp(uniform(random, -1, 1)));
        bent = detail::surface_of(rows, d, bent);
      }
      patches.push_back(turned(with_weights_scaled(bent, uniform(random, 0.1, 10)), integer(random, 0, 7)));
    }
    shuffle(random, patches);
    for (const Composite& c : by_every_rule(patches)) {
      ASSERT_EQ(c.surfaces.size(), 1u) << "case " << k;
      EXPECT_LT(difference(patches, c, random, 12), kExact * 100) << "case " << k;
    }
  }
}

TEST(PartialJoin, RingsWithOtherSeams) {
  // Two floors of the same cylinder, cut at other angles.
  std::vector<NurbsSurface> patches;
  for (int q = 0; q < 4; ++q) patches.push_back(cylinder(20, q * kPi / 2, kPi / 2, 0, 10));
  for (int q = 0; q < 3; ++q) patches.push_back(cylinder(20, 0.5 + q * 2 * kPi / 3, 2 * kPi / 3, 10, 20));
  for (const Composite& c : by_every_rule(patches)) {
    EXPECT_EQ(c.surfaces.size(), 1u);
    Random random(1);
    EXPECT_LT(difference(patches, c, random), kExact * 50);
  }
}

// ---- gaps ----

TEST(JoinGaps, JustBelowAndJustAboveTheTolerance) {
  for (const double gap : {0.0, 0.5e-4, 0.99e-4, 1.01e-4, 1e-3}) {
    const std::vector<NurbsSurface> patches{rectangle(0, 0, 10, 10), rectangle(10, 0, 20, 10, gap)};
    const Composite c = joined(patches);
    check(c);
    if (gap > 1e-4) {
      EXPECT_EQ(c.surfaces.size(), 2u) << gap;
      EXPECT_EQ(c.report.gap_max_mm, 0);
      continue;
    }
    ASSERT_EQ(c.surfaces.size(), 1u) << gap;
    EXPECT_NEAR(c.report.gap_max_mm, gap, 1e-12);
    EXPECT_NEAR(c.surfaces[0].joints[0].gap_mm, gap, 1e-12);
    EXPECT_NEAR(c.surfaces[0].deviation_mm, gap, 1e-9);
    // The first patch keeps its edge.
    Random random(1);
    EXPECT_LT(difference({patches[0]}, c, random), 1e-12);
    EXPECT_LE(difference(patches, c, random), gap + 1e-12);
  }
}

TEST(JoinGaps, NoiseWithinTheTolerance) {
  Random random(15);
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random, 3, 3);
    std::vector<NurbsSurface> patches;
    for (NurbsSurface part : cut_into(random, s, 3, 2)) {
      const auto noise = [&] { return uniform(random, -2e-5, 2e-5); };
      for (HPoint& h : part.points) h = h + h.w * HPoint{noise(), noise(), noise(), 0};
      patches.push_back(turned(part, integer(random, 0, 7)));
    }
    const Composite c = joined(patches);
    check(c);
    ASSERT_EQ(c.surfaces.size(), 1u) << "case " << k;
    const double off = difference(patches, c, random, 12);
    EXPECT_LT(off, 1.5e-4);
    EXPECT_GT(c.report.gap_max_mm, 1e-6);
  }
}

TEST(JoinGaps, KnotsThatOnlyNearlyMatchBecomeOne) {
  Random random(16);
  NurbsSurface s = random_surface(random, 3, 0);
  s = insert_knots(*elevate_degree(s, Direction::v, 1), Direction::v,
                   std::vector<double>{at_fraction(s.domain(Direction::v), 1 / 3.0)});
  auto parts = cut_into(random, s, 2, 1);
  auto knot = std::find_if(parts[1].knots_v.begin(), parts[1].knots_v.end(),
                           [&](double t) { return t > parts[1].knots_v.front(); });
  *knot += 2e-8 * parts[1].domain(Direction::v).length();
  const Composite c = joined(parts);
  ASSERT_EQ(c.surfaces.size(), 1u);
  EXPECT_EQ(c.surfaces[0].surface.count_v, s.count_v);
  EXPECT_LT(difference(parts, c, random), 1e-4);
}

/// A knot of the second patch just before another of its own that the first patch has too: moving the first
/// of them onto the second would make a knot that is there more often than the degree.
TEST(JoinGaps, KnotsThatMoveDoNotFallOnOthers) {
  constexpr double kNear = 5e-7;
  const auto with_knots = [](const NurbsSurface& s, const std::vector<double>& at) {
    return insert_knots(*elevate_degree(with_domain(s, Direction::u, {0, 1}), Direction::u, 2), Direction::u,
                        at);
  };
  const std::vector<NurbsSurface> patches{
      with_knots(rectangle(0, 0, 10, 5), {0.5 + kNear}),
      with_knots(rectangle(0, 5, 10, 9), {0.5, 0.5, 0.5, 0.5 + kNear}),
  };
  Random random(29);
  const Composite c = joined(patches);
  check(c);
  ASSERT_EQ(c.surfaces.size(), 1u);
  EXPECT_LT(difference(patches, c, random), 1e-4);
}

// ---- what is meant to break things ----

TEST(JoinAdversarial, CornersOnly) {
  const std::vector<NurbsSurface> patches{rectangle(0, 0, 1, 1), rectangle(1, 1, 2, 2),
                                          rectangle(2, 0, 3, 1)};
  const Composite c = joined(patches);
  check(c);
  EXPECT_EQ(c.surfaces.size(), 3u);
  EXPECT_TRUE(c.report.unjoined.empty());
}

TEST(JoinAdversarial, DuplicatesStayApart) {
  const NurbsSurface r = rectangle(0, 0, 1, 1);
  const std::vector<NurbsSurface> patches{r, turned(r, 5), rectangle(1, 0, 2, 1)};
  for (const Composite& c : by_every_rule(patches)) {
    EXPECT_EQ(c.surfaces.size(), 2u);
    EXPECT_EQ(c.surfaces[0].members.size(), 2u);
    EXPECT_FALSE(c.report.unjoined.empty());
  }
}

TEST(JoinAdversarial, ThreeAtOneEdge) {
  // A rib on a plate: the smooth pair is joined, the rib is reported.
  const NurbsSurface left = rectangle(0, 0, 1, 1), right = rectangle(1, 0, 2, 1);
  const NurbsSurface rib = quad({1, 0, 0}, {1, 1, 0}, {1, 0, 1}, {1, 1, 1});
  const std::vector<std::vector<NurbsSurface>> orders{
      {left, right, rib}, {rib, left, right}, {left, rib, right}};
  for (const auto& patches : orders) {
    const Composite c = joined(patches);
    check(c);
    EXPECT_EQ(c.surfaces.size(), 2u);
    ASSERT_EQ(c.report.unjoined.size(), 2u);
    for (const auto& u : c.report.unjoined) EXPECT_NE(u.reason.find("more than two"), std::string::npos);
  }
}

TEST(JoinAdversarial, ClosedSinglePatchAndCollapsedEdges) {
  // A whole cylinder and a whole sphere as one patch each: four quarters joined first.
  std::vector<NurbsSurface> quarters, octants;
  for (int q = 0; q < 4; ++q) {
    quarters.push_back(cylinder(20, q * kPi / 2, kPi / 2, 0, 10));
    octants.push_back(turned_arc(0, 30, 0, kPi / 2, q * kPi / 2, kPi / 2));
  }
  for (const auto& parts : {quarters, octants}) {
    const NurbsSurface whole = joined(parts).surfaces[0].surface;
    const Composite alone = joined({whole});
    check(alone);
    ASSERT_EQ(alone.surfaces.size(), 1u);
    EXPECT_EQ(alone.surfaces[0].surface.points, whole.points);
    const Composite two = joined({whole, translated(whole, {0, 0, 10})});
    check(two);
    // The cylinder's floors meet along a whole circle; the domes do not meet.
    EXPECT_EQ(two.surfaces.size(), parts == quarters ? 1u : 2u);
  }
}

TEST(JoinAdversarial, TwoHalvesThatMeetTwice) {
  const std::vector<NurbsSurface> patches{cylinder(20, 0, kPi * 0.9, 0, 10),
                                          cylinder(20, kPi * 0.9, kPi * 0.5, 0, 10),
                                          cylinder(20, kPi * 1.4, kPi * 0.6, 0, 10)};
  for (const Composite& c : by_every_rule(patches)) {
    EXPECT_EQ(c.surfaces.size(), 1u);
  }
}

std::vector<NurbsSurface> moebius_band(int n) {
  std::vector<NurbsSurface> out;
  const auto at = [&](int k, double side) {
    const double turn = 2 * kPi * k / n, twist = 0.5 * turn;
    const double r = 20 + 5 * side * std::cos(twist);
    return Point3{r * std::cos(turn), r * std::sin(turn), 5 * side * std::sin(twist)};
  };
  for (int k = 0; k < n; ++k) out.push_back(quad(at(k, -1), at(k + 1, -1), at(k, 1), at(k + 1, 1)));
  return out;
}

TEST(JoinAdversarial, MoebiusBand) {
  Random random(17);
  for (int k = 0; k < 20; ++k) {
    std::vector<NurbsSurface> patches;
    for (const NurbsSurface& s : moebius_band(integer(random, 3, 12)))
      patches.push_back(turned(s, integer(random, 0, 7)));
    shuffle(random, patches);
    for (const Composite& c : by_every_rule(patches)) {
      EXPECT_EQ(c.surfaces.size(), 1u);
      EXPECT_LT(difference(patches, c, random, 8), 1e-9);
    }
  }
}

TEST(JoinAdversarial, CubeWhoseFramesCannotAgree) {
  Random random(18);
  const auto face = [](Point3 o, Vec3 a, Vec3 b) { return quad(o, o + a, o + b, o + a + b); };
  const Vec3 x{10, 0, 0}, y{0, 10, 0}, z{0, 0, 10};
  const Point3 o{}, far{10, 10, 10};
  for (int k = 0; k < 40; ++k) {
    std::vector<NurbsSurface> patches{face(o, x, y),     face(o, y, z),     face(o, z, x),
                                      face(far, -x, -y), face(far, -y, -z), face(far, -z, -x)};
    for (NurbsSurface& p : patches) p = turned(p, integer(random, 0, 7));
    shuffle(random, patches);
    for (const Grouping rule : kRules) {
      const Composite c = joined(patches, {1e-4, 0.01, rule});
      check(c);
      EXPECT_LT(difference(patches, c, random, 8), 1e-9);
      // A ring of four, and the two that are left are opposite each other.
      if (rule == Grouping::largest) {
        EXPECT_EQ(c.surfaces.size(), 3u);
      }
      EXPECT_GE(c.surfaces.size(), 3u);
      EXPECT_LE(c.surfaces.size(), 6u);
    }
  }
}

/// Rectangles of random sizes thrown on a raster: contacts of every kind, overlaps, duplicates.
TEST(JoinAdversarial, RandomHeaps) {
  Random random(19);
  for (int k = 0; k < kCases; ++k) {
    std::vector<NurbsSurface> patches;
    for (int n = integer(random, 2, 14); n > 0; --n) {
      const int x = integer(random, 0, 4), y = integer(random, 0, 4), z = integer(random, 0, 1);
      patches.push_back(turned(rectangle(x, y, x + integer(random, 1, 3), y + integer(random, 1, 3), z),
                               integer(random, 0, 7)));
    }
    for (const Grouping rule : kRules) {
      const Composite c = joined(patches, {1e-4, 0.01, rule});
      check(c);
      EXPECT_LT(difference(patches, c, random, 8), 1e-9) << "case " << k;
      const Composite again = joined(patches, {1e-4, 0.01, rule});
      ASSERT_EQ(c.surfaces.size(), again.surfaces.size());
      for (std::size_t i = 0; i < c.surfaces.size(); ++i)
        EXPECT_EQ(c.surfaces[i].surface, again.surfaces[i].surface);
    }
  }
}

TEST(JoinAdversarial, TinyAndHugeAndFarWeights) {
  Random random(20);
  for (const double scale : {1e-2, 1.0, 1e4}) {
    for (int k = 0; k < 10; ++k) {
      NurbsSurface s = random_surface(random, 3, 2);
      for (HPoint& h : s.points) {
        const double w = std::exp(uniform(random, -5, 5));
        h = {scale * w * h.x, scale * w * h.y, scale * w * h.z, w * h.w};
      }
      std::vector<NurbsSurface> patches;
      for (const NurbsSurface& part : cut_into(random, s, 2, 2)) patches.push_back(disguised(random, part));
      const Composite c = joined(patches);
      check(c);
      ASSERT_EQ(c.surfaces.size(), 1u) << scale;
      EXPECT_LT(difference(patches, c, random), kExact * 100 * scale);
    }
  }
}

/// Control points on a coarse raster: collapsed edges, edges that run back over themselves, surfaces without
/// area, patches in each other.
TEST(JoinAdversarial, DegenerateNets) {
  Random random(22);
  for (int k = 0; k < kCases; ++k) {
    std::vector<NurbsSurface> patches;
    for (int n = integer(random, 1, 8); n > 0; --n) {
      NurbsSurface s = random_surface(random, 3, 2);
      for (HPoint& h : s.points) {
        const auto coordinate = [&] { return static_cast<double>(integer(random, 0, 1)); };
        const double x = coordinate(), y = coordinate(), z = integer(random, 0, 3) == 0 ? 1 : 0;
        h = homogeneous({x, y, z}, integer(random, 0, 4) == 0 ? 2 : 1);
      }
      patches.push_back(s);
    }
    for (const Composite& c : by_every_rule(patches)) {
      std::vector<bool> seen(patches.size(), false);
      for (const JoinedSurface& s : c.surfaces) {
        EXPECT_LE(s.deviation_mm, 0.01);
        for (const Member& m : s.members) seen[m.patch] = true;
      }
      EXPECT_EQ(std::count(seen.begin(), seen.end(), false), 0);
    }
  }
}

TEST(JoinAdversarial, ExtremeNumbers) {
  Random random(23);
  for (const double size : {1e-12, 1e-5, 1e6, 1e15, 1e18}) {
    std::vector<NurbsSurface> patches;
    for (int i = 0; i < 4; ++i)
      patches.push_back(rectangle(size * (i % 2), size * (i / 2), size * (i % 2 + 1), size * (i / 2 + 1)));
    patches[1] = with_domain(patches[1], Direction::u, {0, 1e-20});
    patches[2] = with_domain(patches[2], Direction::v, {-1e20, 1e20});
    patches[3] = with_weights_scaled(patches[3], 1e10);
    check(joined(patches));
  }
}

TEST(JoinAdversarial, HundredsOfPatches) {
  Random random(21);
  const NurbsSurface s = random_surface(random, 3, 3);
  std::vector<NurbsSurface> patches = cut_into(random, s, 16, 15);
  shuffle(random, patches);
  const Composite c = joined(patches);
  check(c);
  ASSERT_EQ(c.surfaces.size(), 1u);
  EXPECT_LT(difference(patches, c, random, 4), kExact * 100);
}

}  // namespace
}  // namespace burin::geom
