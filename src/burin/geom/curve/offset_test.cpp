// SPDX-License-Identifier: Apache-2.0
// Offsets with known areas, and relations that hold between offsets. Random shapes against an independent
// check are in offset_robustness_test.cpp.
#include "burin/geom/curve/offset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "burin/geom/curve/offset_cases.h"
#include "burin/geom/curve/segment_meet.h"

namespace burin::geom {
namespace {

using cases::circle;
using cases::moved;
using cases::polygon;
using cases::Region;

double area(const Region& region) {
  double sum = 0;
  for (const ArcSpline& s : region) sum += signed_area(s);
  return sum;
}
double length(const Region& region) {
  double sum = 0;
  for (const ArcSpline& s : region) sum += length_of(s);
  return sum;
}
OffsetResult offset(const Region& region, double d) {
  Result<OffsetResult> r = offset_region(region, d);
  EXPECT_TRUE(r.ok()) << (r.ok() ? "" : r.error().to_string());
  return r.ok() ? *std::move(r) : OffsetResult{};
}
ArcSpline square(double x, double y, double size) {
  return polygon({{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}});
}

TEST(Offset, SquareGrowsRoundCornersAndShrinksSharp) {
  const Region region{square(0, 0, 10)};
  const OffsetResult grown = offset(region, 1);
  ASSERT_EQ(grown.contours.size(), 1u);
  EXPECT_EQ(grown.contours[0].segments.size(), 8u);
  EXPECT_NEAR(area(grown.contours), 100 + 40 + kPi, 1e-9);
  int corners = 0;
  for (const Segment& s : grown.contours[0].segments) corners += s.source == kCornerSource ? 1 : 0;
  EXPECT_EQ(corners, 4);
  EXPECT_EQ(count_g1_breaks(grown.contours[0], 1e-9), 0);
  const OffsetResult shrunk = offset(region, -1);
  ASSERT_EQ(shrunk.contours.size(), 1u);
  EXPECT_EQ(shrunk.contours[0].segments.size(), 4u);
  EXPECT_NEAR(area(shrunk.contours), 64, 1e-9);
  EXPECT_TRUE(shrunk.vanished.empty());
}

TEST(Offset, ErodedAwayIsReported) {
  const OffsetResult gone = offset({square(0, 0, 10), square(20, 0, 30)}, -6);
  ASSERT_EQ(gone.contours.size(), 1u);
  EXPECT_EQ(gone.from, std::vector<std::uint32_t>{1});
  EXPECT_EQ(gone.vanished, std::vector<std::uint32_t>{0});
}

TEST(Offset, CircleAndAnnulus) {
  const Region ring{circle({3, 4}, 10, true), circle({3, 4}, 4, false)};
  for (const double d : {1.0, 3.5, -2.5}) {
    const OffsetResult r = offset(ring, d);
    ASSERT_EQ(r.contours.size(), 2u) << d;
    EXPECT_NEAR(area(r.contours), kPi * ((10 + d) * (10 + d) - (4 - d) * (4 - d)), 1e-9) << d;
    for (const ArcSpline& s : r.contours) EXPECT_EQ(s.segments.size(), 2u);
  }
  const OffsetResult filled = offset(ring, 5);
  EXPECT_EQ(filled.contours.size(), 1u);
  EXPECT_EQ(filled.vanished, std::vector<std::uint32_t>{1});
  const OffsetResult gone = offset(ring, -3.1);
  EXPECT_TRUE(gone.contours.empty());
  EXPECT_EQ(gone.vanished.size(), 2u);
}

TEST(Offset, ConcaveCornerStaysSharp) {
  const Region ell{polygon({{0, 0}, {20, 0}, {20, 5}, {5, 5}, {5, 20}, {0, 20}})};
  // Perimeter 80, five convex corners, one concave one that loses a square and gains none of its disk.
  EXPECT_NEAR(area(offset(ell, 1).contours), 175 + 80 + 5 * kPi / 4 - 1, 1e-9);
  EXPECT_NEAR(area(offset(ell, -1).contours), 18 * 3 + 3 * 15 + (1 - kPi / 4), 1e-9);
}

TEST(Offset, TwoDisksMerge) {
  const double r = 3, gap = 7, grown = 4;
  const OffsetResult both = offset({circle({0, 0}, r, true), circle({gap, 0}, r, true)}, grown - r);
  ASSERT_EQ(both.contours.size(), 1u);
  const double half = std::acos(gap / (2 * grown));
  const double lens = 2 * grown * grown * half - gap * std::sqrt(grown * grown - gap * gap / 4);
  EXPECT_NEAR(area(both.contours), 2 * kPi * grown * grown - lens, 1e-9);
}

TEST(Offset, HolesMergeWhenShrinking) {
  const Region plate{square(-20, -20, 60), circle({0, 0}, 3, false), circle({7, 0}, 3, false)};
  const OffsetResult r = offset(plate, -1);
  ASSERT_EQ(r.contours.size(), 2u);
  EXPECT_GT(signed_area(r.contours[0]), 0);
  EXPECT_LT(signed_area(r.contours[1]), 0);
  EXPECT_TRUE(r.vanished.empty());
}

TEST(Offset, GapOfExactlyTwiceTheOffset) {
  const double d = 0.28;
  const OffsetResult touching = offset({square(0, 0, 10), square(10 + 2 * d, 0, 10)}, d);
  const double each = 100 + 40 * d + kPi * d * d;
  EXPECT_NEAR(area(touching.contours), 2 * each, 1e-6 * 60);
  const Region slot{square(-5, -5, 30), polygon({{0, 0}, {0, 2 * d}, {8, 2 * d}, {8, 0}})};
  const OffsetResult closed = offset(slot, d);
  ASSERT_EQ(closed.contours.size(), 1u);
  EXPECT_EQ(closed.vanished, std::vector<std::uint32_t>{1});
}

TEST(Offset, RingOfNoWidth) {
  const ArcSpline outer = square(0, 0, 10);
  const Region ring{outer, reversed(outer)};
  const OffsetResult grown = offset(ring, 1);
  EXPECT_NEAR(area(grown.contours), (140 + kPi) - 64, 1e-6 * 80);
  EXPECT_TRUE(offset(ring, -1).contours.empty());
}

TEST(Offset, FirstAndLastVertexNearlyTogether) {
  const Region region{polygon({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {1e-6, 1e-6}})};
  EXPECT_NEAR(area(offset(region, 1).contours), 140 + kPi, 1e-4);
  EXPECT_NEAR(area(offset(region, -1).contours), 64, 1e-4);
}

TEST(Offset, FilletOfTheOffsetsRadiusClosesToACorner) {
  // The inner corner has a fillet of radius 1: growing by 1 leaves its centre as a sharp corner.
  const Region ell{polygon({{0, 0}, {20, 0}, {20, 5}, {6, 5}, {5, 6}, {5, 20}, {0, 20}},
                           {0, 0, 0, -std::tan(kPi / 8), 0, 0, 0})};
  for (const double d : {0.5, 1.0, 1.5, 4.0}) {
    const Region sharp{polygon({{0, 0}, {20, 0}, {20, 5}, {5, 5}, {5, 20}, {0, 20}})};
    const double fillet = d < 1 ? (1 - d) * (1 - d) * (1 - kPi / 4) : 0;
    EXPECT_NEAR(area(offset(ell, d).contours), area(offset(sharp, d).contours) + fillet, 1e-6) << d;
  }
}

TEST(Offset, TangentFilletsSmallerThanTheOffsetAtAnyAngle) {
  // The joints are smooth up to rounding of either sign, and the arc collapses to its centre.
  const Region ell{polygon({{0, 0}, {20, 0}, {20, 5}, {6, 5}, {5, 6}, {5, 20}, {0, 20}},
                           {0, 0, 0, -std::tan(kPi / 8), 0, 0, 0})};
  const double want =
      area(offset({polygon({{0, 0}, {20, 0}, {20, 5}, {5, 5}, {5, 20}, {0, 20}})}, 2).contours);
  cases::Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Region turned{moved(ell[0], cases::uniform(random, 0, 6.28), {cases::uniform(random, -99, 99), 7})};
    EXPECT_NEAR(area(offset(turned, 2).contours), want, 1e-6) << i;
  }
}

TEST(Offset, SpurOfNoWidth) {
  const Region region{polygon({{0, 0}, {10, 0}, {10, 10}, {5, 10}, {5, 15}, {5, 10}, {0, 10}})};
  EXPECT_NEAR(area(offset(region, 0).contours), 100, 1e-6);
  // Beside the grown square: a strip of width 2 from y = 11 to 15 and half a disk.
  EXPECT_NEAR(area(offset(region, 1).contours), 140 + kPi + 8 + kPi / 2, 1e-6);
}

TEST(SegmentMeet, LargeAndSmallCircleMeetPrecisely) {
  const Segment flat =
      make_arc({-9.662113661473299, -1.5463101501852043}, {-1.6400491566011495, -0.78769354170350026},
               {-6104.137198344205, 64487.862720340905}, true);
  const double big = distance(flat.a, flat.center);
  int met = 0;
  for (int i = 0; i < 60; ++i) {
    const Point2 c{22.0 - i * 0.4, -15.8};
    const Segment small = make_arc({c.x, c.y + 28}, {c.x, c.y - 28}, c, true);
    const detail::Meeting m = detail::meet(flat, small, 1e-9);
    if (const auto* one = std::get_if<detail::OneMeet>(&m)) {
      ++met;
      EXPECT_NEAR(distance(one->p, c), 28, 1e-9);
      EXPECT_NEAR(distance(one->p, flat.center), big, 1e-9);
    }
  }
  EXPECT_GT(met, 5);
}

TEST(SegmentMeet, HalvesOfACircleDoNotMeetBesidesTheirEnds) {
  const ArcSpline c = circle({1, 2}, 3, true);
  EXPECT_TRUE(
      std::holds_alternative<detail::NoMeet>(detail::meet_neighbours(c.segments[0], c.segments[1], 1e-9)));
}

TEST(Offset, NoOffsetGivesTheRegion) {
  const Region region{square(0, 0, 10), circle({5, 5}, 2, false)};
  const OffsetResult same = offset(region, 0);
  ASSERT_EQ(same.contours.size(), 2u);
  EXPECT_NEAR(area(same.contours), area(region), 1e-12);
}

TEST(Offset, OverlappingPartsBecomeOne) {
  const OffsetResult r = offset({square(0, 0, 10), square(5, 5, 10)}, 0);
  ASSERT_EQ(r.contours.size(), 1u);
  EXPECT_NEAR(area(r.contours), 175, 1e-9);
}

TEST(Offset, StartVertexRigidMotionAndOrderDoNotMatter) {
  cases::Random random(7);
  for (int i = 0; i < 60; ++i) {
    const Region region = cases::star(random);
    const double d = cases::uniform(random, -1.5, 1.5);
    const double want = area(offset(region, d).contours), around = length(offset(region, d).contours);
    Region turned = region;
    std::rotate(turned[0].segments.begin(), turned[0].segments.begin() + 1, turned[0].segments.end());
    EXPECT_NEAR(area(offset(turned, d).contours), want, 1e-6 * (1 + around)) << i;
    const Region away{moved(region[0], 1.234, {321, -1234})};
    EXPECT_NEAR(area(offset(away, d).contours), want, 1e-6 * (1 + around)) << i;
    EXPECT_NEAR(length(offset(away, d).contours), around, 1e-4 * (1 + around)) << i;
  }
}

TEST(Offset, GrowingThePartShrinksItsComplement) {
  cases::Random random(8);
  for (int i = 0; i < 60; ++i) {
    const Region region = cases::star(random);
    const double d = cases::uniform(random, 0.01, 1.5);
    const Region frame{square(-50, -50, 100)};
    Region rest = frame;
    for (const ArcSpline& s : region) rest.push_back(reversed(s));
    const double grown = area(offset(region, d).contours);
    const double left = area(offset(rest, -d).contours);
    EXPECT_NEAR(left, (100 - 2 * d) * (100 - 2 * d) - grown, 1e-4) << i;
  }
}

TEST(Offset, AreaGrowsByTheLengthOfTheBoundary) {
  cases::Random random(9);
  for (int i = 0; i < 40; ++i) {
    const Region region = cases::star(random);
    const double d = cases::uniform(random, -1, 1), h = 1e-3;
    const Region at = offset(region, d).contours;
    const double slope =
        (area(offset(region, d + h).contours) - area(offset(region, d - h).contours)) / (2 * h);
    EXPECT_NEAR(slope, length(at), 0.02 * (1 + length(at))) << i;
  }
}

TEST(Offset, TwoStepsOfAConvexPartAreOne) {
  const Region convex{polygon({{0, 0}, {9, -1}, {12, 5}, {4, 9}})};
  const Region twice = offset(offset(convex, 0.7).contours, 0.55).contours;
  EXPECT_NEAR(area(twice), area(offset(convex, 1.25).contours), 1e-8);
}

TEST(Offset, SameInputSameBits) {
  cases::Random random(10);
  const Region region = cases::rectilinear(random, 0.56, 1e-10);
  const OffsetResult a = offset(region, 0.28), b = offset(region, 0.28);
  ASSERT_EQ(a.contours.size(), b.contours.size());
  for (std::size_t i = 0; i < a.contours.size(); ++i)
    EXPECT_EQ(a.contours[i].segments, b.contours[i].segments);
}

void expect_refused(const Region& region, double d, const std::string& part) {
  const Result<OffsetResult> r = offset_region(region, d);
  ASSERT_FALSE(r.ok()) << part;
  EXPECT_NE(r.error().message.find(part), std::string::npos) << r.error().message;
}

TEST(Offset, BadInputIsRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Region good{square(0, 0, 10)};
  expect_refused(good, nan, "not finite");
  Region open = good;
  open.push_back(square(20, 0, 1));
  open[1].closed = false;
  expect_refused(open, 1, "contour 1");
  Region hole = good;
  hole[0].segments[2].a.x += 1e-3;
  expect_refused(hole, 1, "does not start");
  Region wild = good;
  wild[0].segments[1].b.x = wild[0].segments[2].a.x = nan;
  expect_refused(wild, 1, "finite");
  Region arc{circle({0, 0}, 5, true)};
  arc[0].segments[1].radius = 5.001;
  expect_refused(arc, 1, "disagree");
  expect_refused({ArcSpline{{}, true}}, 1, "empty");
  EXPECT_TRUE(offset({}, 1).contours.empty());
}

}  // namespace
}  // namespace burin::geom
