// SPDX-License-Identifier: Apache-2.0
// Where curves land, against closed forms worked out here without the reader.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>

#include "burin/io/dxf/dxf_text.h"

namespace {

using namespace burin;                // NOLINT(google-build-using-namespace)
using namespace burin::io;            // NOLINT(google-build-using-namespace)
using namespace burin::io::dxf_text;  // NOLINT(google-build-using-namespace)
using geom::Arc2;
using geom::Curve2;
using geom::EllipseArc2;
using geom::kPi;
using geom::Line2;
using geom::Nurbs2;
using geom::Point2;
using geom::point_at;

constexpr double kRoot2 = 1.41421356237309504880;

void expect_ends(const Curve2& curve, Point2 start, Point2 middle, Point2 end, double within = 1e-9) {
  expect_near(point_at(curve, 0), start, within);
  expect_near(point_at(curve, 0.5), middle, within);
  expect_near(point_at(curve, 1), end, within);
}

// --- arcs

TEST(DxfArc, RunsCounterClockwiseFromStartToEnd) {
  const Drawing drawing =
      read(file("0 ARC|10 10|20 5|40 2|50 0|51 90|0 ARC|10 0|20 0|40 1|50 270|51 90|0 ARC|10 0|20 0|40 1|50 "
                "-90|51 -450"));
  expect_ends(only_curve(drawing, 0), {12, 5}, {10 + kRoot2, 5 + kRoot2}, {10, 7});
  expect_ends(only_curve(drawing, 1), {0, -1}, {1, 0}, {0, 1});
  EXPECT_NEAR(std::get<Arc2>(only_curve(drawing, 2)).sweep, 2 * kPi,
              1e-12);  // a whole turn apart: full circle
  EXPECT_TRUE(drawing.entities[2].paths[0].closed);
}

TEST(DxfArc, CircleIsClosed) {
  const Drawing drawing = read(file("0 CIRCLE|10 3|20 4|40 2.5"));
  const auto& arc = std::get<Arc2>(only_curve(drawing));
  EXPECT_EQ(arc.center, (Point2{3, 4}));
  EXPECT_EQ(arc.radius, 2.5);
  EXPECT_NEAR(std::abs(arc.sweep), 2 * kPi, 1e-15);
  EXPECT_TRUE(drawing.entities[0].paths[0].closed);
}

TEST(DxfArc, NegativeExtrusionMirrorsX) {
  const Drawing drawing = read(file("0 ARC|10 10|20 5|40 2|50 0|51 90|210 0|220 0|230 -1"));
  EXPECT_TRUE(std::holds_alternative<Arc2>(only_curve(drawing)));
  expect_ends(only_curve(drawing), {-12, 5}, {-10 - kRoot2, 5 + kRoot2}, {-10, 7});
}

const char* const kArcBlock = "0 BLOCK|2 B|70 0|10 0|20 0|0 ARC|5 31|10 10|20 5|40 2|50 0|51 90|0 ENDBLK";

Drawing inserted(const std::string& insert, const std::string& blocks = kArcBlock) {
  Parts parts;
  parts.blocks = blocks;
  parts.entities = insert;
  return read(file(parts));
}

TEST(DxfArc, NegativeInsertScaleMirrors) {
  const Drawing x = inserted("0 INSERT|2 B|10 100|20 0|41 -1");
  EXPECT_TRUE(std::holds_alternative<Arc2>(only_curve(x)));
  expect_ends(only_curve(x), {88, 5}, {90 - kRoot2, 5 + kRoot2}, {90, 7});
  const Drawing y = inserted("0 INSERT|2 B|10 100|20 0|42 -1");
  expect_ends(only_curve(y), {112, -5}, {110 + kRoot2, -5 - kRoot2}, {110, -7});
  const Drawing both = inserted("0 INSERT|2 B|10 0|20 0|41 -3|42 -3");
  expect_ends(only_curve(both), {-36, -15}, {-30 - 3 * kRoot2, -15 - 3 * kRoot2}, {-30, -21});
}

TEST(DxfArc, MirroredInsertIsTurnedAfterwards) {
  // Scale (-2, 2), then a quarter turn to the left, then the shift: (x, y) -> (-2x, 2y) -> (-2y, -2x) -> +
  // (1, 1).
  const Drawing drawing = inserted("0 INSERT|2 B|10 1|20 1|41 -2|42 2|50 90");
  const auto map = [](double x, double y) { return Point2{-2 * y + 1, -2 * x + 1}; };
  EXPECT_TRUE(std::holds_alternative<Arc2>(only_curve(drawing)));
  expect_ends(only_curve(drawing), map(12, 5), map(10 + kRoot2, 5 + kRoot2), map(10, 7));
}

TEST(DxfArc, ExtrusionsOfInsertAndMemberCancel) {
  const std::string block = "0 BLOCK|2 B|70 0|10 0|20 0|0 ARC|10 10|20 5|40 2|50 0|51 90|230 -1|0 ENDBLK";
  // Insertion point (100, 0) in its own system is (-100, 0); the two mirrors undo each other.
  const Drawing drawing = inserted("0 INSERT|2 B|10 100|20 0|230 -1", block);
  expect_ends(only_curve(drawing), {-88, 5}, {-90 + kRoot2, 5 + kRoot2}, {-90, 7});
}

TEST(DxfArc, NonUniformScaleMakesAnEllipse) {
  const Drawing drawing = inserted("0 INSERT|2 B|10 0|20 0|41 2|42 1|50 30");
  ASSERT_TRUE(std::holds_alternative<EllipseArc2>(only_curve(drawing)));
  const double c = std::cos(kPi / 6), s = std::sin(kPi / 6);
  for (const double t : {0.0, 0.3, 0.77, 1.0}) {
    const double x = 2 * (10 + 2 * std::cos(t * kPi / 2)), y = 5 + 2 * std::sin(t * kPi / 2);
    expect_near(point_at(only_curve(drawing), t), {c * x - s * y, s * x + c * y});
  }
}

TEST(DxfArc, TiltedCircleIsProjectedAndReported) {
  // N = (0, 1, 1) / sqrt 2: by the arbitrary axis algorithm x = Z x N = (-1, 0, 0), y = N x x = (0, -1, 1) /
  // sqrt 2.
  Diagnostics diagnostics;
  const Drawing drawing =
      read(file("0 CIRCLE|10 3|20 4|30 5|40 2|210 0|220 0.70710678118654752|230 0.70710678118654752"),
           diagnostics);
  for (const double t : {0.0, 0.2, 0.5, 0.9}) {
    const double u = 3 + 2 * std::cos(2 * kPi * t), v = 4 + 2 * std::sin(2 * kPi * t);
    expect_near(point_at(only_curve(drawing), t), {-u, (-v + 5) / kRoot2});
  }
  EXPECT_EQ(diagnostics.count("tilted"), 1u);
  Diagnostics upright;
  EXPECT_TRUE(read(file("0 CIRCLE|10 3|20 4|40 2|210 1|220 0|230 0"), upright).entities.empty());
  EXPECT_EQ(upright.count("edge_on"), 1u);
  EXPECT_TRUE(upright.anything_left_out());
}

TEST(DxfArc, WithoutLengthIsReportedWithPlace) {
  Diagnostics diagnostics;
  EXPECT_TRUE(
      read(
          file("0 ARC|5 A|10 3|20 4|40 0|50 0|51 90|0 ARC|10 3|20 4|40 1|50 30|51 30|0 CIRCLE|10 3|20 4|40 0|"
               "0 ELLIPSE|10 3|20 4|40 1|0 LWPOLYLINE|10 3|20 4|0 SPLINE|71 1|40 0|40 0|40 1|40 1|10 3|20 "
               "4|10 3|20 4"),
          diagnostics)
          .entities.empty());
  ASSERT_EQ(diagnostics.count("zero_length"), 6u);
  EXPECT_EQ(diagnostics.warnings()[0].where.entity, "ARC A");
  for (const Warning& warning : diagnostics.warnings()) {
    ASSERT_TRUE(warning.position_mm);
    EXPECT_EQ((*warning.position_mm)[0], 3);
    EXPECT_EQ((*warning.position_mm)[1], 4);
  }
  EXPECT_EQ(read(file("0 LINE|10 1|20 1|11 1|21 1")).entities.size(), 1u);  // the joiner's business
}

// --- ellipses

TEST(DxfEllipse, ArcByParameters) {
  const Drawing drawing = read(file("0 ELLIPSE|10 1|20 2|11 0|21 4|40 0.5|41 0|42 1.5707963267948966"));
  // Major axis up, minor = left of it.
  expect_ends(only_curve(drawing), {1, 6}, {1 - kRoot2, 2 + 2 * kRoot2}, {-1, 2});
  EXPECT_FALSE(drawing.entities[0].paths[0].closed);
}

TEST(DxfEllipse, NegativeExtrusionTurnsTheOtherWay) {
  // Points of an ELLIPSE are in world coordinates; only the sense of the parameter changes.
  const Drawing drawing =
      read(file("0 ELLIPSE|10 1|20 2|11 0|21 4|40 0.5|41 0|42 1.5707963267948966|230 -1"));
  expect_ends(only_curve(drawing), {1, 6}, {1 + kRoot2, 2 + 2 * kRoot2}, {3, 2});
}

TEST(DxfEllipse, RoundOnesBecomeArcs) {
  const Drawing drawing =
      read(file("0 ELLIPSE|10 1|20 2|11 0|21 3|40 1|41 0|42 6.283185307179586|"
                "0 ELLIPSE|10 1|20 2|11 0|21 3|40 1|41 0|42 1.5707963267948966|230 -1"));
  EXPECT_EQ(std::get<Arc2>(only_curve(drawing, 0)).radius, 3);
  EXPECT_TRUE(drawing.entities[0].paths[0].closed);
  ASSERT_TRUE(std::holds_alternative<Arc2>(only_curve(drawing, 1)));
  expect_ends(only_curve(drawing, 1), {1, 5}, {1 + 3 / kRoot2, 2 + 3 / kRoot2}, {4, 2});
}

TEST(DxfEllipse, InRotatedInsert) {
  const std::string block =
      "0 BLOCK|2 B|10 0|20 0|0 ELLIPSE|10 2|20 1|11 3|21 1|40 0.25|41 0.5|42 4|0 ENDBLK";
  const Drawing drawing = inserted("0 INSERT|2 B|10 7|20 -3|41 -1.5|42 2|50 40", block);
  const std::complex<double> turn = std::polar(1.0, 40 * kPi / 180);
  for (const double t : {0.0, 0.25, 0.6, 1.0}) {
    const double u = 0.5 + 3.5 * t;
    const double x = 2 + 3 * std::cos(u) - 0.25 * std::sin(u), y = 1 + std::cos(u) + 0.75 * std::sin(u);
    const auto p = std::complex<double>(7, -3) + turn * std::complex<double>(-1.5 * x, 2 * y);
    expect_near(point_at(only_curve(drawing), t), {p.real(), p.imag()});
  }
}

// --- blocks

TEST(DxfInsert, BasePointScaleTurnShift) {
  const std::string block = "0 BLOCK|2 B|10 1|20 2|0 LINE|10 1|20 2|11 4|21 2|0 ENDBLK";
  const Drawing drawing = inserted("0 INSERT|2 B|10 10|20 20|41 2|42 5|50 90", block);
  const auto& line = std::get<Line2>(only_curve(drawing));
  expect_near(line.a, {10, 20});
  expect_near(line.b, {10, 26});
}

TEST(DxfInsert, NestedAgainstComplexNumbers) {
  const std::string blocks =
      "0 BLOCK|2 In|10 1|20 1|0 LINE|5 33|10 2|20 3|11 5|21 -1|0 ENDBLK|"
      "0 BLOCK|2 Out|10 0|20 -1|0 INSERT|5 32|2 In|10 4|20 4|41 1.5|42 1.5|50 25|0 ENDBLK";
  const Drawing drawing = inserted("0 INSERT|5 31|2 Out|10 -7|20 3|41 2|42 2|50 -70", blocks);
  using C = std::complex<double>;
  const auto map = [](C p) {
    const C inner = C(4, 4) + std::polar(1.5, 25 * kPi / 180) * (p - C(1, 1));
    return C(-7, 3) + std::polar(2.0, -70 * kPi / 180) * (inner - C(0, -1));
  };
  const C a = map({2, 3}), b = map({5, -1});
  const auto& line = std::get<Line2>(only_curve(drawing));
  expect_near(line.a, {a.real(), a.imag()});
  expect_near(line.b, {b.real(), b.imag()});
  EXPECT_EQ(drawing.entities[0].id, "INSERT 31/INSERT 32/LINE 33");
}

TEST(DxfInsert, ArraySpacingTurnsButDoesNotScale) {
  const std::string block = "0 BLOCK|2 B|10 0|20 0|0 LINE|5 C|10 0|20 0|11 1|21 0|0 ENDBLK";
  const Drawing drawing = inserted("0 INSERT|5 A|2 B|10 5|20 5|41 3|42 3|50 90|70 3|71 2|44 10|45 20", block);
  ASSERT_EQ(drawing.entities.size(), 6u);
  std::size_t i = 0;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column, ++i) {
      const auto& line = std::get<Line2>(only_curve(drawing, i));
      expect_near(line.a, {5 - 20.0 * row, 5 + 10.0 * column});
      expect_near(line.b, {5 - 20.0 * row, 8 + 10.0 * column});
    }
  }
  EXPECT_EQ(drawing.entities[4].id, "INSERT A(2,2)/LINE C");
}

