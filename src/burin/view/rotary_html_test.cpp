// SPDX-License-Identifier: Apache-2.0
#include "burin/view/rotary_html.h"

#include <gtest/gtest.h>

#include <cmath>
#include <pugixml.hpp>
#include <vector>

#include "burin/view/page_test_support.h"
#include "burin/view/rotary_places.h"
#include "burin/view/rotary_shape.h"

namespace burin::view {
namespace {

using geom::kPi;
using geom::Point2;
using geom::Point3;
using rotary::RotaryPoint;
using rotary::State;

using test::data_of;
using test::decode64;
using test::expect_closed_page;

constexpr double kRadius = 10, kBall = 2, kLength = 20;

/// A square bar with round nose circles is not needed here: a square, turned by 90 degrees over its length.
rotary::SweptSection square() {
  rotary::SweptSection swept;
  const std::vector<Point2> p{
      {kRadius, -kRadius}, {kRadius, kRadius}, {-kRadius, kRadius}, {-kRadius, -kRadius}};
  for (std::size_t i = 0; i < 4; ++i) swept.section.segments.push_back(geom::make_line(p[i], p[(i + 1) % 4]));
  swept.section.closed = true;
  swept.stations = {{0, 0}, {kLength, kPi / 2}};
  return swept;
}

/// Rings on a cylinder inside of that part, planned by hand: every seventh point is moved, every eleventh not
/// reached.
struct Sample {
  rotary::Part part;
  rotary::RotaryPlan plan;
  model::BallTool tool;
  rotary::RotaryOptions options;
  Diagnostics diagnostics;

  explicit Sample(std::size_t paths = 3, std::size_t points = 40) {
    part = *rotary::make_swept(square(), {});
    tool.radius = tool.shank_radius = kBall;
    tool.holder = {{12, 30}};
    for (std::size_t k = 0; k < paths; ++k)
      add_ring(k, points, kLength * static_cast<double>(k + 1) / static_cast<double>(paths + 1));
    plan.counts.contact_points = plan.points.size();
    plan.quality.side_step_max_mm = kLength / static_cast<double>(paths + 1);
    diagnostics.info("note", "a </script> \xff message");
    diagnostics.add({Severity::left_out, "unreachable", "not reached", {}, std::array{1.0, 2.0, 3.0}});
  }
  RotaryPicture picture() const {
    RotaryPicture p;
    p.title = "sample <&> \"@DATA@\" \xff";
    p.command_line = "burin rotary </script><script>alert(1)";
    p.part = &part;
    p.plan = &plan;
    p.tool = &tool;
    p.options = &options;
    p.diagnostics = &diagnostics;
    p.figures = {{"Counts", "contact_points", "120"}};
    p.nc_text = "(</script>)\nG93\n";
    return p;
  }

