// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/mesh_index.h"
#include "burin/plan/rotary/part.h"

namespace burin::rotary {
namespace {

using geom::ArcSpline;
using geom::Point2;
using geom::Point3;

ArcSpline circle(Point2 c, double r, double start = 0) {
  const geom::Vec2 d{r * std::cos(start), r * std::sin(start)};
  return {{geom::make_arc(c + d, c - d, c, true), geom::make_arc(c - d, c + d, c, true)}, true};
}
ArcSpline polygon(const std::vector<Point2>& p) {
  ArcSpline out;
  out.closed = true;
  for (std::size_t i = 0; i < p.size(); ++i)
    out.segments.push_back(geom::make_line(p[i], p[(i + 1) % p.size()]));
  return out;
}

void expect_sound(const Part& part) {
  const auto report = geom::examine(part.mesh);
  EXPECT_TRUE(report.holes.empty());
  EXPECT_EQ(report.shared_by_many + report.against_sense, 0U);
  EXPECT_GT(report.signed_volume, 0);
  EXPECT_EQ(part.corner_normals.size(), part.mesh.triangles.size());
}

TEST(PartLoft, CylinderWithinTheDeflection) {
  for (const double deflection : {0.1, 0.01, 0.002}) {
    // The same circle, begun elsewhere in each section.
    const auto part =
        make_loft({{circle({0, 0}, 10), 0}, {circle({0, 0}, 10, 1), 20}, {circle({0, 0}, 10, 4), 50}},
                  {.deflection_mm = deflection});
    ASSERT_TRUE(part.ok()) << part.error().message;
    expect_sound(*part);
    EXPECT_EQ(part->x_min, 0);
    EXPECT_EQ(part->x_max, 50);
    EXPECT_NEAR(part->radius_max, 10, 1e-9);
    const geom::MeshIndex index(part->mesh);
    for (int i = 0; i < 500; ++i) {
      const double a = 0.1 * i, x = 1 + 0.09 * i;
      const auto hit = index.nearest({x, 10 * std::cos(a), 10 * std::sin(a)}, 10);
      ASSERT_TRUE(hit.has_value());
      EXPECT_LE(hit->distance, deflection);
    }
  }
}

TEST(PartLoft, NaturalCubicAlongX) {
  // Circles of radius r_k: the radius between them is the natural cubic through them. For 10, 12, 10 at 0,
  // 10, 20 that is r = 10 + 0.3 x - 0.001 x^3 up to the middle.
  const auto part = make_loft({{circle({0, 0}, 10), 0}, {circle({0, 0}, 12), 10}, {circle({0, 0}, 10), 20}},
                              {.deflection_mm = 0.005});
  ASSERT_TRUE(part.ok()) << part.error().message;
  expect_sound(*part);
  const geom::MeshIndex index(part->mesh);
  for (int i = 1; i < 200; ++i) {
    const double x = 0.1 * i, s = x < 10 ? x : 20 - x, r = 10 + 0.3 * s - 0.001 * s * s * s, a = 0.37 * i;
    EXPECT_LE(index.nearest({x, r * std::cos(a), r * std::sin(a)}, 10)->distance, 0.005) << x;
  }
}

TEST(PartLoft, SectionsAreMatchedByLengthFromAngleZero) {
  // Squares, the second turned by an eighth: side mid points meet corners.
  const ArcSpline square = polygon({{5, -5}, {5, 5}, {-5, 5}, {-5, -5}});
  const double d = 5 * std::sqrt(2);
  const ArcSpline turned = polygon({{d, 0}, {0, d}, {-d, 0}, {0, -d}});
  const auto part = make_loft({{square, 0}, {turned, 30}}, {.deflection_mm = 0.01});
  ASSERT_TRUE(part.ok()) << part.error().message;
  expect_sound(*part);
  const geom::MeshIndex index(part->mesh);
  // Straight lines between places of the same length from +Y: (5, 0) - (d, 0), (5, 5) - half a side on.
  for (const double t : {0.1, 0.5, 0.9}) {
    EXPECT_LE(index.nearest({30 * t, 5 + t * (d - 5), 0}, 10)->distance, 0.01);
    EXPECT_LE(index.nearest({30 * t, 5 + t * (d / 2 - 5), 5 + t * (d / 2 - 5)}, 10)->distance, 0.01);
  }
  // Turned by whole lengths the other way round gives the same.
  const auto clockwise = make_loft({{reversed(square), 0}, {turned, 30}}, {.deflection_mm = 0.01});
  ASSERT_TRUE(clockwise.ok());
  EXPECT_NEAR(geom::examine(clockwise->mesh).signed_volume, geom::examine(part->mesh).signed_volume, 1e-9);
}

TEST(PartLoft, SectionsThatAreNone) {
  const auto error = [](const std::vector<LoftSection>& s, const PartOptions& options = {}) {
    const auto part = make_loft(s, options);
    return part ? std::string("was made") : part.error().message;
  };
  EXPECT_NE(error({}).find("at least two"), std::string::npos);
  EXPECT_NE(error({{circle({0, 0}, 5), 0}}).find("at least two"), std::string::npos);
  EXPECT_NE(error({{circle({0, 0}, 5), 0}, {circle({0, 0}, 5), 0}}).find("does not follow"),
            std::string::npos);
  EXPECT_NE(error({{circle({0, 0}, 5), 0}, {circle({0, 0}, 5), -3}}).find("does not follow"),
            std::string::npos);
  EXPECT_NE(error({{circle({0, 0}, 5), 0}, {circle({9, 0}, 5), 9}}).find("section 2: "), std::string::npos);
  EXPECT_NE(error({{circle({0, 0}, 5), 0}, {ArcSpline{}, 9}}).find("section 2: "), std::string::npos);
  EXPECT_NE(error({{circle({0, 0}, 5), std::nan("")}, {circle({0, 0}, 5), 9}}).find("within"),
            std::string::npos);
  EXPECT_NE(error({{circle({0, 0}, 5), 0}, {circle({0, 0}, 5), 9}}, {.deflection_mm = -1}).find("above 0"),
            std::string::npos);
  const auto many = make_loft({{circle({0, 0}, 5), 0}, {circle({0, 0}, 5), 9}},
                              {.deflection_mm = 1e-9, .max_triangles = 1000});
  ASSERT_FALSE(many.ok());
  EXPECT_EQ(many.error().code, ErrorCode::range);
  // Between them the axis runs outside: the splines swing out.
  const auto swing = make_loft({{circle({0, 0}, 5), 0},
                                {circle({4.5, 0}, 5), 1},
                                {circle({-4.5, 0}, 5), 40},
                                {circle({4.5, 0}, 5), 41}},
                               {.deflection_mm = 0.01});
  EXPECT_FALSE(swing.ok());
}

}  // namespace
}  // namespace burin::rotary
