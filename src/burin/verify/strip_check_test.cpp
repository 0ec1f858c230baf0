// SPDX-License-Identifier: Apache-2.0
// Ridges on a plane, a cylinder and a sphere have closed forms.
#include "burin/verify/strip_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "burin/geom/surface/surface_cases.h"

namespace burin::verify {
namespace {

using geom::NurbsSurface;
using geom::Point3;
using geom::Vec3;

NurbsSurface plane(double size) {
  NurbsSurface s;
  s.degree_u = s.degree_v = 1;
  s.count_u = s.count_v = 2;
  s.knots_u = s.knots_v = {0, 0, 1, 1};
  for (const double y : {-size, size})
    for (const double x : {-size, size}) s.points.push_back({x, y, 0, 1});
  return s;
}

/// The tool at contact c with normal n, leaning by `tilt` towards the feed turned by `yaw` about n: the
/// contact by its geometry.
StripStation station(const CheckedMill& tool, Point3 c, Vec3 n, Vec3 f, double tilt, double yaw = 0) {
  const Vec3 d = std::cos(yaw) * f + std::sin(yaw) * cross(n, f);
  const Vec3 u = std::cos(tilt) * n + std::sin(tilt) * d, in = std::sin(tilt) * n - std::cos(tilt) * d;
  const double r = tool.corner_radius;
  return {c, {c + r * n + (tool.radius - r) * in - r * u, u}};
}

StripReport measured(const NurbsSurface& surface, const std::vector<StripPass>& passes,
                     const CheckedMill& tool, StripOptions options = {}) {
  const auto report = measure_strips(surface, passes, tool, options);
  if (!report) {
    ADD_FAILURE() << report.error().message;
    return {};
  }
  return *report;
}

/// Height of the silhouette of a mill at +-y beside the contact, seen along the feed (yaw 0): an ellipse,
/// moved out by the corner.
double silhouette(const CheckedMill& tool, double tilt, double y) {
  const double a = tool.radius - tool.corner_radius, b = a * std::sin(tilt), r = tool.corner_radius;
  if (a == 0) return r - std::sqrt(r * r - y * y);
  // The lowest of the circles of radius r about the ellipse (x, b - b sqrt(1 - x^2 / a^2)) that reach y.
  double low = 1e9;
  for (int i = -4000; i <= 4000; ++i) {
    const double x = a * i / 4000, off = y - x;
    if (std::abs(off) > r) continue;
    low = std::min(low, b - b * std::sqrt(1 - (x / a) * (x / a)) + r - std::sqrt(r * r - off * off));
  }
  return r > 0 ? low : b - b * std::sqrt(1 - y * y / (a * a));
}

std::vector<StripPass> on_plane(const CheckedMill& tool, double step, double tilt, double yaw = 0) {
  std::vector<StripPass> passes;
  for (int i = 0; i < 4; ++i) {
    StripPass pass;
    pass.runs.emplace_back();
    for (int k = 0; k <= 8; ++k)
      pass.runs[0].push_back(station(tool, {-80.0 + 20 * k, i * step, 0}, {0, 0, 1}, {1, 0, 0}, tilt, yaw));
    passes.push_back(pass);
  }
  return passes;
}

TEST(StripCheck, TiltedEndsOnAPlane) {
  for (const double corner : {0.0, 5.0, 30.0})
    for (const double tilt : {geom::radians(2.0), geom::radians(15.0)}) {
      SCOPED_TRACE(std::to_string(corner) + " " + std::to_string(tilt));
      const CheckedMill tool{30, corner, 60, {}};
      const double step = corner == 30 ? 4 : 16;
      const StripReport report = measured(plane(100), on_plane(tool, step, tilt), tool);
      const double want = silhouette(tool, tilt, step / 2);
      ASSERT_EQ(report.ridges.size(), 3u);
      EXPECT_NEAR(report.scallop_max_mm, want, 3e-4 + 2e-3 * want);
      // The first station of a pass sees less of the way in than the others.
      EXPECT_NEAR(report.scallop_min_mm, want, 3e-4 + 2e-3 * want);
      EXPECT_LE(report.gouge_max_mm, 1e-4);
    }
}

// A turned ellipse: the two sides of a pass are not alike; the ridge is where the one of the left meets the
// one of the right.
TEST(StripCheck, YawOnAPlane) {
  const CheckedMill tool{30, 0, 60, {}};
  const double tilt = geom::radians(6.0), yaw = geom::radians(40.0), step = 14;
  const StripReport report = measured(plane(100), on_plane(tool, step, tilt, yaw), tool);
  // The rim as seen along the feed, tried in places.
  const Vec3 d{std::cos(yaw), std::sin(yaw), 0},
      u{std::sin(tilt) * d.x, std::sin(tilt) * d.y, std::cos(tilt)};
  const Vec3 in{-std::cos(tilt) * d.x, -std::cos(tilt) * d.y, std::sin(tilt)}, e = cross(u, in);
  constexpr double kBin = 0.02;
  std::vector<double> rim(4000, 1e9);  // the lowest place by y
  for (int i = 0; i < 400000; ++i) {
    const double a = 2 * geom::kPi * i / 400000;
    const Vec3 p = 30 * in - 30 * (std::cos(a) * in + std::sin(a) * e);
    double& low = rim[static_cast<std::size_t>(2000 + std::floor(p.y / kBin))];
    low = std::min(low, p.z);
  }
  double want = 0;
  for (std::size_t k = 0; k <= std::size_t(step / kBin); ++k)
    want = std::max(want, std::min(rim[2000 + k], rim[2000 + k - std::size_t(step / kBin)]));
  EXPECT_GT(want, 0.1);
  // Not at the ends of the passes, where the tool has not come with the part of its rim that cuts there.
  EXPECT_NEAR(report.scallop_min_mm, want, 2e-3);
  EXPECT_NEAR(report.stations[4].mm, want, 2e-3);
  EXPECT_GT(report.scallop_max_mm, want + 0.1);
  EXPECT_LE(report.gouge_max_mm, 1e-4);
}

/// Lines along the axis of a cylinder about z, the feed along the axis: in the section a circle and the
/// silhouette.
TEST(StripCheck, FlatEndAlongACylinder) {
  const double radius = 90, half = 0.08, tilt = geom::radians(10.0);
  const CheckedMill tool{30, 0, 60, {}};
  const NurbsSurface s = geom::cases::cylinder(radius, 200);
  std::vector<StripPass> passes;
  for (int i = -1; i <= 2; ++i) {
    const double a = 0.7 + 2 * half * i;
    const Vec3 n{std::cos(a), std::sin(a), 0};
    StripPass pass;
    pass.runs.emplace_back();
    for (int k = 0; k <= 10; ++k)
      pass.runs[0].push_back(station(tool, Point3{0, 0, 10.0 * k + 50} + radius * n, n, {0, 0, 1}, tilt));
    passes.push_back(pass);
  }
  // Half way between: up the normal until the silhouette of one of them.
  double lo = 0, hi = 5;
  for (int i = 0; i < 60; ++i) {
    const double h = 0.5 * (lo + hi), y = (radius + h) * std::sin(half),
                 z = (radius + h) * std::cos(half) - radius;
    (z < silhouette(tool, tilt, y) ? lo : hi) = h;
  }
  // Su x Sv points inwards, as surface_cases.h says of profiles that run upwards.
  const StripReport report = measured(s, passes, tool, {.normal_reversed = true});
  EXPECT_NEAR(report.scallop_max_mm, lo, 3e-4);
  EXPECT_NEAR(report.scallop_min_mm, lo, 3e-4);
  EXPECT_LE(report.gouge_max_mm, 1e-4);
}

TEST(StripCheck, BallRoundASphere) {
  const double radius = 60, r = 8, step = 0.06;
  const CheckedMill tool{r, r, 60, {}};
  std::vector<StripPass> passes;
  for (int i = 0; i < 4; ++i) {
    StripPass pass;
    pass.runs.emplace_back();
    const double up = 0.3 + step * i;
    for (int k = 0; k <= 400; ++k) {
      const double a = 0.2 + 1.2 * k / 400;
      const Vec3 n{std::cos(up) * std::cos(a), std::cos(up) * std::sin(a), std::sin(up)};
      pass.runs[0].push_back(station(tool, Point3{} + radius * n, n, {-std::sin(a), std::cos(a), 0}, 0.1));
    }
    passes.push_back(pass);
  }
  const double c = radius + r, want = c * std::cos(step / 2) -
                                      std::sqrt(r * r - std::pow(c * std::sin(step / 2), 2)) - radius;
  const StripReport report = measured(geom::cases::sphere(radius), passes, tool,
                                      {.normal_reversed = true, .max_stations = 60, .threads = 2});
  EXPECT_NEAR(report.scallop_max_mm, want, 5e-4);
  EXPECT_NEAR(report.scallop_min_mm, want, 5e-4);
  // Chords of the way: 0.0005 mm below the circle.
  EXPECT_LE(report.gouge_max_mm, 1e-3);
}

// What is planted shows: a pass left out, a place too deep.
TEST(StripCheck, SeesPlantedFaults) {
  const CheckedMill tool{30, 0, 60, {}};
  const double tilt = geom::radians(10.0), step = 10;
  std::vector<StripPass> passes = on_plane(tool, step, tilt);
  auto deep = passes;
  for (StripStation& s : deep[2].runs[0]) s.pose.tip.z -= 0.05;
  EXPECT_NEAR(measured(plane(100), deep, tool).gouge_max_mm, 0.05, 3e-4);
  passes.erase(passes.begin() + 1);
  const StripReport gap = measured(plane(100), passes, tool);
  EXPECT_NEAR(gap.ridges[0].max_mm, silhouette(tool, tilt, step), 5e-3);
  EXPECT_NEAR(gap.ridges[1].max_mm, silhouette(tool, tilt, step / 2), 1e-3);
}

TEST(StripCheck, BadInputIsAnError) {
  const CheckedMill tool{30, 0, 60, {}};
  auto passes = on_plane(tool, 10, 0.1);
  EXPECT_FALSE(measure_strips({}, passes, tool));
  EXPECT_FALSE(measure_strips(plane(10), passes, {}));
  EXPECT_FALSE(measure_strips(plane(10), passes, tool, {.window_mm = 0}));
  passes[0].runs[0][1].contact.x = std::nan("");
  EXPECT_FALSE(measure_strips(plane(10), passes, tool));
  EXPECT_TRUE(measure_strips(plane(10), {}, tool));
}

}  // namespace
}  // namespace burin::verify
