// SPDX-License-Identifier: Apache-2.0
#include "burin/view/cspace_picture.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <pugixml.hpp>
#include <string>

#include "burin/view/canvas.h"
#include "burin/view/cspace_contours.h"
#include "burin/view/stroke_font.h"

namespace burin::view {
namespace {

using orient::Angles;
using orient::Cause;

constexpr double kDegree = geom::kPi / 180;

// --- a reader of PNG of our own: chunks, checksums, rows

struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  std::array<int, 3> at(double x, double y) const {
    const auto k =
        3 * (static_cast<std::size_t>(x) + static_cast<std::size_t>(y) * static_cast<std::size_t>(width));
    return {rgb[k], rgb[k + 1], rgb[k + 2]};
  }
};

std::uint32_t big32(const std::string& s, std::size_t at) {
  std::uint32_t v = 0;
  for (std::size_t i = 0; i < 4; ++i) v = (v << 8) | static_cast<unsigned char>(s.at(at + i));
  return v;
}

/// By the polynomial, bit by bit: not the library that wrote it.
std::uint32_t checksum(const std::string& s) {
  std::uint32_t c = 0xffffffffu;
  for (const char ch : s) {
    c ^= static_cast<unsigned char>(ch);
    for (int k = 0; k < 8; ++k) c = (c & 1u) ? (c >> 1) ^ 0xedb88320u : c >> 1;
  }
  return ~c;
}

Pixels decode_png(const std::string& png) {
  Pixels out;
  EXPECT_EQ(png.substr(0, 8), std::string("\x89PNG\r\n\x1a\n"));
  std::string packed, order;
  std::size_t at = 8;
  while (at + 12 <= png.size()) {
    const std::size_t size = big32(png, at);
    const std::string type = png.substr(at + 4, 4), data = png.substr(at + 8, size);
    EXPECT_EQ(big32(png, at + 8 + size), checksum(type + data)) << type;
    order += type;
    if (type == "IHDR") {
      out.width = static_cast<int>(big32(data, 0));
      out.height = static_cast<int>(big32(data, 4));
      EXPECT_EQ(data.substr(8), std::string("\x08\x02\x00\x00\x00", 5));
    }
    if (type == "IDAT") packed += data;
    at += size + 12;
  }
  EXPECT_EQ(at, png.size());
  EXPECT_EQ(order, "IHDRIDATIEND");
  const std::size_t stride = 3 * static_cast<std::size_t>(out.width);
  std::vector<std::uint8_t> rows((stride + 1) * static_cast<std::size_t>(out.height));
  uLongf size = static_cast<uLongf>(rows.size());
  EXPECT_EQ(uncompress(rows.data(), &size, reinterpret_cast<const Bytef*>(packed.data()),
                       static_cast<uLong>(packed.size())),
            Z_OK);
  EXPECT_EQ(size, rows.size());
  for (std::size_t y = 0; y < static_cast<std::size_t>(out.height); ++y) {
    const auto row = rows.begin() + static_cast<std::ptrdiff_t>(y * (stride + 1));
    EXPECT_EQ(*row, 0) << "filter";
    out.rgb.insert(out.rgb.end(), row + 1, row + 1 + static_cast<std::ptrdiff_t>(stride));
  }
  return out;
}

// --- a map by hand

struct Sample {
  orient::CSpaceMap map;
  model::Mill mill;
  explicit Sample(int tilts = 90, int yaws = 45) {
    map.range = {1.5 * kDegree, 20 * kDegree, -90 * kDegree, 90 * kDegree};
    map.tilts = tilts, map.yaws = yaws;
    mill.radius = 125, mill.length = 60;
    for (int j = 0; j < yaws; ++j) {
      for (int i = 0; i < tilts; ++i) {
        const double a = 1.5 + 18.5 * i / (tilts - 1), b = -90 + 180.0 * j / (yaws - 1);
        const bool gouge = a < 4 + 6 * std::pow((b - 20) / 90, 2) + 1.2 * std::sin(b / 14);
        const bool collision = b < -48 + 1.1 * a || (a > 15 && b > 40 && b < 62);
        map.cells.push_back(gouge       ? Cause::gouge
                            : collision ? Cause::collision
                            : b > 74    ? Cause::limit
                                        : Cause::none);
      }
    }
  }
  CSpacePicture picture() const {
    return {"Path 3, point 17 of blade.toml",
            &map,
            &mill,
            {{"initial", {9.4 * kDegree, 0}}, {"optimum", {3.9 * kDegree, 22 * kDegree}}}};
  }
};

/// Where the picture has its plot: what the SVG's frame says.
struct Plot {
  double left = 0, top = 0, right = 0, bottom = 0;
};
std::vector<geom::Point2> path_points(const std::string& d) {
  std::vector<geom::Point2> out;
  const char* p = d.c_str();
  while (*p) {
    if (*p != 'M' && *p != 'L' && *p != ' ') break;
    ++p;
    char* end = nullptr;
    const double x = std::strtod(p, &end), y = std::strtod(end, &end);
    out.push_back({x, y});
    p = end;
  }
  return out;
}
Plot plot_of(const pugi::xml_node& svg) {
  for (const auto& path : svg.children("path")) {
    const auto p = path_points(path.attribute("d").value());
    if (std::string(path.attribute("stroke").value()) == "#5b6776" && p.size() == 5)
      return {p[0].x, p[0].y, p[2].x, p[2].y};
  }
  ADD_FAILURE() << "no frame";
  return {};
}

TEST(StrokeFont, EveryPrintableCharacterIsThereAndStaysOnItsLine) {
  for (char c = '!'; c <= '~'; ++c) {
    const GlyphRun run = lay_text(std::string(1, c));
    ASSERT_FALSE(run.strokes.empty()) << c;
    for (const auto& s : run.strokes) {
      ASSERT_GE(s.size(), 2u) << c;
      for (const geom::Point2 p : s) {
        EXPECT_GE(p.x, -1.1) << c;
        EXPECT_LE(p.x, run.width + 1.1) << c;
        EXPECT_GE(p.y, -5) << c;
        EXPECT_LE(p.y, 16) << c;
      }
    }
    EXPECT_NE(lay_text("\xff").strokes, run.strokes) << c;
  }
  EXPECT_EQ(lay_text("").width, 0);
  EXPECT_GT(lay_text("il").width, 2);
  EXPECT_EQ(lay_text("\u00e4").width, lay_text("a").width);
  EXPECT_EQ(code_points("a\xc3\xa4\xe2\x82\xacx\xff\xc3"),
            (std::vector<char32_t>{U'a', U'\u00e4', U'\u20ac', U'x', U'\ufffd', U'\ufffd'}));
}

TEST(PixelCanvas, AreasHaveTheirAreaAndLinesTheirWidth) {
  const auto ink = [](const PixelCanvas& canvas) {  // of black on white, in pixels
    const Pixels p = decode_png(canvas.png());
    double sum = 0;
    for (std::size_t i = 0; i < p.rgb.size(); i += 3) sum += (255 - p.rgb[i]) / 255.0;
    return sum;
  };
  PixelCanvas triangle(60, 50, 2);
  triangle.polygon({{3.3, 4.1}, {50.2, 11.7}, {17.9, 44.4}}, {0, 0, 0});
  const double area = std::abs(46.9 * 40.3 - 14.6 * 7.6) / 2 * 4;
  EXPECT_NEAR(ink(triangle), area, 0.003 * area);
  PixelCanvas line(80, 60, 2);
  line.line({{10, 10}, {60, 40}}, {{0, 0, 0}, 3});
  const double strip = (std::hypot(50, 30) * 3 + geom::kPi * 1.5 * 1.5) * 4;
  EXPECT_NEAR(ink(line), strip, 0.01 * strip);
  PixelCanvas twice(80, 60, 2);  // to and fro is the same line
  twice.line({{10, 10}, {60, 40}, {10, 10}}, {{0, 0, 0, 0.5}, 3});
  EXPECT_NEAR(ink(twice), strip / 2, 0.02 * strip);
  PixelCanvas outside(20, 20, 1);
  outside.line({{-50, -50}, {-10, 80}}, {{0, 0, 0}, 3});
  outside.box(-5, -5, 0, 90, {0, 0, 0});
  outside.polygon({{30, 30}, {90, 30}, {1e9, 90}}, {0, 0, 0});
  outside.text(25, 10, "x", {});
  EXPECT_EQ(ink(outside), 0);
}

TEST(CSpaceContours, EveryPointLiesOnItsContourAndEveryPieceEndsAtTheBorder) {
  for (const double corner : {0.0, 20.0}) {
    const model::Mill mill{corner > 0 ? model::MillKind::bull : model::MillKind::flat, 125, corner, 60, {}};
    for (const orient::AngleRange& r :
         {orient::AngleRange{1.5 * kDegree, 20 * kDegree, -90 * kDegree, 90 * kDegree},
          {0, 35 * kDegree, 10 * kDegree, 60 * kDegree},
          {2 * kDegree, 3 * kDegree, -70 * kDegree, -5 * kDegree}}) {
      const auto levels = contour_levels(r, mill, 600, 500, 30);
      EXPECT_GE(levels.size(), 4u);
      EXPECT_LE(levels.size(), 40u);
      for (const double level : levels) {
        const auto pieces = contour_of(level, r, mill);
        ASSERT_FALSE(pieces.empty()) << level;
        for (const auto& piece : pieces) {
          for (const Angles& a : piece) {
            ASSERT_NEAR(effective_radius(a, mill), level, 1e-9 * level);
            ASSERT_TRUE(r.contains(a));
          }
          for (const Angles& a : {piece.front(), piece.back()}) {
            const double gap = std::min(
                {a.alpha - r.alpha_lo, r.alpha_hi - a.alpha, a.beta - r.beta_lo, r.beta_hi - a.beta});
            EXPECT_LT(gap, 1e-9);
          }
        }
      }
    }
  }
}

TEST(CSpaceContours, NoRoomNoContours) {
  const model::Mill mill{model::MillKind::flat, 10, 0, 20, {}};
  EXPECT_TRUE(contour_levels({0.1, 0.1, -1, 1}, mill, 600, 500, 30).empty());
  EXPECT_TRUE(contour_of(1e9, {0.1, 0.2, -1, 1}, mill).empty());
  EXPECT_TRUE(contour_of(-1, {0.1, 0.2, -1, 1}, mill).empty());
  const model::Mill ball{model::MillKind::bull, 10, 10, 20, {}};
  EXPECT_TRUE(contour_levels({0.1, 0.2, -1, 1}, ball, 600, 500, 30).empty());
}

TEST(CSpaceSvg, IsWellFormedAndItsContoursLieWhereTheClosedFormHasThem) {
  const Sample sample;
  const std::string svg = cspace_svg(sample.picture());
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(svg.c_str()));
  const pugi::xml_node root = document.child("svg");
  const Plot plot = plot_of(root);
  const orient::AngleRange& r = sample.map.range;
  std::size_t contours = 0;
  for (const auto& path : root.children("path")) {
    if (std::string(path.attribute("stroke-opacity").value()) != "0.78") continue;
    const auto points = path_points(path.attribute("d").value());
    if (points.size() < 3) continue;  // the legend's
    ++contours;
    double lo = 1e300, hi = 0;
    for (const geom::Point2 p : points) {
      // A hundredth of a point is all that was written.
      for (const double dx : {-0.006, 0.006}) {
        const Angles a{
            r.alpha_lo + (p.x + dx - plot.left) / (plot.right - plot.left) * (r.alpha_hi - r.alpha_lo),
            r.beta_lo + (plot.bottom - p.y) / (plot.bottom - plot.top) * (r.beta_hi - r.beta_lo)};
        const double rho = effective_radius(a, sample.mill);
        lo = std::min(lo, rho), hi = std::max(hi, rho);
      }
    }
    // One round number lies within all that the rounding allows.
    EXPECT_LT(hi / lo, 1.02);
    bool named = false;
    for (const auto& text : root.children("text")) {
      const double value = std::atof(text.child_value());
      named = named || (value > lo / 1.01 && value < hi * 1.01);
    }
    EXPECT_TRUE(named) << lo << " to " << hi << " has no label";
  }
  EXPECT_GE(contours, 8u);
}

