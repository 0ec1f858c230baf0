// SPDX-License-Identifier: Apache-2.0
// Joining: drawings that are cut up, shuffled, reversed, moved a little and drawn twice give the same
// contours again.
#include "burin/plan/laser/contours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace burin::laser {
namespace {

using geom::Arc2;
using geom::Curve2;
using geom::kPi;
using geom::Line2;
using geom::Point2;

io::Entity entity(const char* kind, std::vector<Curve2> curves, bool closed = false,
                  const std::string& layer = "0") {
  io::Entity e;
  e.kind = kind;
  e.layer = layer;
  e.paths.push_back({std::move(curves), closed});
  return e;
}

io::Drawing drawing_of(std::vector<io::Entity> entities) {
  io::Drawing drawing;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    entities[i].id = std::to_string(i);
    drawing.entities.push_back(std::move(entities[i]));
  }
  drawing.layers = {"0"};
  return drawing;
}

io::Drawing loose(const std::vector<Curve2>& curves) {
  std::vector<io::Entity> entities;
  for (const Curve2& curve : curves) entities.push_back(entity(curve.index() == 0 ? "LINE" : "ARC", {curve}));
  return drawing_of(std::move(entities));
}

struct Joined {
  std::vector<Contour> contours;
  Diagnostics diagnostics;
  std::size_t count(const char* code) const { return diagnostics.count(code); }
  std::size_t closed() const {
    return static_cast<std::size_t>(
        std::count_if(contours.begin(), contours.end(), [](const Contour& c) { return c.closed; }));
  }
};

double end_gap(const Contour& c, std::size_t i) {  // largest distance of joint i from the drawn ends there
  double gap = 0;
  if (i < c.curves.size()) gap = std::max(gap, geom::distance(c.joints[i], geom::start_point(c.curves[i])));
  if (i > 0) gap = std::max(gap, geom::distance(c.joints[i], geom::end_point(c.curves[i - 1])));
  if (i == 0 && c.closed) gap = std::max(gap, geom::distance(c.joints[0], geom::end_point(c.curves.back())));
  return gap;
}

/// Joins, and checks what holds for every result.
Joined join(const io::Drawing& drawing, const LaserOptions& options = {}) {
  Joined joined;
  auto result = join_contours(drawing, options, joined.diagnostics);
  EXPECT_TRUE(result.ok()) << result.error().to_string();
  if (!result.ok()) return joined;
  joined.contours = std::move(*result);
  const double most = 0.5 * options.tolerance.join_mm + 1e-9;
  for (const Contour& c : joined.contours) {
    EXPECT_FALSE(c.curves.empty());
    EXPECT_EQ(c.curves.size(), c.entity.size());
    EXPECT_EQ(c.joints.size(), c.curves.size() + (c.closed ? 0 : 1));
    for (std::size_t i = 0; i < c.joints.size(); ++i) EXPECT_LE(end_gap(c, i), most);
    for (const Curve2& curve : c.curves) EXPECT_TRUE(geom::validate(curve).ok());
  }
  for (std::size_t i = 0; i + 1 < joined.contours.size(); ++i) {
    const auto first = [](const Contour& c) { return *std::min_element(c.entity.begin(), c.entity.end()); };
    EXPECT_LE(first(joined.contours[i]), first(joined.contours[i + 1]));
  }
  return joined;
}

/// Twice the signed area under a contour, from many chords: does not depend on the start.
double area(const Contour& c) {
  double sum = 0;
  for (const Curve2& curve : c.curves) {
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i) {
      const Point2 p = geom::point_at(curve, static_cast<double>(i) / kSteps);
      const Point2 q = geom::point_at(curve, static_cast<double>(i + 1) / kSteps);
      sum += 0.5 * (p.x * q.y - q.x * p.y);
    }
  }
  return sum;
}

double total_length(const Joined& joined) {
  double sum = 0;
  for (const Contour& c : joined.contours) {
    for (const Curve2& curve : c.curves) sum += geom::length(curve);
  }
  return sum;
}

std::vector<Curve2> rectangle(double x0, double y0, double x1, double y1) {
  const Point2 p[] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  return {Line2{p[0], p[1]}, Line2{p[1], p[2]}, Line2{p[2], p[3]}, Line2{p[3], p[0]}};
}

