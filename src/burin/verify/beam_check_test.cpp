// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/beam_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace burin::verify {
namespace {

using geom::ArcSpline;
using geom::Point2;
using geom::Segment;
using geom::Vec2;

constexpr double kKerf = 0.2, kRadius = 0.1;

std::vector<Segment> polygon(const std::vector<Point2>& p, bool closed = true) {
  std::vector<Segment> s;
  for (std::size_t i = 0; i + (closed ? 0 : 1) < p.size(); ++i)
    s.push_back(geom::make_line(p[i], p[(i + 1) % p.size()]));
  return s;
}
std::vector<Segment> circle(Point2 c, double r, bool ccw = true) {
  const Point2 e{c.x + r, c.y}, w{c.x - r, c.y};
  return {geom::make_arc(e, w, c, ccw), geom::make_arc(w, e, c, ccw)};
}
std::vector<Segment> box(double x0, double y0, double x1, double y1) {
  return polygon({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
}
std::vector<Segment> turned(const std::vector<Segment>& s) {
  return reversed(ArcSpline{s, true}).segments;
}
/// A convex polygon (counter-clockwise) grown by d > 0, corners rounded.
std::vector<Segment> grown(const std::vector<Point2>& p, double d) {
  std::vector<Segment> s;
  const std::size_t n = p.size();
  const auto normal = [&](std::size_t i) { return d * right(unit(p[(i + 1) % n] - p[i])); };
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 b = p[(i + 1) % n];
    s.push_back(geom::make_line(p[i] + normal(i), b + normal(i)));
    s.push_back(geom::make_arc(b + normal(i), b + normal((i + 1) % n), b, true));
  }
  return s;
}
const std::vector<Point2> kSquare{{0, 0}, {20, 0}, {20, 20}, {0, 20}};

class Path {
 public:
  Path& rapid(Point2 p) { return add(cl::Rapid{at(p)}); }
  Path& feed(Point2 p) { return add(cl::Feed{at(p)}); }
  Path& beam(bool on) { return add(cl::Beam{on, on ? 100.0 : 0.0}); }
  Path& along(const std::vector<Segment>& s) {
    for (const Segment& k : s) {
      if (k.is_line()) {
        feed(k.b);
      } else {
        add(cl::Arc{geom::at_z(k.center, 0), {0, 0, k.radius > 0 ? 1.0 : -1.0}, std::abs(k.radius), at(k.b)});
      }
    }
    return *this;
  }
  Path& cut(const std::vector<Segment>& s) { return rapid(s.front().a).beam(true).along(s).beam(false); }
  cl::Program program;

 private:
  static cl::Pose at(Point2 p) { return {geom::at_z(p, 0), {0, 0, 1}}; }
  Path& add(cl::Record r) {
    program.add(std::move(r));
    return *this;
  }
};

BeamCheckOptions options() {
  BeamCheckOptions o;
  o.kerf_mm = kKerf;
  return o;
}
BeamReport checked(const std::vector<Outline>& outlines, const cl::Program& program,
                   const BeamCheckOptions& o = options()) {
  auto report = check_beam(outlines, program, o);
  EXPECT_TRUE(report) << report.error().to_string();
  return report ? *report : BeamReport{};
}
BeamReport checked(const std::vector<std::vector<Segment>>& closed, const cl::Program& program,
                   const BeamCheckOptions& o = options()) {
  std::vector<Outline> outlines;
  for (const auto& s : closed) outlines.push_back({s, true});
  return checked(outlines, program, o);
}
void expect_clean(const BeamReport& r) {
  EXPECT_LE(r.bound_mm, 0.001);
  EXPECT_LE(r.gouge.mm, 1e-9);
  EXPECT_LE(r.excess.mm, 0.001);  // beside corners less than the bound is not looked into
  EXPECT_EQ(r.gouge_area_mm2, 0);
  EXPECT_EQ(r.excess_area_mm2, 0);
  EXPECT_EQ(r.uncut_mm, 0);
  EXPECT_TRUE(r.uncut_outlines.empty());
}

TEST(BeamCheck, ACutAtHalfTheKerfIsClean) {
  const BeamReport r = checked({polygon(kSquare)}, Path().cut(grown(kSquare, kRadius)).program);
  expect_clean(r);
  EXPECT_EQ(r.corner_excess.mm, 0);
  EXPECT_NEAR(r.outline_mm, 80, 1e-9);
  double length = 0;
  for (const BeamPlace& p : r.places) length += p.length_mm;
  EXPECT_NEAR(length, 80, 1e-9);
  expect_clean(checked({circle({5, 5}, 3), circle({5, 5}, 1, false)},
                       Path().cut(circle({5, 5}, 3.1)).cut(circle({5, 5}, 0.9, false)).program));
}

TEST(BeamCheck, TooCloseIsGougeAndTooFarIsExcessToTheMicrometre) {
  for (const double off : {-0.05, -0.002, 0.002, 0.05, 0.3}) {
    SCOPED_TRACE(off);
    BeamCheckOptions o = options();
    o.tolerance_mm = 0.001;
    const BeamReport r = checked({polygon(kSquare)}, Path().cut(grown(kSquare, kRadius + off)).program, o);
    EXPECT_LE(r.bound_mm, 0.001);
    EXPECT_NEAR(r.gouge.mm, std::max(0.0, -off), r.bound_mm);
    EXPECT_NEAR(r.excess.mm, std::max(0.0, off), r.bound_mm);
    EXPECT_NEAR(r.excess_mean_mm, std::max(0.0, off), 1e-9);
    EXPECT_NEAR(r.excess_area_mm2, std::max(0.0, 80 * off), 1e-6);
    const double g = std::max(0.0, -off);
    EXPECT_NEAR(r.gouge_area_mm2, 80 * g - 4 * g * g, 0.02 * 80 * g);
    EXPECT_EQ(r.uncut_mm, 0);
    for (const BeamPlace& p : r.places) {
      if (off > 0) {
        EXPECT_NEAR(p.deviation_mm, off, 1e-6);
      }
      // Near a corner the other edge is nearer.
      const double corner = std::min({std::abs(p.p.x), std::abs(p.p.x - 20), 1.0}) +
                            std::min({std::abs(p.p.y), std::abs(p.p.y - 20), 1.0});
      if (off < 0 && corner > 1.0) {
        EXPECT_NEAR(p.deviation_mm, off, 1e-6);
      }
    }
  }
}

TEST(BeamCheck, RoundPartsOnBothSides) {
  for (const double off : {-0.03, 0.03}) {
    SCOPED_TRACE(off);
    const double g = std::max(0.0, -off), e = std::max(0.0, off);
    const BeamReport r = checked({circle({0, 0}, 8)}, Path().cut(circle({0, 0}, 8 + kRadius + off)).program);
    EXPECT_NEAR(r.gouge.mm, g, r.bound_mm);
    EXPECT_NEAR(r.excess.mm, e, r.bound_mm);
    EXPECT_NEAR(r.gouge_area_mm2, geom::kPi * (64 - (8 - g) * (8 - g)), 0.01);
    EXPECT_NEAR(r.excess_area_mm2, geom::kPi * ((8 + e) * (8 + e) - 64), 1e-6);
    // In a hole the beam is too close when its circle is too large.
    const BeamReport h = checked({box(-20, -20, 20, 20), circle({0, 0}, 8, false)},
                                 Path()
                                     .cut(grown({{-20, -20}, {20, -20}, {20, 20}, {-20, 20}}, kRadius))
                                     .cut(circle({0, 0}, 8 - kRadius - off, false))
                                     .program);
    EXPECT_NEAR(h.gouge.mm, g, h.bound_mm);
    EXPECT_NEAR(h.excess.mm, e, h.bound_mm);
    EXPECT_NEAR(h.excess_area_mm2, geom::kPi * (64 - (8 - e) * (8 - e)), 1e-6);
    EXPECT_NEAR(h.gouge_area_mm2, geom::kPi * ((8 + g) * (8 + g) - 64), 0.01);
    EXPECT_EQ(h.uncut_mm, 0);
  }
}

TEST(BeamCheck, AnInnerCornerKeepsWhatTheBeamCannotReach) {
  const std::vector<Point2> ell{{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 20}, {0, 20}};
  const double d = kRadius;
  const std::vector<Segment> path =
      polygon({{-d, -d}, {20 + d, -d}, {20 + d, 8 + d}, {8 + d, 8 + d}, {8 + d, 20 + d}, {-d, 20 + d}});
  const BeamReport r = checked({polygon(ell)}, Path().cut(path).program);
  expect_clean(r);
  EXPECT_NEAR(r.corner_excess.mm, kRadius * (std::sqrt(2.0) - 1), 0.001);
  EXPECT_NEAR(distance(r.corner_excess.at, {8, 8}), 0, 0.001);
  // Rounded off more than it has to be, the corner counts.
  std::vector<Segment> lazy = path;
  lazy[2].b = {8 + d + 1, 8 + d};
  lazy[3] = geom::make_arc({8 + d + 1, 8 + d}, {8 + d, 8 + d + 1}, {9 + d, 9 + d}, false);
  lazy[4].a = {8 + d, 8 + d + 1};
  // The edge of the cut is a circle of 1.1 mm about (9.1, 9.1).
  const BeamReport l = checked({polygon(ell)}, Path().cut(lazy).program);
  const double fits = kRadius + options().tolerance_mm, x = 1.1 - fits;
  EXPECT_NEAR(l.excess.mm, 1.1 - std::sqrt(1.1 * 1.1 - x * x), 0.005);
  EXPECT_NEAR(l.corner_excess.mm, 1.1 * (std::sqrt(2.0) - 1), 0.002);
}

TEST(BeamCheck, WhatIsNotCutIsNamed) {
  const auto square = polygon(kSquare), hole = circle({10, 10}, 4, false);
  const BeamReport r = checked({square, hole}, Path().cut(grown(kSquare, kRadius)).program);
  EXPECT_EQ(r.uncut_outlines, std::vector<std::uint32_t>{1});
  EXPECT_NEAR(r.uncut_mm, 8 * geom::kPi, 1e-6);
  EXPECT_LE(r.excess.mm, 1e-9);
  EXPECT_LE(r.gouge.mm, 1e-9);
  // A gap of 2 mm in a straight cut leaves 2 mm less what the ends of the cuts take.
  std::vector<Segment> path = grown(kSquare, kRadius);
  path.erase(path.begin());
  Path split;
  split.rapid({11, -kRadius}).beam(true).feed({20, -kRadius}).along(path).feed({9, -kRadius}).beam(false);
  const BeamReport s = checked({square}, split.program);
  EXPECT_NEAR(s.uncut_mm, 2 - kKerf, 0.002);
  EXPECT_NEAR(s.excess.mm, kRadius, 0.01);
  EXPECT_EQ(s.uncut_outlines, std::vector<std::uint32_t>{0});
}

TEST(BeamCheck, ANeighbourBehindThePartDoesNotCutAHole) {
  // Wall of 0.5 mm between the hole and the outside: the cut outside is no cut of the hole.
  const BeamReport r = checked({box(0, 0, 10, 10), turned(box(0.5, 0.5, 9.5, 9.5))},
                               Path().cut(grown({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, kRadius)).program);
  EXPECT_EQ(r.uncut_outlines, std::vector<std::uint32_t>{1});
  EXPECT_NEAR(r.uncut_mm, 36, 0.01);
}

TEST(BeamCheck, TheBeamThroughThePartIsFoundWithItsDepthAndMove) {
  const auto square = polygon(kSquare);
  Path p;
  p.cut(grown(kSquare, kRadius));
  const auto moves = static_cast<std::uint32_t>(p.program.move_count());
  // On the way to the next cut the beam was not switched off.
  p.rapid({-5, 3}).beam(true).rapid({25, 3}).beam(false);
  const BeamReport r = checked({square}, p.program);
  EXPECT_NEAR(r.gouge.mm, 3 + kRadius, r.bound_mm);
  EXPECT_LE(r.bound_mm, 0.001);
  EXPECT_EQ(r.gouge.move, moves + 1);
  EXPECT_NEAR(r.gouge.at.y, 3 + kRadius, 0.001);
  EXPECT_NEAR(r.gouge_area_mm2, 20 * kKerf, 0.1);
  BeamCheckOptions o = options();
  o.rapids_cut = false;
  expect_clean(checked({square}, p.program, o));
}

TEST(BeamCheck, APierceInThePartIsFound) {
  Path p;
  p.cut(grown(kSquare, kRadius)).rapid({7, 9}).beam(true).beam(false);
  const BeamReport r = checked({polygon(kSquare)}, p.program);
  EXPECT_NEAR(r.gouge.mm, 7 + kRadius, r.bound_mm);
  EXPECT_LE(r.bound_mm, 0.001);
  EXPECT_NEAR(r.gouge_area_mm2, geom::kPi * kRadius * kRadius, 0.002);
}

TEST(BeamCheck, ThinWallsAreNoDeeperThanHalf) {
  // The beam is wider than the web it runs along.
  const BeamReport r =
      checked({box(0, 0, 10, 0.1)}, Path().cut(polygon({{-1, 0.05}, {11, 0.05}}, false)).program);
  EXPECT_NEAR(r.gouge.mm, 0.05, r.bound_mm);
  EXPECT_LE(r.bound_mm, 0.001);
  EXPECT_NEAR(r.gouge_area_mm2, 1, 0.01);
}

TEST(BeamCheck, AnArcWithTheWrongCentre) {
  // The slot's end is cut about a centre 0.04 mm further out: gouge there, by that much at the apex.
  const auto slot = [](double r) {
    return std::vector<Segment>{
        geom::make_line({0, -r}, {10, -r}), geom::make_arc({10, -r}, {10, r}, {10, 0}, true),
        geom::make_line({10, r}, {0, r}), geom::make_arc({0, r}, {0, -r}, {0, 0}, true)};
  };
  auto path = slot(3 + kRadius);
  expect_clean(checked({slot(3)}, Path().cut(path).program));
  const double r = 3 + kRadius, c = 9.96;
  path[1] = geom::make_arc({10, -r}, {10, r}, {c, 0}, true);
  // Through the same ends with radius hypot(0.04, r): the apex lies at c + hypot.
  const double apex = c + std::hypot(0.04, r), over = 13 + kRadius - apex;
  const BeamReport bad = checked({slot(3)}, Path().cut(path).program);
  EXPECT_NEAR(bad.gouge.mm, over, bad.bound_mm);
  EXPECT_NEAR(distance(bad.gouge.at, {13 - over, 0}), 0, 0.1);
}

TEST(BeamCheck, CentreLines) {
  const std::vector<Outline> outlines{{polygon(kSquare), true},
                                      {polygon({{3, 3}, {9, 3}, {9, 8}}, false), false}};
  Path p;
  p.cut(grown(kSquare, kRadius));
  Path good = p, beside = p;
  good.cut(polygon({{3, 3}, {9, 3}, {9, 8}}, false));
  expect_clean(checked(outlines, good.program));
  beside.cut(polygon({{3, 3.04}, {8.96, 3.04}, {8.96, 8}}, false));
  const BeamReport r = checked(outlines, beside.program);
  EXPECT_NEAR(r.excess.mm, 0.04 * std::sqrt(2.0), r.bound_mm);
  EXPECT_NEAR(r.gouge.mm, 0.04, r.bound_mm);
  EXPECT_EQ(r.uncut_mm, 0);
  const BeamReport none = checked(outlines, p.program);
  EXPECT_EQ(none.uncut_outlines, std::vector<std::uint32_t>{1});
  EXPECT_NEAR(none.uncut_mm, 11, 1e-6);
}

TEST(BeamCheck, HolesAloneArePartOfASheet) {
  const BeamReport r =
      checked({circle({0, 0}, 4, false)}, Path().cut(circle({0, 0}, 4 - kRadius, false)).program);
  expect_clean(r);
  const BeamReport wrong =
      checked({circle({0, 0}, 4, false)}, Path().cut(circle({0, 0}, 4 + kRadius, false)).program);
  EXPECT_NEAR(wrong.gouge.mm, kKerf, wrong.bound_mm);
}

TEST(BeamCheck, OutlinesThatOverlapAreOnePart) {
  const std::vector<std::vector<Segment>> two{box(0, 0, 10, 10), box(6, 4, 16, 14)};
  const double d = kRadius;
  const std::vector<Point2> around{{-d, -d},         {10 + d, -d},    {10 + d, 4 - d}, {16 + d, 4 - d},
                                   {16 + d, 14 + d}, {6 - d, 14 + d}, {6 - d, 10 + d}, {-d, 10 + d}};
  Path p;
  p.cut(polygon(around));
  const BeamReport r = checked(two, p.program);
  EXPECT_LE(r.gouge.mm, 1e-9);
  EXPECT_LE(r.excess.mm, 0.001);
  EXPECT_EQ(r.uncut_mm, 0);
  EXPECT_NEAR(r.corner_excess.mm, kRadius * (std::sqrt(2.0) - 1), 0.001);
  // Where they overlap it is part as well; depth counts from what is drawn.
  const BeamReport through = checked(two, p.rapid({8, 7}).beam(true).beam(false).program);
  EXPECT_NEAR(through.gouge.mm, 2, through.bound_mm);
}

TEST(BeamCheck, AnArcOfUnequalRadiiIsHeldAgainstItsSpiral) {
  Path p;
  p.rapid({3.1, 0}).beam(true);
  p.program.add(cl::Arc{{0, 0, 0}, {0, 0, 1}, 3.1, {{-3.11, 0, 0}, {0, 0, 1}}});
  p.program.add(cl::Arc{{0, 0, 0}, {0, 0, 1}, 3.11, {{3.1, 0, 0}, {0, 0, 1}}});
  const BeamReport r = checked({circle({0, 0}, 3)}, p.beam(false).program);
  EXPECT_NEAR(r.excess.mm, 0.01, r.bound_mm);
  EXPECT_LE(r.gouge.mm, 0.001);
}

// --- against brute force
// ---------------------------------------------------------------------------------------

struct Dice {
  std::mt19937_64 engine;
  double in(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(engine() >> 11) * 0x1p-53); }
};

/// A ring about c whose sides are lines and arcs.
std::vector<Segment> ring(Dice& dice, Point2 c, double r0, double r1, int n, bool ccw) {
  std::vector<Point2> p;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * geom::kPi * (i + dice.in(-0.25, 0.25)) / n, r = dice.in(r0, r1);
    p.push_back({c.x + r * std::cos(angle), c.y + r * std::sin(angle)});
  }
  std::vector<Segment> s = polygon(p);
  for (Segment& k : s) {
    if (dice.in(0, 1) < 0.5) k = geom::from_bulge(k.a, k.b, dice.in(-0.2, 0.2));
  }
  return ccw ? s : turned(s);
}

/// What the check claims, by looking everywhere.
struct Brute {
  std::vector<ArcSpline> outlines;
  std::vector<Segment> beam;
  double edge(Point2 p) const {
    double best = 1e9;
    for (const ArcSpline& o : outlines) best = std::min(best, distance_to(o, p));
    return best;
  }
  bool part(Point2 p) const {
    int winding = 0;
    for (const ArcSpline& o : outlines) winding += winding_number(o, p);
    return winding > 0;
  }
  bool swept(Point2 p) const {
    return std::any_of(beam.begin(), beam.end(),
                       [&](const Segment& s) { return nearest_on(s, p).distance <= kRadius; });
  }
};

struct Case {
  std::vector<Outline> outlines;
  Brute brute;
  cl::Program program;
};
/// A part with a hole; around it a beam that strays, and one that crosses everything.
Case random_case(std::uint64_t seed) {
  Dice dice{std::mt19937_64(seed)};
  Case c;
  Path path;
  for (const bool outer : {true, false}) {
    const double r = outer ? 3 : 1.2;
    const auto outline = ring(dice, {0, 0}, 0.8 * r, r, outer ? 9 : 6, outer);
    c.outlines.push_back({outline, true});
    c.brute.outlines.push_back({outline, true});
    // The corners moved out by about the radius, joined as the outline's are.
    std::vector<Segment> way = outline;
    for (std::size_t i = 0; i < way.size(); ++i) {
      Segment& s = way[i];
      const auto out = [&](const Segment& k) {
        return k.a + (kRadius + dice.in(-0.03, 0.06)) * right(start_tangent(k));
      };
      const Point2 a = i == 0 ? out(s) : way[i - 1].b;
      const Point2 b = i + 1 < way.size() ? out(outline[i + 1]) : way[0].a;
      s = geom::from_bulge(a, b, geom::bulge_of(s));
    }
    path.cut(way);
    c.brute.beam.insert(c.brute.beam.end(), way.begin(), way.end());
  }
  if (seed % 3 == 0) {
    const Point2 a{-4, dice.in(-2, 2)}, b{4, dice.in(-2, 2)};
    path.rapid(a).beam(true).rapid(b).beam(false);
    c.brute.beam.push_back(geom::make_line(a, b));
  }
  c.program = path.program;
  return c;
}

TEST(BeamCheck, AgreesWithLookingEverywhere) {
  constexpr double kStep = 0.02;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    const Case c = random_case(seed);
    BeamCheckOptions o = options();
    o.spacing_mm = 0.1;
    const BeamReport r = checked(c.outlines, c.program, o);
    EXPECT_LE(r.bound_mm, 0.001);
    double deepest = 0, area = 0;
    for (double x = -4; x < 4; x += kStep) {
      for (double y = -4; y < 4; y += kStep) {
        const Point2 p{x, y};
        if (!c.brute.swept(p) || !c.brute.part(p)) continue;
        deepest = std::max(deepest, c.brute.edge(p));
        area += kStep * kStep;
      }
    }
    EXPECT_GE(r.gouge.mm, deepest - r.bound_mm);
    EXPECT_LE(r.gouge.mm, deepest + kStep);
    EXPECT_NEAR(r.gouge_area_mm2, area, 0.06 * area + 0.02);
    EXPECT_TRUE(r.gouge.mm == 0 || c.brute.part(r.gouge.at));
    EXPECT_NEAR(c.brute.edge(r.gouge.at), r.gouge.mm, 1e-6);
    // The places, one by one, and places between them.
    constexpr double kMarch = 0.002;
    const auto march = [&](Point2 p, Vec2 n) {
      for (double s = 0; s <= options().reach_mm; s += kMarch) {
        if (c.brute.swept(p + s * n)) return s;
        if (s > 0.01 && c.brute.part(p + s * n)) return -1.0;
      }
      return -1.0;
    };
    std::size_t compared = 0;
    for (std::size_t i = 0; i < r.places.size(); i += 2) {
      const BeamPlace& place = r.places[i];
      if (place.corner || place.deviation_mm < o.bound_mm) continue;  // gouged, or touched
      const double s = march(place.p, place.n);
      EXPECT_EQ(s < 0, std::isnan(place.deviation_mm)) << i;
      if (s >= 0 && !std::isnan(place.deviation_mm)) {
        EXPECT_NEAR(place.deviation_mm, s, 2 * kMarch) << i;
      }
      ++compared;
    }
    EXPECT_GT(compared, 10U);
    const double fits = kRadius + options().tolerance_mm;
    for (const Outline& outline : c.outlines) {
      for (const Segment& s : outline.segments) {
        for (double f = 0.005; f < 1; f += 0.01) {
          const Point2 p = point_on(s, f);
          const Vec2 n = s.is_line() ? right(start_tangent(s)) : (s.radius > 0 ? 1 : -1) * unit(p - s.center);
          if (c.brute.edge(p + fits * n) < fits - 1e-4) continue;  // a corner
          const double e = march(p, n);
          EXPECT_TRUE(e < 0 ? r.uncut_mm > 0 : e <= r.excess.mm + r.bound_mm + kMarch) << p.x << ' ' << p.y;
        }
      }
    }
  }
}

