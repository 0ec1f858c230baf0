// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/path_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "burin/base/text.h"
#include "burin/io/svg/svg_test_util.h"

namespace burin::io::svg {
namespace {

using geom::Point2;
using svg_test::expect_point;

constexpr std::size_t kMany = 100000;

Outline parsed(std::string_view data) {
  auto outline = parse_path_data(data, kMany);
  EXPECT_TRUE(outline.ok()) << data << ": " << (outline.ok() ? "" : outline.error().message);
  return outline.ok() ? *outline : Outline{};
}

std::string refusal(std::string_view data) {
  const auto outline = parse_path_data(data, kMany);
  EXPECT_FALSE(outline.ok()) << data;
  if (outline.ok()) return "";
  EXPECT_EQ(outline.error().code, ErrorCode::syntax);
  return outline.error().message;
}

/// Ends of all curves, starting with the first start: what a chain of lines goes through.
std::vector<Point2> corners(const Path& path) {
  std::vector<Point2> points{geom::start_point(path.curves.front())};
  for (const geom::Curve2& curve : path.curves) points.push_back(geom::end_point(curve));
  return points;
}

TEST(PathData, LinesAbsoluteRelativeAndRepeated) {
  const std::vector<Point2> expected{{1, 2}, {3, 4}, {5, 4}, {5, 7}};
  for (const char* data :
       {"M1,2 L3,4 H5 V7", "m1,2 l2,2 h2 v3", "M1 2 3 4 5 4 5 7", "m1 2 2 2 2 0 0 3", "M1 2L3 4 5 4 5 7",
        " \n M 1 , 2\tl 2 2 H 4 5 v 1 2", "M+1 2e0L.3e1 4. H 5.0 V 70e-1"}) {
    const Outline outline = parsed(data);
    ASSERT_EQ(outline.paths.size(), 1u) << data;
    EXPECT_FALSE(outline.paths[0].closed);
    std::vector<Point2> points = corners(outline.paths[0]);
    // "H 4 5 v 1 2" stops on the way at points of the same lines.
    points.erase(std::remove_if(points.begin(), points.end(),
                                [](Point2 p) {
                                  return p == Point2{4, 4} || p == Point2{5, 5};
                                }),
                 points.end());
    EXPECT_EQ(points, expected) << data;
  }
}

TEST(PathData, CompactNumbers) {
  const Outline outline = parsed("M1.5.5-3-.25L1e1-2E-1");
  const std::vector<Point2> expected{{1.5, 0.5}, {-3, -0.25}, {10, -0.2}};
  ASSERT_EQ(outline.paths.size(), 1u);
  EXPECT_EQ(corners(outline.paths[0]), expected);
}

TEST(PathData, ArcFlagsNeedNoSeparators) {
  const Outline spaced = parsed("M0 0 a1 1 0 0 0 0.5 0.5 a 1 1 0 0 1 2 3");
  for (const char* data : {"M0 0a1 1 0 00.5.5a1 1 0 012 3", "M0,0a1,1,0,0,0,.5,.5a1,1,0,0,1,2,3",
                           "M0 0a1 1 0 00.5.5 1 1 0 012 3"}) {
    svg_test::expect_same(parsed(data).paths, spaced.paths, 0);
  }
}

TEST(PathData, BezierDegreesAndSmoothControls) {
  const Outline outline = parsed("M0 0 C1 2 3 4 5 6 S9 8 10 10 Q12 12 14 10 T18 10 t4 1 s1 1 2 0");
  const auto& curves = outline.paths.at(0).curves;
  ASSERT_EQ(curves.size(), 6u);
  const auto points = [&](std::size_t i) { return std::get<geom::Nurbs2>(curves.at(i)).points; };
  EXPECT_EQ(points(0), (std::vector<Point2>{{0, 0}, {1, 2}, {3, 4}, {5, 6}}));
  EXPECT_EQ(points(1), (std::vector<Point2>{{5, 6}, {7, 8}, {9, 8}, {10, 10}}));
  EXPECT_EQ(points(2), (std::vector<Point2>{{10, 10}, {12, 12}, {14, 10}}));
  EXPECT_EQ(points(3), (std::vector<Point2>{{14, 10}, {16, 8}, {18, 10}}));
  EXPECT_EQ(points(4), (std::vector<Point2>{{18, 10}, {20, 12}, {22, 11}}));
  // After a quadratic, s starts with the current point.
  EXPECT_EQ(points(5), (std::vector<Point2>{{22, 11}, {22, 11}, {23, 12}, {24, 11}}));
  EXPECT_EQ(std::get<geom::Nurbs2>(curves[0]).degree, 3);
  EXPECT_EQ(std::get<geom::Nurbs2>(curves[2]).degree, 2);
  for (const geom::Curve2& curve : curves) EXPECT_TRUE(geom::validate(curve).ok());
}

TEST(PathData, ControlPointsOnTheEndsGiveALine) {
  const Outline outline = parsed("M0 0 C0 0 4 2 4 2 C4 2 4 2 8 2 Q8 2 9 9 C 12 9 10 9 13 9");
  const auto& curves = outline.paths.at(0).curves;
  ASSERT_EQ(curves.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(std::holds_alternative<geom::Line2>(curves[i])) << i;
  EXPECT_TRUE(std::holds_alternative<geom::Nurbs2>(curves[3]));
}

TEST(PathData, ClosingAddsTheLineAndGoesOnFromTheStart) {
  const Outline outline = parsed("M1 1 H3 V3 z l1 1 m5 5 h1 Z M9 9 L9 8 L9 9 z");
  ASSERT_EQ(outline.paths.size(), 4u);
  EXPECT_TRUE(outline.paths[0].closed);
  EXPECT_EQ(corners(outline.paths[0]), (std::vector<Point2>{{1, 1}, {3, 1}, {3, 3}, {1, 1}}));
  EXPECT_FALSE(outline.paths[1].closed);
  EXPECT_EQ(corners(outline.paths[1]), (std::vector<Point2>{{1, 1}, {2, 2}}));
  EXPECT_EQ(corners(outline.paths[2]), (std::vector<Point2>{{7, 7}, {8, 7}, {7, 7}}));
  EXPECT_EQ(outline.paths[3].curves.size(), 2u);  // already closed: no line of zero length
}

TEST(PathData, RoundingOfRelativeCoordinatesGivesNoClosingLine) {
  const Outline outline = parsed("m0.1,0.2 l0.1,0 0,0.1 0.1,0.2 -0.2,-0.3 z");
  ASSERT_EQ(outline.paths.size(), 1u);
  EXPECT_EQ(outline.paths[0].curves.size(), 4u);
  EXPECT_EQ(geom::end_point(outline.paths[0].curves.back()),
            geom::start_point(outline.paths[0].curves.front()));
  // A gap that the file does state is a line.
  EXPECT_EQ(parsed("m0.1,0.2 l0.1,0 0,0.1 -0.1,-0.099999 z").paths[0].curves.size(), 4u);
}

TEST(PathData, PointsAreDroppedAndCounted) {
  for (const char* data :
       {"M1 1", "M1 1 z", "M1 1 L1 1 z", "M1 1 A5 5 0 1 1 1 1", "m1 1 h0 v0 c0 0 0 0 0 0"}) {
    EXPECT_TRUE(parsed(data).paths.empty()) << data;
    EXPECT_EQ(parsed(data).points_dropped, 1) << data;
  }
  const Outline outline = parsed("M0 0 L0 0 L5 0 L5 0 z M2 2 M3 3 L4 4");
  EXPECT_EQ(outline.points_dropped, 1);
  ASSERT_EQ(outline.paths.size(), 2u);
  EXPECT_EQ(outline.paths[0].curves.size(), 2u);
  EXPECT_TRUE(parsed("").paths.empty());
  EXPECT_TRUE(parsed(" \n").paths.empty());
}

TEST(PathData, DamageIsRefusedWithItsPosition) {
  EXPECT_NE(refusal("M0 0 L10").find("character 9"), std::string::npos);
  EXPECT_NE(refusal("M0 0 L1 1 x 5 5").find("character 11"), std::string::npos);
  EXPECT_NE(refusal("L1 1").find("starts with M"), std::string::npos);
  EXPECT_NE(refusal("5 5").find("starts with M"), std::string::npos);
  EXPECT_NE(refusal("M0 0 A1 1 0 2 0 5 5").find("flag"), std::string::npos);
  for (const char* data :
       {"M", "M1", "M0 0 C1 1 2 2", "M0 0 L1 1,", "M0 0,,1 1", "M0 0 L1 nan", "M0 0 L1 1e999", "M0 0 Z 5 5",
        "M0 0 A1 1 0 0", "M0 0 H", "M0 0 L1 -", "M0 0 L. 1", "M0 0;L1 1"}) {
    EXPECT_FALSE(refusal(data).empty()) << data;
  }
}

TEST(PathData, LimitOfCurves) {
  std::string data = "M0 0";
  for (int i = 1; i < 50; ++i) data += " " + std::to_string(i) + " 0";
  EXPECT_TRUE(parse_path_data(data, 49).ok());
  const auto refused = parse_path_data(data, 48);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::range);
}

// --- arcs
// -----------------------------------------------------------------------------------------------------

/// Distance of a point from the ellipse in units of its radii: |(x/rx, y/ry)| - 1 in the rotated frame.
double off_ellipse(Point2 p, Point2 center, double rx, double ry, double rotation_deg) {
  const double phi = geom::radians(rotation_deg);
  const geom::Vec2 d = p - center;
  const double x = (std::cos(phi) * d.x + std::sin(phi) * d.y) / rx;
  const double y = (-std::sin(phi) * d.x + std::cos(phi) * d.y) / ry;
  return std::hypot(x, y) - 1;
}

Point2 center_of(const geom::Curve2& curve) {
  const auto* arc = std::get_if<geom::Arc2>(&curve);
  return arc != nullptr ? arc->center : std::get<geom::EllipseArc2>(curve).center;
}

double sweep_of(const geom::Curve2& curve) {
  const auto* arc = std::get_if<geom::Arc2>(&curve);
  return arc != nullptr ? arc->sweep : std::get<geom::EllipseArc2>(curve).sweep;
}

TEST(Arc, FourFlagsOfAQuarterCircle) {
  // From (10, 0) to (0, 10) with radius 10: the centres are (0, 0) and (10, 10).
  struct Case {
    bool large, sweep;
    Point2 center;
    double turn;
  };
  constexpr double kQuarter = geom::kPi / 2;
  for (const Case& c : {Case{false, true, {0, 0}, kQuarter}, Case{true, false, {0, 0}, -3 * kQuarter},
                        Case{false, false, {10, 10}, -kQuarter}, Case{true, true, {10, 10}, 3 * kQuarter}}) {
    const geom::Curve2 curve = arc_between({10, 0}, {0, 10}, 10, 10, 0, c.large, c.sweep);
    const auto& arc = std::get<geom::Arc2>(curve);
    expect_point(arc.center, c.center.x, c.center.y, 1e-12);
    EXPECT_NEAR(arc.radius, 10, 1e-12);
    EXPECT_NEAR(arc.sweep, c.turn, 1e-12);
    expect_point(geom::start_point(curve), 10, 0, 1e-12);
    expect_point(geom::end_point(curve), 0, 10, 1e-12);
  }
}

TEST(Arc, RandomEllipsesMeetTheirEndsAndFlags) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(-10, 10), radius(0.1, 30), angle(-400, 400);
  for (int i = 0; i < 5000; ++i) {
    const Point2 from{place(random), place(random)}, to{place(random), place(random)};
    const double rx = radius(random), ry = i % 3 == 0 ? rx : radius(random), rotation = angle(random);
    const bool large = (random() & 1) != 0, sweep = (random() & 1) != 0;
    const geom::Curve2 curve = arc_between(from, to, rx, ry, rotation, large, sweep);
    ASSERT_TRUE(geom::validate(curve).ok());
    EXPECT_EQ(std::holds_alternative<geom::Arc2>(curve), rx == ry);
    expect_point(geom::start_point(curve), from.x, from.y, 1e-10);
    expect_point(geom::end_point(curve), to.x, to.y, 1e-10);
    EXPECT_EQ(sweep_of(curve) > 0, sweep);
    // F.6.6: the radii grow together when the chord is too long for them.
    const Point2 middle = lerp(from, to, 0.5);
    const double needed = off_ellipse(from, middle, rx, ry, rotation) + 1;
    const double grow = std::max(1.0, needed);
    for (int k = 0; k <= 8; ++k) {
      const Point2 p = geom::point_at(curve, k / 8.0);
      EXPECT_NEAR(off_ellipse(p, center_of(curve), rx * grow, ry * grow, rotation), 0, 1e-10);
    }
    if (needed > 1) {
      expect_point(center_of(curve), middle.x, middle.y, 1e-10);
      EXPECT_NEAR(std::abs(sweep_of(curve)), geom::kPi, 1e-10);
    } else {
      EXPECT_EQ(std::abs(sweep_of(curve)) > geom::kPi, large);
    }
  }
}

TEST(Arc, ZeroRadiusIsALineAndNegativeRadiiCountPositive) {
  EXPECT_TRUE(std::holds_alternative<geom::Line2>(arc_between({0, 0}, {1, 1}, 0, 5, 0, true, true)));
  EXPECT_TRUE(std::holds_alternative<geom::Line2>(arc_between({0, 0}, {1, 1}, 5, 0, 0, true, true)));
  EXPECT_EQ(arc_between({0, 0}, {1, 1}, -5, 3, 20, false, true),
            arc_between({0, 0}, {1, 1}, 5, 3, 20, false, true));
}

TEST(Arc, TinyChordOnALargeCircle) {
  const Point2 from{100, 0}, to{100, 1e-7};
  const geom::Curve2 small = arc_between(from, to, 50, 50, 0, false, true);
  const geom::Curve2 whole = arc_between(from, to, 50, 50, 0, true, false);
  expect_point(geom::end_point(small), to.x, to.y, 1e-11);
  expect_point(geom::end_point(whole), to.x, to.y, 1e-11);
  EXPECT_NEAR(geom::length(small), 1e-7, 1e-12);
  EXPECT_NEAR(geom::length(whole), 100 * geom::kPi, 1e-6);
}

// --- metamorphic
// -------------------------------------------------------------------------------------------------

struct RandomPath {
  std::string absolute, relative;
};

/// The same path twice. Coordinates are multiples of 1/64, so that sums are exact and both give equal
/// numbers.
RandomPath random_path(std::mt19937_64& random) {
  const auto number = [&] { return static_cast<double>(static_cast<int>(random() % 2001) - 1000) / 64.0; };
  RandomPath path;
  Point2 current, start;
  const auto put = [&](char letter, int points) {
    path.absolute += letter;
    path.relative += static_cast<char>(letter - 'A' + 'a');
    Point2 last = current;
    for (int i = 0; i < points; ++i) {
      last = {number(), number()};
      path.absolute += " " + format_shortest(last.x) + "," + format_shortest(last.y);
      path.relative += " " + format_shortest(last.x - current.x) + "," + format_shortest(last.y - current.y);
    }
    current = last;
  };
  put('M', 1);
  start = current;
  for (int i = 0; i < 12; ++i) {
    switch (random() % 8) {
      case 0:
        put('M', 1), start = current;
        break;
      case 1:
        put('C', 3);
        break;
      case 2:
        put('S', 2);
        break;
      case 3:
        put('Q', 2);
        break;
      case 4:
        put('T', 1);
        break;
      case 5:
        put('L', 1);
        break;
      case 6:
        path.absolute += "Z", path.relative += "z", current = start;
        break;
      default: {
        const std::string arc = " " + format_shortest(number()) + " 7 " + format_shortest(number()) +
                                (random() & 1 ? " 01" : " 1,0");
        const Point2 to{number(), number()};
        path.absolute += "A" + arc + " " + format_shortest(to.x) + " " + format_shortest(to.y);
        path.relative +=
            "a" + arc + " " + format_shortest(to.x - current.x) + " " + format_shortest(to.y - current.y);
        current = to;
      }
    }
  }
  return path;
}

TEST(PathData, RelativeAndAbsoluteGiveTheSameCurves) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 500; ++i) {
    const RandomPath path = random_path(random);
    const Outline a = parsed(path.absolute), b = parsed(path.relative);
    ASSERT_EQ(a.paths.size(), b.paths.size()) << path.absolute;
    for (std::size_t k = 0; k < a.paths.size(); ++k) {
      EXPECT_EQ(a.paths[k].curves, b.paths[k].curves) << path.absolute << "\n" << path.relative;
      EXPECT_EQ(a.paths[k].closed, b.paths[k].closed);
    }
  }
}

TEST(PathData, CurvesOfAPathAreConnected) {
  std::mt19937_64 random(12);
  for (int i = 0; i < 500; ++i) {
    const Outline outline = parsed(random_path(random).relative);
    for (const Path& path : outline.paths) {
      for (std::size_t k = 1; k < path.curves.size(); ++k) {
        EXPECT_LT(distance(geom::end_point(path.curves[k - 1]), geom::start_point(path.curves[k])), 1e-9);
      }
      if (path.closed) {
        EXPECT_LT(distance(geom::end_point(path.curves.back()), geom::start_point(path.curves.front())),
                  1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace burin::io::svg
