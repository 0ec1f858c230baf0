// SPDX-License-Identifier: Apache-2.0
#include "burin/nc/surface_program.h"

#include <gtest/gtest.h>

#include "burin/base/file.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/nc/program.h"

namespace burin::nc {
namespace {

using geom::Point3;
using geom::Vec3;

struct Read {
  SurfaceProgram program;
  Diagnostics diagnostics;
};

Read read(std::string_view text, SurfaceReadOptions options = {.file_name = "a.nc"}) {
  Read out;
  auto program = read_surface_program(text, options, out.diagnostics);
  EXPECT_TRUE(program) << program.error().to_string();
  if (program) out.program = *std::move(program);
  return out;
}

Error fail(std::string_view text, bool strict = false) {
  Diagnostics diagnostics;
  auto program = read_surface_program(text, {.file_name = "a.nc", .strict = strict}, diagnostics);
  EXPECT_FALSE(program) << text;
  return program ? Error{} : program.error();
}

std::string example(const std::string& name) {
  auto text = read_file(std::string(BURIN_SOURCE_DIR) + "/examples/" + name);
  EXPECT_TRUE(text) << name;
  return text ? *text : "";
}

template <class T>
std::vector<T> all(const SurfaceProgram& program) {
  std::vector<T> found;
  for (const Step& step : program.steps)
    if (const T* one = std::get_if<T>(&step)) found.push_back(*one);
  return found;
}

/// Ends of the straight moves.
std::vector<Point3> ends(const SurfaceProgram& program) {
  std::vector<Point3> found;
  for (const Plain& plain : all<Plain>(program))
    if (const cl::Pose* pose = cl::pose_of(plain.record)) found.push_back(pose->tip);
  return found;
}

/// 2 x 2 points of order 2 over the square [x, x + 10]^2.
std::string square(int x, const std::string& words, const std::string& code = "") {
  const std::string a = std::to_string(x), b = std::to_string(x + 10);
  return code + "G06.23 U2 V2 P2 Q2 " + words + "\nX" + a + " Y0 Z0 W1\nX" + b + "\nX" + a + " Y10\nX" + b +
         "\n";
}

constexpr const char* kCut = "D5 F500 S0.01";

TEST(SurfaceProgram, Table2RunsAsPrinted) {
  const Read r = read(example("table2/table2.nc"));
  ASSERT_EQ(r.program.blocks.size(), 3u);
  EXPECT_EQ(r.program.blocks[0].number, 10);
  EXPECT_EQ(r.program.blocks[2].tool_diameter, 3);
  const auto groups = all<MachineGroup>(r.program);
  ASSERT_EQ(groups.size(), 3u);

  EXPECT_TRUE(groups[0].join);
  EXPECT_EQ(groups[0].line, 3);
  EXPECT_EQ(groups[0].blocks, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(groups[0].method, PathMethod::iso_parametric);
  EXPECT_EQ(groups[0].grouping, geom::Grouping::largest);
  EXPECT_EQ(groups[0].tool_diameter, 5);
  EXPECT_EQ(groups[0].side_step, 0.01);
  EXPECT_EQ(groups[0].scallop, 0.001);
  EXPECT_EQ(groups[0].feed, 500);
  EXPECT_EQ(groups[0].safety_z, 15);
  EXPECT_EQ(groups[0].start, (Point3{0, 0, 0}));

  EXPECT_FALSE(groups[1].join);
  EXPECT_EQ(groups[1].safety_z, 40);
  EXPECT_EQ(groups[1].tool_diameter, 3);
  EXPECT_FALSE(groups[1].side_step);
  EXPECT_EQ(groups[1].displacement, (Vec3{}));
  EXPECT_FALSE(groups[1].repeat);
  EXPECT_TRUE(groups[2].repeat);
  EXPECT_EQ(groups[2].displacement, (Vec3{10, 0, 0}));
  EXPECT_EQ(groups[2].blocks, (std::vector<std::size_t>{2}));

  // N70 G00 Z40. is a step of 40 up from the 40 of W: the warning says so, with its place.
  ASSERT_EQ(ends(r.program).size(), 3u);
  EXPECT_EQ(ends(r.program)[1], (Point3{10, 0, 40}));  // back over where N50 commanded
  EXPECT_EQ(ends(r.program)[2], (Point3{10, 0, 80}));
  EXPECT_EQ(r.diagnostics.count("modal_g91"), 1u);
  EXPECT_EQ(r.diagnostics.count("units_assumed"), 1u);
  EXPECT_EQ(r.diagnostics.warnings().size(), 2u);
  EXPECT_FALSE(r.diagnostics.anything_left_out());
  const Warning& modal = r.diagnostics.warnings()[1];
  EXPECT_NE(modal.message.find("moves by 40 mm, from 40 to 80"), std::string::npos) << modal.message;
  EXPECT_EQ(modal.where.line, 118);
  EXPECT_EQ(modal.where.column, 9);
  EXPECT_EQ(r.program.nc_blocks, 119u);
}

TEST(SurfaceProgram, TheKeysAreTheCopiedKeys) {
  const Read once = read(example("keys/keys.nc")), copied = read(example("keys/keys_copied.nc"));
  EXPECT_TRUE(once.diagnostics.empty());
  const auto a = all<MachineGroup>(once.program), b = all<MachineGroup>(copied.program);
  ASSERT_EQ(a.size(), 6u);
  ASSERT_EQ(b.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(a[i].repeat, i > 0);
    EXPECT_FALSE(b[i].repeat);
    EXPECT_EQ(a[i].safety_z, 40);
    const auto& surface = once.program.blocks[a[i].blocks.at(0)].surface;
    const auto& other = copied.program.blocks[b[i].blocks.at(0)].surface;
    ASSERT_EQ(surface.points.size(), other.points.size());
    for (std::size_t k = 0; k < surface.points.size(); ++k)
      EXPECT_LE(distance(project(surface.points[k]) + a[i].displacement, project(other.points[k])), 1e-4);
  }
  EXPECT_LT(3 * example("keys/keys.nc").size(), example("keys/keys_copied.nc").size());
}

TEST(SurfaceProgram, NinePatchesOfTheClock) {
  const Read r = read(example("clock/clock.nc"));
  EXPECT_TRUE(r.diagnostics.empty());
  ASSERT_EQ(r.program.blocks.size(), 9u);
  const auto groups = all<MachineGroup>(r.program);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].blocks.size(), 9u);
  EXPECT_EQ(groups[0].method, PathMethod::iso_scallop);
  for (const SurfaceBlock& block : r.program.blocks) {
    EXPECT_EQ(block.tool_diameter, 8);  // from the cycle
    EXPECT_EQ(block.scallop, 0.02);
    EXPECT_EQ(block.feed, 1500);
    EXPECT_TRUE(geom::validate(block.surface));
  }
  // Left and lower neighbours touch: N20's left edge is N10's right one.
  const auto &a = r.program.blocks[0].surface, &b = r.program.blocks[1].surface;
  for (double v : {0.0, 0.3, 1.0}) EXPECT_LE(distance(point(a, 1, v), point(b, 0, v)), 1e-5);
}

TEST(SurfaceProgram, WordsStayPointByPoint) {
  const Read r = read("G21\nG6.23 U3 V2 P2 Q2 D5 F9 S.1 L.2\nX1 Y2 Z3 W.5\nX2\nY3 W2\nx1 y5 z4 w1\nX2\nX3\n");
  const auto& s = r.program.blocks.at(0).surface;
  const Point3 want[] = {{1, 2, 3}, {2, 2, 3}, {2, 3, 3}, {1, 5, 4}, {2, 5, 4}, {3, 5, 4}};
  const double weights[] = {.5, .5, 2, 1, 1, 1};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_LE(distance(project(s.points[i]), want[i]), 1e-12);
    EXPECT_EQ(s.points[i].w, weights[i]);
  }
  EXPECT_EQ(s.knots_u, (std::vector<double>{0, 0, 0.5, 1, 1}));
  EXPECT_EQ(s.knots_v, (std::vector<double>{0, 0, 1, 1}));
  EXPECT_EQ(r.program.blocks[0].stock, 0.2);
}