TEST(CSpacePng, NodesHaveTheColourOfTheirCause) {
  const Sample sample;
  CSpacePicture bare = sample.picture();
  bare.marks.clear();
  const Pixels p = decode_png(cspace_png(bare));
  ASSERT_GE(p.width, 900);
  ASSERT_GE(p.height, 700);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(cspace_svg(bare).c_str()));
  const Plot plot = plot_of(document.child("svg"));
  const double k = p.width / document.child("svg").attribute("width").as_double();
  std::map<Cause, std::map<std::array<int, 3>, int>> seen;
  for (int j = 1; j + 1 < sample.map.yaws; ++j) {
    for (int i = 1; i + 1 < sample.map.tilts; ++i) {
      const double x = plot.left + (plot.right - plot.left) * i / (sample.map.tilts - 1);
      const double y = plot.bottom - (plot.bottom - plot.top) * j / (sample.map.yaws - 1);
      ++seen[sample.map.at(i, j)][p.at(k * x, k * y)];
    }
  }
  // Grid, contours and texts cover some nodes; all others have one colour a cause, and another each cause.
  const std::map<Cause, std::array<int, 3>> wanted{{Cause::none, {238, 246, 239}},
                                                   {Cause::gouge, {229, 145, 140}},
                                                   {Cause::collision, {246, 200, 118}},
                                                   {Cause::limit, {186, 174, 222}}};
  for (const auto& [cause, colour] : wanted) {
    int all = 0;
    for (const auto& [c, n] : seen[cause]) all += n;
    ASSERT_GT(all, 50);
    EXPECT_GT(seen[cause][colour], 0.6 * all) << static_cast<int>(cause);
    for (const auto& [other, not_it] : wanted) EXPECT_TRUE(other == cause || seen[cause][not_it] == 0);
  }
}