TEST(DxfInsert, QuarterTurnsAreExact) {
  const std::string block = "0 BLOCK|2 B|10 0|20 0|0 LINE|10 0.1|20 0.7|11 3|21 0.7|0 ENDBLK";
  const Drawing drawing = inserted("0 INSERT|2 B|10 0|20 0|50 270", block);
  EXPECT_EQ(only_curve(drawing), Curve2(Line2{{0.7, -0.1}, {0.7, -3}}));
}

// --- polylines

TEST(DxfPolyline, BulgeOfAHalfCircle) {
  const Drawing drawing =
      read(file("0 LWPOLYLINE|90 3|70 1|10 0|20 0|42 1|10 10|20 0|10 10|20 10|42 -0.41421356237309503"));
  ASSERT_EQ(drawing.entities.size(), 1u);
  const Path& path = drawing.entities[0].paths.at(0);
  EXPECT_TRUE(path.closed);
  ASSERT_EQ(path.curves.size(), 3u);
  expect_ends(path.curves[0], {0, 0}, {5, -5}, {10, 0});  // counter-clockwise: below the chord
  EXPECT_EQ(path.curves[1], Curve2(Line2{{10, 0}, {10, 10}}));
  // A quarter of a circle of radius 10 * sqrt 2 / sqrt 2 = 10, clockwise about (10, 0): from (10, 10) to (0,
  // 0) would be counter-clockwise about (10, 0), so the clockwise one is about (0, 10).
  expect_ends(path.curves[2], {10, 10}, {10 / kRoot2, 10 - 10 / kRoot2}, {0, 0});
}

