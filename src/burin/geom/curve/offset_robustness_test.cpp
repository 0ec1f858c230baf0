// SPDX-License-Identifier: Apache-2.0
// The offset against a check that shares no code with it. Grown by d: R united with D = {p : distance to the
// boundary of R <= d}; shrunk by d: R without D. Along a scan line both sides are unions of intervals whose
// ends are known in closed form (capsule against line), so every scan line is compared over its whole length,
// not at samples; and every segment of the result must lie at distance d of the input.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>

#include "burin/geom/curve/offset.h"
#include "burin/geom/curve/offset_cases.h"

namespace burin::geom {
namespace {

using cases::Random;
using cases::Region;

/// What offset.h guarantees, mm.
constexpr double kGuarantee = 1e-6;

double boundary_distance(const Region& region, Point2 p) {
  double best = 1e300;
  for (const ArcSpline& s : region) best = std::min(best, distance_to(s, p));
  return best;
}
int winding(const Region& region, Point2 p) {
  int w = 0;
  for (const ArcSpline& s : region) w += winding_number(s, p);
  return w;
}

void circle_crossings(Point2 c, double r, double y, std::vector<double>& x) {
  const double h = y - c.y;
  if (r <= 0 || std::abs(h) > r) return;
  const double half = std::sqrt(std::max(0.0, r * r - h * h));
  x.push_back(c.x - half);
  x.push_back(c.x + half);
}
void line_crossings(Point2 a, Point2 b, double y, std::vector<double>& x) {
  if ((a.y - y) * (b.y - y) > 0 || a.y == b.y) return;
  x.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
}
void segment_crossings(const Segment& s, double y, std::vector<double>& x) {
  if (s.is_line()) {
    line_crossings(s.a, s.b, y, x);
  } else {
    circle_crossings(s.center, std::abs(s.radius), y, x);
  }
}
/// All x where membership in the points within d of the segment can change.
void capsule_crossings(const Segment& s, double d, double y, std::vector<double>& x) {
  circle_crossings(s.a, d, y, x);
  circle_crossings(s.b, d, y, x);
  if (s.is_line()) {
    const Vec2 n = d * left(unit(s.b - s.a));
    line_crossings(s.a + n, s.b + n, y, x);
    line_crossings(s.a - n, s.b - n, y, x);
    return;
  }
  circle_crossings(s.center, std::abs(s.radius) + d, y, x);
  circle_crossings(s.center, std::abs(std::abs(s.radius) - d), y, x);
}

/// "" when the result is right along the line, else what is wrong.
std::string check_scan_line(const Region& region, double d, const Region& result, double y) {
  std::vector<double> x;
  for (const ArcSpline& s : region) {
    for (const Segment& g : s.segments) {
      segment_crossings(g, y, x);
      capsule_crossings(g, std::abs(d), y, x);
    }
  }
  for (const ArcSpline& s : result) {
    for (const Segment& g : s.segments) segment_crossings(g, y, x);
  }
  std::sort(x.begin(), x.end());
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    // Shorter pieces hold no point that is further than the guarantee from where something changes.
    if (x[i + 1] - x[i] < kGuarantee) continue;
    const Point2 p{0.5 * (x[i] + x[i + 1]), y};
    const double distance = boundary_distance(region, p);
    const bool inside = winding(region, p) > 0;
    const double margin = std::abs(distance - std::abs(d));
    if (margin <= kGuarantee) continue;
    const bool want = d > 0 ? inside || distance < d : inside && distance > -d;
    const int got = winding(result, p);
    if (got != (want ? 1 : 0)) {
      return "at (" + std::to_string(p.x) + ", " + std::to_string(p.y) + "): winding of the result " +
             std::to_string(got) + ", wanted " + (want ? "1" : "0") + ", distance to the input " +
             std::to_string(distance) + ", margin " + std::to_string(margin);
    }
  }
  return "";
}

std::string check_boundary(const Region& region, double d, const Region& result) {
  for (const ArcSpline& s : result) {
    if (!s.closed || s.segments.size() < 2) return "a contour that is not closed or of one segment";
    for (std::size_t i = 0; i < s.segments.size(); ++i) {
      const Segment& g = s.segments[i];
      if (!(g.b == s.segments[(i + 1) % s.segments.size()].a)) return "segments that do not meet exactly";
      if (!g.is_line()) {
        const double slack = kArcConsistency * (std::abs(g.radius) + 1) * 1e3;
        if (std::abs(distance(g.a, g.center) - std::abs(g.radius)) > slack ||
            std::abs(distance(g.b, g.center) - std::abs(g.radius)) > slack) {
          return "an arc whose ends are off its circle";
        }
      }
      for (const double f : {0.0, 0.21, 0.5, 0.83}) {
        const double off = std::abs(boundary_distance(region, point_on(g, f)) - std::abs(d));
        if (!(off <= kGuarantee)) {
          const Point2 p = point_on(g, f);
          return "a segment " + std::to_string(off) + " mm off the offset distance at (" +
                 std::to_string(p.x) + ", " + std::to_string(p.y) + ")";
        }
      }
    }
  }
  return "";
}

std::string check(const Region& region, double d, const Region& result, Random& random, int lines) {
  if (std::string wrong = check_boundary(region, d, result); !wrong.empty()) return wrong;
  Box2 box;
  std::vector<double> ys;
  for (const ArcSpline& s : region) {
    box.add(bounds_of(s));
    for (const Segment& g : s.segments) ys.push_back(g.a.y);
  }
  for (int i = 0; i < lines; ++i) {
    double y = cases::uniform(random, box.lo.y - std::abs(d), box.hi.y + std::abs(d));
    // Every third line runs close by a vertex, where corners, touches and thin webs are.
    if (i % 3 == 0) {
      y = ys[random() % ys.size()] + (i % 2 ? 1 : -1) * std::pow(10.0, cases::uniform(random, -5, -1)) +
          (i % 4 == 0 ? std::abs(d) : 0.0);
    }
    if (std::string wrong = check_scan_line(region, d, result, y); !wrong.empty()) return wrong;
  }
  return "";
}

/// Cases per family: 2500 unless BURIN_CASES says otherwise (sanitizer and debug runs use fewer).
int case_count() {
  if (const char* text = std::getenv("BURIN_CASES")) return std::max(1, std::atoi(text));
#ifdef NDEBUG
  return 2500;
#else
  return 200;
#endif
}

using Make = std::function<std::pair<Region, double>(Random&)>;

void run_family(std::uint64_t seed, const Make& make) {
  int wrong = 0;
  std::string first;
  const int count = case_count();
  for (int i = 0; i < count; ++i) {
    Random random(seed * 1000003 + static_cast<std::uint64_t>(i));
    const auto [region, d] = make(random);
    const auto result = offset_region(region, d);
    std::string what = result ? check(region, d, result->contours, random, 12) : result.error().to_string();
    if (what.empty()) continue;
    ++wrong;
    if (wrong <= 5) first += "case " + std::to_string(i) + ", d " + std::to_string(d) + ": " + what + "\n";
  }
  EXPECT_EQ(wrong, 0) << "of " << count << "\n" << first;
}

double either_side(Random& random, double d) {
  return cases::between(random, 0, 1) ? d : -d;
}

TEST(OffsetRobustness, StarsWithArcs) {
  run_family(1, [](Random& r) {
    Region region = cases::star(r);
    return std::pair{region, either_side(r, std::pow(10.0, cases::uniform(r, -2, 0.7)))};
  });
}

TEST(OffsetRobustness, RectilinearWithCoincidentOffsets) {
  run_family(2, [](Random& r) {
    const double d = cases::between(r, 0, 1) ? 0.28 : cases::uniform(r, 0.1, 2);
    const double factor = std::array{1.0, 2.0, 2.0, 4.0, 0.5}[r() % 5];
    const double dirt = std::array{0.0, 1e-13, 1e-10, 1e-8}[r() % 4];
    Region region = cases::rectilinear(r, factor * d, dirt);
    return std::pair{region, either_side(r, d)};
  });
}

TEST(OffsetRobustness, Gears) {
  run_family(3, [](Random& r) {
    Region region = cases::gear(r);
    return std::pair{region, either_side(r, std::pow(10.0, cases::uniform(r, -2, 0.5)))};
  });
}

TEST(OffsetRobustness, SlotsOfExactlyTwiceTheOffset) {
  run_family(4, [](Random& r) {
    const double d = either_side(r, std::array{0.28, 0.25, 0.1, 1.0 / 3}[r() % 4]);
    return std::pair{cases::slots(r, d), d};
  });
}

TEST(OffsetRobustness, VerticesNearlyTogether) {
  run_family(5, [](Random& r) {
    Region region = cases::near_vertices(r);
    return std::pair{region, either_side(r, std::pow(10.0, cases::uniform(r, -2, 0.5)))};
  });
}

TEST(OffsetRobustness, TheCheckItselfSeesPlantedFaults) {
  Random random(1);
  const Region square{cases::polygon({{0, 0}, {10, 0}, {10, 10}, {0, 10}})};
  const auto good = offset_region(square, 1.0);
  ASSERT_TRUE(good.ok());
  EXPECT_EQ(check(square, 1.0, good->contours, random, 30), "");
  EXPECT_NE(check(square, 1.00001, good->contours, random, 30), "");
  EXPECT_NE(check(square, 1.0, {}, random, 30), "");
  Region twice = good->contours;
  twice.push_back(twice.front());
  EXPECT_NE(check(square, 1.0, twice, random, 30), "");
}

}  // namespace
}  // namespace burin::geom
