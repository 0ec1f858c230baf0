// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "burin/geom/mesh/mesh_index.h"
#include "burin/plan/rotary/cap.h"
#include "burin/plan/rotary/part.h"
#include "burin/plan/rotary/rotary_cases.h"

namespace burin::rotary {
namespace {

using geom::ArcSpline;
using geom::kPi;
using geom::Point2;
using geom::Point3;
using geom::Vec2;
using geom::Vec3;

struct Case {
  const char* name;
  SweptSection swept;
};

std::vector<Case> all_cases() {
  std::vector<Case> all{
      {"circle", cases::swept(cases::circle(10), 20, 0)},
      {"circle beside the axis, twisted", cases::swept(cases::circle(10, {3, 2}), 20, 1)},
      {"ellipse", cases::swept(cases::ellipse(12, 7), 30, -2)},
      {"cam", cases::swept(cases::cam(12, 4, 6), 15, 0)},
      {"keyway", cases::swept(cases::keyway(10, 4, 3), 15, kPi / 2)},
      {"cutter", cases::swept(cases::cutter(8, 20, 13, 1.5), 50, kPi)},
      {"square", cases::swept(cases::polygon({{5, 5}, {-5, 5}, {-5, -5}, {5, -5}}), 10, 3)}};
  all.push_back({"stations", {cases::ellipse(12, 7), {{0, 0}, {5, 0}, {10, 0.5}, {20, -0.5}}}});
  return all;
}

/// S(u, x) straight from the definition.
Point3 on_sweep(const SweptSection& s, Point2 c, double x) {
  const double a = s.turn_at(x);
  return {x, c.x * std::cos(a) - c.y * std::sin(a), c.x * std::sin(a) + c.y * std::cos(a)};
}

TEST(MakeSwept, MeshIsClosedAndHoldsItsVolume) {
  for (const Case& c : all_cases()) {
    SCOPED_TRACE(c.name);
    auto part = make_swept(c.swept, {});
    ASSERT_TRUE(part) << part.error().message;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    double volume = 0;
    for (const auto& t : part->mesh.triangles) {
      for (int k = 0; k < 3; ++k) ++edges[{t[std::size_t(k)], t[std::size_t((k + 1) % 3)]}];
      const Point3 o{}, a = part->mesh.vertices[t[0]], b = part->mesh.vertices[t[1]],
                        d = part->mesh.vertices[t[2]];
      volume += dot(a - o, cross(b - o, d - o)) / 6;
    }
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1);
      ASSERT_TRUE(edges.count({edge.second, edge.first})) << "an edge without its other side";
    }
    const double length = part->x_max - part->x_min;
    const double area = signed_area(c.swept.section);
    EXPECT_NEAR(volume, area * length, part->deflection_mm * length_of(c.swept.section) * length);
    EXPECT_EQ(part->corner_normals.size(), part->mesh.triangles.size());
  }
}

TEST(MakeSwept, MeshLeavesTheSurfaceByAtMostTheDeflection) {
  for (const Case& c : all_cases()) {
    SCOPED_TRACE(c.name);
    auto part = make_swept(c.swept, {});
    ASSERT_TRUE(part);
    const geom::MeshIndex index(part->mesh);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit_(0, 1);
    double worst = 0;
    for (int k = 0; k < 4000; ++k) {
      const auto& segments = c.swept.section.segments;
      const geom::Segment& seg = segments[std::size_t(unit_(random) * double(segments.size()))];
      const Point3 p = on_sweep(c.swept, point_on(seg, unit_(random)), unit_(random) * part->x_max);
      const auto hit = index.nearest(p, 1.0);
      ASSERT_TRUE(hit);
      worst = std::max(worst, hit->distance);
    }
    EXPECT_LE(worst, part->deflection_mm * (1 + 1e-9));
    // And the other way: random points of the mesh, turned back into the section.
    worst = 0;
    for (int k = 0; k < 2000; ++k) {
      const auto& t = part->mesh.triangles[std::size_t(unit_(random) * double(part->mesh.triangles.size()))];
      const Point3 a = part->mesh.vertices[t[0]], b = part->mesh.vertices[t[1]],
                   d = part->mesh.vertices[t[2]];
      const double f = unit_(random), g = unit_(random);
      const Point3 p = a + f * (1 - g) * (b - a) + g * (d - a);
      if (p.x <= 1e-9 || p.x >= part->x_max - 1e-9) continue;  // caps
      const double back = -c.swept.turn_at(p.x);
      const Point2 q{p.y * std::cos(back) - p.z * std::sin(back),
                     p.y * std::sin(back) + p.z * std::cos(back)};
      worst = std::max(worst, distance_to(c.swept.section, q));
    }
    // In the plane of the section the distance may be larger than in space, by the slope of the surface.
    EXPECT_LE(worst, 3 * part->deflection_mm);
  }
}