TEST(DxfPolyline, BulgesAgainstChordAndHeight) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-100, 100), exponent(-6, 3);
  for (int i = 0; i < 300; ++i) {
    const Point2 a{coordinate(random), coordinate(random)}, b{coordinate(random), coordinate(random)};
    const double bulge = (i % 2 != 0 ? -1 : 1) * std::pow(10.0, exponent(random));
    const Drawing drawing = read(file("0 LWPOLYLINE|90 2|70 0|10 " + number(a.x) + "|20 " + number(a.y) +
                                      "|42 " + number(bulge) + "|10 " + number(b.x) + "|20 " + number(b.y)));
    // The middle of the arc stands off the middle of the chord by bulge * chord / 2, to the right for
    // positive bulges.
    const geom::Vec2 chord = b - a;
    const Point2 middle = lerp(a, b, 0.5) + 0.5 * bulge * geom::right(chord);
    const double within = 1e-13 * norm(chord) * (1 / std::abs(bulge) + std::abs(bulge) + 1) + 1e-9;
    expect_ends(only_curve(drawing), a, middle, b, within);
  }
}

TEST(DxfPolyline, MirroredBulges) {
  const Drawing drawing = read(file("0 LWPOLYLINE|90 2|70 0|38 3|230 -1|10 0|20 0|42 1|10 10|20 0"));
  expect_ends(only_curve(drawing), {0, 0}, {-5, -5}, {-10, 0});
}

