// SPDX-License-Identifier: Apache-2.0
// Colours, cascade, inheritance, display and visibility.
#include <gtest/gtest.h>

#include "burin/io/svg/color.h"
#include "burin/io/svg/style_sheet.h"
#include "burin/io/svg/svg_test_util.h"

namespace burin::io {
namespace {

using svg_test::page;
using svg_test::read;

TEST(Color, Forms) {
  const auto is = [](std::string_view text, std::uint32_t rgb) {
    const auto color = svg::parse_color(text);
    ASSERT_TRUE(color.has_value()) << text;
    EXPECT_EQ(*color, rgb) << text;
  };
  is("red", 0xFF0000);
  is(" LightGoldenRodYellow ", 0xFAFAD2);
  is("grey", 0x808080);
  is("gray", 0x808080);
  is("yellowgreen", 0x9ACD32);
  is("aliceblue", 0xF0F8FF);
  is("#1aF", 0x11AAFF);
  is("#1AfC", 0x11AAFF);
  is("#12ab9F", 0x12AB9F);
  is("#12ab9F80", 0x12AB9F);
  is("rgb(1,2,255)", 0x0102FF);
  is("rgb( 100% , 0%,50% )", 0xFF0080);
  is("rgb(300, -5, 0)", 0xFF0000);
  is("rgba(1, 2, 3, 0.5)", 0x010203);
  is("rgb(1 2 3 / 50%)", 0x010203);
  is("hsl(120, 100%, 25%)", 0x008000);
  is("hsl(0,0%,100%)", 0xFFFFFF);
  for (const char* bad : {"", "none", "currentColor", "url(#a)", "#12", "#12345", "#ggg", "rgb(1,2)",
                          "rgb(1,2,3", "rgb(a,b,c)", "redd", "rgb(1,2,3,4,5)", "#1234567"}) {
    EXPECT_FALSE(svg::parse_color(bad).has_value()) << bad;
  }
}

/// Colour that the line with id "x" gets.
std::uint32_t color_in(const std::string& content) {
  const Drawing drawing = read(page(content));
  for (const Entity& entity : drawing.entities) {
    if (entity.id == "x") return entity.color;
  }
  ADD_FAILURE() << "no element x in " << content;
  return 0xDEAD;
}
std::string line_x(const std::string& attributes) {
  return "<line id='x' x2='1' " + attributes + "/>";
}

TEST(Style, StrokeElseFill) {
  EXPECT_EQ(color_in(line_x("stroke='red' fill='blue'")), 0xFF0000u);
  EXPECT_EQ(color_in(line_x("stroke='none' fill='blue'")), 0x0000FFu);
  EXPECT_EQ(color_in(line_x("fill='blue'")), 0x0000FFu);
  EXPECT_EQ(color_in(line_x("")), 0u);
  EXPECT_EQ(color_in(line_x("fill='none'")), 0u);
  EXPECT_EQ(color_in(line_x("stroke='currentColor' color='#123456'")), 0x123456u);
  EXPECT_EQ(color_in(line_x("stroke='url(#gradient) lime'")), 0x00FF00u);
  EXPECT_EQ(color_in(line_x("stroke='no-colour' fill='blue'")), 0x0000FFu);
}

TEST(Style, Inheritance) {
  EXPECT_EQ(color_in("<g stroke='red'><g><a>" + line_x("") + "</a></g></g>"), 0xFF0000u);
  EXPECT_EQ(color_in("<g stroke='red'>" + line_x("stroke='none' fill='lime'") + "</g>"), 0x00FF00u);
  EXPECT_EQ(color_in("<g stroke='red'>" + line_x("style='stroke:inherit'") + "</g>"), 0xFF0000u);
  // currentColor is inherited as a keyword: the colour of the element itself counts.
  EXPECT_EQ(color_in("<g stroke='currentColor' color='red'>" + line_x("color='blue'") + "</g>"), 0x0000FFu);
}

TEST(Style, Cascade) {
  const std::string sheet =
      "<style type='text/css'><![CDATA[ /* a { */ line { stroke: red; stroke-width: 1px }\n"
      ".c { stroke: lime } .d{stroke:navy;} #x.e{stroke:teal} line.f , rect { stroke : gold }"
      "g.outer > line.g{stroke:aqua} g.outer line.h{stroke:pink} .i{stroke:tan !important}"
      " line[data-k='v'] {stroke: plum} ]]></style>";
  EXPECT_EQ(color_in(sheet + line_x("stroke='blue'")), 0xFF0000u);  // rule over attribute
  EXPECT_EQ(color_in(sheet + line_x("class='c'")), 0x00FF00u);      // class over element
  EXPECT_EQ(color_in(sheet + line_x("class='d c'")), 0x000080u);    // later rule of the same weight
  EXPECT_EQ(color_in(sheet + line_x("class='c d e'")), 0x008080u);  // id over classes
  EXPECT_EQ(color_in(sheet + line_x("class='d f'")), 0xFFD700u);    // element.class over class
  EXPECT_EQ(color_in(sheet + line_x("class='c' style='stroke:blue'")),
            0x0000FFu);  // style attribute over rules
  EXPECT_EQ(color_in(sheet + line_x("class='i' style='stroke:blue'")), 0xD2B48Cu);  // important over all
  EXPECT_EQ(color_in(sheet + "<g class='outer'>" + line_x("class='g'") + "</g>"), 0x00FFFFu);
  EXPECT_EQ(color_in(sheet + "<g class='outer'><g>" + line_x("class='g'") + "</g></g>"), 0xFF0000u);
  EXPECT_EQ(color_in(sheet + "<g class='outer'><g>" + line_x("class='h'") + "</g></g>"), 0xFFC0CBu);
  EXPECT_EQ(color_in(sheet + line_x("data-k='v'")), 0xDDA0DDu);
  EXPECT_EQ(color_in(sheet + line_x("class='cc'")), 0xFF0000u);
}

TEST(Style, ChildAndDescendantNeedBacktracking) {
  // The nearest g.a is not a child of a; the one above is.
  const std::string sheet = "<style>a > .a .t{stroke:red}</style>";
  EXPECT_EQ(color_in(sheet + "<a><g class='a'><g><g class='a'>" + line_x("class='t'") + "</g></g></g></a>"),
            0xFF0000u);
}

TEST(Style, UnknownCssIsSkippedAndReported) {
  Diagnostics diagnostics;
  const auto drawing = svg_test::try_read(
      page(
          "<style>@import url('a;b.css'); @media print{ line{stroke:blue} } line:hover{stroke:lime} "
          "line{stroke:;fill:none;stroke:red; broken; :x } line + line {stroke:blue} .z{stroke:blue</style>" +
          line_x("")),
      diagnostics);
  ASSERT_TRUE(drawing.ok()) << drawing.error().to_string();
  EXPECT_EQ(drawing->entities.at(0).color, 0xFF0000u);
  EXPECT_EQ(diagnostics.count("css_skipped"), 1u);
}

TEST(Style, HostileSelectorsAreBounded) {
  // Twelve descendants among fifty groups: as many ways to match as (50 over 12), and none succeeds.
  std::string open, close;
  for (int i = 0; i < 50; ++i) open += "<g>", close += "</g>";
  EXPECT_EQ(svg_test::error_of("<svg><style>x g g g g g g g g g g g g .t{stroke:red}</style>" + open +
                               "<line x2='1' class='t'/>" + close + "</svg>")
                .code,
            ErrorCode::range);
}

TEST(Style, DisplayAndVisibility) {
  const Drawing drawing = read(
      page("<g display='none'><line x2='1'/><g style='display:inline'><rect width='1' "
           "height='1'/></g><text>t</text></g>"
           "<g visibility='hidden'><line x2='1'/><line id='shown' x2='1' visibility='visible'/></g>"
           "<line x2='1' style='visibility:collapse'/><line x2='1' opacity='0' id='clear'/>"
           "<style>.off{display:none}</style><circle r='1' class='off'/><path d='damaged' display='none'/>"));
  ASSERT_EQ(drawing.entities.size(), 2u);
  EXPECT_EQ(drawing.entities[0].id, "shown");
  EXPECT_EQ(drawing.entities[1].id, "clear");
  const std::map<std::string, int> ignored{{"circle (hidden)", 1},
                                           {"line (hidden)", 3},
                                           {"path (hidden)", 1},
                                           {"rect (hidden)", 1},
                                           {"text (hidden)", 1}};
  EXPECT_EQ(drawing.ignored, ignored);
}

TEST(Style, InvisiblePaintIsReported) {
  Diagnostics diagnostics;
  const auto drawing = svg_test::try_read(page(line_x("fill='none'")), diagnostics);
  ASSERT_TRUE(drawing.ok());
  EXPECT_EQ(drawing->entities.size(), 1u);
  EXPECT_EQ(diagnostics.count("not_painted"), 1u);
}

}  // namespace
}  // namespace burin::io
