// SPDX-License-Identifier: Apache-2.0
// Whole files: elements, transforms, use, layers, XML, limits.
#include "burin/io/svg/read_svg.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

#include "burin/base/text.h"
#include "burin/io/svg/svg_test_util.h"
#include "burin/io/svg/transform_list.h"

namespace burin::io {
namespace {

using geom::Affine2;
using geom::Point2;
using svg_test::error_of;
using svg_test::expect_point;
using svg_test::page;
using svg_test::path;
using svg_test::read;

Point2 start_of(const Entity& entity) {
  return geom::start_point(entity.paths.at(0).curves.front());
}
Point2 end_of(const Entity& entity) {
  return geom::end_point(entity.paths.at(0).curves.back());
}

// --- shapes
// ---------------------------------------------------------------------------------------------------

TEST(Shapes, CircleAndEllipse) {
  const Drawing drawing =
      read(page("<circle cx='5' cy='-6' r='2'/><ellipse cx='1' cy='-2' rx='4' ry='3'/>"
                "<ellipse rx='3' ry='3'/><ellipse rx='3'/>"));
  ASSERT_EQ(drawing.entities.size(), 4u);
  const auto& circle = std::get<geom::Arc2>(drawing.entities[0].paths[0].curves[0]);
  expect_point(circle.center, 5, 6);
  EXPECT_NEAR(circle.radius, 2, 1e-12);
  EXPECT_NEAR(std::abs(circle.sweep), 2 * geom::kPi, 1e-12);
  EXPECT_TRUE(drawing.entities[0].paths[0].closed);
  const geom::Curve2& ellipse = drawing.entities[1].paths[0].curves[0];
  ASSERT_TRUE(std::holds_alternative<geom::EllipseArc2>(ellipse));
  for (int i = 0; i < 20; ++i) {
    const Point2 p = geom::point_at(ellipse, i / 20.0);
    EXPECT_NEAR(std::hypot((p.x - 1) / 4, (p.y - 2) / 3), 1, 1e-12);
  }
  EXPECT_TRUE(std::holds_alternative<geom::Arc2>(drawing.entities[2].paths[0].curves[0]));
  EXPECT_TRUE(std::holds_alternative<geom::Arc2>(drawing.entities[3].paths[0].curves[0]));
}

TEST(Shapes, RectWithItsCorners) {
  struct Case {
    const char* radii;
    double rx, ry;
    std::size_t curves;
  };
  // 20 x 10: area w h - (4 - pi) rx ry.
  for (const Case& c :
       {Case{"", 0, 0, 4}, Case{"rx='2'", 2, 2, 8}, Case{"ry='3'", 3, 3, 8}, Case{"rx='4' ry='2'", 4, 2, 8},
        Case{"rx='50'", 10, 5, 4}, Case{"rx='1' ry='9'", 1, 5, 6}, Case{"rx='10' ry='1'", 10, 1, 6},
        Case{"rx='0' ry='3'", 0, 0, 4}, Case{"rx='auto' ry='3'", 3, 3, 8}}) {
    const Drawing drawing =
        read(page("<rect x='1' y='-30' width='20' height='10' " + std::string(c.radii) + "/>"));
    ASSERT_EQ(drawing.entities.size(), 1u);
    const Path& path = drawing.entities[0].paths.at(0);
    EXPECT_TRUE(path.closed);
    EXPECT_EQ(path.curves.size(), c.curves) << c.radii;
    double area = 0, x_min = 1e9, x_max = -1e9;
    constexpr int kSteps = 2000;
    for (const geom::Curve2& curve : path.curves) {
      for (int i = 0; i < kSteps; ++i) {
        const Point2 p = geom::point_at(curve, static_cast<double>(i) / kSteps);
        const Point2 q = geom::point_at(curve, static_cast<double>(i + 1) / kSteps);
        area += (p.x * q.y - q.x * p.y) / 2;
        x_min = std::min(x_min, p.x), x_max = std::max(x_max, p.x);
      }
    }
    EXPECT_NEAR(std::abs(area), 200 - (4 - geom::kPi) * c.rx * c.ry, 1e-4) << c.radii;
    EXPECT_NEAR(x_min, 1, 1e-9);
    EXPECT_NEAR(x_max, 21, 1e-9);
    const bool round = c.rx == c.ry && c.rx > 0;
    for (const geom::Curve2& curve : path.curves) {
      if (std::holds_alternative<geom::Line2>(curve)) continue;
      EXPECT_EQ(std::holds_alternative<geom::Arc2>(curve), round) << c.radii;
    }
  }
}

TEST(Shapes, LinePolylinePolygon) {
  const Drawing drawing =
      read(page("<line x1='1' y1='-2' x2='3' y2='-4'/><polyline points='0,0 5,0 5-5'/>"
                "<polygon points=' 0 0, 5 0 5,-5 '/><polygon points='0 0 5 0 0 0'/>"));
  ASSERT_EQ(drawing.entities.size(), 4u);
  expect_point(start_of(drawing.entities[0]), 1, 2);
  expect_point(end_of(drawing.entities[0]), 3, 4);
  EXPECT_EQ(drawing.entities[1].paths[0].curves.size(), 2u);
  EXPECT_FALSE(drawing.entities[1].paths[0].closed);
  EXPECT_EQ(drawing.entities[2].paths[0].curves.size(), 3u);
  EXPECT_TRUE(drawing.entities[2].paths[0].closed);
  EXPECT_EQ(drawing.entities[3].paths[0].curves.size(), 2u);
}

TEST(Shapes, SizeZeroIsReportedAndNegativeRefused) {
  Diagnostics diagnostics;
  const auto drawing = svg_test::try_read(
      page("<rect width='0' height='5'/><circle/><ellipse rx='0' ry='1'/><line/><polyline points='1 1'/>" +
           path("M1 1 M2 2z") + "<path/><path d=''/><polygon points=''/>"),
      diagnostics);
  ASSERT_TRUE(drawing.ok());
  EXPECT_TRUE(drawing->entities.empty());
  EXPECT_EQ(diagnostics.count("zero_length"), 6u);
  EXPECT_EQ(error_of(page("<rect width='-1' height='5'/>")).code, ErrorCode::range);
  EXPECT_EQ(error_of(page("<circle r='-1'/>")).code, ErrorCode::range);
  EXPECT_EQ(error_of(page("<circle r='x'/>")).code, ErrorCode::syntax);
  EXPECT_EQ(error_of(page("<polyline points='1 2 3'/>")).code, ErrorCode::syntax);
  EXPECT_EQ(error_of(page("<polyline points='1 2 3 b'/>")).code, ErrorCode::syntax);
}

TEST(Shapes, DamagedPathNamesElementAndPlace) {
  const Error error = error_of("<svg>\n<g>\n<path id='wing' d='M0 0 L5 5 L7'/></g></svg>");
  EXPECT_EQ(error.code, ErrorCode::syntax);
  EXPECT_EQ(error.where.line, 3);
  EXPECT_EQ(error.where.entity, "path#wing");
  EXPECT_EQ(error.where.file, "test.svg");
  EXPECT_NE(error.message.find("character 13"), std::string::npos) << error.message;
}

// --- transforms
// -------------------------------------------------------------------------------------------------

TEST(Transform, Functions) {
  struct Case {
    const char* text;
    double x, y;  // image of (2, 3)
  };
  for (const Case& c :
       {Case{"", 2, 3}, Case{"none", 2, 3}, Case{"translate(10)", 12, 3}, Case{"translate(10,20)", 12, 23},
        Case{"translate(10 20),scale(2)", 14, 26}, Case{"scale(2)translate(10 20)", 24, 46},
        Case{"scale(2,-1)", 4, -3}, Case{"rotate(90)", -3, 2}, Case{"rotate(90 1 1)", -1, 2},
        Case{"rotate(180,2,3)", 2, 3}, Case{" skewX( 45 ) ", 5, 3}, Case{"skewY(45)", 2, 5},
        Case{"matrix(1 2 3 4 5 6)", 16, 22}, Case{"matrix(1,2,3,4,5,6)", 16, 22},
        Case{"rotate(0.25turn)", -3, 2}, Case{"translate(1px, 2px)", 3, 5},
        Case{"translateX(1) translateY(2) scaleX(2) scaleY(3)", 5, 11}, Case{"rotate(-270)", -3, 2},
        Case{"rotate(1e1)rotate(80)", -3, 2}}) {
    const auto map = svg::parse_transform(c.text);
    ASSERT_TRUE(map.ok()) << c.text << map.error().message;
    expect_point((*map)(Point2{2, 3}), c.x, c.y, 1e-12);
  }
  for (const char* bad :
       {"rotate", "rotate(", "rotate()", "rotate(1,2)", "matrix(1 2 3)", "scale(1 2 3)", "spin(1)",
        "translate(1;2)", "translate(1 2", "rotate3d(1,0,0,5)", "translate(5%)", "5", "translate(1em)"}) {
    EXPECT_FALSE(svg::parse_transform(bad).ok()) << bad;
    EXPECT_EQ(
        error_of(page("<g id='g' transform='" + std::string(bad) + "'><line x2='1'/></g>")).where.entity,
        "g#g");
  }
}

std::string random_transform(std::mt19937_64& random, Affine2& map) {
  std::uniform_real_distribution<double> value(-2, 2);
  const double a[6] = {value(random), value(random), value(random),
                       value(random), value(random), value(random)};
  map = {a[0], a[1], a[2], a[3], a[4], a[5]};
  std::string text = "matrix(";
  for (const double v : a) text += format_shortest(v) + " ";
  return text + ")";
}

TEST(Transform, OnAGroupEqualsTransformingTheCurves) {
  std::mt19937_64 random(3);
  const std::string shapes =
      path("M1 2 C3 4 5 -6 7 8 Q9 9 3 1 A4 4 0 0 1 9 9 A5 3 20 1 0 2 2 Z") +
      "<circle cx='3' r='2'/><ellipse rx='3' ry='1'/><rect width='5' height='4' rx='1'/>";
  const Drawing plain = read("<svg>" + shapes + "</svg>");
  const double k = plain.mm_per_unit;
  for (int i = 0; i < 50; ++i) {
    Affine2 outer, inner;
    const std::string a = random_transform(random, outer), b = random_transform(random, inner);
    const Drawing moved =
        read("<svg><g transform='" + a + "'><g transform='" + b + "'>" + shapes + "</g></g></svg>");
    const Drawing list = read("<svg><g style='transform: " + a + " " + b + "'>" + shapes + "</g></svg>");
    // User units to mm and y up, around the map of the file.
    const Affine2 up{k, 0, 0, -k, 0, 0}, down{1 / k, 0, 0, -1 / k, 0, 0};
    ASSERT_EQ(moved.entities.size(), plain.entities.size());
    for (std::size_t e = 0; e < plain.entities.size(); ++e) {
      std::vector<Path> expected = plain.entities[e].paths;
      transform(expected, up * outer * inner * down);
      // Circles that become ellipses keep their parameters, so that even the points at equal t agree.
      svg_test::expect_same(moved.entities[e].paths, expected, 1e-9);
      svg_test::expect_same(list.entities[e].paths, expected, 1e-9);
    }
  }
}

TEST(Transform, ArcsStayArcsUnderSimilarity) {
  for (const char* map : {"rotate(33)", "scale(-2)", "scale(1,-1)", "matrix(0.6 0.8 -0.8 0.6 1 2)",
                          "rotate(10)scale(3)", "scale(2,1)scale(.5,1)"}) {
    const Drawing drawing = read("<svg><g transform='" + std::string(map) + "'>" +
                                 path("M5 0 A5 5 0 0 1 0 5") + "<circle r='3'/></g></svg>");
    ASSERT_EQ(drawing.entities.size(), 2u);
    for (const Entity& e : drawing.entities) {
      EXPECT_TRUE(std::holds_alternative<geom::Arc2>(e.paths[0].curves[0])) << map;
    }
  }
  const Drawing skewed = read("<svg><circle r='3' transform='skewX(10)'/></svg>");
  EXPECT_TRUE(std::holds_alternative<geom::EllipseArc2>(skewed.entities.at(0).paths[0].curves[0]));
  // An ellipse that the map makes round is a circle.
  const Drawing round = read(page("<ellipse cx='4' cy='-2' rx='1' ry='2' transform='scale(2,1)'/>"));
  const auto& circle = std::get<geom::Arc2>(round.entities.at(0).paths[0].curves[0]);
  expect_point(circle.center, 8, 2);
  EXPECT_NEAR(circle.radius, 2, 1e-12);
}

TEST(Transform, MirroredArcKeepsItsPlace) {
  const std::string arc = path("M5 0 A5 5 0 0 1 0 5");
  const Drawing drawing = read(page("<g transform='scale(-1,1)'>" + arc + "</g>"));
  // The middle of the quarter in the file is (5, 5) / sqrt 2, y down.
  expect_point(geom::point_at(drawing.entities.at(0).paths[0].curves[0], 0.5), -5 / std::sqrt(2),
               -5 / std::sqrt(2));
}

TEST(Transform, Origin) {
  struct Case {
    const char* origin;
    double x, y;  // where (0, 0) goes by a quarter turn about it: (ox + oy, oy - ox) in the file
  };
  for (const Case& c :
       {Case{"3 4", 7, 1}, Case{"3px, 4px", 7, 1}, Case{"10% 0", 10, -10}, Case{"left 5", 5, 5},
        Case{"top right", 100, -100}, Case{"0 0", 0, 0}, Case{"20", 70, 30}, Case{"3 4 0", 7, 1}}) {
    const std::string style =
        "style='transform:rotate(90deg);transform-origin:" + std::string(c.origin) + "'";
    const Drawing drawing =
        read("<svg viewBox='0 0 100 100' width='100mm'><line x2='1' " + style + "/></svg>");
    ASSERT_EQ(drawing.entities.size(), 1u);
    expect_point(start_of(drawing.entities[0]), c.x, 100 - c.y);
  }
  EXPECT_EQ(error_of("<svg><g transform='scale(2)' transform-origin='middle'/></svg>").code,
            ErrorCode::unsupported);
}

TEST(Transform, ThatFlattensThePlane) {
  const Drawing drawing = read(
      page("<g transform='scale(0)'><line x2='1'/></g><rect width='1' height='1' transform='scale(1,0)'/>"));
  EXPECT_TRUE(drawing.entities.empty());
  EXPECT_EQ(drawing.ignored.at("line (flattened by its transform)"), 1);
}

// --- structure
// --------------------------------------------------------------------------------------------------

TEST(Use, PlacesClones) {
  const Drawing drawing = read(page(
      "<defs><path id='d' d='M0 0 H2' fill='none'/></defs>"
      "<use id='u' href='#d' x='10' y='-20' stroke='red'/><use xlink:href=' #d ' transform='translate(0,-5) "
      "scale(2)' x='1'/>"
      "<g id='grp'><line id='l' x2='1'/><rect width='1' height='1'/></g><use id='v' href='#grp' y='-50'/>"));
  ASSERT_EQ(drawing.entities.size(), 6u);
  expect_point(start_of(drawing.entities[0]), 10, 20);
  expect_point(end_of(drawing.entities[0]), 12, 20);
  EXPECT_EQ(drawing.entities[0].color, 0xFF0000u);
  EXPECT_EQ(drawing.entities[0].id, "u/d");
  expect_point(start_of(drawing.entities[1]), 2, 5);
  expect_point(end_of(drawing.entities[1]), 6, 5);
  EXPECT_EQ(drawing.entities[4].id, "v/l");
  EXPECT_EQ(drawing.entities[5].id, "v/rect");
  EXPECT_EQ(drawing.entities[5].kind, "rect");
  expect_point(start_of(drawing.entities[4]), 0, 50);
}

TEST(Use, SymbolsWithViewBox) {
  const Drawing drawing =
      read(page("<symbol id='s' viewBox='0 0 10 10'><line x2='10'/></symbol>"
                "<symbol id='t'><line x2='10'/></symbol>"
                "<use href='#s' x='5' y='-40' width='40' height='20'/><use href='#t' x='5' y='-40' "
                "width='40' height='20'/>"
                "<use href='#s' height='50'/>"));
  ASSERT_EQ(drawing.entities.size(), 3u);
  expect_point(start_of(drawing.entities[0]), 15, 40);  // 20 x 20 in the middle of 40 x 20
  expect_point(end_of(drawing.entities[0]), 35, 40);
  expect_point(start_of(drawing.entities[1]), 5, 40);
  expect_point(end_of(drawing.entities[1]), 15, 40);
  expect_point(start_of(drawing.entities[2]), 25, 0);  // width 100 % of the page, fitted to the height
  expect_point(end_of(drawing.entities[2]), 75, 0);
}

TEST(Use, CirclesAreRefusedAndMissingTargetsReported) {
  for (const char* content : {"<g id='a'><use href='#a'/></g>", "<use id='a' href='#a'/>",
                              "<g id='a'><use href='#b'/></g><g id='b'><use href='#a'/></g>",
                              "<symbol id='a'><use href='#a'/></symbol><use href='#a'/>"}) {
    EXPECT_EQ(error_of(page(content)).code, ErrorCode::syntax) << content;
  }
  Diagnostics diagnostics;
  const auto drawing =
      svg_test::try_read(page("<use href='#none'/><use href='x.svg#a'/><use/>"), diagnostics);
  ASSERT_TRUE(drawing.ok());
  EXPECT_EQ(diagnostics.count("missing_reference"), 3u);
  EXPECT_TRUE(diagnostics.anything_left_out());
}

TEST(Use, ExpansionIsBounded) {
  std::string bomb = "<g id='a0'><line x2='1'/></g>", empty = "<g id='a0'/>";
  for (int i = 1; i < 40; ++i) {
    const std::string before = std::to_string(i - 1);
    const std::string level =
        "<g id='a" + std::to_string(i) + "'><use href='#a" + before + "'/><use href='#a" + before + "'/></g>";
    bomb += level;
    empty += level;
  }
  ReadOptions options;
  options.max_entities = 10000;
  options.max_depth = 200;
  for (const std::string& text : {bomb, empty})
    EXPECT_EQ(error_of(page(text), options).code, ErrorCode::range);
  // A long path drawn often is bounded by its curves and its bytes.
  std::string data = "M0 0";
  for (int i = 0; i < 2000; ++i) data += " 1 " + std::to_string(i);
  std::string uses;
  for (int i = 0; i < 200; ++i) uses += "<use href='#p'/>";
  EXPECT_EQ(error_of(page(path(data) + uses), options).code, ErrorCode::range);
}

TEST(Use, HiddenCloneWithAVisiblePart) {
  const Drawing drawing =
      read(page("<defs><g id='d'><line x2='1'/><line id='v' x2='1' visibility='visible'/></g></defs>"
                "<use href='#d' visibility='hidden'/><use href='#d' display='none'/>"));
  ASSERT_EQ(drawing.entities.size(), 1u);
  EXPECT_EQ(drawing.entities[0].id, "use/v");
}

TEST(Structure, DefinitionsAreNotDrawn) {
  const std::string shape = "<rect width='1' height='1'/>";
  std::string content;
  for (const char* name : {"defs", "symbol", "clipPath", "mask", "pattern", "marker", "metadata"}) {
    content += "<" + std::string(name) + ">" + shape + "</" + name + ">";
  }
  content += "<text>abc</text><image/><foreignObject>" + shape + "</foreignObject><g><text/></g><sparkle/>";
  const Drawing drawing = read(page(content));
  EXPECT_TRUE(drawing.entities.empty());
  const std::map<std::string, int> ignored{{"text", 2}, {"image", 1}, {"foreignObject", 1}, {"sparkle", 1}};
  EXPECT_EQ(drawing.ignored, ignored);
}

TEST(Structure, SwitchTakesTheFirstThatApplies) {
  const Drawing drawing =
      read(page("<switch><foreignObject requiredExtensions='http://ns.adobe.com/AdobeIllustrator/10.0/'/>"
                "<g id='kept'><line id='a' x2='1'/></g><line id='b' x2='1'/></switch>"
                "<switch><line id='de' x2='1' systemLanguage='de'/><line id='en' x2='1' systemLanguage='fr, "
                "en-GB'/></switch>"));
  ASSERT_EQ(drawing.entities.size(), 2u);
  EXPECT_EQ(drawing.entities[0].id, "a");
  EXPECT_EQ(drawing.entities[0].layer, "kept");
  EXPECT_EQ(drawing.entities[1].id, "en");
}

TEST(Structure, Layers) {
  const Drawing drawing = read(
      page("<g id='layer1' inkscape:groupmode='layer' inkscape:label='Cut'><g id='x'><line x2='1'/>"
           "<g id='sub' inkscape:groupmode='layer' inkscape:label='Cut inner'><line x2='1'/></g></g></g>"
           "<g id='plain'><g id='deeper'><line x2='1'/></g></g><g id='g9' inkscape:label='Named'><line "
           "x2='1'/></g>"
           "<line x2='1'/><g id='l2' inkscape:groupmode='layer'><line x2='1'/></g>"
           "<g inkscape:groupmode='layer' inkscape:label='Off' style='display:none'><line x2='1'/></g>"));
  std::vector<std::string> layers;
  for (const Entity& e : drawing.entities) layers.push_back(e.layer);
  EXPECT_EQ(layers, (std::vector<std::string>{"Cut", "Cut inner", "plain", "Named", "", "l2"}));
  EXPECT_EQ(drawing.layers, (std::vector<std::string>{"Cut", "Cut inner", "Named", "Off", "l2", "plain"}));
}

TEST(Structure, LinesAndNames) {
  const Drawing drawing = read(
      "<?xml version='1.0'?>\n<svg>\n  <g>\n<rect\n id='r'\n width='1' height='1'/><line x2='1'/></g></svg>");
  ASSERT_EQ(drawing.entities.size(), 2u);
  EXPECT_EQ(drawing.entities[0].line, 4);
  EXPECT_EQ(drawing.entities[0].name(), "rect#r");
  EXPECT_EQ(drawing.entities[1].name(), "line at line 6");
}

TEST(Structure, ClipPathsAreNamed) {
  Diagnostics diagnostics;
  const auto drawing =
      svg_test::try_read(page("<rect width='1' height='1' clip-path='url(#c)'/>"), diagnostics);
  ASSERT_TRUE(drawing.ok());
  EXPECT_EQ(diagnostics.count("clip_ignored"), 1u);
}

// --- XML
// ----------------------------------------------------------------------------------------------------------

TEST(Xml, Prefixes) {
  const Drawing drawing = read(
      "<svg:svg xmlns:svg='http://www.w3.org/2000/svg' "
      "xmlns:ink='http://www.inkscape.org/namespaces/inkscape' "
      "xmlns='urn:other' xmlns:xl='http://www.w3.org/1999/xlink'>"
      "<svg:g ink:groupmode='layer' ink:label='L'><svg:path id='p' d='M0 0H1'/></svg:g><svg:use "
      "xl:href='#p'/>"
      "<path d='M0 0 foreign'/><g xmlns='http://www.w3.org/2000/svg'><line x2='1'/></g></svg:svg>");
  ASSERT_EQ(drawing.entities.size(), 3u);
  EXPECT_EQ(drawing.entities[0].layer, "L");
}

TEST(Xml, InternalEntities) {
  const Drawing drawing = read(
      "<?xml version='1.0'?><!DOCTYPE svg PUBLIC '-//W3C//DTD SVG 1.1//EN' 'svg11.dtd' [\n"
      "<!ENTITY ns_svg \"http://www.w3.org/2000/svg\"><!ENTITY st0 'stroke:&col;'><!ENTITY col \"red\">"
      "<!ENTITY % param 'x'> <!ENTITY ext SYSTEM 'file.txt'> ]>"
      "<svg xmlns='&ns_svg;'><line x2='1' style='&st0;' id='&unknown;a&amp;b'/></svg>");
  ASSERT_EQ(drawing.entities.size(), 1u);
  EXPECT_EQ(drawing.entities[0].color, 0xFF0000u);
  EXPECT_EQ(drawing.entities[0].id, "&unknown;a&b");
}

TEST(Xml, EntityBombsAndMarkupAreRefused) {
  std::string bomb = "<!DOCTYPE svg [<!ENTITY a0 'xxxxxxxxxx'>";
  for (int i = 1; i < 9; ++i) {
    bomb += "<!ENTITY a" + std::to_string(i) + " '";
    for (int k = 0; k < 10; ++k) bomb += "&a" + std::to_string(i - 1) + ";";
    bomb += "'>";
  }
  EXPECT_EQ(error_of(bomb + "]><svg><g id='&a8;'/></svg>").code, ErrorCode::range);
  EXPECT_EQ(error_of("<!DOCTYPE svg [<!ENTITY a '&a;'>]><svg><g id='&a;'/></svg>").code, ErrorCode::range);
  EXPECT_EQ(error_of("<!DOCTYPE svg [<!ENTITY a '<line x2=\"1\"/>'>]><svg>&a;</svg>").code,
            ErrorCode::unsupported);
}

TEST(Xml, NotWellFormed) {
  const Error error = error_of("<svg>\n  <g>\n <line x2='1'/></h></svg>");
  EXPECT_EQ(error.code, ErrorCode::syntax);
  EXPECT_EQ(error.where.line, 3);
  EXPECT_GT(error.where.column, 1);
  for (const char* bad :
       {"", "   ", "no xml", "<html/>", "<svg", "<svg><g></svg>", "<svg/><svg/>", "<svg a='1' a='2'/>",
        "<?xml version='1.0'?>", "<!-- only -->", "{\"json\": 1}", "<svg><path d='M0 0 L1 1"}) {
    EXPECT_EQ(error_of(bad).code, ErrorCode::syntax) << bad;
  }
  EXPECT_EQ(error_of(std::string("<svg>\n\0</svg>", 13)).where.line, 2);
}

TEST(Xml, DoubleHyphenInACommentIsAWarning) {
  Diagnostics diagnostics;
  const auto drawing = svg_test::try_read("<svg>\n <!-- use --laser -->\n<line x2='1'/></svg>", diagnostics);
  ASSERT_TRUE(drawing.ok());
  EXPECT_EQ(drawing->entities.size(), 1u);
  ASSERT_EQ(diagnostics.count("malformed_xml"), 1u);
  EXPECT_EQ(diagnostics.warnings()[0].where.line, 2);
}

TEST(Xml, Encodings) {
  const std::string ascii = "<svg><g id='\xC3\xA4'><line x2='1'/></g></svg>";  // a umlaut
  std::string wide = "\xFF\xFE";
  for (const char c : std::string("<svg><g id='")) wide += c, wide += '\0';
  wide += "\xE4", wide += '\0';
  for (const char c : std::string("'><line x2='1'/></g></svg>")) wide += c, wide += '\0';
  const std::string latin =
      "<?xml version='1.0' encoding='ISO-8859-1'?><svg><g id='\xE4'><line x2='1'/></g></svg>";
  const std::string undeclared = "<svg><g id='\xE4'><line x2='1'/></g></svg>";
  for (const std::string& text : {ascii, "\xEF\xBB\xBF" + ascii, wide, latin, undeclared}) {
    const Drawing drawing = read(text);
    ASSERT_EQ(drawing.entities.size(), 1u);
    EXPECT_EQ(drawing.entities[0].layer, "\xC3\xA4");
  }
  EXPECT_EQ(error_of("\x1F\x8B\x08").code, ErrorCode::unsupported);
}

// --- limits
// ---------------------------------------------------------------------------------------------------------

TEST(Limits, DeepNestingDoesNotOverflowTheStack) {
  std::string text = "<svg>";
  constexpr int kDepth = 200000;
  for (int i = 0; i < kDepth; ++i) text += "<g>";
  text += "<line x2='1'/>";
  for (int i = 0; i < kDepth; ++i) text += "</g>";
  const Error error = error_of(text + "</svg>");
  EXPECT_EQ(error.code, ErrorCode::range);
  EXPECT_NE(error.message.find("nested"), std::string::npos) << error.message;
  ReadOptions options;
  options.max_depth = 3;
  EXPECT_EQ(read(page("<g><g><line x2='1'/></g></g>"), options).entities.size(), 1u);
  EXPECT_EQ(error_of(page("<g><g><g><line x2='1'/></g></g></g>"), options).code, ErrorCode::range);
}

TEST(Limits, EntitiesAndCurvesAndCoordinates) {
  ReadOptions options;
  options.max_entities = 3;
  const std::string line = "<line x2='1'/>";
  EXPECT_EQ(read(page(line + line + line), options).entities.size(), 3u);
  EXPECT_EQ(error_of(page(line + line + line + line), options).code, ErrorCode::range);
  EXPECT_EQ(error_of(page(path("M0 0 1 1 2 2 3 3 4 5")), options).code, ErrorCode::range);
  for (const char* huge :
       {"M0 0 L1e10 0", "M0 0 L1e308 1e308", "M0 0 A1e300 1e-300 0 0 1 5 5", "m1e308 0 1e308 0"}) {
    EXPECT_FALSE(error_of(page(path(huge))).message.empty()) << huge;
  }
  EXPECT_FALSE(error_of(page("<g transform='scale(1e300)'><circle r='1e300'/></g>")).message.empty());
}

TEST(Limits, XmlTreeIsBoundedBeforeItIsBuilt) {
  ReadOptions options;
  options.max_entities = 10;
  std::string nodes, attributes = "<g ";
  for (int i = 0; i < 20000; ++i) nodes += "<a/>", attributes += "a" + std::to_string(i) + "='' ";
  EXPECT_EQ(error_of(page(nodes), options).code, ErrorCode::range);
  EXPECT_EQ(error_of(page(attributes + "/>"), options).code, ErrorCode::range);
}

TEST(Limits, WarningsOfOneKindAreCounted) {
  std::string content;
  for (int i = 0; i < 500; ++i) content += "<circle/>";
  Diagnostics diagnostics;
  ASSERT_TRUE(svg_test::try_read(page(content), diagnostics).ok());
  EXPECT_EQ(diagnostics.count("zero_length"), 101u);
}

TEST(Limits, LargeFileIsReadInOneSecond) {
  std::string content;
  for (int i = 0; i < 20000; ++i) {
    content += "<path id='p" + std::to_string(i) + "' class='k' d='M0 0 L10,10 C20 20 30 30 40 40 Z'/>";
  }
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(read(page("<style>.k{stroke:red}</style>" + content)).entities.size(), 20000u);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(spent.count(),
            10.0);  // quadratic work would take minutes; the margin is for sanitizers and busy machines
}

TEST(Determinism, TwoReadsAgree) {
  const std::string text = page("<g id='b'><line x2='1'/></g><g id='a'><circle r='1'/></g><text/><image/>");
  const Drawing first = read(text), second = read(text);
  ASSERT_EQ(first.entities.size(), second.entities.size());
  for (std::size_t i = 0; i < first.entities.size(); ++i) {
    EXPECT_EQ(first.entities[i].paths[0].curves, second.entities[i].paths[0].curves);
  }
  EXPECT_EQ(first.layers, second.layers);
}

}  // namespace
}  // namespace burin::io