TEST(DxfPolyline, RepeatedFirstVertexAddsNothing) {
  const Drawing drawing = read(file("0 LWPOLYLINE|90 4|70 1|10 0|20 0|10 4|20 0|10 4|20 3|10 0|20 0"));
  EXPECT_EQ(drawing.entities[0].paths[0].curves.size(), 3u);
  EXPECT_TRUE(drawing.entities[0].paths[0].closed);
}

TEST(DxfPolyline, R12WithVertices) {
  const Drawing drawing =
      read(file("0 POLYLINE|5 10|8 Cut|66 1|70 1|10 0|20 0|30 0|0 VERTEX|5 11|8 Other|10 0|20 0|42 1|0 "
                "VERTEX|10 2|20 0|0 SEQEND|"
                "0 POLYLINE|66 1|0 VERTEX|10 0|20 0|0 VERTEX|10 1|20 1|0 SEQEND|0 LINE|10 0|20 0|11 1|21 1"));
  ASSERT_EQ(drawing.entities.size(), 3u);
  EXPECT_EQ(drawing.entities[0].name(), "POLYLINE 10");
  EXPECT_EQ(drawing.entities[0].layer, "Cut");
  ASSERT_EQ(drawing.entities[0].paths[0].curves.size(), 2u);
  expect_ends(drawing.entities[0].paths[0].curves[0], {0, 0}, {1, -1}, {2, 0});
  EXPECT_EQ(drawing.entities[0].paths[0].curves[1], Curve2(Line2{{2, 0}, {0, 0}}));
  EXPECT_FALSE(drawing.entities[1].paths[0].closed);
}

