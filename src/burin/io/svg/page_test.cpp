// SPDX-License-Identifier: Apache-2.0
// Sizes: units, viewBox, resolution rules, nested viewports.
#include <gtest/gtest.h>

#include "burin/io/svg/svg_test_util.h"
#include "burin/io/svg/units.h"

namespace burin::io {
namespace {

using svg_test::error_of;
using svg_test::expect_point;
using svg_test::read;

constexpr const char* kNamespaces =
    "xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" "
    "xmlns:sodipodi=\"http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd\" ";

/// A line from (0, 0) to (100, 50) user units under the given root attributes.
std::string sheet(const std::string& root, const std::string& before = "") {
  return before + "<svg " + kNamespaces + root + "><line x2='100' y2='50' stroke='red'/></svg>";
}

struct Scale {
  double unit;    // mm per user unit, from the length of the line in x
  double bottom;  // y of its start
  std::string reason;
};
Scale scale_of(const std::string& text, Units units = Units::from_file) {
  ReadOptions options;
  options.units = units;
  const Drawing drawing = read(text, options);
  if (drawing.entities.size() != 1) return {};
  const geom::Curve2& line = drawing.entities[0].paths.at(0).curves.at(0);
  const geom::Point2 a = geom::start_point(line), b = geom::end_point(line);
  EXPECT_NEAR((b.x - a.x) / 100, (a.y - b.y) / 50, 1e-12);
  EXPECT_NEAR(drawing.mm_per_unit, (b.x - a.x) / 100, 1e-12);
  return {(b.x - a.x) / 100, a.y, drawing.units_reason};
}

TEST(Page, ResolutionRules) {
  EXPECT_NEAR(scale_of(sheet("")).unit, 25.4 / 96, 1e-15);
  EXPECT_EQ(scale_of(sheet("")).reason, "96 dpi");
  EXPECT_NEAR(scale_of(sheet("width='960' height='480'")).unit, 25.4 / 96, 1e-15);
  EXPECT_NEAR(scale_of(sheet("width='960px' height='480px' viewBox='0 0 960 480'")).unit, 25.4 / 96, 1e-15);
  for (const char* old : {"0.91 r13725", "0.48.5 r10040", "0.91", "0.45+devel"}) {
    const std::string root = "inkscape:version='" + std::string(old) + "'";
    EXPECT_NEAR(scale_of(sheet(root)).unit, 25.4 / 90, 1e-15) << old;
    // A page size in mm without viewBox says nothing of the user unit.
    EXPECT_NEAR(scale_of(sheet(root + " width='210mm' height='297mm'")).unit, 25.4 / 90, 1e-15) << old;
    EXPECT_NEAR(scale_of(sheet(root + " width='210mm' height='297mm' viewBox='0 0 210 297'")).unit, 1, 1e-15);
  }
  EXPECT_EQ(scale_of(sheet("inkscape:version='0.48.5 r10040'")).reason, "90 dpi (Inkscape 0.48.5)");
  EXPECT_NEAR(scale_of(sheet("sodipodi:version='0.32'")).unit, 25.4 / 90, 1e-15);
  for (const char* recent : {"0.92.1 r15371", "0.92", "1.0alpha (d0d1dbf8a0)", "1.3 (0e150ed6c4)"}) {
    EXPECT_NEAR(scale_of(sheet("inkscape:version='" + std::string(recent) + "'")).unit, 25.4 / 96, 1e-15)
        << recent;
  }
}

TEST(Page, Illustrator) {
  const std::string generator =
      "<?xml version='1.0'?>\n<!-- Generator: Adobe Illustrator 15.1.0, SVG Export -->\n";
  EXPECT_NEAR(scale_of(sheet("width='720px' height='72px' viewBox='0 0 720 72'", generator)).unit, 25.4 / 72,
              1e-15);
  EXPECT_NEAR(scale_of(sheet("viewBox='0 0 720 72'", generator)).unit, 25.4 / 72, 1e-15);
  EXPECT_EQ(scale_of(sheet("viewBox='0 0 720 72'", generator)).reason, "72 dpi (Illustrator)");
  // It wins over the version that an Inkscape before it has left.
  EXPECT_NEAR(scale_of(sheet("inkscape:version='0.48'", generator)).unit, 25.4 / 72, 1e-15);
  EXPECT_NEAR(scale_of(sheet("width='100mm' viewBox='0 0 200 100'", generator)).unit, 0.5, 1e-15);
  EXPECT_NEAR(scale_of(sheet("xmlns:i='http://ns.adobe.com/AdobeIllustrator/10.0/'")).unit, 25.4 / 72, 1e-15);
  // The comment of a drawing pasted into a group says nothing of this file.
  EXPECT_NEAR(read("<svg><g><!-- Generator: Adobe Illustrator 9 --></g><rect width='1' height='1'/></svg>")
                  .mm_per_unit,
              25.4 / 96, 1e-15);
}

TEST(Page, PhysicalUnits) {
  struct Case {
    const char* width;
    double mm;
  };
  for (const Case& c : {Case{"100mm", 100}, Case{"10cm", 100}, Case{"400Q", 100}, Case{"2in", 50.8},
                        Case{"72pt", 25.4}, Case{"6pc", 25.4}, Case{" 1.5e2mm ", 150}, Case{"96px", 25.4},
                        Case{"96", 25.4}, Case{"100MM", 100}, Case{"6em", 25.4}, Case{"12ex", 25.4}}) {
    const std::string root = "width='" + std::string(c.width) + "' viewBox='0 0 200 100'";
    EXPECT_NEAR(scale_of(sheet(root)).unit, c.mm / 200, 1e-12) << c.width;
    EXPECT_NEAR(scale_of(sheet(root)).bottom, c.mm / 2, 1e-12) << c.width;
  }
  EXPECT_EQ(scale_of(sheet("width='210mm' height='297mm' viewBox='0 0 21000 29700'")).reason,
            "width 210mm over viewBox 21000");
  EXPECT_NEAR(scale_of(sheet("height='50mm' viewBox='0 0 200 100'")).unit, 0.5, 1e-12);
  EXPECT_NEAR(scale_of(sheet("width='100%' height='100%' viewBox='0 0 200 100'")).unit, 25.4 / 96, 1e-12);
}

TEST(Page, YIsTurnedUp) {
  EXPECT_DOUBLE_EQ(scale_of(sheet("height='80mm'")).bottom, 80);
  EXPECT_DOUBLE_EQ(scale_of(sheet("height='96'")).bottom, 25.4);
  EXPECT_DOUBLE_EQ(scale_of(sheet("")).bottom, 0);
  EXPECT_DOUBLE_EQ(scale_of(sheet("width='100mm' height='70mm' viewBox='5 20 100 70'")).bottom, 90);
}

TEST(Page, UnitsOptionOverridesTheFile) {
  for (const char* root : {"", "width='210mm' viewBox='0 0 21000 29700'", "inkscape:version='0.48'"}) {
    EXPECT_DOUBLE_EQ(scale_of(sheet(root), Units::mm).unit, 1) << root;
    EXPECT_DOUBLE_EQ(scale_of(sheet(root), Units::inch).unit, 25.4) << root;
  }
  EXPECT_EQ(scale_of(sheet(""), Units::inch).reason, "--units inch");
  EXPECT_DOUBLE_EQ(scale_of(sheet("width='10' height='7' viewBox='0 0 100 70'"), Units::mm).bottom, 70);
  EXPECT_DOUBLE_EQ(scale_of(sheet("height='70'"), Units::inch).bottom, 70 * 25.4);
}

TEST(Page, AspectRatioOfTheRoot) {
  // A viewBox of 100 x 100 on a page of 200 x 100 mm: fits with factor 1, covers with factor 2.
  struct Case {
    const char* ratio;
    double scale, x0, y0;  // y0 from the top
  };
  for (const Case& c : {Case{"xMidYMid meet", 1, 50, 0}, Case{"", 1, 50, 0}, Case{"xMinYMin", 1, 0, 0},
                        Case{"xMaxYMid meet", 1, 100, 0}, Case{"xMidYMid slice", 2, 0, -50},
                        Case{"xMinYMin slice", 2, 0, 0}, Case{"xMaxYMax slice", 2, 0, -100}}) {
    const Drawing drawing =
        read("<svg width='200mm' height='100mm' viewBox='0 0 100 100' preserveAspectRatio='" +
             std::string(c.ratio) + "'><line x2='10'/></svg>");
    ASSERT_EQ(drawing.entities.size(), 1u);
    const geom::Curve2& line = drawing.entities[0].paths[0].curves[0];
    expect_point(geom::start_point(line), c.x0, 100 - c.y0);
    expect_point(geom::end_point(line), c.x0 + 10 * c.scale, 100 - c.y0);
  }
  const Drawing stretched = read(
      "<svg width='200mm' height='50mm' viewBox='0 0 100 100' preserveAspectRatio='none'><circle "
      "r='10'/></svg>");
  const geom::Box2 box = bounds(stretched);
  expect_point(box.lo, -20, 45, 1e-6);
  expect_point(box.hi, 20, 55, 1e-6);
  EXPECT_TRUE(std::holds_alternative<geom::EllipseArc2>(stretched.entities[0].paths[0].curves[0]));
}

TEST(Page, ImpossibleSizesAreRefused) {
  for (const char* root :
       {"width='0'", "width='-5mm'", "height='abc'", "viewBox='0 0 0 10'", "viewBox='0 0 10'",
        "viewBox='0 0 -1 5'", "viewBox='0 0 1e999 5'", "width='5 mm 3'"}) {
    EXPECT_NE(error_of(sheet(root)).message.find("("), std::string::npos) << root;
  }
}

TEST(Page, LengthsWithUnitsInsideTheDrawing) {
  // 10 mm are 37.8 px of 1/96 inch: user units of 1 mm make them 37.8 mm, as the standard says.
  const Drawing drawing = read(
      "<svg width='200mm' height='100mm' viewBox='0 0 200 100'>"
      "<line x2='10mm'/><line x2='50%' y2='50%'/><circle r='10%'/></svg>");
  ASSERT_EQ(drawing.entities.size(), 3u);
  expect_point(geom::end_point(drawing.entities[0].paths[0].curves[0]), 960 / 25.4, 100);
  expect_point(geom::end_point(drawing.entities[1].paths[0].curves[0]), 100, 50);
  EXPECT_NEAR(std::get<geom::Arc2>(drawing.entities[2].paths[0].curves[0]).radius,
              0.1 * std::sqrt((200.0 * 200 + 100 * 100) / 2), 1e-9);
  EXPECT_EQ(error_of("<svg><line x2='50%'/></svg>").code, ErrorCode::unsupported);
}

TEST(Page, NestedSvg) {
  const Drawing drawing =
      read(svg_test::page("<svg x='10' y='-50' width='40' height='20' viewBox='0 0 4 4'><line x2='4'/></svg>"
                          "<svg x='10%' y='0'><line x2='4'/></svg>"
                          "<svg viewBox='0 0 10 10'><line x2='50%'/></svg>"));
  ASSERT_EQ(drawing.entities.size(), 3u);
  const auto line = [&](std::size_t i) { return drawing.entities[i].paths[0].curves[0]; };
  expect_point(geom::start_point(line(0)), 20, 50);  // 20 x 20 in the middle of 40 x 20
  expect_point(geom::end_point(line(0)), 40, 50);
  expect_point(geom::start_point(line(1)), 10, 0);
  expect_point(geom::end_point(line(1)), 14, 0);
  expect_point(geom::end_point(line(2)), 50, 0);  // 100 % of the page, and 50 % of its own viewBox
}

TEST(Length, Texts) {
  for (const char* bad : {"", "mm", "1 2", "1km", "--1", "1e", "0x10", "1mm;"})
    EXPECT_FALSE(svg::parse_length(bad)) << bad;
  EXPECT_EQ(svg::parse_length("-.5em")->value, -0.5);
  EXPECT_EQ(svg::parse_length("1e1ex")->unit, svg::Unit::ex);
}

}  // namespace
}  // namespace burin::io