void append(std::vector<Curve2>& to, const std::vector<Curve2>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// A closed chain of lines and arcs around `center`: a star-shaped polygon with n corners, some sides bulged.
std::vector<Curve2> blob(std::mt19937& random, Point2 center, double radius, int n) {
  std::uniform_real_distribution<double> r(0.5 * radius, radius), bulge(-0.3, 0.3);
  std::vector<Point2> corners;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * kPi * i / n, d = r(random);
    corners.push_back({center.x + d * std::cos(angle), center.y + d * std::sin(angle)});
  }
  std::vector<Curve2> curves;
  for (int i = 0; i < n; ++i) {
    const Point2 a = corners[static_cast<std::size_t>(i)], b = corners[static_cast<std::size_t>((i + 1) % n)];
    const double k = i % 3 == 0 ? bulge(random) : 0;
    if (std::abs(k) < 0.05) {
      curves.emplace_back(Line2{a, b});
      continue;
    }
    const geom::Vec2 chord = b - a;  // bulge = tan(sweep / 4)
    const Point2 middle = geom::lerp(a, b, 0.5) + ((1 - k * k) / (4 * k)) * geom::left(chord);
    const geom::Vec2 from = a - middle;
    curves.emplace_back(Arc2{middle, geom::norm(from), std::atan2(from.y, from.x), 4 * std::atan(k)});
  }
  return curves;
}

Curve2 moved(const Curve2& curve, geom::Vec2 by) {
  return geom::transformed({1, 0, 0, 1, by.x, by.y}, curve);
}

TEST(Join, OneClosedCurveIsAContour) {
  const Joined joined = join(drawing_of({entity("CIRCLE", {Arc2{{3, 4}, 5, 0, 2 * kPi}}, true),
                                         entity("ARC", {Arc2{{30, 4}, 5, 1, -2 * kPi}}, false)}));
  ASSERT_EQ(joined.contours.size(), 2U);
  EXPECT_EQ(joined.closed(), 2U);
  EXPECT_EQ(joined.contours[0].joints.size(), 1U);
  EXPECT_TRUE(joined.diagnostics.empty());
}

TEST(Join, ClosedPolylineStaysAsDrawn) {
  const std::vector<Curve2> drawn = rectangle(0, 0, 10, 5);
  const Joined joined = join(drawing_of({entity("LWPOLYLINE", drawn, true)}));
  ASSERT_EQ(joined.contours.size(), 1U);
  EXPECT_TRUE(joined.contours[0].closed);
  EXPECT_EQ(joined.contours[0].curves, drawn);
  EXPECT_TRUE(joined.diagnostics.empty());
}

TEST(Join, ShuffledReversedJitteredPiecesGiveTheContoursBack) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    std::mt19937 random(seed);
    const double jitter =
        seed % 3 == 0 ? 0 : 0.0049 / 2 / std::sqrt(2.0);  // two ends: 0.0049 mm apart at most
    std::uniform_real_distribution<double> shift(-jitter, jitter);
    std::vector<double> areas;
    std::vector<Curve2> curves;
    for (int k = 0; k < 9; ++k) {
      const auto chain =
          blob(random, {100.0 * (k % 3), 100.0 * (k / 3)}, 40, 3 + static_cast<int>(random() % 30));
      areas.push_back(std::abs(area({chain, {}, {}, true, Treatment::cut})));
      append(curves, chain);
    }
    for (Curve2& curve : curves) {
      if (random() % 2) curve = geom::reversed(curve);
      curve = moved(curve, {shift(random), shift(random)});
    }
    std::shuffle(curves.begin(), curves.end(), random);
    const Joined joined = join(loose(curves));
    ASSERT_EQ(joined.contours.size(), 9U) << seed;
    ASSERT_EQ(joined.closed(), 9U) << seed;
    EXPECT_EQ(joined.count("ends_joined"), jitter > 0 ? 9U : 0U);
    EXPECT_EQ(joined.count("branch_point") + joined.count("open_chain"), 0U);
    std::vector<double> found;
    for (const Contour& c : joined.contours) found.push_back(std::abs(area(c)));
    std::sort(found.begin(), found.end());
    std::sort(areas.begin(), areas.end());
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(found[i], areas[i], 2.0);  // 240 mm round, moved by 0.005
  }
}