TEST(DxfPolyline, FramePointsOfSplineFitsAreSkipped) {
  const Drawing drawing =
      read(file("0 POLYLINE|66 1|70 4|0 VERTEX|70 16|10 0|20 9|0 VERTEX|70 8|10 0|20 0|0 VERTEX|70 8|10 1|"
                "20 1|0 VERTEX|70 16|10 5|20 9|0 VERTEX|70 8|10 2|20 0|0 SEQEND"));
  const auto& curves = drawing.entities.at(0).paths.at(0).curves;
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[0], Curve2(Line2{{0, 0}, {1, 1}}));
  EXPECT_EQ(curves[1], Curve2(Line2{{1, 1}, {2, 0}}));
}

TEST(DxfPolyline, SpatialOnesAreProjectedMeshesListed) {
  Diagnostics diagnostics;
  const Drawing drawing = read(
      file("0 POLYLINE|66 1|70 8|230 -1|0 VERTEX|70 32|10 1|20 0|30 5|0 VERTEX|70 32|10 3|20 4|30 9|0 SEQEND|"
           "0 POLYLINE|66 1|70 16|71 2|72 2|0 VERTEX|70 64|10 0|20 0|0 SEQEND|"
           "0 POLYLINE|66 1|70 64|0 VERTEX|70 192|10 0|20 0|0 VERTEX|70 128|71 1|0 SEQEND"),
      diagnostics);
  EXPECT_EQ(only_curve(drawing),
            Curve2(Line2{{1, 0}, {3, 4}}));  // in world coordinates, whatever the extrusion
  EXPECT_EQ(drawing.ignored, (std::map<std::string, int>{{"POLYLINE mesh", 2}}));
  EXPECT_EQ(diagnostics.count("z_ignored"), 1u);
}