TEST(SurfaceProgram, KnotsOfUThenOfV) {
  const Read r = read(
      "G21\nG6.23 U3 V2 P3 Q2 D5 F9 S.1\nX0 Y0 Z0\nX1\nX2\nX0 Y1\nX1\nX2\n"
      "K-1\nK-1\nK-1\nK4\nK4\nK4\nN5 K0\nK0.\nK2\nK2.0\n");
  const auto& s = r.program.blocks.at(0).surface;
  EXPECT_EQ(s.knots_u, (std::vector<double>{-1, -1, -1, 4, 4, 4}));
  EXPECT_EQ(s.knots_v, (std::vector<double>{0, 0, 2, 2}));
}

TEST(SurfaceProgram, AloneASurfaceIsMachinedByItselfFromWhereTheToolStands) {
  const Read r = read("G21 G0 X1 Y2 Z30\n" + square(0, kCut) + "G0 Z50\n");
  const auto groups = all<MachineGroup>(r.program);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_FALSE(groups[0].join);
  EXPECT_EQ(groups[0].method, PathMethod::iso_parametric);
  EXPECT_EQ(groups[0].safety_z, 30);
  EXPECT_EQ(groups[0].start, (Point3{1, 2, 30}));
  EXPECT_EQ(ends(r.program), (std::vector<Point3>{{1, 2, 30}, {1, 2, 30}, {1, 2, 50}}));
}

