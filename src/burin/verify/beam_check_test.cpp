// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/beam_check.h"

#include <gtest/gtest.h>

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
  EXPECT_LE(r.excess.mm, 0.0005);  // half the bound: beside corners less is not looked into
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

TEST(BeamCheck, AnArcOfUnequalRadiiIsHeldAgainstItsSpiral) {
  Path p;
  p.rapid({3.1, 0}).beam(true);
  p.program.add(cl::Arc{{0, 0, 0}, {0, 0, 1}, 3.1, {{-3.11, 0, 0}, {0, 0, 1}}});
  p.program.add(cl::Arc{{0, 0, 0}, {0, 0, 1}, 3.11, {{3.1, 0, 0}, {0, 0, 1}}});
  const BeamReport r = checked({circle({0, 0}, 3)}, p.beam(false).program);
  EXPECT_NEAR(r.excess.mm, 0.01, r.bound_mm);
  EXPECT_LE(r.gouge.mm, 0.001);
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
