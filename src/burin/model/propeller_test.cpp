// SPDX-License-Identifier: Apache-2.0
#include "burin/model/propeller.h"

#include <gtest/gtest.h>

#include <cmath>

#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/mesh_index.h"
#include "burin/geom/surface/evaluate.h"

namespace burin::model {
namespace {

TEST(Propeller, SectionsAtTheRadiiOfTheTablesAreTheTables) {
  PropellerData data;  // five blades, 1000 mm, Ae/Ao 0.75
  struct Row {
    double radius, chord, leading, thickest, a, b;
  };
  for (const Row& row :
       {Row{0.2, 1.662, 0.617, 0.35, 0.0526, 0.004}, Row{0.5, 2.152, 0.586, 0.355, 0.034, 0.0025},
        Row{0.9, 1.582, 0.351, 0.5, 0.0092, 0.0005}}) {
    const BladeSection s = blade_section(data, row.radius);
    const double chord = row.chord * 1000 * 0.75 / 5;
    EXPECT_NEAR(s.chord, chord, 1e-9);
    EXPECT_NEAR(s.leading, row.leading * chord, 1e-9);
    EXPECT_NEAR(s.max_thickness, 1000 * (row.a - 5 * row.b), 1e-9);
    // The greatest thickness stands at its place and is the full one.
    double thickest = 0, at = 0;
    for (std::size_t i = 0; i < s.face.size(); ++i) {
      const double t = s.back[i].y - s.face[i].y;
      EXPECT_GT(t, 0);
      if (t > thickest) thickest = t, at = s.face[i].x;
    }
    EXPECT_NEAR(thickest, s.max_thickness, 1e-9);
    EXPECT_NEAR(at, -s.leading + row.thickest * chord, 1e-9);
    EXPECT_NEAR(s.face.front().x, -s.leading, 1e-9);
    EXPECT_NEAR(s.face.back().x, chord - s.leading, 1e-9);
  }
}

TEST(Propeller, TheBladesMakeTheExpandedArea) {
  for (const int blades : {3, 4, 5, 7}) {
    PropellerData data;
    data.blades = blades;
    data.area_ratio = 0.6;
    // From the hub of the series to the tip; substituted so that the round tip is smooth.
    const double from = 0.167;
    const int n = 2000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double w = (i + 0.5) / n * std::sqrt(1 - from), x = 1 - w * w;
      sum += blade_section(data, x).chord * 2 * w * std::sqrt(1 - from) / n * 500;
    }
    EXPECT_NEAR(blades * sum / (geom::kPi * 500 * 500), 0.6, 0.006) << blades;
  }
}

TEST(Propeller, TheFaceIsAHelicoidOfThePitch) {
  PropellerData data;
  data.side = BladeSide::back;  // forward is +Z
  data.pitch_ratio = 1.1;
  for (const double ratio : {0.3, 0.5, 0.7, 0.9}) {
    const BladeSection s = blade_section(data, ratio);
    EXPECT_NEAR(s.pitch, 1100, 1e-9);
  }
  const auto p = make_propeller(data);
  ASSERT_TRUE(p.ok()) << p.error().to_string();
  // Beyond 0.7 R the face is flat: going round by an angle goes forward by pitch * angle / turn.
  for (const double v : {0.75, 0.85, 0.95}) {
    const auto a = geom::point(p->other_side, 0.2, v), b = geom::point(p->other_side, 0.8, v);
    const double turn = std::atan2(a.y, a.x) - std::atan2(b.y, b.x);
    EXPECT_GT(turn, 0);  // the leading edge goes first: right-handed, about +Z
    EXPECT_NEAR((a.z - b.z) / (turn / (2 * geom::kPi)), 1100, 1) << v;
  }
}

TEST(Propeller, TheSideLooksUpAndAwayFromTheBlade) {
  for (const BladeSide side : {BladeSide::face, BladeSide::back}) {
    PropellerData data;
    data.side = side;
    const auto p = make_propeller(data);
    ASSERT_TRUE(p.ok());
    for (double u = 0.02; u < 1; u += 0.06) {
      for (double v = 0; v <= 1; v += 0.1) {
        const geom::Vec3 n = (p->reversed ? -1.0 : 1.0) * geom::normal(p->side, u, v);
        EXPECT_GT(n.z, 0) << u << " " << v;
        const geom::Vec3 through = geom::point(p->other_side, u, v) - geom::point(p->side, u, v);
        EXPECT_LT(geom::dot(n, through), 0);
      }
    }
  }
}

TEST(Propeller, BladesAndHubAreClosed) {
  for (const int blades : {2, 4, 7}) {
    PropellerData data;
    data.blades = blades;
    data.area_ratio = 0.5;
    const auto p = make_propeller(data);
    ASSERT_TRUE(p.ok()) << p.error().to_string();
    const auto report = geom::examine(neighbour_blades(data, *p, 0.1));
    EXPECT_EQ(report.holes.size(), 0u);
    EXPECT_EQ(report.shared_by_many, 0u);
    EXPECT_EQ(report.against_sense, 0u);
    EXPECT_EQ(report.degenerate, 0u);
    EXPECT_GT(report.signed_volume, 0);
    const auto hub = geom::examine(hub_mesh(data, *p, 0.1));
    EXPECT_EQ(hub.holes.size() + hub.shared_by_many + hub.against_sense, 0u);
    EXPECT_NEAR(hub.signed_volume, geom::kPi * p->hub_radius * p->hub_radius * p->hub_height,
                0.01 * hub.signed_volume);
    // Blade 0 without its side has one hole: the side.
    EXPECT_EQ(geom::examine(blade_back(data, *p, 0.1)).holes.size(), 1u);
  }
}

TEST(Propeller, BladesKeepApartAndAreNowhereThinnerThanTheirEdges) {
  for (const auto& [blades, area] : {std::pair{4, 1.05}, {5, 0.75}, {7, 0.85}}) {
    PropellerData data;
    data.blades = blades;
    data.area_ratio = area;
    const auto p = make_propeller(data);
    ASSERT_TRUE(p.ok()) << p.error().to_string();
    // Blade 1 against blade 2: turned by one pitch of the blades they would be the same.
    geom::Mesh all = neighbour_blades(data, *p, 1);
    const std::size_t triangles = all.triangles.size() / static_cast<std::size_t>(blades - 1);
    const std::size_t vertices = all.vertices.size() / static_cast<std::size_t>(blades - 1);
    geom::Mesh first = all;
    first.triangles.resize(triangles);
    const geom::MeshIndex index(first);
    for (std::size_t i = vertices; i < 2 * vertices; i += 7) {
      EXPECT_FALSE(index.inside(all.vertices[i]));
      EXPECT_FALSE(index.nearest(all.vertices[i], 2).has_value());
    }
    const double edge = blade_section(data, 0.975).edge_thickness;
    for (double v = 0; v <= 1; v += 0.05) {
      for (double u = 0; u <= 1; u += 0.05) {
        const double thick = geom::distance(geom::point(p->side, u, v), geom::point(p->other_side, u, v));
        EXPECT_GT(thick, 0.99 * edge) << u << " " << v;
      }
    }
  }
}

TEST(Propeller, SaysWhatItDoesNotTake) {
  const auto message = [](auto change) {
    PropellerData data;
    change(data);
    const auto p = make_propeller(data);
    return p.ok() ? std::string("fine") : p.error().message;
  };
  EXPECT_EQ(message([](PropellerData& d) { d.blades = 8; }), "the number of blades is 8 (2 to 7)");
  EXPECT_NE(message([](PropellerData& d) { d.diameter = std::nan(""); }).find("(1 to 20000)"),
            std::string::npos);
  EXPECT_NE(message([](PropellerData& d) { d.pitch_ratio = 3; }).find("(0.5 to 1.4)"), std::string::npos);
  EXPECT_NE(message([](PropellerData& d) { d.area_ratio = 0; }).find("(0.3 to 1.05)"), std::string::npos);
  EXPECT_NE(message([](PropellerData& d) { d.hub_ratio = 0.9; }).find("hub ratio"), std::string::npos);
  EXPECT_NE(message([](PropellerData& d) { d.rake = 1; }).find("rake"), std::string::npos);
}

}  // namespace
}  // namespace burin::model
