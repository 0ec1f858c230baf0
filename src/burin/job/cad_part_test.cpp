// SPDX-License-Identifier: Apache-2.0
// Parts from CAD faces that do not say that they share edges: written by ourselves, sewn again.
#include "burin/job/cad_part.h"

#include <gtest/gtest.h>

#include <cmath>

#include "burin/geom/mesh/check.h"
#include "burin/io/step/read_step.h"

namespace burin::job {
namespace {

using geom::HPoint;
using geom::NurbsSurface;
using geom::Point3;

/// Surface of a quarter turn about X between two circles (x, r): u along, v around.
NurbsSurface quarter(int number, double x0, double r0, double x1, double r1) {
  NurbsSurface s;
  s.degree_u = 1, s.degree_v = 2;
  s.knots_u = {0, 0, 1, 1}, s.knots_v = {0, 0, 0, 1, 1, 1};
  s.count_u = 2, s.count_v = 3;
  const double w = std::sqrt(0.5), a = number * geom::kPi / 2;
  for (const double step : {0.0, 0.5, 1.0}) {
    const double angle = a + step * geom::kPi / 2, out = step == 0.5 ? 1 / w : 1;
    for (const bool far : {false, true}) {
      const double x = far ? x1 : x0, r = (far ? r1 : r0) * out;
      s.points.push_back(
          geom::homogeneous({x, r * std::cos(angle), r * std::sin(angle)}, step == 0.5 ? w : 1));
    }
  }
  return s;
}

std::string shaft(double gap) {
  std::vector<NurbsSurface> faces;
  for (int i = 0; i < 4; ++i) {
    faces.push_back(quarter(i, 0, 8, 30, 10));
    faces.push_back(quarter(i, 30 + gap, 10, 50, 6));
    faces.push_back(quarter(i, 0, 1e-3, 0, 8));
    faces.push_back(quarter(i, 50, 1e-3, 50, 6));
  }
  return io::write_step(faces, "shaft").value();
}

TEST(CadPart, FacesAreSewn) {
  const std::string bytes = shaft(0);
  Diagnostics diagnostics;
  const auto part = part_from_cad(bytes, "shaft.step", {.deflection_mm = 0.05}, diagnostics);
  if (!part && part.error().code == ErrorCode::unsupported) GTEST_SKIP() << "built without STEP";
  ASSERT_TRUE(part.ok()) << part.error().to_string();
  EXPECT_LE(part->deflection_mm, 0.05 + 1e-12);
  EXPECT_NEAR(part->x_min, 0, 0.05);
  EXPECT_NEAR(part->x_max, 50, 0.05);
  EXPECT_NEAR(part->radius_max, 10, 0.05);
  const auto report = geom::examine(part->mesh);
  EXPECT_EQ(report.shared_by_many + report.against_sense, 0U);
  const auto cone = [](double h, double r, double q) { return geom::kPi * h / 3 * (r * r + r * q + q * q); };
  const double volume = cone(30, 8, 10) + cone(20, 10, 6);
  EXPECT_NEAR(report.signed_volume, volume, 0.005 * volume);
}

TEST(CadPart, GapsWiderThanTheDeflectionAreSaid) {
  Diagnostics diagnostics;
  const auto part = part_from_cad(shaft(0.2), "shaft.step", {.deflection_mm = 0.05}, diagnostics);
  ASSERT_FALSE(part.ok());
  if (part.error().code == ErrorCode::unsupported) GTEST_SKIP() << "built without STEP";
  EXPECT_EQ(part.error().code, ErrorCode::geometry);
  EXPECT_EQ(part.error().where.file, "shaft.step");
  EXPECT_NE(part.error().message.find("edges at (30"), std::string::npos) << part.error().message;
}

}  // namespace
}  // namespace burin::job
