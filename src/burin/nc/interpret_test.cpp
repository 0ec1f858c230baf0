// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "burin/nc/program.h"

namespace burin::nc {
namespace {

using geom::kPi;
using geom::Point3;
using geom::Vec3;

cl::Program run(std::string_view text, InterpretOptions options = {}) {
  Diagnostics diagnostics;
  auto program = interpret(text, options, diagnostics);
  EXPECT_TRUE(program) << program.error().to_string();
  if (!program) return {};
  EXPECT_TRUE(cl::validate(*program, 0.013)) << cl::validate(*program, 0.013).error().to_string();
  return *program;
}

std::vector<cl::Record> motions(const cl::Program& program) {
  std::vector<cl::Record> found;
  for (const cl::Record& record : program.records)
    if (cl::is_motion(record)) found.push_back(record);
  return found;
}

template <class T>
std::vector<T> all(const cl::Program& program) {
  std::vector<T> found;
  for (const cl::Record& record : program.records)
    if (const T* one = std::get_if<T>(&record)) found.push_back(*one);
  return found;
}

void expect_near(Point3 a, Point3 b, double tolerance = 1e-9) {
  EXPECT_LE(distance(a, b), tolerance);
}

TEST(Interpret, InchMetricAbsoluteIncremental) {
  const auto p = run("G20 G90 G0 X1 Y2\nG91 G1 X1 F10\nG21 X10\nG90 X0\n");
  const auto m = motions(p);
  ASSERT_EQ(m.size(), 4u);
  expect_near(cl::pose_of(m[0])->tip, {25.4, 50.8, 0});
  expect_near(cl::pose_of(m[1])->tip, {50.8, 50.8, 0});
  expect_near(cl::pose_of(m[2])->tip, {60.8, 50.8, 0});
  expect_near(cl::pose_of(m[3])->tip, {0, 50.8, 0});
  EXPECT_NEAR(all<cl::FeedRate>(p).at(0).mm_min, 254, 1e-9);
  EXPECT_EQ(p.source[0], 1u);
  EXPECT_EQ(p.source.back(), 4u);
}

// Every plane and both senses, against the closed form: a quarter turn ends where the turned radius says.
TEST(Interpret, QuarterTurnsInEveryPlane) {
  const struct {
    const char* plane;
    Vec3 first, second, normal;
  } planes[] = {{"G17", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                {"G18", {0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
                {"G19", {0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};
  const char letters[] = "XYZ", offsets[] = "IJK";
  for (const auto& plane : planes) {
    for (bool clockwise : {false, true}) {
      for (int mode = 0; mode < 3; ++mode) {  // offsets, absolute centre, R
        const Point3 center{3, -4, 5};
        const Point3 start = center + 10 * plane.first,
                     end = center + (clockwise ? -10.0 : 10.0) * plane.second;
        std::string text = "G21 G90 G0 X" + std::to_string(start.x) + " Y" + std::to_string(start.y) + " Z" +
                           std::to_string(start.z) + " F100\n" + plane.plane + (mode == 1 ? " G90.1" : "") +
                           (clockwise ? " G2" : " G3");
        const double to[] = {end.x, end.y, end.z}, c[] = {center.x, center.y, center.z};
        const double from[] = {start.x, start.y, start.z};
        const double in_plane[] = {plane.first.x + plane.second.x, plane.first.y + plane.second.y,
                                   plane.first.z + plane.second.z};
        for (int i = 0; i < 3; ++i) {
          if (in_plane[i] == 0) continue;
          text += std::string(" ") + letters[i] + std::to_string(to[i]);
          if (mode < 2)
            text += std::string(" ") + offsets[i] + std::to_string(mode == 1 ? c[i] : c[i] - from[i]);
        }
        if (mode == 2) text += " R10";
        const auto p = run(text);
        const auto arcs = all<cl::Arc>(p);
        ASSERT_EQ(arcs.size(), 1u) << text;
        expect_near(arcs[0].center, center, 1e-5);
        EXPECT_LE(norm(arcs[0].normal - (clockwise ? -1.0 : 1.0) * plane.normal), 1e-12) << text;
        EXPECT_NEAR(cl::arc_sweep(start, arcs[0]), kPi / 2, 1e-6) << text;
        EXPECT_NEAR(cl::totals(p).feed_mm, 10 * kPi / 2, 1e-5);
      }
    }
  }
}

TEST(Interpret, CirclesHelicesAndLongArcs) {
  EXPECT_NEAR(cl::totals(run("G21 G0 X10 Y0 Z0\nG2 I-10 F100\n")).feed_mm, 20 * kPi, 1e-9);
  EXPECT_NEAR(cl::totals(run("G21 G0 X10 Y0 Z0\nG3 X10 Y0 Z3 I-10 F100\n")).feed_mm, std::hypot(20 * kPi, 3),
              1e-9);
  EXPECT_NEAR(cl::totals(run("G21 G0 X10 Y0\nG3 X0 Y10 R-10 F100\n")).feed_mm, 15 * kPi, 1e-6);
  EXPECT_NEAR(cl::totals(run("G21 G0 X10 Y0\nG2 X0 Y10 R10 F100\n")).feed_mm, 5 * kPi, 1e-6);
  // Increments that meet again within rounding are a full turn, not a very short arc.
  EXPECT_NEAR(cl::totals(run("G21 G0 X0.1 Y0.7 F9\nG91 G1 X0.2\nX0.1\nX-0.3\nG90 G3 X0.1 Y0.7 I5\n")).feed_mm,
              0.6 + 10 * kPi, 1e-6);
}

TEST(Interpret, SpindleToolCoolantDwellStops) {
  const auto p = run("T3 M6\nS1000 M3 M8\nS2000\nG4 P1.5\nG4 X2\nM0\nM5 M9\nM2\nG1 X1\n");
  EXPECT_EQ(all<cl::ToolChange>(p).at(0).number, 3);
  EXPECT_EQ(all<cl::Spindle>(p),
            (std::vector<cl::Spindle>{{cl::Rotation::clockwise, 1000}, {cl::Rotation::clockwise, 2000}, {}}));
  EXPECT_EQ(all<cl::Coolant>(p), (std::vector<cl::Coolant>{{true}, {false}}));
  EXPECT_EQ(all<cl::Dwell>(p), (std::vector<cl::Dwell>{{1.5}, {2}}));
  EXPECT_EQ(all<cl::Unknown>(p), (std::vector<cl::Unknown>{{"STOP"}}));
  EXPECT_EQ(p.move_count(), 0u);
  EXPECT_EQ(all<cl::Dwell>(run("G4 P500", {.dwell_p_milliseconds = true})).at(0).seconds, 0.5);
}

TEST(Interpret, BeamInsteadOfSpindle) {
  const auto p = run("M4 S500\nG1 X1 F100\nX2 S250\nM5\n", {.beam = true, .watts_per_s = 0.1});
  EXPECT_EQ(all<cl::Beam>(p), (std::vector<cl::Beam>{{true, 50}, {true, 25}, {}}));
  EXPECT_TRUE(all<cl::Spindle>(p).empty());
}

TEST(Interpret, PercentAndEnds) {
  EXPECT_EQ(run("(leader)\n%\nO1 (PLATE)\nG0 X1\n%\nG0 X2 garbage").move_count(), 1u);
  EXPECT_EQ(run("%\nO1 (PLATE)\nM30\n%").name, "PLATE");
}

TEST(Interpret, ReferenceReturnIsLeftOutAndNotFedFrom) {
  Diagnostics diagnostics;
  const auto p = interpret("G21 G0 X1 Y1 Z5\nG91 G28 Z0\nG90 G0 X5\nG0 Z3\nG1 X9 F100\n", {}, diagnostics);
  ASSERT_TRUE(p) << p.error().to_string();
  EXPECT_EQ(diagnostics.count("machine_position"), 1u);
  EXPECT_TRUE(diagnostics.anything_left_out());
  const auto fed = interpret("G21 G0 X1 Y1 Z5\nG28 Z9\nG1 X9 F100\n", {}, diagnostics);
  ASSERT_FALSE(fed);
  EXPECT_EQ(fed.error().where.line, 3);
}

TEST(Interpret, RefusesWhatItWouldMisread) {
  const struct {
    const char* text;
    int line, column;
    ErrorCode code;
  } cases[] = {
      {"G0 X0\nG81 X1 Z-1 R1 F10", 2, 1, ErrorCode::unsupported},
      {"G41 D1", 1, 1, ErrorCode::unsupported},
      {"G21 G42 D1 X0", 1, 5, ErrorCode::unsupported},
      {"G92 X0", 1, 1, ErrorCode::unsupported},
      {"G71 Q100 D.5", 1, 1, ErrorCode::unsupported},
      {"G5.2 P1 L4", 1, 1, ErrorCode::unsupported},
      {"G106.2 P10", 1, 1, ErrorCode::unsupported},
      {"G95 G1 X1 F1", 1, 1, ErrorCode::unsupported},
      {"G999", 1, 1, ErrorCode::unsupported},
      {"M98 P100", 1, 1, ErrorCode::unsupported},
      {"G54\nG55", 2, 1, ErrorCode::unsupported},
      {"G0 X1\nG0 A90", 2, 4, ErrorCode::unsupported},
      {"G0 X1 E5", 1, 7, ErrorCode::unsupported},
      {"G0 X1 P5", 1, 7, ErrorCode::unsupported},
      {"X1", 1, 1, ErrorCode::syntax},
      {"G1 X1", 1, 1, ErrorCode::syntax},
      {"G1 X1 F-5", 1, 7, ErrorCode::range},
      {"G0 G1 X1", 1, 4, ErrorCode::syntax},
      {"G0 X1 X2", 1, 7, ErrorCode::syntax},
      {"F9 G2 X1", 1, 4, ErrorCode::syntax},
      {"F9 G2 X1 I1 R1", 1, 4, ErrorCode::syntax},
      {"F9 G2 X1 I1 K1", 1, 4, ErrorCode::syntax},
      {"F9 G2 X1 R0.4", 1, 4, ErrorCode::geometry},
      {"F9 G2 X10 I5.1", 1, 4, ErrorCode::geometry},
      {"F9 G2 X0 R5", 1, 4, ErrorCode::geometry},
      {"F9 G2 X5 I0 J0", 1, 4, ErrorCode::geometry},
      {"F9 G2 X0 I5 P3", 1, 13, ErrorCode::unsupported},
      {"G4", 1, 1, ErrorCode::syntax},
      {"G0 X1e5", 1, 6, ErrorCode::unsupported},
      {"G0 X99999999999", 1, 4, ErrorCode::range},
  };
  for (const auto& c : cases) {
    Diagnostics diagnostics;
    const auto p = interpret(c.text, {.file_name = "a.nc"}, diagnostics);
    ASSERT_FALSE(p) << c.text;
    EXPECT_EQ(p.error().code, c.code) << c.text << ": " << p.error().message;
    EXPECT_EQ(p.error().where.line, c.line) << c.text << ": " << p.error().message;
    EXPECT_EQ(p.error().where.column, c.column) << c.text << ": " << p.error().message;
    EXPECT_NE(p.error().message.find('('), std::string::npos);
  }
}

TEST(Interpret, RadiiMayDifferByTheControlsTolerance) {
  const auto read = [](double off) {
    Diagnostics diagnostics;
    return interpret("G21 G0 X10 Y0 F100\nG3 X0 Y" + std::to_string(10 + off) + " I-10 J0\n", {}, diagnostics)
        .ok();
  };
  EXPECT_TRUE(read(0.012));
  EXPECT_FALSE(read(0.014));
}

TEST(Interpret, WhatDoesNotMoveTheToolIsFine) {
  EXPECT_EQ(run("G17 G21 G40 G49 G54 G64 P0.01 G80 G90 G91.1 G94 G97 G98\nG5 P10000\nG43 H1\nM48\nG0 X1 "
                "B0\nG5 P0\n")
                .move_count(),
            1u);
  Diagnostics diagnostics;
  ASSERT_TRUE(interpret("M110 P3\nM110\n/G0 X1\n", {}, diagnostics));
  EXPECT_EQ(diagnostics.count("unknown_m_code"), 1u);
  EXPECT_EQ(diagnostics.count("block_skip"), 1u);
  EXPECT_EQ(diagnostics.count("units_assumed"), 1u);
}

}  // namespace
}  // namespace burin::nc