TEST(SurfaceProgram, ARapidToAPlaceNeedsNoWayBack) {
  const Read r = read("G21 G0 X1 Y2 Z30\n" + square(0, kCut) + "G0 X9 Y9\n");
  EXPECT_EQ(ends(r.program), (std::vector<Point3>{{1, 2, 30}, {9, 9, 30}}));
}

TEST(SurfaceProgram, DisplacementsOfRepeats) {
  const Read r = read("G21 G90 G0 X5 Y0 Z20\nG106.1 W40 I2 M2\n" + square(0, kCut) +
                      "G91 X10\nX10 L2\nY-5\nG90 X5 Y0\nX7 Z21\nG80\nG0 X0\n");
  const auto groups = all<MachineGroup>(r.program);
  ASSERT_EQ(groups.size(), 7u);
  const Vec3 want[] = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {30, 0, 0}, {30, -5, 0}, {0, 0, 0}, {2, 0, 1}};
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_LE(norm(groups[i].displacement - want[i]), 1e-12) << i;
    EXPECT_EQ(groups[i].method, PathMethod::iso_scallop);
    EXPECT_EQ(groups[i].side_step, 2);
    EXPECT_EQ(groups[i].safety_z, 40);
  }
  EXPECT_EQ(groups[0].start, (Point3{5, 0, 20}));
  EXPECT_EQ(groups[1].start, (Point3{5, 0, 40}));
  EXPECT_EQ(groups[2].start, (Point3{15, 0, 40}));
  EXPECT_EQ(ends(r.program).back(), (Point3{0, 0, 40}));
  EXPECT_EQ(r.diagnostics.count("modal_g91"), 0u);
}

TEST(SurfaceProgram, LOfTheCycleHoldsForEachMove) {
  const Read r =
      read("G21 G90 G0 Z20\nG106.1 W0 L3\n" + square(0, kCut) + "G91 X10\nY10 L1\nG80 G90\nG0 X0\n");
  const auto groups = all<MachineGroup>(r.program);
  ASSERT_EQ(groups.size(), 5u);
  EXPECT_EQ(groups[3].displacement, (Vec3{30, 0, 0}));
  EXPECT_EQ(groups[4].displacement, (Vec3{30, 10, 0}));
  EXPECT_EQ(groups[4].safety_z, 20);  // W0: back to where it stood
}

TEST(SurfaceProgram, TheLastSurfaceIsRepeated) {
  const Read r = read("G21 G90 G0 Z20\nG106.1 W30\n" + square(0, kCut) + square(20, "") + "G91 X50\n");
  const auto groups = all<MachineGroup>(r.program);
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[1].tool_diameter, 5);  // D, S and L stay from block to block
  EXPECT_EQ(groups[2].blocks, (std::vector<std::size_t>{1}));
  EXPECT_EQ(r.diagnostics.count("repeats_last_surface"), 1u);
}

