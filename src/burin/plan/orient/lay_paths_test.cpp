// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "burin/geom/surface/surface_cases.h"
#include "burin/plan/orient/paths.h"

namespace burin::orient {
namespace {

using geom::NurbsSurface;
using geom::Point2;
using geom::Point3;

NurbsSurface plate(double a, double b) {
  NurbsSurface s;
  s.degree_u = s.degree_v = 1;
  s.count_u = s.count_v = 2;
  s.knots_u = s.knots_v = {0, 0, 1, 1};
  for (const double y : {0.0, b})
    for (const double x : {0.0, a}) s.points.push_back(geom::homogeneous({x, y, 0}, 1));
  return s;
}

using StripOf = std::function<Strip(const CcPoint&)>;

struct Laid {
  Result<std::vector<double>> places;
  int rounds = 0;
  std::size_t lanes = 0;
};
Laid lay(const PathFamily& family, const StripOf& strip, std::size_t max_paths = 10000) {
  int rounds = 0;
  std::size_t lanes = 0;
  const LanePlanner planner = [&](const std::vector<double>& ws) {
    ++rounds;
    lanes += ws.size();
    std::vector<Lane> out;
    for (const double w : ws) {
      Lane lane{w, family.at(w), {}};
      for (const auto& piece : lane.pieces) {
        lane.strips.emplace_back();
        for (const CcPoint& p : piece) lane.strips.back().push_back(strip(p));
      }
      out.push_back(std::move(lane));
    }
    return out;
  };
  auto places = lay_paths(family, planner, max_paths);
  return {std::move(places), rounds, lanes};
}

PathFamily family_of(const Part& part, const PathOptions& options = {}) {
  auto family = PathFamily::make(part, 0, options);
  EXPECT_TRUE(family.ok());
  return std::move(*family);
}
Part part_of(NurbsSurface s, bool reversed = false) {
  Part part;
  part.faces.push_back({std::move(s), reversed, {}, 1});
  return part;
}

/// On a plate 100 x b, paths along x: every place is within a strip of a path.
void expect_covered(const std::vector<double>& places, double b, const StripOf& strip) {
  for (int i = 0; i <= 30; ++i) {
    const double x = 100.0 * i / 30;
    for (int j = 0; j <= 1000; ++j) {
      const double y = b * j / 1000;
      bool covered = false;
      for (const double w : places) {
        CcPoint at{{x, w * b, 0}, {0, 0, 1}, {1, 0, 0}};
        const Strip s = strip(at);
        const double off = y - w * b;
        // Linear between stations: what the planner is given too.
        covered = covered || (off <= s.left + 0.01 && off >= -s.right - 0.01);
      }
      EXPECT_TRUE(covered) << x << " " << y;
    }
  }
}

/// The fewest paths: each as far on as the strips allow, by small steps.
std::size_t fewest(double b, const StripOf& strip) {
  const auto room = [&](double from, double to) {  // > 0: not covered
    double most = -1e300;
    for (int i = 0; i <= 60; ++i) {
      const double x = 100.0 * i / 60;
      const double before = from < 0 ? 0 : from + strip({{x, from, 0}, {0, 0, 1}, {1, 0, 0}}).left;
      const double behind = to > b ? b : to - strip({{x, to, 0}, {0, 0, 1}, {1, 0, 0}}).right;
      most = std::max(most, behind - before);
    }
    return most;
  };
  std::size_t count = 0;
  double y = -1;
  while (count < 100000) {
    double next = std::max(y, 0.0);
    while (next + 4e-3 <= b && room(y, next + 4e-3) <= 0) next += 4e-3;
    y = next;
    ++count;
    if (room(y, b + 1) <= 0) return count;
  }
  return count;
}

TEST(LayPaths, OnAPlateAsFewAsTheStripsAllow) {
  const std::vector<StripOf> strips{
      [](const CcPoint&) {
        return Strip{3, 3};
      },
      [](const CcPoint&) {
        return Strip{1.3, 0.4};
      },
      // Wider towards one border, and waves along the path.
      [](const CcPoint& p) {
        return Strip{1 + p.c.y / 40, 0.5 + p.c.y / 60};
      },
      [](const CcPoint& p) {
        const double s = 1.5 + 0.5 * std::sin(p.c.y / 9 + p.c.x / 30);
        return Strip{s, 1.2 * s};
      },
      [](const CcPoint& p) {
        return p.c.y < 37 ? Strip{0.5, 0.6} : Strip{2, 2};
      },
      [](const CcPoint&) {
        return Strip{70, 70};
      },
  };
  PathOptions o;
  o.max_step_mm = 2;
  constexpr double kWide = 97;
  const Part part = part_of(plate(100, kWide));
  const PathFamily family = family_of(part, o);
  for (std::size_t i = 0; i < strips.size(); ++i) {
    const Laid laid = lay(family, strips[i]);
    ASSERT_TRUE(laid.places.ok()) << i;
    const std::size_t least = fewest(kWide, strips[i]), got = laid.places->size();
    expect_covered(*laid.places, kWide, strips[i]);
    EXPECT_LE(static_cast<double>(got), std::ceil(1.02 * static_cast<double>(least))) << i;
    EXPECT_TRUE(std::is_sorted(laid.places->begin(), laid.places->end()));
    EXPECT_LE(laid.lanes, 13 + 5 * got) << i;
  }
}

TEST(LayPaths, OnACylinderAndASphere) {
  // A ball of 5 mm on a cylinder of 20 mm radius, paths along the axis and round it; on a sphere along
  // latitudes.
  struct Case {
    Part part;
    Pattern pattern;
    double length;  ///< across
    double k;       ///< of the profile across
  };
  std::vector<Case> cases;
  cases.push_back({part_of(geom::cases::cylinder(20, 50), true), Pattern::iso_u, 40 * geom::kPi, -1.0 / 20});
  cases.push_back({part_of(geom::cases::cylinder(20, 50), true), Pattern::iso_v, 50, 0});
  cases.push_back({part_of(geom::cases::sphere(20), true), Pattern::iso_v, 20 * geom::kPi, -1.0 / 20});
  cases.push_back({part_of(geom::cases::sphere(20), false), Pattern::iso_v, 20 * geom::kPi, 1.0 / 20});
  for (std::size_t i = 0; i < cases.size(); ++i) {
    PathOptions o;
    o.pattern = cases[i].pattern;
    const PathFamily family = family_of(cases[i].part, o);
    const auto strip = [](const CcPoint& p) { return ball_strip(p, 5, 0.05); };
    const double half = ball_strip({{}, {0, 0, 1}, {1, 0, 0}, 0, 0, cases[i].k}, 5, 0.05).left;
    const double least = std::ceil(cases[i].length / (2 * half));
    const Laid laid = lay(family, strip);
    ASSERT_TRUE(laid.places.ok());
    EXPECT_GE(static_cast<double>(laid.places->size()), least);
    EXPECT_LE(static_cast<double>(laid.places->size()), std::ceil(1.02 * least));
  }
}

TEST(LayPaths, UnreachableStationsDoNotConstrain) {
  const Part part = part_of(plate(100, 50));
  PathOptions o;
  o.max_step_mm = 2;
  const PathFamily family = family_of(part, o);
  // In the middle nothing can be reached.
  const Laid some = lay(family, [](const CcPoint& p) {
    return p.c.x > 30 && p.c.x < 60 ? Strip{} : Strip{2, 2};
  });
  ASSERT_TRUE(some.places.ok());
  EXPECT_LE(some.places->size(), 14U);
  const Laid none = lay(family, [](const CcPoint&) { return Strip{}; });
  ASSERT_TRUE(none.places.ok());
  EXPECT_EQ(*none.places, std::vector<double>{0.5});
  const Laid one = lay(family, [](const CcPoint&) { return Strip{300, 300}; });
  ASSERT_TRUE(one.places.ok());
  ASSERT_EQ(one.places->size(), 1U);
  EXPECT_NEAR(one.places->front(), 0.5, 1e-6);
}

TEST(LayPaths, LobesAndRimsOfHolesAreCovered) {
  // A plate with a tooth on its upper border and a hole; paths along x.
  const std::vector<Point2> outline{{0, 0},    {1, 0},   {1, 0.7},    {0.62, 0.7},
                                    {0.61, 1}, {0.5, 1}, {0.49, 0.7}, {0, 0.7}};
  const std::vector<Point2> hole{{0.2, 0.3}, {0.2, 0.43}, {0.4, 0.43}, {0.4, 0.3}};
  Part part = part_of(plate(100, 50));
  part.faces[0].trims = {outline, hole};
  PathOptions o;
  o.max_step_mm = 1;
  const PathFamily family = family_of(part, o);
  for (const double s : {0.9, 2.3, 5.0}) {
    const Laid laid = lay(family, [s](const CcPoint&) { return Strip{s, s}; });
    ASSERT_TRUE(laid.places.ok());
    EXPECT_LE(static_cast<double>(laid.places->size()), std::ceil(50 / (2 * s)) + 3);
    std::vector<std::vector<CcPoint>> pieces;
    for (const double w : *laid.places)
      for (auto& piece : family.at(w)) pieces.push_back(std::move(piece));
    // Beside the corners that slant.
    for (const double x : {5.0, 22.0, 30.0, 38.0, 52.0, 55.0, 59.0, 80.0}) {
      for (double y = 0.05; y < 50; y += 0.1) {
        const double top = x > 50 && x < 61 ? 50 : 35;
        if (y > top || (x > 20 && x < 40 && y > 15 && y < 21.5)) continue;
        const bool covered = std::any_of(pieces.begin(), pieces.end(), [&](const auto& piece) {
          return piece.front().c.x <= x + 1e-9 && piece.back().c.x >= x - 1e-9 &&
                 std::abs(piece.front().c.y - y) <= s + 0.02;
        });
        EXPECT_TRUE(covered) << s << ": " << x << " " << y;
      }
    }
  }
}

TEST(LayPaths, TooManyPathsAreAnError) {
  const Part part = part_of(plate(100, 50));
  const PathFamily family = family_of(part);
  for (const double s : {1e-3, 1e-9, 0.2}) {
    const Laid laid = lay(
        family,
        [s](const CcPoint&) {
          return Strip{s, s};
        },
        100);
    ASSERT_FALSE(laid.places.ok());
    EXPECT_EQ(laid.places.error().code, ErrorCode::range);
    EXPECT_LE(laid.lanes, 400U);
  }
}

TEST(LayPaths, RoughStripsStillEndCovered) {
  const Part part = part_of(plate(100, 50));
  PathOptions o;
  o.max_step_mm = 2;
  const PathFamily family = family_of(part, o);
  // Jumps everywhere, as where the search falls into another piece of the C-space.
  const StripOf rough = [](const CcPoint& p) {
    const double s = 1 + 0.7 * std::sin(1e4 * p.c.y);
    return Strip{s, s};
  };
  const Laid laid = lay(family, rough);
  ASSERT_TRUE(laid.places.ok());
  expect_covered(*laid.places, 50, rough);
  EXPECT_LE(laid.lanes, 300U);
}

}  // namespace
}  // namespace burin::orient