TEST(CSpacePng, ContoursAreDrawnWhereTheClosedFormHasThem) {
  Sample sample;
  std::fill(sample.map.cells.begin(), sample.map.cells.end(), Cause::none);
  CSpacePicture bare = sample.picture();
  bare.marks.clear();
  const Pixels p = decode_png(cspace_png(bare));
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(cspace_svg(bare).c_str()));
  const Plot plot = plot_of(document.child("svg"));
  const double k = p.width / document.child("svg").attribute("width").as_double();
  const orient::AngleRange& r = sample.map.range;
  const auto luminance = [&](double x, double y) { return p.at(k * x, k * y)[0]; };
  int dark = 0, all = 0;
  for (double beta = -60; beta <= 60; beta += 0.7) {
    const auto alpha = orient::contour_tilt(1000, beta * kDegree, sample.mill);
    if (!alpha || *alpha < r.alpha_lo) continue;
    const double x = plot.left + (*alpha - r.alpha_lo) / (r.alpha_hi - r.alpha_lo) * (plot.right - plot.left);
    const double y =
        plot.bottom - (beta * kDegree - r.beta_lo) / (r.beta_hi - r.beta_lo) * (plot.bottom - plot.top);
    ++all;
    dark += luminance(x, y) < 170 ? 1 : 0;
  }
  EXPECT_GT(all, 150);
  EXPECT_GT(dark, 0.85 * all);  // the value's own box hides the rest
}