TEST(SurfaceProgram, JoinedOnceAtThePlaceOfTheLast) {
  const Read r =
      read("G21 G0 Z50\nG106.2 P10 Q30 W60 E3 I2\nM3 S800\n" + square(0, kCut, "N10 ") + square(10, kCut) +
           "M8\n" + square(20, kCut, "N30 ") + square(40, "", "N40 ") + "G0 Z90\n");
  const auto groups = all<MachineGroup>(r.program);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].blocks, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(groups[0].grouping, geom::Grouping::u_first);
  EXPECT_FALSE(groups[1].join);  // N40 stands behind the cycle
  EXPECT_EQ(groups[1].safety_z, 60);
  std::size_t coolant = 0, first_group = 0;
  for (std::size_t i = 0; i < r.program.steps.size(); ++i) {
    if (const auto* plain = std::get_if<Plain>(&r.program.steps[i]))
      if (std::holds_alternative<cl::Coolant>(plain->record)) coolant = i;
    if (std::holds_alternative<MachineGroup>(r.program.steps[i]) && first_group == 0) first_group = i;
  }
  EXPECT_LT(coolant, first_group);
}

TEST(SurfaceProgram, InchesAreMillimetres) {
  const Read r = read("G20 G90 G0 Z2\nG106.1 W1. M.1 D.5\n" + square(0, "D5 F10 S.001 L.01") + "G91 X1\n");
  const auto groups = all<MachineGroup>(r.program);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_NEAR(groups[0].safety_z, 25.4, 1e-12);
  EXPECT_NEAR(*groups[0].side_step, 2.54, 1e-12);
  EXPECT_NEAR(groups[0].tool_diameter, 12.7, 1e-12);  // the cycle's
  EXPECT_NEAR(groups[0].scallop, 0.0254, 1e-12);
  EXPECT_NEAR(groups[0].stock, 0.254, 1e-12);
  EXPECT_NEAR(groups[0].feed, 254, 1e-12);
  EXPECT_NEAR(groups[1].displacement.x, 25.4, 1e-12);
  EXPECT_NEAR(project(r.program.blocks[0].surface.points[1]).x, 254, 1e-9);
}

TEST(SurfaceProgram, PointsAreAbsoluteEvenInG91) {
  const Read r = read("G21 G90 G0 X5 Y5 Z20\nG91\n" + square(0, kCut));
  EXPECT_EQ(project(r.program.blocks[0].surface.points[3]), (Point3{10, 10, 0}));
  EXPECT_EQ(r.diagnostics.count("points_absolute"), 1u);
}

TEST(SurfaceProgram, CurvesAsOnFanuc) {
  const Read r = read("G21 G0 X1 Y2 Z3\nG06.2 P3 K0 X1 Y2 R1 F100\nK0 X3 R.5\nK0 Y4\nK2\nK2\nK2\nG1 X0\n");
  const auto curves = all<CurveMove>(r.program);
  ASSERT_EQ(curves.size(), 1u);
  const geom::NurbsCurve& c = curves[0].curve;
  EXPECT_EQ(c.degree, 2);
  EXPECT_EQ(c.knots, (std::vector<double>{0, 0, 0, 2, 2, 2}));
  EXPECT_EQ(project(c.points[1]), (Point3{3, 2, 3}));
  EXPECT_EQ(c.points[1].w, 0.5);
  EXPECT_EQ(c.points[2].w, 1);  // R left out is 1, not the R before
  EXPECT_EQ(curves[0].feed, 100);
  EXPECT_EQ(curves[0].line, 2);
  EXPECT_EQ(ends(r.program).back(), (Point3{0, 4, 3}));
}

TEST(SurfaceProgram, CurveFromWhereTheToolStands) {
  const Read a = read("G21 G0 X1 Y2 Z3 F50\nG06.2 P2\nK0 X4 Y2\nK1\nK1\n");
  const Read b = read("G21 G0 X1 Y2 Z3 F50\nG06.2 P2 K0 X1\nK0 X4\nK1\nK1\n");
  ASSERT_EQ(all<CurveMove>(a.program).size(), 1u);
  EXPECT_EQ(all<CurveMove>(a.program)[0].curve, all<CurveMove>(b.program)[0].curve);
}