// --- splines

std::string spline(int degree, int flags, const std::vector<double>& knots, const std::vector<Point2>& points,
                   const std::vector<double>& weights = {}) {
  std::string text = "0 SPLINE|5 9A|70 " + std::to_string(flags) + "|71 " + std::to_string(degree) + "|72 " +
                     std::to_string(knots.size()) + "|73 " + std::to_string(points.size());
  for (const double k : knots) text += "|40 " + number(k);
  for (const double w : weights) text += "|41 " + number(w);
  for (const Point2 p : points) text += "|10 " + number(p.x) + "|20 " + number(p.y) + "|30 0";
  return text;
}

TEST(DxfSpline, RationalQuarterCircle) {
  const Drawing drawing =
      read(file(spline(2, 12, {0, 0, 0, 1, 1, 1}, {{1, 0}, {1, 1}, {0, 1}}, {1, 1 / kRoot2, 1})));
  for (double t = 0; t <= 1; t += 0.125) {
    const Point2 p = point_at(only_curve(drawing), t);
    EXPECT_NEAR(std::hypot(p.x, p.y), 1, 1e-14);
  }
  expect_ends(only_curve(drawing), {1, 0}, {1 / kRoot2, 1 / kRoot2}, {0, 1});
}

TEST(DxfSpline, MirroredAndScaledByInsert) {
  const std::string block = "0 BLOCK|2 B|10 0|20 0|" +
                            spline(2, 12, {0, 0, 0, 1, 1, 1}, {{1, 0}, {1, 1}, {0, 1}}, {1, 1 / kRoot2, 1}) +
                            "|0 ENDBLK";
  const Drawing drawing = inserted("0 INSERT|2 B|10 0|20 0|41 -2|42 3", block);
  ASSERT_TRUE(std::holds_alternative<Nurbs2>(only_curve(drawing)));
  expect_ends(only_curve(drawing), {-2, 0}, {-kRoot2, 3 / kRoot2}, {0, 3});
}

TEST(DxfSpline, PeriodicUniformCubic) {
  // Unclamped uniform knots with the first three points repeated: each knot lies at (P0 + 4 P1 + P2) / 6.
  const std::vector<Point2> p = {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {6, 0}, {6, 6}};
  const Drawing drawing = read(file(spline(3, 11, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, p)));
  EXPECT_TRUE(drawing.entities[0].paths[0].closed);
  for (int i = 0; i <= 4; ++i) {
    const auto k = static_cast<std::size_t>(i);
    expect_near(point_at(only_curve(drawing), i / 4.0),
                {(p[k].x + 4 * p[k + 1].x + p[k + 2].x) / 6, (p[k].y + 4 * p[k + 1].y + p[k + 2].y) / 6},
                1e-12);
  }
}

TEST(DxfSpline, ClosedByFlagOnlyIsReported) {
  Diagnostics diagnostics;
  const Drawing drawing = read(file(spline(1, 1, {0, 0, 1, 1}, {{0, 0}, {3, 0}})), diagnostics);
  EXPECT_FALSE(drawing.entities.at(0).paths.at(0).closed);
  EXPECT_EQ(diagnostics.count("spline_open"), 1u);
}