TEST(Join, DirectionAndStartAreThoseOfTheFirstDrawnCurve) {
  auto curves = rectangle(0, 0, 10, 5);
  std::swap(curves[0], curves[2]);
  for (const bool turned : {false, true}) {
    if (turned) curves[0] = geom::reversed(curves[0]);
    const Joined joined = join(loose(curves));
    ASSERT_EQ(joined.contours.size(), 1U);
    EXPECT_EQ(joined.contours[0].curves[0], curves[0]);
    EXPECT_EQ(area(joined.contours[0]) > 0, !turned);
  }
}

TEST(Join, GapAboveToleranceStaysOpenAndIsReported) {
  auto curves = rectangle(0, 0, 10, 5);
  curves[3] = Line2{{0, 5}, {0, 0.0101}};
  const Joined joined = join(loose(curves));
  ASSERT_EQ(joined.contours.size(), 1U);
  EXPECT_FALSE(joined.contours[0].closed);
  ASSERT_EQ(joined.count("open_chain"), 1U);
  const Warning& warning = joined.diagnostics.warnings()[0];
  EXPECT_EQ(warning.severity, Severity::left_out);
  EXPECT_EQ(warning.where.entity, "LINE 0");
  ASSERT_TRUE(warning.position_mm);
  EXPECT_EQ((*warning.position_mm)[0], 0);
  EXPECT_EQ((*warning.position_mm)[1], 0);
  EXPECT_NE(warning.message.find("(0, 0.0101)"), std::string::npos) << warning.message;
  EXPECT_NE(warning.message.find("0.0101 mm"), std::string::npos);
  curves[3] = Line2{{0, 5}, {0, 0.0099}};
  const Joined near = join(loose(curves));
  EXPECT_EQ(near.closed(), 1U);
  ASSERT_EQ(near.count("ends_joined"), 1U);
  EXPECT_NEAR((*near.diagnostics.warnings()[0].position_mm)[1], 0.0099 / 2, 1e-12);
}

TEST(Join, ZeroLengthIsDroppedAndReported) {
  auto curves = rectangle(0, 0, 10, 5);
  curves.insert(curves.begin() + 2, Line2{{7, 7}, {7, 7}});
  const Joined joined = join(loose(curves));
  EXPECT_EQ(joined.contours.size(), 1U);
  ASSERT_EQ(joined.count("zero_length"), 1U);
  EXPECT_EQ(joined.diagnostics.warnings()[0].where.entity, "LINE 2");
  EXPECT_EQ((*joined.diagnostics.warnings()[0].position_mm)[0], 7);
}

TEST(Join, DuplicatesInEitherDirectionVanish) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> noise(-3e-7, 3e-7);
    std::vector<Curve2> curves = blob(random, {5, 5}, 40, 12);
    const double length = total_length(join(loose(curves)));
    const std::size_t n = curves.size();
    std::size_t added = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (auto k = random() % 3; k > 0; --k, ++added) {
        const Curve2 copy = random() % 2 ? geom::reversed(curves[i]) : curves[i];
        curves.push_back(moved(copy, {noise(random), noise(random)}));
      }
    }
    std::shuffle(curves.begin(), curves.end(), random);
    const Joined joined = join(loose(curves));
    ASSERT_EQ(joined.contours.size(), 1U) << seed;
    EXPECT_TRUE(joined.contours[0].closed);
    EXPECT_EQ(joined.contours[0].curves.size(), n);
    EXPECT_NEAR(total_length(joined), length, 1e-4);
    EXPECT_EQ(joined.count("duplicate_removed"), added);
    EXPECT_EQ(joined.count("overlap_removed") + joined.count("shared_edge"), 0U);
  }
}

