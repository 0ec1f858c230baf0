// SPDX-License-Identifier: Apache-2.0
#include "burin/job/verify_laser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace burin::job {
namespace {

std::string svg(const std::string& shapes) {
  return R"(<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">)" +
         shapes + "</svg>";
}
LaserOutlines read(const std::string& shapes, const LaserOutlineOptions& options = {}) {
  Diagnostics notes;
  auto out = read_laser_outlines(svg(shapes), "drawing.svg", options, notes);
  EXPECT_TRUE(out) << out.error().to_string();
  return out ? std::move(*out) : LaserOutlines{};
}
double area(const verify::Outline& o) {
  return signed_area(geom::ArcSpline{o.segments, o.closed});
}

const char* const kNested =
    R"(<rect x="10" y="10" width="80" height="80"/><circle cx="50" cy="50" r="30"/>
       <rect x="40" y="40" width="20" height="20"/><circle cx="50" cy="50" r="5"/><circle cx="20" cy="20" r="4"/>)";

TEST(VerifyLaser, ThePartIsOnTheLeftByNesting) {
  const LaserOutlines o = read(kNested);
  ASSERT_EQ(o.outlines.size(), 5U);
  EXPECT_NEAR(area(o.outlines[0]), 6400, 1e-6);
  EXPECT_NEAR(area(o.outlines[1]), -900 * geom::kPi, 1e-6);
  EXPECT_NEAR(area(o.outlines[2]), 400, 1e-6);
  EXPECT_NEAR(area(o.outlines[3]), -25 * geom::kPi, 1e-6);
  EXPECT_NEAR(area(o.outlines[4]), -16 * geom::kPi, 1e-6);
  EXPECT_EQ(o.names[0].substr(0, 4), "rect");
  EXPECT_LE(o.bound_mm, 1e-9);
}

TEST(VerifyLaser, SidesAreAsAskedFor) {
  LaserOutlineOptions options;
  options.side = laser::Side::inside;
  for (const auto& o : read(kNested, options).outlines) EXPECT_LT(area(o), 0);
  options.side = laser::Side::outside;
  for (const auto& o : read(kNested, options).outlines) EXPECT_GT(area(o), 0);
  options.side = laser::Side::on;
  for (const auto& o : read(kNested, options).outlines) EXPECT_FALSE(o.closed);
}

TEST(VerifyLaser, CurvesAreWithinWhatIsSaid) {
  LaserOutlineOptions options;
  options.curve_mm = 1e-3;
  const LaserOutlines o = read(R"(<ellipse cx="50" cy="50" rx="40" ry="10"/>)", options);
  ASSERT_EQ(o.outlines.size(), 1U);
  EXPECT_GT(o.bound_mm, 0);
  EXPECT_LE(o.bound_mm, 1e-3);
  EXPECT_NEAR(area(o.outlines[0]), 400 * geom::kPi, 1e-3 * 170);
  const geom::ArcSpline spline{o.outlines[0].segments, true};
  for (int i = 0; i < 360; ++i) {
    const double u = geom::radians(i);
    EXPECT_LE(distance_to(spline, {50 + 40 * std::cos(u), 50 + 10 * std::sin(u)}), o.bound_mm + 1e-9);
  }
}

TEST(VerifyLaser, LayersAndOpenLines) {
  LaserOutlineOptions options;
  options.layers = {{"mark", laser::Treatment::engrave}, {"frame", laser::Treatment::ignore}};
  const LaserOutlines o = read(
      R"(<g id="cut"><rect x="10" y="10" width="30" height="30"/><path d="M15 15 L20 25"/></g>
         <g id="mark"><circle cx="25" cy="25" r="3"/></g><g id="frame"><rect x="0" y="0" width="99" height="99"/></g>)",
      options);
  ASSERT_EQ(o.outlines.size(), 3U);
  EXPECT_TRUE(o.outlines[0].closed);
  EXPECT_NEAR(area(o.outlines[0]), 900, 1e-9);
  EXPECT_FALSE(o.outlines[1].closed);
  EXPECT_FALSE(o.outlines[2].closed);  // engraved: a centre line, and no hole
}

TEST(VerifyLaser, GapsAreClosedAndCounted) {
  const LaserOutlines o = read(R"(<path d="M10 10 L90 10 L90 90.004"/><path d="M90 90 L10 90 L10 10"/>)");
  ASSERT_EQ(o.outlines.size(), 1U);
  EXPECT_TRUE(o.outlines[0].closed);
  EXPECT_NEAR(o.bound_mm, 0.002, 1e-6);
  const auto& s = o.outlines[0].segments;
  for (std::size_t i = 0; i < s.size(); ++i) EXPECT_EQ(s[i].b, s[(i + 1) % s.size()].a);
}

TEST(VerifyLaser, DrawingsThatSayNothingAreRefused) {
  Diagnostics notes;
  const auto code = [&](const std::string& bytes, const char* name, const LaserOutlineOptions& options = {}) {
    const auto r = read_laser_outlines(bytes, name, options, notes);
    EXPECT_FALSE(r);
    if (r) return ErrorCode::internal;
    EXPECT_EQ(r.error().where.file, name);
    return r.error().code;
  };
  EXPECT_EQ(code(svg(""), "a.svg"), ErrorCode::geometry);
  EXPECT_EQ(code("no drawing", "a.svg"), ErrorCode::syntax);
  EXPECT_EQ(code("x", "a.step"), ErrorCode::usage);
  LaserOutlineOptions layers;
  layers.layers = {{"nosuch", laser::Treatment::cut}};
  EXPECT_EQ(code(svg(kNested), "a.svg", layers), ErrorCode::usage);
  EXPECT_TRUE(is_drawing("Part.DXF"));
  EXPECT_FALSE(is_drawing("part.step"));
}

TEST(VerifyLaser, ProgramsOfBothKindsHaveTheirBeam) {
  Diagnostics notes;
  for (const char* text :
       {"G21 G90\nG0 X1 Y2\nM3 S500\nG1 X5 F1000\nM5\n",
        "PARTNO P\nRAPID\nGOTO/1,2,0\nBEAM/ON,500\nFEDRAT/1000,MMPM\nGOTO/5,2,0\nBEAM/OFF\nFINI\n"}) {
    auto p = read_laser_program(text, "p", notes);
    ASSERT_TRUE(p) << p.error().to_string();
    bool on = false, cut = false;
    for (const cl::Record& r : p->records) {
      if (const auto* beam = std::get_if<cl::Beam>(&r)) on = beam->on;
      cut = cut || (on && std::holds_alternative<cl::Feed>(r));
    }
    EXPECT_TRUE(cut);
    EXPECT_FALSE(on);
  }
  EXPECT_FALSE(read_laser_program("what is this", "p", notes));
}

}  // namespace
}  // namespace burin::job