TEST(SurfaceProgram, CurvesAsOnLinuxCNC) {
  const Read a = read("G21 G0 X1 Y2 F50\nG6.2 P2 X1 Y2 R1 K0 Q3\nX4 Y2 R1 K0\nG6.2 K1\nG6.2 K1\nG1 X9\n");
  ASSERT_EQ(all<CurveMove>(a.program).size(), 1u);
  EXPECT_EQ(a.diagnostics.count("word_without_effect"), 1u);
}

TEST(SurfaceProgram, CurveAfterASurfaceStartsWhereTheProgramCounts) {
  const Read r = read("G21 G0 X1 Y2 Z30\n" + square(0, kCut) + "G06.2 P2 K0 X1 Y2\nK0 X4\nK1\nK1\n");
  EXPECT_EQ(ends(r.program), (std::vector<Point3>{{1, 2, 30}, {1, 2, 30}}));
}

TEST(SurfaceProgram, TrimComments) {
  const Read r = read("G21\n" + square(0, kCut) +
                      "(BURIN TRIM LOOP 3)\n(burin trim 0,0 1,0.5)\n(x)\n(BURIN TRIM 0.25,1)\n"
                      ";BURIN TRIM LOOP 4\n( BURIN TRIM .1,.1 .2,.1 .2,.2 .1,.2 )\nG0 Z5\n");
  const auto& trims = r.program.blocks.at(0).trims;
  ASSERT_EQ(trims.size(), 2u);
  EXPECT_EQ(trims[0].points, (std::vector<geom::Point2>{{0, 0}, {1, 0.5}, {0.25, 1}}));
  EXPECT_EQ(trims[1].points.size(), 4u);
}

TEST(SurfaceProgram, StrictTurnsWarningsIntoErrors) {
  const Error modal = fail("G21 G90 G0 Z20\nG106.1 W30\n" + square(0, kCut) + "G91 X9\nG80\nG0 Z40\n", true);
  EXPECT_EQ(modal.where.line, 10);
  EXPECT_EQ(modal.where.column, 4);
  EXPECT_EQ(fail(square(0, kCut), true).where.line, 1);  // the unit
  EXPECT_EQ(fail("G21\nM77\n", true).where.line, 2);
  Diagnostics none;
  EXPECT_TRUE(read_surface_program("G21 G0 Z5\n" + square(0, kCut), {.strict = true}, none));
}

TEST(SurfaceProgram, SizesAreCheckedBeforeTheyAreUsed) {
  EXPECT_EQ(fail("G21\nG6.23 U4000000 V4000000 D5 F9 S.1\nX0 Y0 Z0\n").code, ErrorCode::range);
  EXPECT_EQ(fail("G21\nG6.23 U2000 V2000 D5 F9 S.1\nX0 Y0 Z0\n").code, ErrorCode::range);
  EXPECT_EQ(fail("G21 G0 Z9\nG106.1 W9\n" + square(0, kCut) + "G91\n" +
                 [] {
                   std::string text;
                   for (int i = 0; i < 20; ++i) text += "X1 L9999\n";
                   return text;
                 }())
                .code,
            ErrorCode::range);
}

TEST(SurfaceProgram, OrdinaryProgramsReadAsTheyDid) {
  const std::string text =
      "%\nO7 (PLATE)\nG21 G90 T2 M6\nS900 M3\nG0 X1 Y2 Z3\nG1 Z0 F50\nG2 X3 I1\nG4 P1\nM30\n%\n";
  Diagnostics d;
  const auto plain = interpret(text, {}, d);
  const Read r = read(text);
  ASSERT_TRUE(plain);
  ASSERT_EQ(r.program.steps.size(), plain->records.size());
  for (std::size_t i = 0; i < plain->records.size(); ++i) {
    EXPECT_EQ(std::get<Plain>(r.program.steps[i]).record, plain->records[i]);
    EXPECT_EQ(static_cast<std::uint32_t>(std::get<Plain>(r.program.steps[i]).line), plain->source[i]);
  }
  EXPECT_EQ(r.program.name, "PLATE");
}

}  // namespace
}  // namespace burin::nc