TEST(Join, WholeFiguresDrawnTwice) {
  const Curve2 circle = Arc2{{0, 0}, 5, 0, 2 * kPi};
  const Curve2 turned = Arc2{{0, 0}, 5, 2, -2 * kPi};
  const Curve2 ellipse = geom::EllipseArc2{{0, 0}, {3, 4}, {-4, 3}, 0.5, 2 * kPi};  // round: a circle
  const Joined circles = join(drawing_of({entity("CIRCLE", {circle}, true), entity("CIRCLE", {turned}, true),
                                          entity("ELLIPSE", {ellipse}, true)}));
  ASSERT_EQ(circles.contours.size(), 1U);
  EXPECT_EQ(circles.contours[0].curves, std::vector<Curve2>{circle});
  EXPECT_EQ(circles.count("duplicate_removed"), 2U);

  auto reversed = rectangle(0, 0, 10, 5);
  std::reverse(reversed.begin(), reversed.end());
  for (Curve2& c : reversed) c = geom::reversed(c);
  std::rotate(reversed.begin(), reversed.begin() + 1, reversed.end());
  const Joined polylines = join(
      drawing_of({entity("LWPOLYLINE", rectangle(0, 0, 10, 5), true), entity("LWPOLYLINE", reversed, true)}));
  ASSERT_EQ(polylines.contours.size(), 1U);
  EXPECT_EQ(polylines.contours[0].curves, rectangle(0, 0, 10, 5));
  EXPECT_EQ(polylines.count("duplicate_removed"), 1U);  // one for the entity, not one for each side

  const Curve2 e1 = geom::EllipseArc2{{0, 0}, {8, 0}, {0, 3}, 0, 2 * kPi};
  const Curve2 e2 = geom::EllipseArc2{{0, 0}, {0, -3}, {8, 0}, 1.2, -2 * kPi};
  const Joined ellipses = join(drawing_of({entity("ELLIPSE", {e1}, true), entity("ELLIPSE", {e2}, true)}));
  EXPECT_EQ(ellipses.contours.size(), 1U);
  EXPECT_EQ(ellipses.count("duplicate_removed"), 1U);
}

TEST(Join, FreeCurvesDrawnTwice) {
  const geom::Nurbs2 s{3, {0, 0, 0, 0, 1, 1, 1, 1}, {{0, 0}, {3, 8}, {7, 8}, {10, 0}}, {1, 1, 1, 1}};
  geom::Nurbs2 moved_knots = s;  // the same cubic over another interval
  for (double& k : moved_knots.knots) k = 3 + 2 * k;
  geom::Nurbs2 other = s;
  other.points[1].y = 8.1;
  const Curve2 base = Line2{{10, 0}, {0, 0}};
  const Joined joined = join(loose({s, base, geom::reversed(Curve2{moved_knots})}));
  EXPECT_EQ(joined.contours.size(), 1U);
  EXPECT_EQ(joined.closed(), 1U);
  EXPECT_EQ(joined.count("duplicate_removed"), 1U);
  EXPECT_EQ(join(loose({s, other})).count("duplicate_removed"), 0U);
  // A straight spline whose parameters are not those of the line.
  const geom::Nurbs2 straight{2, {0, 0, 0, 1, 1, 1}, {{10, 0}, {7, 0}, {0, 0}}, {1, 1, 1}};
  EXPECT_EQ(join(loose({s, base, straight})).count("duplicate_removed"), 1U);
}

TEST(Join, OverlappingLinesAndArcsAreCoveredOnce) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    std::mt19937 random(seed);
    const std::vector<Curve2> whole = blob(random, {5, 5}, 40, 9);
    const double length = total_length(join(loose(whole)));
    std::uniform_real_distribution<double> u(0, 1);
    std::vector<Curve2> curves;
    bool overlaps = false;
    for (const Curve2& c : whole) {
      if (random() % 2) {
        curves.push_back(c);
      } else {  // two overlapping pieces of it
        const double t0 = 0.2 + 0.3 * u(random), t1 = t0 + 0.05 + 0.3 * u(random);
        curves.push_back(geom::part(c, 0, t1));
        curves.push_back(geom::part(c, t0, 1));
        overlaps = true;
      }
      if (random() % 3 == 0) {  // and a piece inside
        const double t0 = 0.4 * u(random), t1 = 0.6 + 0.4 * u(random);
        curves.push_back(geom::part(c, t0, t1));
        overlaps = true;
      }
    }
    for (Curve2& c : curves) {
      if (random() % 2) c = geom::reversed(c);
    }
    std::shuffle(curves.begin(), curves.end(), random);
    const Joined joined = join(loose(curves));
    ASSERT_EQ(joined.contours.size(), 1U) << seed;
    EXPECT_TRUE(joined.contours[0].closed) << seed;
    EXPECT_NEAR(total_length(joined), length, 0.01 * static_cast<double>(curves.size()));
    EXPECT_EQ(joined.count("overlap_removed") > 0, overlaps);
  }
}