 private:
  void add_ring(std::size_t path, std::size_t points, double x) {
    rotary::Leg leg;
    leg.kind = rotary::LegKind::cut;
    leg.path = path;
    for (std::size_t i = 0; i < points; ++i) {
      const double a = 2 * kPi * static_cast<double>(i) / static_cast<double>(points);
      RotaryPoint p;
      p.path = path, p.index = i;
      const geom::Vec3 n{0, std::sin(a), std::cos(a)};
      p.place.contact = {Point3{x, 0, 0} + kRadius * n, n, a / (2 * kPi), x / kLength};
      p.place.center = Point3{x, 0, 0} + (kRadius + kBall) * n;
      p.place.state = i % 11 == 10 ? State::unreachable : i % 7 == 6 ? State::moved : State::ok;
      p.place.excess_mm = p.place.state == State::ok ? 0 : 0.01 * static_cast<double>(i);
      p.initial = p.theta = a;
      p.initial_interferes = i % 2 == 0;
      if (p.place.state != State::unreachable) {
        const double lo = std::remainder(a - 1, 2 * kPi);
        p.reachable = {{lo, lo + 2}};
        leg.poses.push_back({p.place.center, p.theta});
        leg.points.push_back(plan.points.size());
      }
      plan.points.push_back(p);
    }
    plan.legs.push_back(leg);
  }
};

TEST(RotaryHtml, IsOnePageWhoseDataParsesAndCannotEscape) {
  const Sample sample;
  const std::string page = rotary_html(sample.picture());
  expect_closed_page(page);
  test::expect_balanced(page);
  EXPECT_NE(page.find("<title>sample &lt;&amp;&gt; &quot;@DATA@&quot;"), std::string::npos);
  const auto data = data_of(page);
  EXPECT_EQ(data["title"].get<std::string>().substr(0, 19), "sample <&> \"@DATA@\"");
  EXPECT_EQ(data["warnings"].size(), 2u);
  EXPECT_EQ(data["nc"].get<std::string>(), sample.picture().nc_text);
  EXPECT_EQ(data["sections"]["list"].size(), 3u);
}

TEST(RotaryHtml, PointsAndPosesComeBack) {
  const Sample sample;
  const auto data = data_of(rotary_html(sample.picture()));
  const auto& points = data["points"];
  const std::size_t n = points["n"];
  ASSERT_EQ(n, sample.plan.points.size());
  const std::vector<float> contact = test::numbers<float>(points["contact"]),
                           theta = test::numbers<float>(points["theta"]),
                           reach = test::numbers<float>(points["reach"]);
  const std::string flags = decode64(points["flags"].get<std::string>()),
                    counts = decode64(points["reachCount"].get<std::string>());
  std::size_t at = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const RotaryPoint& p = sample.plan.points[i];
    EXPECT_NEAR(contact[3 * i + 1], p.place.contact.p.y, 1e-5);
    EXPECT_NEAR(theta[i], p.theta, 1e-6);
    EXPECT_EQ(flags[i] & 3, static_cast<int>(p.place.state));
    EXPECT_EQ((flags[i] & 4) != 0, p.initial_interferes);
    ASSERT_EQ(static_cast<std::size_t>(counts[i]), p.reachable.size());
    for (const rotary::AngleInterval& interval : p.reachable) {
      EXPECT_NEAR(reach[at++], interval.lo, 1e-6);
      EXPECT_NEAR(reach[at++], interval.hi, 1e-6);
    }
  }
  EXPECT_EQ(at, reach.size());
  std::size_t poses = 0;
  for (const rotary::Leg& leg : sample.plan.legs) poses += leg.poses.size();
  EXPECT_EQ(data["poses"]["n"], poses);
  EXPECT_EQ(decode64(data["poses"]["xyzt"].get<std::string>()).size(), 16 * poses);
}

TEST(RotaryHtml, SamePictureSameBytes) {
  const Sample a, b;
  EXPECT_EQ(rotary_html(a.picture()), rotary_html(b.picture()));
  EXPECT_EQ(rotary_svg(a.part, a.plan, a.tool), rotary_svg(b.part, b.plan, b.tool));
}

TEST(RotaryHtml, StaysBelowTenMegabytes) {
  const Sample sample(200, 1000);
  RotaryPicture picture = sample.picture();
  picture.nc_text = std::string(3'000'000, '\n');
  const std::string page = rotary_html(picture);
  EXPECT_LT(page.size(), 10'000'000u);
  const auto data = data_of(page);
  EXPECT_EQ(data["points"]["of"], 200'000);
  EXPECT_LE(data["points"]["n"].get<int>(), 60'000 + 200);
}

TEST(RotaryHtml, NothingPlannedIsAPageToo) {
  Sample sample(1, 1);
  sample.plan = {};
  EXPECT_EQ(data_of(rotary_html(sample.picture()))["points"]["n"], 0);
  sample.part = {};
  EXPECT_EQ(data_of(rotary_html(sample.picture()))["shape"]["triangles"], 0);
  EXPECT_FALSE(rotary_svg(sample.part, sample.plan, sample.tool).empty());
}

TEST(RotarySvg, IsWellFormedAndHasBothPictures) {
  const Sample sample;
  const std::string svg = rotary_svg(sample.part, sample.plan, sample.tool);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(svg.c_str()));
  std::size_t parts = 0, bad = 0;
  for (const pugi::xml_node& node : document.child("svg").children("path")) {
    const std::string kind = node.attribute("class").value();
    parts += kind == "part" ? 1 : 0;
    if (kind != "bad") continue;
    for (const char* c = node.attribute("d").value(); *c != 0; ++c) bad += *c == 'M' ? 1 : 0;
  }
  EXPECT_EQ(parts, 2u);
  EXPECT_EQ(bad, 20u) << "every second of the 40 points of a ring, in the left picture only";
  EXPECT_NE(svg.find("20 of 40 interfere"), std::string::npos);
  EXPECT_NE(svg.find("3 places not reached"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(RotaryShape, SweptPartsLieOnTheirSurface) {
  const rotary::Part part = *rotary::make_swept(square(), {});
  const Shape shape = drawn_shape(part, 20'000);
  ASSERT_EQ(shape.points.size(), shape.normals.size());
  ASSERT_LE(shape.points.size(), 60'000u);
  ASSERT_GT(shape.points.size(), 300u);
  std::size_t caps = 0;
  for (std::size_t i = 0; i < shape.points.size(); ++i) {
    const Point3 p = shape.points[i];
    EXPECT_NEAR(norm(shape.normals[i]), 1, 1e-9);
    const double a = -kPi / 2 * p.x / kLength;
    const double y = p.y * std::cos(a) - p.z * std::sin(a), z = p.y * std::sin(a) + p.z * std::cos(a);
    if (std::abs(shape.normals[i].x) > 0.999) {
      ++caps;
      continue;
    }
    EXPECT_NEAR(std::max(std::abs(y), std::abs(z)), kRadius, 1e-9);
    // Outwards, and square to the way along the part: d/dx of the point is (1, -k z, k y).
    const double k = kPi / 2 / kLength;
    const geom::Vec3 n = shape.normals[i];
    EXPECT_GT(n.y * p.y + n.z * p.z, 0);
    EXPECT_NEAR(n.x - k * p.z * n.y + k * p.y * n.z, 0, 1e-9);
  }
  EXPECT_GT(caps, 0u);
}

TEST(RotaryShape, FineMeshesAreThinnedAndStayNear) {
  rotary::Part part = *rotary::make_swept(square(), {.deflection_mm = 0.0005});
  part.swept.reset();
  ASSERT_GT(part.mesh.triangles.size(), 500u);
  const Shape shape = drawn_shape(part, 300);
  EXPECT_LE(shape.points.size(), 900u);
  EXPECT_GT(shape.points.size(), 90u);
  for (const Point3 p : shape.points) EXPECT_LE(std::hypot(p.y, p.z), kRadius * std::sqrt(2.0) + 1e-6);
}

TEST(RotaryShape, OutlinesAreTheTurnedSection) {
  const rotary::Part part = *rotary::make_swept(square(), {});
  const std::vector<double> xs{0, 5, 10, 20};
  const std::vector<Outline> all = outlines(part, xs, 0.01);
  ASSERT_EQ(all.size(), xs.size());
  for (std::size_t k = 0; k < xs.size(); ++k) {
    ASSERT_EQ(all[k].size(), 1u);
    double area = 0;
    const auto& line = all[k].front();
    for (std::size_t i = 1; i < line.size(); ++i)
      area += cross(line[i - 1] - Point2{}, line[i] - Point2{}) / 2;
    EXPECT_NEAR(area, 4 * kRadius * kRadius, 1) << xs[k];
  }
}

TEST(RotaryPlaces, NeighboursAreOnePlaceAndTheWorstIsFirst) {
  Sample sample(1, 40);
  auto& points = sample.plan.points;
  for (RotaryPoint& p : points) p.place.state = State::ok;
  for (const std::size_t i : {3u, 4u, 5u})
    points[i].place.state = State::moved, points[i].place.excess_mm = 0.1 * static_cast<double>(i);
  points[9].place.state = State::moved, points[9].place.excess_mm = 3;
  points[20].place.state = points[21].place.state = State::unreachable;
  points[20].place.excess_mm = 0.1, points[21].place.excess_mm = 0.2;
  const std::vector<LeftPlace> places = left_places(sample.plan);
  ASSERT_EQ(places.size(), 3u);
  EXPECT_EQ(places[0].state, State::unreachable);
  EXPECT_EQ(places[0].worst, 21u);
  EXPECT_EQ(places[1].first, 9u);
  EXPECT_EQ(places[2].first, 3u);
  EXPECT_EQ(places[2].last, 5u);
  EXPECT_EQ(places[2].worst, 5u);
}

TEST(RotaryPlaces, WithoutSmoothingTheNearestReachableAngleIsTaken) {
  RotaryPoint p;
  p.initial = 0.5;
  EXPECT_EQ(unsmoothed(p, 0.1), 0.5) << "nothing reachable";
  p.reachable = {{1, 2}};
  EXPECT_NEAR(unsmoothed(p, 0.1), 1.1, 1e-12);
  p.reachable = {{0, 2}};
  EXPECT_NEAR(unsmoothed(p, 0.1), 0.5, 1e-12);
}

}  // namespace
}  // namespace burin::view