TEST(MakeSwept, CornerNormalsAreThoseOfTheSurface) {
  // Facets leave the surface by micrometres: their own normals are near those given at their corners.
  for (const Case& c : all_cases()) {
    SCOPED_TRACE(c.name);
    auto part = make_swept(c.swept, {});
    ASSERT_TRUE(part);
    double worst = 0;
    for (std::size_t i = 0; i < part->mesh.triangles.size(); i += 7) {
      const auto& t = part->mesh.triangles[i];
      const Point3 a = part->mesh.vertices[t[0]], b = part->mesh.vertices[t[1]],
                   d = part->mesh.vertices[t[2]];
      const Vec3 face = unit(cross(b - a, d - a));
      for (const Vec3 n : part->corner_normals[i]) {
        EXPECT_NEAR(norm(n), 1, 1e-12);
        worst = std::max(worst, std::acos(std::clamp(dot(n, face), -1.0, 1.0)));
      }
    }
    // The normal turns by at most 0.25 over a facet along the section, and by the turn of a row.
    EXPECT_LT(worst, 0.25);
  }
}

TEST(MakeSwept, ClockwiseSectionsAreTurnedRound) {
  auto part = make_swept(cases::swept(reversed(cases::cam(12, 4, 6)), 10, 0), {});
  ASSERT_TRUE(part);
  EXPECT_GT(signed_area(part->swept->section), 0);
  EXPECT_NEAR(part->radius_max, 18, 1e-9);
}

TEST(MakeSwept, RefusesWhatIsNoPart) {
  const auto message = [](SweptSection s, PartOptions o = {}) {
    auto part = make_swept(s, o);
    EXPECT_FALSE(part);
    return part ? std::string() : part.error().message;
  };
  ArcSpline open = cases::polygon({{5, 5}, {-5, 5}, {-5, -5}, {5, -5}});
  open.segments.pop_back();
  open.closed = false;
  EXPECT_NE(message(cases::swept(open, 10, 0)).find("open"), std::string::npos);
  open.closed = true;
  EXPECT_NE(message(cases::swept(open, 10, 0)).find("open"), std::string::npos);
  const std::string crossing =
      message(cases::swept(cases::polygon({{5, 5}, {-5, -5.5}, {-5, 5}, {5, -5}, {9, 0}}), 10, 0));
  EXPECT_NE(crossing.find("crosses or touches itself at"), std::string::npos) << crossing;
  // A spike out and back along itself.
  EXPECT_NE(message(cases::swept(cases::polygon({{5, 5}, {0, 5}, {0, 8}, {0, 5}, {-5, 5}, {-5, -5}, {5, -5}}),
                                 10, 0))
                .find("crosses or touches"),
            std::string::npos);
  EXPECT_NE(message(cases::swept(cases::circle(5, {9, 0}), 10, 0)).find("axis"), std::string::npos);
  EXPECT_NE(message(cases::swept(cases::circle(5, {5, 0}), 10, 0)).find("axis"), std::string::npos);
  EXPECT_NE(message(cases::swept(cases::circle(5, {4.999, 0}), 10, 0)).find("axis"), std::string::npos);
  EXPECT_NE(message(cases::swept(cases::circle(0.003), 10, 0)).find("small"), std::string::npos);
  EXPECT_NE(message({cases::circle(5), {{0, 0}}}).find("two stations"), std::string::npos);
  EXPECT_NE(message({cases::circle(5), {{0, 0}, {5, 1}, {5, 2}}}).find("ascend"), std::string::npos);
  EXPECT_NE(message({cases::circle(5), {{0, 0}, {5, NAN}}}).find("range"), std::string::npos);
  EXPECT_NE(message({cases::circle(5), {{1, 0}, {5, 0}}}).find("x = 0"), std::string::npos);
  EXPECT_NE(message({ArcSpline{{}, true}, {{0, 0}, {5, 0}}}).find("empty"), std::string::npos);
  EXPECT_NE(message({cases::circle(NAN), {{0, 0}, {5, 0}}}).find("not numbers"), std::string::npos);
  PartOptions few;
  few.max_triangles = 1000;
  EXPECT_NE(message(cases::swept(cases::cutter(8, 20, 13, 1.5), 50, kPi), few).find("triangles"),
            std::string::npos);
  EXPECT_NE(message(cases::swept(cases::circle(5), 1e-3, 1e6)).find("triangles"), std::string::npos);
}

TEST(Cap, TrianglesFillRandomPolygonsOnce) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 200; ++round) {
    std::vector<Point2> p;
    std::uniform_real_distribution<double> radius(1, 20);
    const int n = 3 + int(random() % 300);
    for (int i = 0; i < n; ++i) p.push_back(cases::polar(radius(random), 2 * kPi * i / n));
    double polygon = 0, sum = 0;
    for (int i = 0; i < n; ++i)
      polygon += 0.5 * cross(p[std::size_t(i)] - Point2{}, p[std::size_t((i + 1) % n)] - Point2{});
    const auto triangles = detail::triangulate(p);
    ASSERT_EQ(triangles.size(), p.size() - 2);
    for (const auto& t : triangles) {
      const double area = 0.5 * cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
      EXPECT_GE(area, -1e-9);
      sum += area;
    }
    EXPECT_NEAR(sum, polygon, 1e-9 * polygon);
  }
}

}  // namespace
}  // namespace burin::rotary