TEST(Join, ArcsOnACircle) {
  const Curve2 circle = Arc2{{0, 0}, 5, 1, 2 * kPi};
  const Joined first = join(loose({Arc2{{0, 0}, 5, 0.2, 1.5}, circle, Arc2{{0, 0}, 5, 3, -4}}));
  ASSERT_EQ(first.contours.size(), 1U);
  EXPECT_EQ(first.contours[0].curves, std::vector<Curve2>{circle});
  const Joined halves = join(loose({Arc2{{0, 0}, 5, 0, kPi}, Arc2{{0, 0}, 5, kPi, kPi}, circle}));
  ASSERT_EQ(halves.contours.size(), 1U);
  EXPECT_TRUE(halves.contours[0].closed);
  EXPECT_NEAR(total_length(halves), 10 * kPi, 1e-6);
  const Joined three = join(loose({Arc2{{0, 0}, 5, 0, 3}, Arc2{{0, 0}, 5, 2, 3}, Arc2{{0, 0}, 5, 4, 3}}));
  ASSERT_EQ(three.contours.size(), 1U);
  EXPECT_TRUE(three.contours[0].closed);
  EXPECT_NEAR(total_length(three), 10 * kPi, 1e-6);
}

TEST(Join, SmallOverlapsAreGapsNotOverlaps) {
  // Sides that run 0.004 mm past the corner of the next collinear piece.
  const Joined joined = join(loose(
      {Line2{{0, 0}, {5.004, 0}}, Line2{{5, 0}, {10, 0}}, Line2{{10, 0}, {5, 8}}, Line2{{5, 8}, {0, 0}}}));
  EXPECT_EQ(joined.closed(), 1U);
  EXPECT_EQ(joined.count("overlap_removed"), 0U);
  EXPECT_EQ(joined.count("ends_joined"), 1U);
}

TEST(Join, SquaresThatShareAnEdgeStayClosed) {
  for (const bool polylines : {true, false}) {
    const auto a = rectangle(0, 0, 10, 10), b = rectangle(10, 0, 20, 10), inner = rectangle(10, 2, 15, 6);
    for (const auto& other : {b, inner}) {
      std::vector<Curve2> curves = a;
      append(curves, other);
      const Joined joined =
          join(polylines ? drawing_of({entity("LWPOLYLINE", a, true), entity("LWPOLYLINE", other, true)})
                         : loose(curves));
      ASSERT_EQ(joined.contours.size(), 2U) << polylines;
      EXPECT_EQ(joined.closed(), 2U);
      EXPECT_NEAR(std::abs(area(joined.contours[0])), 100, 1e-9);
      EXPECT_NEAR(std::abs(area(joined.contours[1])), area({other, {}, {}, true, Treatment::cut}), 1e-9);
      EXPECT_EQ(joined.count("shared_edge"), 1U);
      EXPECT_EQ(joined.count("duplicate_removed") + joined.count("overlap_removed"), 0U);
    }
  }
}

TEST(Join, GridOfSquaresWithAllEdgesDrawnTwice) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::vector<Curve2> curves;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 3; ++j) append(curves, rectangle(10 * i, 10 * j, 10 * i + 10, 10 * j + 10));
    }
    if (seed > 0) std::shuffle(curves.begin(), curves.end(), random);
    for (Curve2& c : curves) {
      if (random() % 2) c = geom::reversed(c);
    }
    const Joined joined = join(loose(curves));
    ASSERT_EQ(joined.contours.size(), 12U) << seed;
    EXPECT_EQ(joined.closed(), 12U);
    for (const Contour& c : joined.contours) EXPECT_NEAR(std::abs(area(c)), 100, 1e-9);
  }
}