TEST(DxfSpline, DegreeOneAndFive) {
  const Drawing one = read(file(spline(1, 8, {0, 0, 1, 2, 2}, {{0, 0}, {3, 0}, {3, 5}})));
  expect_near(point_at(only_curve(one), 0.5), {3, 0});
  expect_near(point_at(only_curve(one), 0.75), {3, 2.5});
  std::vector<Point2> points;
  for (int i = 0; i < 6; ++i) points.push_back({static_cast<double>(i), i % 2 * 32.0});
  const Drawing five = read(file(spline(5, 8, {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1}, points)));
  // Bezier of degree 5 at 1/2: binomials 1 5 10 10 5 1 over 32.
  expect_near(point_at(only_curve(five), 0.5), {2.5, 5 + 10 + 1});
}

TEST(DxfSpline, FitPointsOnly) {
  const std::vector<Point2> fit = {{0, 0}, {10, 5}, {20, -5}, {35, 0}, {40, 20}};
  std::string text = "0 SPLINE|5 9A|70 8|71 3|72 0|73 0|74 5|12 1|22 0|32 0|13 0|23 1|33 0";
  for (const Point2 p : fit) text += "|11 " + number(p.x) + "|21 " + number(p.y) + "|31 0";
  const Drawing drawing = read(file(text));
  const Curve2& curve = only_curve(drawing);
  for (const Point2 p : fit) {
    double nearest = 1e9;
    for (int i = 0; i <= 20000; ++i) nearest = std::min(nearest, distance(p, point_at(curve, i / 20000.0)));
    EXPECT_LT(nearest, 2e-3);  // the sampling step
  }
  expect_near(point_at(curve, 0), fit.front());
  expect_near(point_at(curve, 1), fit.back());
  const auto start = geom::tangent_at(curve, 0), end = geom::tangent_at(curve, 1);
  EXPECT_NEAR(start.x, 1, 1e-9);
  EXPECT_NEAR(end.y, 1, 1e-9);
}

TEST(DxfSpline, ClosedThroughFitPoints) {
  const Drawing drawing = read(file("0 SPLINE|70 11|71 3|74 4|11 1|21 0|11 0|21 1|11 -1|21 0|11 0|21 -1"));
  EXPECT_TRUE(drawing.entities.at(0).paths.at(0).closed);
  const auto a = geom::tangent_at(only_curve(drawing), 0), b = geom::tangent_at(only_curve(drawing), 1);
  EXPECT_NEAR(cross(a, b), 0, 1e-9);
  EXPECT_GT(dot(a, b), 0);
}

TEST(DxfSpline, KnotTrouble) {
  const std::vector<Point2> points = {{0, 0}, {1, 2}, {3, 2}, {4, 0}};
  const auto codes = [&](const std::vector<double>& knots, const std::vector<double>& weights = {}) {
    Diagnostics diagnostics;
    const Drawing drawing = read(file(spline(3, 8, knots, points, weights)), diagnostics);
    std::string all = drawing.entities.empty() ? "none:" : "some:";
    for (const Warning& warning : diagnostics.warnings())
      all += warning.code + (warning.where.entity == "SPLINE 9A" ? "" : "?");
    return all;
  };
  EXPECT_EQ(codes({0, 0, 0, 0, 1, 1, 1, 1}), "some:");
  EXPECT_EQ(codes({}), "some:spline_repaired");
  EXPECT_EQ(codes({0, 0, 0, 1, 1, 1}), "some:spline_repaired");
  EXPECT_EQ(codes({0, 0, 0, 0, 1, 1, 1, 0.9999999999}), "some:spline_repaired");
  EXPECT_EQ(codes({0, 0, 0, 0, 1, 1, 1, 0.5}), "none:bad_spline");
  EXPECT_EQ(codes({0, 0, 0, 0, 1, 1, 1}), "none:bad_spline");
  EXPECT_EQ(codes({0, 0, 0, 0, 0, 0, 0, 0}), "none:bad_spline");
  EXPECT_EQ(codes({0, 0, 0, 0, 1, 1, 1, 1}, {1, -1, 1, 1}), "none:bad_spline");
  EXPECT_EQ(codes({0, 0, 0, 0, 1, 1, 1, 1}, {1, 0, 1, 1}), "none:bad_spline");
}

