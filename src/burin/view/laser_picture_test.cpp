// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>
#include <string>

#include "burin/plan/laser/laser.h"
#include "burin/view/picture.h"

namespace burin::view {
namespace {

/// A plate with a round hole and a slot, planned for real.
struct Job {
  io::Drawing drawing;
  laser::LaserJob job;
  Diagnostics diagnostics;

  explicit Job(const std::string& layer = "0", int holes = 1) {
    const auto add = [&](std::vector<geom::Curve2> curves) {
      io::Entity e;
      e.kind = "LINE";
      e.id = "A" + std::to_string(drawing.entities.size());
      e.layer = layer;
      e.paths.push_back({std::move(curves), true});
      drawing.entities.push_back(std::move(e));
    };
    using geom::Arc2, geom::Line2;
    add({Line2{{0, 0}, {100, 0}}, Line2{{100, 0}, {100, 60}}, Line2{{100, 60}, {0, 60}},
         Line2{{0, 60}, {0, 0}}});
    for (int i = 0; i < holes; ++i) add({Arc2{{20.0 + 9 * i, 30}, 4, 0.3, 2 * geom::kPi}});
    laser::LaserOptions options;
    options.offset_mm = 0.2;
    auto planned = laser::plan_laser(drawing, options, diagnostics);
    EXPECT_TRUE(planned.ok());
    if (planned) job = std::move(*planned);
  }
  LaserPicture picture() const {
    LaserPicture p;
    p.profile = &job.profile;
    p.toolpath = &job.toolpath;
    p.drawing = &drawing;
    p.kerf_mm = 0.4;
    p.title = "plate <&> \"1\"";
    p.command_line = "burin laser a.dxf --kerf 0.4 </script><script>alert(1)</script>";
    p.nc_text = "G21\n(</script>)\n";
    p.nc_line_to_record = {0xffffffffu, 1};
    p.diagnostics = &diagnostics;
    p.figures = {{"Process", "kerf", "0.4 mm"}};
    return p;
  }
};

/// Reads "M x y", "L x y", "A r r 0 large sweep x y" and "Z", as laser_svg writes them, into segments.
std::vector<geom::Segment> segments_of(const std::string& d) {
  std::vector<geom::Segment> out;
  std::istringstream in(d);
  geom::Point2 here, start;
  char command = 0;
  while (in >> command) {
    geom::Point2 to;
    if (command == 'M') {
      in >> here.x >> here.y;
      start = here;
    } else if (command == 'L') {
      in >> to.x >> to.y;
      out.push_back(geom::make_line(here, to));
      here = to;
    } else if (command == 'A') {
      double rx = 0, ry = 0, turn = 0;
      int large = 0, sweep = 0;
      in >> rx >> ry >> turn >> large >> sweep >> to.x >> to.y;
      EXPECT_EQ(rx, ry);
      // The centre by the SVG formula: left of the chord for a small positive sweep.
      const geom::Vec2 chord = to - here;
      const double h = std::sqrt(std::max(0.0, rx * rx - geom::norm2(chord) / 4));
      const double side = (large != 0) != (sweep != 0) ? 1 : -1;
      out.push_back(geom::make_arc(
          here, to, geom::lerp(here, to, 0.5) + side * h * geom::unit(geom::left(chord)), sweep != 0));
      here = to;
    } else if (command == 'Z') {
      here = start;
    } else {
      ADD_FAILURE() << "unknown command " << command;
      return out;
    }
  }
  return out;
}

TEST(LaserSvg, IsWellFormedAndDrawsTheMoves) {
  const Job job;
  pugi::xml_document svg;
  const std::string text = laser_svg(job.picture());
  ASSERT_TRUE(svg.load_string(text.c_str())) << text;
  EXPECT_STREQ(svg.child("svg").child("title").text().get(), "plate <&> \"1\"");
  std::string cut, outline;
  for (const pugi::xml_node path : svg.child("svg").child("g").children("path")) {
    if (std::string(path.attribute("id").value()) == "cut") cut = path.attribute("d").value();
    if (std::string(path.attribute("id").value()) == "outline") outline = path.attribute("d").value();
  }
  const auto length = [](const std::vector<geom::Segment>& s) {
    double sum = 0;
    for (const geom::Segment& g : s) sum += length_of(g);
    return sum;
  };
  // Beam 0.2 outside the plate (corners are quarter circles) and inside the hole.
  EXPECT_NEAR(length(segments_of(cut)), 320 + 2 * geom::kPi * 0.2 + 2 * geom::kPi * 3.8, 1e-3);
  EXPECT_NEAR(length(segments_of(outline)), 320 + 2 * geom::kPi * 4, 1e-3);
  for (const geom::Segment& g : segments_of(cut)) {
    for (const double f : {0.0, 0.3, 0.7}) {
      double nearest = 1e9;
      for (const laser::CutPath& p : job.job.profile.paths)
        nearest = std::min(nearest, distance_to(p.spline, point_on(g, f)));
      EXPECT_LT(nearest, 1e-4);
    }
  }
}

TEST(LaserHtml, IsOnePageWhoseDataParsesAndCannotEscape) {
  const Job job("layer \xff\xfe damaged", 3);
  const std::string page = laser_html(job.picture());
  EXPECT_EQ(page.find("@DATA@"), std::string::npos);
  EXPECT_EQ(page.find("@TITLE@"), std::string::npos);
  for (const char* outside : {"src=", "http://", "https://", "@import", "url("}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  // Two script elements and no more, whatever stands in the texts.
  std::size_t scripts = 0;
  for (std::size_t at = page.find("<script"); at != std::string::npos; at = page.find("<script", at + 1))
    ++scripts;
  EXPECT_EQ(scripts, 2u);
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(open) + open.size();
  const auto data = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  EXPECT_EQ(data["title"], "plate <&> \"1\"");
  EXPECT_EQ(data["outlines"].size(), 4u);
  EXPECT_EQ(data["paths"].size(), 4u);
  EXPECT_EQ(data["pierces"].size(), 4u);
  double cut = 0;
  for (const auto& m : data["moves"]) {
    if (m[7] == static_cast<int>(laser::MoveKind::cut)) ++cut;
  }
  // 4 lines and 4 corner arcs, two half circles a hole; a start in the middle of a segment makes two of it.
  EXPECT_GE(cut, 8 + 3 * 2);
  EXPECT_LE(cut, 8 + 3 * 2 + 4);
}

}  // namespace
}  // namespace burin::view