TEST(CSpacePicture, HostileNamesStayTextAndAnythingIsAPicture) {
  const Sample sample;
  CSpacePicture picture = sample.picture();
  picture.title = "</title><script>alert(1)</script> \xff & \"x\" " + std::string(500, 'w');
  picture.marks[0].name = "<b>";
  picture.marks[1].angles = {9, 9};
  for (int k = 0; k < 40; ++k) picture.marks.push_back({"more", {0.1, 0.1}});
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(cspace_svg(picture).c_str()));
  EXPECT_FALSE(document.child("svg").child("script"));
  EXPECT_EQ(std::string(document.child("svg").child_value("title")).substr(0, 8), "</title>");
  EXPECT_EQ(cspace_svg(picture).find('\xff'), std::string::npos);
  decode_png(cspace_png(picture));
  decode_png(cspace_png({}));
  EXPECT_TRUE(document.load_string(cspace_svg({}).c_str()));
  orient::CSpaceMap broken = sample.map;
  broken.cells.pop_back();
  picture.map = &broken;
  EXPECT_TRUE(document.load_string(cspace_svg(picture).c_str()));
  const Sample least(2, 2);
  decode_png(cspace_png(least.picture()));
}

TEST(CSpacePicture, SamePictureSameBytes) {
  const Sample a, b;
  EXPECT_EQ(cspace_png(a.picture()), cspace_png(b.picture()));
  EXPECT_EQ(cspace_svg(a.picture()), cspace_svg(b.picture()));
}

}  // namespace
}  // namespace burin::view