TEST(BeamCheck, ThreadsAndOrderChangeNothing) {
  const Case c = random_case(3);
  BeamCheckOptions o = options();
  const BeamReport a = checked(c.outlines, c.program, o);
  o.threads = 2;
  const BeamReport b = checked(c.outlines, c.program, o);
  EXPECT_EQ(a.gouge.mm, b.gouge.mm);
  EXPECT_EQ(a.excess.mm, b.excess.mm);
  EXPECT_EQ(a.gouge_area_mm2, b.gouge_area_mm2);
  EXPECT_EQ(a.excess_area_mm2, b.excess_area_mm2);
  ASSERT_EQ(a.places.size(), b.places.size());
  for (std::size_t i = 0; i < a.places.size(); ++i) {
    EXPECT_EQ(a.places[i].p, b.places[i].p);
    EXPECT_TRUE(a.places[i].deviation_mm == b.places[i].deviation_mm || std::isnan(a.places[i].deviation_mm));
  }
}

TEST(BeamCheck, WrongInputIsRefused) {
  const auto code = [](const std::vector<Outline>& outlines, const cl::Program& program,
                       const BeamCheckOptions& o) {
    const auto r = check_beam(outlines, program, o);
    EXPECT_FALSE(r);
    return r ? ErrorCode::internal : r.error().code;
  };
  const std::vector<Outline> square{{polygon(kSquare), true}};
  const cl::Program good = Path().cut(grown(kSquare, kRadius)).program;
  BeamCheckOptions o;
  EXPECT_EQ(code(square, good, o), ErrorCode::range);
  EXPECT_EQ(code({}, good, options()), ErrorCode::geometry);
  auto gap = square;
  gap[0].segments.pop_back();
  EXPECT_EQ(code(gap, good, options()), ErrorCode::geometry);
  auto nan = square;
  nan[0].segments[1].b.x = std::nan("");
  EXPECT_EQ(code(nan, good, options()), ErrorCode::geometry);
  Path lost, tilted;
  lost.rapid({0, 0}).beam(true).feed({INFINITY, 0});
  EXPECT_EQ(code(square, lost.program, options()), ErrorCode::range);
  tilted.rapid({0, 0}).beam(true);
  tilted.program.add(cl::Arc{{1, 0, 0}, {0, 1, 0}, 1, {{2, 0, 0}, {0, 0, 1}}});
  EXPECT_EQ(code(square, tilted.program, options()), ErrorCode::geometry);
  o = options();
  o.spacing_mm = 1e-9;
  EXPECT_EQ(code(square, good, o), ErrorCode::range);
  const BeamReport idle = checked(square, {});
  EXPECT_NEAR(idle.uncut_mm, 80, 1e-9);
}

}  // namespace
}  // namespace burin::verify
