// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/clearance.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "burin/plan/laser/nesting.h"
#include "burin/plan/laser/point_grid.h"
#include "burin/plan/laser/toolpath_fixture.h"

namespace burin::laser::detail {
namespace {

using namespace fixture;

struct Random {
  std::mt19937 engine;
  double real(double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(engine()) / 4294967296.0);
  }
  Point2 point(double size) { return {real(0, size), real(0, size)}; }
  Segment segment(double size) {
    const Point2 a = point(size);
    if (engine() % 3 == 0) return geom::make_line(a, point(size));
    return geom::from_bulge(a, point(size), real(-3, 3));
  }
};

TEST(SegmentDistance, AgreesWithDenseSampling) {
  Random random{std::mt19937(5)};
  for (int n = 0; n < 2000; ++n) {
    const Segment s = random.segment(10), t = random.segment(10);
    const double got = segment_distance(s, t);
    double sampled = 1e300;
    constexpr int kSamples = 400;
    for (int k = 0; k <= kSamples; ++k) {
      sampled = std::min(sampled, geom::nearest_on(t, geom::point_on(s, k / double{kSamples})).distance);
    }
    EXPECT_LE(got, sampled + 1e-9);
    EXPECT_GE(got, sampled - geom::length_of(s) /
                                 kSamples);  // a sample lies within half a step of the nearest point
    EXPECT_NEAR(got, segment_distance(t, s), 1e-9);
  }
}

TEST(Clearance, SeesEveryCopy) {
  Builder b;
  b.plate({0, 0}, {10, 10});
  const Tiling tiling{4, 3, {12, 15}};
  const Clearance clearance = clearance_of_outlines(b.profile, tiling);
  Random random{std::mt19937(7)};
  for (int n = 0; n < 500; ++n) {
    const Point2 a = random.point(60) - Vec2{10, 10};
    const Segment move = geom::make_line(a, a + Vec2{random.real(-15, 15), random.real(-15, 15)});
    double nearest = 1e300;
    for (int i = -3; i <= 3; ++i) {
      for (int j = -2; j <= 2; ++j) {
        for (const Segment& s : b.profile.outlines[0].spline.segments) {
          nearest = std::min(nearest, segment_distance(move, moved(s, {12.0 * i, 15.0 * j})));
        }
      }
    }
    const double distance = random.real(0.1, 3);
    EXPECT_EQ(clearance.is_free(move, distance), nearest >= distance);
  }
}

TEST(PathParents, AgreeWithWindingNumbers) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const Profile profile = random_profile(seed, 0.25);
    const auto& paths = profile.paths;
    const auto parents = path_parents(paths, 1e-7);
    for (std::size_t i = 0; i < paths.size(); ++i) {
      std::uint32_t want = kNoParent;
      double area = 1e300;
      for (std::uint32_t j = 0; paths[i].role != Role::engrave && j < paths.size(); ++j) {
        if (i == j || !paths[j].spline.closed) continue;
        const double a = std::abs(geom::signed_area(paths[j].spline));
        if (geom::winding_number(paths[j].spline, paths[i].spline.segments[0].a) != 0 && a < area) {
          want = j;
          area = a;
        }
      }
      EXPECT_EQ(parents[i], want) << "seed " << seed << " path " << i;
    }
  }
}

TEST(PathParents, TouchingAndEqualPathsMakeNoCycle) {
  Builder b;
  b.d = 0;
  b.plate({0, 0}, {10, 10});
  b.plate({0, 0}, {10, 10});
  b.plate({0, 0}, {5, 5});
  b.plate({10, 0}, {20, 10});
  const auto parents = path_parents(b.profile.paths, 1e-7);
  for (std::uint32_t i = 0; i < parents.size(); ++i) {
    std::uint32_t p = i;
    for (std::size_t k = 0; p != kNoParent; ++k) {
      ASSERT_LE(k, parents.size());
      p = parents[p];
    }
  }
  EXPECT_EQ(parents[3], kNoParent);
}

TEST(PointGrid, NearestIsWhatATestOfEveryPointFinds) {
  Random random{std::mt19937(8)};
  std::vector<Point2> points;
  for (int i = 0; i < 600; ++i) {
    points.push_back(i % 3 ? random.point(100)
                           : Point2{std::floor(random.real(0, 10)), std::floor(random.real(0, 10))});
  }
  PointGrid grid(points);
  std::set<std::uint32_t> in;
  for (std::uint32_t i = 0; i < points.size(); i += 2) {
    grid.insert(i);
    in.insert(i);
  }
  for (std::uint32_t late = 1; !in.empty(); late += 2) {
    const Point2 p = random.point(140) - Vec2{20, 20};
    std::vector<std::pair<double, std::uint32_t>> want;
    for (const std::uint32_t i : in) want.emplace_back(geom::distance2(p, points[i]), i);
    std::sort(want.begin(), want.end());
    const auto got = grid.nearest(p, 5);
    ASSERT_EQ(got.size(), std::min<std::size_t>(5, want.size()));
    for (std::size_t k = 0; k < got.size(); ++k) ASSERT_EQ(got[k], want[k].second);
    grid.erase(got[0]);
    in.erase(got[0]);
    if (late < 100) {
      grid.insert(late);
      in.insert(late);
    }
  }
  EXPECT_EQ(grid.nearest({0, 0}), PointGrid::kNone);
}

}  // namespace
}  // namespace burin::laser::detail