TEST(Join, GridOfSingleLinesKeepsTheOutlineClosed) {
  std::vector<Curve2> curves;  // 3 x 3 cells, every edge once
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= 3; ++j) {
      curves.emplace_back(Line2{{10.0 * i, 10.0 * j}, {10.0 * i + 10, 10.0 * j}});
      curves.emplace_back(Line2{{10.0 * j, 10.0 * i}, {10.0 * j, 10.0 * i + 10}});
    }
  }
  const Joined joined = join(loose(curves));
  EXPECT_EQ(joined.closed(), 1U);
  EXPECT_EQ(joined.contours.size(), 5U);  // the outline and four straight lines through
  EXPECT_EQ(joined.count("open_chain"), 4U);
  EXPECT_NEAR(std::abs(area(joined.contours[0])), 900, 1e-9);
  EXPECT_EQ(joined.count("branch_point"), 12U);
}

TEST(Join, LoopsThatTouchStayLoops) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::vector<Curve2> curves = rectangle(0, 0, 10, 10);
    append(curves, rectangle(10, 10, 15, 18));                               // corner to corner
    append(curves, {Arc2{{-3, 0}, 3, 0, kPi}, Arc2{{-3, 0}, 3, kPi, kPi}});  // a circle at a corner
    append(curves,
           {Line2{{0, 10}, {4, 8}}, Line2{{4, 8}, {2, 5}}, Line2{{2, 5}, {0, 10}}});  // a hole at a corner
    std::uniform_real_distribution<double> shift(-0.0015, 0.0015);
    for (Curve2& c : curves) {
      if (random() % 2) c = geom::reversed(c);
      if (seed % 2) c = moved(c, {shift(random), shift(random)});
    }
    std::shuffle(curves.begin(), curves.end(), random);
    const Joined joined = join(loose(curves));
    ASSERT_EQ(joined.contours.size(), 4U) << seed;
    EXPECT_EQ(joined.closed(), 4U);
    EXPECT_EQ(joined.count("branch_point"), 3U);
    std::vector<double> areas;
    for (const Contour& c : joined.contours) areas.push_back(std::abs(area(c)));
    std::sort(areas.begin(), areas.end());
    EXPECT_NEAR(areas[0], 8, 0.1);
    EXPECT_NEAR(areas[1], 9 * kPi, 0.1);
    EXPECT_NEAR(areas[2], 40, 0.1);
    EXPECT_NEAR(areas[3], 100, 0.1);
  }
}

TEST(Join, DanglingBranchesBecomeOpenChains) {
  std::vector<Curve2> curves = rectangle(0, 0, 10, 10);
  append(curves, {Line2{{10, 10}, {12, 14}}, Line2{{12, 14}, {20, 14}}});
  const Joined joined = join(loose(curves));
  ASSERT_EQ(joined.contours.size(), 2U);
  EXPECT_TRUE(joined.contours[0].closed);
  EXPECT_FALSE(joined.contours[1].closed);
  EXPECT_EQ(joined.contours[1].curves.size(), 2U);
  EXPECT_EQ(joined.count("branch_point"), 1U);
  EXPECT_EQ(joined.count("open_chain"), 1U);
}

TEST(Join, LineAcrossACircleIsAnOpenChain) {
  const Joined joined =
      join(loose({Arc2{{0, 0}, 5, 0, kPi}, Arc2{{0, 0}, 5, kPi, kPi}, Line2{{-5, 0}, {5, 0}}}));
  ASSERT_EQ(joined.contours.size(), 2U);
  EXPECT_TRUE(joined.contours[0].closed);
  EXPECT_NEAR(std::abs(area(joined.contours[0])), 25 * kPi, 1e-2);
}

TEST(Join, TouchingTheInsideOfACurveDoesNotSplitIt) {
  const Joined joined = join(loose({Line2{{0, 0}, {10, 0}}, Line2{{5, 0}, {5, 5}}}));
  EXPECT_EQ(joined.contours.size(), 2U);
  EXPECT_EQ(joined.count("open_chain"), 2U);
  EXPECT_EQ(joined.count("branch_point"), 0U);
}