TEST(DxfSpline, EvenKnotsWhenTheyAreMissing) {
  // Five points of degree 3 without knots: knots 0 0 0 0 1 2 2 2 2.
  const std::vector<Point2> points = {{0, 0}, {1, 2}, {3, 2}, {4, 0}, {7, 1}};
  const Drawing without = read(file(spline(3, 8, {}, points)));
  const Drawing with = read(file(spline(3, 8, {0, 0, 0, 0, 1, 2, 2, 2, 2}, points)));
  EXPECT_EQ(only_curve(without), only_curve(with));
}

TEST(DxfSpline, BezierChainsWithFullKnotsFallIntoTheirPieces) {
  // Degree 2, inner knots three times: two parabolas that meet, and a third one apart.
  const Drawing drawing =
      read(file(spline(2, 8, {0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3},
                       {{0, 0}, {1, 2}, {2, 0}, {2, 0}, {3, -2}, {4, 0}, {9, 0}, {10, 2}, {11, 0}})));
  ASSERT_EQ(drawing.entities.size(), 1u);
  ASSERT_EQ(drawing.entities[0].paths.size(), 2u);
  ASSERT_EQ(drawing.entities[0].paths[0].curves.size(), 2u);
  expect_ends(drawing.entities[0].paths[0].curves[0], {0, 0}, {1, 1}, {2, 0});
  expect_ends(drawing.entities[0].paths[0].curves[1], {2, 0}, {3, -1}, {4, 0});
  expect_ends(drawing.entities[0].paths[1].curves.at(0), {9, 0}, {10, 1}, {11, 0});
}

TEST(DxfSpline, KnotsRepeatedTooOftenDropTheirPoints) {
  // The inner knot four times at degree 2: the point in between belongs to no piece.
  const Drawing drawing = read(file(spline(2, 8, {0, 0, 0, 1, 1, 1, 1, 2, 2, 2},
                                           {{0, 0}, {1, 2}, {2, 0}, {99, 99}, {2, 0}, {3, -2}, {4, 0}})));
  const Path& path = drawing.entities.at(0).paths.at(0);
  ASSERT_EQ(path.curves.size(), 2u);
  expect_ends(path.curves[0], {0, 0}, {1, 1}, {2, 0});
  expect_ends(path.curves[1], {2, 0}, {3, -1}, {4, 0});
}

// --- as a whole

TEST(DxfUnits, InchAndMillimetreDrawingsAgree) {
  const auto drawing = [](double scale, const char* units) {
    const auto n = [&](double v) { return number(v * scale); };
    Parts parts;
    parts.header = std::string("9 $INSUNITS|70 ") + units;
    parts.blocks =
        "0 BLOCK|2 B|10 " + n(1) + "|20 0|0 CIRCLE|10 " + n(2) + "|20 " + n(3) + "|40 " + n(4) + "|0 ENDBLK";
    parts.entities = "0 INSERT|2 B|10 " + n(5) + "|20 " + n(6) + "|41 2|42 1|70 2|44 " + n(30) +
                     "|0 LWPOLYLINE|10 " + n(0) + "|20 " + n(0) + "|42 0.5|10 " + n(9) + "|20 " + n(1);
    return read(file(parts));
  };
  const Drawing mm = drawing(1, "4"), inch = drawing(1 / 25.4, "1");
  ASSERT_EQ(mm.entities.size(), 3u);
  ASSERT_EQ(inch.entities.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    for (const double t : {0.0, 0.4, 1.0}) {
      expect_near(point_at(only_curve(mm, i), t), point_at(only_curve(inch, i), t));
    }
  }
}

}  // namespace
