// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/join.h"

#include "burin/geom/surface/join_test_support.h"

namespace burin::geom {
namespace {

using namespace test;

/// In release thousands of random cases, in Debug enough to see that it works.
#ifdef NDEBUG
constexpr int kCases = 150;
#else
constexpr int kCases = 12;
#endif

TEST(Join, RefusesWhatIsNoPatch) {
  Diagnostics diagnostics;
  EXPECT_FALSE(join({}, {}, diagnostics));
  NurbsSurface bad = rectangle(0, 0, 1, 1);
  bad.points[2].w = -1;
  const auto r = join({rectangle(0, 0, 1, 1), bad}, {}, diagnostics);
  ASSERT_FALSE(r);
  EXPECT_EQ(r.error().code, ErrorCode::geometry);
  EXPECT_NE(r.error().message.find("patch 2"), std::string::npos);
}

TEST(Join, AloneStaysAsItIs) {
  Random random(1);
  for (int k = 0; k < 20; ++k) {
    const NurbsSurface s = random_surface(random);
    const Composite c = joined({s});
    check(c);
    ASSERT_EQ(c.surfaces.size(), 1u);
    EXPECT_EQ(c.surfaces[0].surface.points, s.points);
    EXPECT_EQ(c.surfaces[0].deviation_mm, 0);
    EXPECT_TRUE(c.surfaces[0].joints.empty());
    EXPECT_LT(difference({s}, c, random), kExact);
  }
}

TEST(Join, TwoInAllOrientations) {
  Random random(2);
  for (int k = 0; k < std::max(1, kCases / 50); ++k) {
    const NurbsSurface s = random_surface(random);
    const auto parts = cut_into(random, s, 2, 1);
    for (int first = 0; first < 8; ++first) {
      for (int second = 0; second < 8; ++second) {
        const std::vector<NurbsSurface> patches{turned(parts[0], first), turned(parts[1], second)};
        for (const Composite& c : by_every_rule(patches)) {
          ASSERT_EQ(c.surfaces.size(), 1u) << first << " " << second;
          EXPECT_LT(difference(patches, c, random, 8), kExact * 100);
          ASSERT_EQ(c.surfaces[0].joints.size(), 1u);
        }
      }
    }
  }
}

TEST(Join, GridsOfDisguisedParts) {
  Random random(3);
  for (int k = 0; k < kCases; ++k) {
    const NurbsSurface s = random_surface(random);
    const int columns = integer(random, 1, 3), rows = integer(random, 1, 3);
    std::vector<NurbsSurface> patches;
    for (const NurbsSurface& part : cut_into(random, s, columns, rows))
      patches.push_back(disguised(random, part));
    shuffle(random, patches);
    for (const Composite& c : by_every_rule(patches)) {
      ASSERT_EQ(c.surfaces.size(), 1u) << "case " << k;
      EXPECT_LT(difference(patches, c, random, 12), kExact * 100) << "case " << k;
      EXPECT_LT(c.surfaces[0].deviation_mm, kExact * 100);
      EXPECT_LT(c.report.gap_max_mm, kExact * 100);
      EXPECT_TRUE(c.report.unjoined.empty());
      EXPECT_EQ(static_cast<int>(c.surfaces[0].joints.size()), columns - 1 + rows - 1);
    }
  }
}

TEST(Join, QuarterCylindersMakeARingCutAtTheFirst) {
  Random random(4);
  for (int k = 0; k < std::max(4, kCases / 20); ++k) {
    std::vector<NurbsSurface> patches;
    const int floors = integer(random, 1, 3);
    for (int z = 0; z < floors; ++z)
      for (int q = 0; q < 4; ++q)
        patches.push_back(disguised(random, cylinder(20, 0.3 + q * kPi / 2, kPi / 2, 10 * z, 10 * (z + 1))));
    shuffle(random, patches);
    for (const Composite& c : by_every_rule(patches)) {
      ASSERT_EQ(c.surfaces.size(), 1u);
      EXPECT_LT(difference(patches, c, random, 12), kExact * 40);
      for (const Joint& joint : c.surfaces[0].joints) EXPECT_EQ(joint.continuity, Continuity::g2);
      // The first patch lies at the low end of the direction that goes round.
      const Member* first = nullptr;
      for (const Member& m : c.surfaces[0].members)
        if (m.patch == 0) first = &m;
      ASSERT_NE(first, nullptr);
      const NurbsSurface& s = c.surfaces[0].surface;
      const bool round_u = distance(point(s, 0, 0), point(s, s.knots_u.back(), 0)) < 1e-6;
      EXPECT_EQ(round_u ? first->u.lo : first->v.lo, 0);
    }
  }
}

TEST(Join, SphereOfOctants) {
  Random random(5);
  for (int k = 0; k < std::max(4, kCases / 20); ++k) {
    std::vector<NurbsSurface> patches;
    for (int q = 0; q < 4; ++q)
      for (const double lower : {-kPi / 2, 0.0})
        patches.push_back(disguised(random, turned_arc(0, 30, lower, kPi / 2, q * kPi / 2, kPi / 2)));
    shuffle(random, patches);
    for (const Composite& c : by_every_rule(patches)) {
      ASSERT_EQ(c.surfaces.size(), 1u);
      EXPECT_LT(difference(patches, c, random, 12), kExact * 60);
      for (const Joint& joint : c.surfaces[0].joints) EXPECT_EQ(joint.continuity, Continuity::g2);
    }
  }
}

TEST(Join, TorusIsCutTwice) {
  Random random(6);
  std::vector<NurbsSurface> patches;
  for (int q = 0; q < 4; ++q)
    for (int p = 0; p < 4; ++p)
      patches.push_back(disguised(random, turned_arc(50, 20, p * kPi / 2, kPi / 2, q * kPi / 2, kPi / 2)));
  for (const Composite& c : by_every_rule(patches)) {
    ASSERT_EQ(c.surfaces.size(), 1u);
    EXPECT_EQ(c.surfaces[0].joints.size(), 6u);
    EXPECT_LT(difference(patches, c, random), kExact * 140);
  }
}

}  // namespace
}  // namespace burin::geom