TEST(Join, RowsOfTinyPiecesKeepTheirShape) {
  std::vector<Curve2> curves;  // a circle of 2000 lines, 0.003 mm each: shorter than the join tolerance
  constexpr int kCount = 2000;
  const double radius = 0.003 * kCount / (2 * kPi);
  const auto at = [&](int i) {
    const double angle = 2 * kPi * (i % kCount) / kCount;
    return Point2{radius * std::cos(angle), radius * std::sin(angle)};
  };
  for (int i = 0; i < kCount; ++i) curves.emplace_back(Line2{at(i), at(i + 1)});
  std::mt19937 random(7);
  std::shuffle(curves.begin(), curves.end(), random);
  const Joined closed = join(loose(curves));
  ASSERT_EQ(closed.contours.size(), 1U);
  EXPECT_TRUE(closed.contours[0].closed);
  EXPECT_EQ(closed.contours[0].curves.size(), curves.size());
  curves.resize(curves.size() - 1);  // a gap of 0.003 mm: closed over it, not into the row beside it
  const Joined gap = join(loose(curves));
  ASSERT_EQ(gap.contours.size(), 1U);
  EXPECT_TRUE(gap.contours[0].closed);
  EXPECT_EQ(gap.contours[0].curves.size(), curves.size());
}

TEST(Join, SpikesAreDroppedWhenTiny) {
  for (const double spike : {0.03, 3.0}) {  // along the first side, past the corner and back
    const std::vector<Curve2> outline = {Line2{{0, 0}, {10 + spike, 0}}, Line2{{10 + spike, 0}, {10, 0}},
                                         Line2{{10, 0}, {10, 5}}, Line2{{10, 5}, {0, 5}},
                                         Line2{{0, 5}, {0, 0}}};
    const Joined joined = join(drawing_of({entity("LWPOLYLINE", outline, true)}));
    EXPECT_EQ(joined.closed(), 1U);
    EXPECT_NEAR(area(joined.contours[0]), 50, 1e-9);
    EXPECT_EQ(joined.count("open_chain"), spike > 1 ? 1U : 0U);
    EXPECT_EQ(joined.count("zero_length"), spike > 1 ? 0U : 1U);
  }
}

TEST(Join, CutAndEngravedAreNotJoined) {
  auto sides = rectangle(0, 0, 10, 5);
  io::Drawing drawing =
      drawing_of({entity("LINE", {sides[0]}, false, "Cut"), entity("LINE", {sides[1]}, false, "cut me"),
                  entity("LINE", {sides[2]}, false, "Marks"), entity("LINE", {sides[3]}, false, "Notes")});
  drawing.layers = {"Cut", "Marks", "Notes", "cut me"};
  LaserOptions options;
  options.layers = {{"marks", Treatment::engrave}, {"Notes", Treatment::ignore}};
  const Joined joined = join(drawing, options);
  ASSERT_EQ(joined.contours.size(), 2U);
  EXPECT_EQ(joined.contours[0].curves.size(), 2U);
  EXPECT_EQ(joined.contours[0].treatment, Treatment::cut);
  EXPECT_EQ(joined.contours[1].treatment, Treatment::engrave);
  EXPECT_EQ(joined.count("open_chain"), 1U);  // engraved lines may be open
}

TEST(Join, UnknownLayersAreUsageErrors) {
  io::Drawing drawing = drawing_of({entity("LINE", {Line2{{0, 0}, {1, 0}}}, false, "Outline")});
  drawing.entities[0].color = 0xff0000;
  drawing.layers = {"Outline", "Inside"};
  LaserOptions options;
  Diagnostics diagnostics;
  options.layers = {{"Outlne", Treatment::cut}};
  const auto result = join_contours(drawing, options, diagnostics);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::usage);
  EXPECT_NE(result.error().message.find("did you mean \"Outline\""), std::string::npos)
      << result.error().message;
  EXPECT_NE(result.error().message.find("\"Inside\""), std::string::npos);
  options.layers = {{"#F00", Treatment::ignore}};
  EXPECT_TRUE(join(drawing, options).contours.empty());
  options.layers = {{"#00ff00", Treatment::ignore}};
  EXPECT_FALSE(join_contours(drawing, options, diagnostics).ok());
}

}  // namespace
}  // namespace burin::laser
