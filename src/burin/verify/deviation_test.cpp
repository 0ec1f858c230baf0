// SPDX-License-Identifier: Apache-2.0
// Closed forms within the bound, brute force, planted faults.
#include "burin/verify/deviation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace burin::verify {
namespace {

using geom::Mesh;
using geom::Point3;
using geom::Vec3;

Mesh grid(std::uint32_t nu, std::uint32_t nv, const std::function<Point3(double u, double v)>& at) {
  Mesh m;
  for (std::uint32_t j = 0; j <= nv; ++j)
    for (std::uint32_t i = 0; i <= nu; ++i) m.vertices.push_back(at(i / double(nu), j / double(nv)));
  for (std::uint32_t j = 0; j < nv; ++j)
    for (std::uint32_t i = 0; i < nu; ++i) {
      const std::uint32_t a = j * (nu + 1) + i, b = a + nu + 1;
      m.triangles.push_back({a, a + 1, b + 1});
      m.triangles.push_back({a, b + 1, b});
    }
  return m;
}
/// z = 0 over [0, size]^2.
Mesh plate(double size) {
  return grid(1, 1, [size](double u, double v) { return Point3{size * u, size * v, 0}; });
}

/// Every pose a move of its own.
ToolPath tool_path(const CheckedMill& tool, const std::vector<cl::Pose>& poses) {
  ToolPath path{tool, 1, poses.front(), {}};
  for (std::size_t i = 1; i < poses.size(); ++i)
    path.pieces.push_back({poses[i], static_cast<std::uint32_t>(i), false});
  return path;
}
CheckedPath checked(const std::vector<ToolPath>& tools) {
  CheckedPath path{tools, {}, 0};
  for (const ToolPath& t : tools) path.moves.resize(std::max(path.moves.size(), t.pieces.size() + 1));
  return path;
}
CheckedPath checked(const CheckedMill& tool, const std::vector<cl::Pose>& poses) {
  return checked({tool_path(tool, poses)});
}

/// Passes along x, to and fro, over [0, size]^2 and `over` beyond; the same pose all the way.
std::vector<cl::Pose> passes(double size, double over, double step, double z, Vec3 axis = {0, 0, 1}) {
  std::vector<cl::Pose> poses;
  bool back = false;
  for (double y = -over; y < size + over; y += step, back = !back)
    for (const bool end : {false, true}) poses.push_back({{end != back ? size + over : -over, y, z}, axis});
  return poses;
}

DeviationReport measured(const Mesh& mesh, const SampledSurface& surface, const CheckedPath& path,
                         const DeviationOptions& options = {}) {
  const auto report = measure_deviation(mesh, surface, path, options);
  if (!report) {
    ADD_FAILURE() << report.error().message;
    return {};
  }
  return *report;
}
SampledSurface sampled(const Mesh& mesh, SampleOptions options = {}) {
  const auto surface = sample_surface(mesh, {}, {}, options);
  if (!surface) {
    ADD_FAILURE() << surface.error().message;
    return {};
  }
  return *surface;
}
SampledSurface sampled(const Mesh& mesh, double spacing) {
  SampleOptions options;
  options.spacing_mm = spacing;
  return sampled(mesh, options);
}

TEST(Samples, LeaveNoPlaceAlone) {
  std::mt19937 engine(1);
  const auto in = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine()) / 4294967296.0;
  };
  for (int n = 0; n < 20; ++n) {
    Mesh m;
    for (int i = 0; i < 3; ++i) m.vertices.push_back({in(0, 5), in(0, n % 2 ? 5 : 0.1), in(0, 5)});
    m.triangles = {{0, 1, 2}};
    const SampledSurface surface = sampled(m, 0.3);
    double area = 0;
    for (const SurfaceSample& s : surface.samples) area += s.area_mm2;
    const Vec3 normal = cross(m.vertices[1] - m.vertices[0], m.vertices[2] - m.vertices[0]);
    EXPECT_NEAR(area, 0.5 * norm(normal), 1e-5 * area);
    for (int k = 0; k < 200; ++k) {
      double a = in(0, 1), b = in(0, 1);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      const Point3 p =
          m.vertices[0] + a * (m.vertices[1] - m.vertices[0]) + b * (m.vertices[2] - m.vertices[0]);
      double nearest = 1e9;
      for (const SurfaceSample& s : surface.samples) nearest = std::min(nearest, geom::distance(p, s.p));
      ASSERT_LE(nearest, 0.3 / std::sqrt(2.0));
    }
  }
}

Vec3 leaning(double tilt) {
  return {std::sin(tilt), 0, std::cos(tilt)};
}
/// Where the tip is when the lowest place of the tool is at height `low` over (x, y), the tool leaning
/// towards +x.
Point3 tip_at(const CheckedMill& tool, double tilt, double x, double y, double low) {
  const double flat = tool.radius - tool.corner_radius, r = tool.corner_radius;
  return {x, y, low + r + flat * std::sin(tilt) - r * std::cos(tilt)};
}

TEST(Deviation, BallOverAPlane) {
  const Mesh mesh = plate(8);
  const SampledSurface surface = sampled(mesh, 0.5);
  const double r = 3, step = 1.4;
  for (const double depth : {0.0, 0.05, -0.03}) {
    SCOPED_TRACE(depth);
    auto poses = passes(8, 5, step, -depth);
    const double cusp = r - std::sqrt(r * r - step * step / 4) - depth;
    auto report = measured(mesh, surface, checked({r, r, 30, {}}, poses));
    EXPECT_LE(report.bound_mm, 0.002);
    EXPECT_NEAR(report.gouge.mm, std::max(0.0, depth), report.bound_mm);
    EXPECT_NEAR(report.excess.mm, cusp, report.bound_mm);
    EXPECT_NEAR(report.area_mm2, 64, 1e-3);
    EXPECT_EQ(report.unmachined_area_mm2, 0);
    // One point 0.05 too deep, in the middle of a pass: between the samples, found all the same.
    const std::size_t row = poses.size() / 4 * 2;
    const double y = poses[row].tip.y;
    poses.insert(
        poses.begin() + static_cast<std::ptrdiff_t>(row) + 1,
        {{{3.9, y, -depth}, {0, 0, 1}}, {{4, y, -depth - 0.05}, {0, 0, 1}}, {{4.1, y, -depth}, {0, 0, 1}}});
    report = measured(mesh, surface, checked({r, r, 30, {}}, poses));
    EXPECT_NEAR(report.gouge.mm, std::max(0.0, depth + 0.05), report.bound_mm);
    EXPECT_LE(report.bound_mm, 0.002);
    EXPECT_NEAR(report.gouge.at.x, 4, 0.2);
    EXPECT_NEAR(report.gouge.at.y, y, 0.2);
    EXPECT_TRUE(report.gouge.move == row + 2 || report.gouge.move == row + 3) << report.gouge.move;
  }
}

// Passes along a cylinder about x, and rings round a sphere: cusps between balls that touch in steps of an
// angle.
TEST(Deviation, BallOnCylinderAndSphere) {
  const double big = 20, r = 2, step = 0.04, low = 0.02;
  const double cusp = (big + r - low) * std::cos(step / 2) -
                      std::sqrt(r * r - std::pow((big + r - low) * std::sin(step / 2), 2)) - big;
  const auto up = [&](double a, double b) {
    return Vec3{std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b)};
  };
  for (const bool sphere : {false, true}) {
    SCOPED_TRACE(sphere);
    const Mesh mesh = grid(30, 30, [&](double u, double v) {
      const double a = -0.1 + 0.2 * v;
      if (!sphere) return Point3{2 * u, big * std::sin(a), big * std::cos(a)};
      return Point3{} + big * up(a, 0.5 + 0.2 * u);
    });
    std::vector<Vec3> normals;
    for (const Point3& p : mesh.vertices) normals.push_back(unit(sphere ? p - Point3{} : Vec3{0, p.y, p.z}));
    SampleOptions options;
    options.spacing_mm = 0.3;
    const auto surface = sample_surface(mesh, {}, normals, options);
    ASSERT_TRUE(surface);
    std::vector<cl::Pose> poses;
    for (int i = -12; i <= 12; ++i) {
      if (!sphere) {
        const Vec3 n{0, std::sin(step * i), std::cos(step * i)};
        for (const double x : {-4.0, 6.0})
          poses.push_back({Point3{i % 2 ? 2 - x : x, 0, 0} + (big - low) * n, n});
        continue;
      }
      for (int k = -40; k <= 40; ++k) {
        const Vec3 n = up(0.008 * (i % 2 ? -k : k), 0.6 + step * i);
        poses.push_back({Point3{} + (big - low) * n, n});
      }
    }
    const auto report = measured(mesh, *surface, checked({r, r, 30, {}}, poses));
    // Triangles under the true surface, and chords of the motion on the sphere.
    const double deflection = big * std::pow(0.2 / 30, 2) / 8 * 2 + (sphere ? big * 0.008 * 0.008 / 8 : 0);
    EXPECT_LE(report.bound_mm, 0.002);
    EXPECT_NEAR(report.gouge.mm, low, report.bound_mm + deflection);
    EXPECT_NEAR(report.excess.mm, cusp, report.bound_mm + deflection);
    EXPECT_GT(cusp, 0.02);
  }
}

// Flat and bull ends leaning against the feed: the lowest place of the rim makes the floor.
TEST(Deviation, TiltedEndsOverAPlane) {
  const Mesh mesh = plate(6);
  const SampledSurface surface = sampled(mesh, 0.5);
  for (const double corner : {0.0, 1.5})
    for (const double tilt : {0.05, 0.3}) {
      SCOPED_TRACE(std::to_string(corner) + " " + std::to_string(tilt));
      const CheckedMill tool{8, corner, 30, {}};
      std::vector<cl::Pose> poses;
      const double step = 2, low = tilt < 0.1 ? 0.03 : 0.01;
      bool back = false;
      for (double y = -12; y < 18; y += step, back = !back)
        for (const double x : {-20.0, 26.0})
          poses.push_back({tip_at(tool, tilt, back ? 6 - x : x, y, -low), leaning(tilt)});
      const auto report = measured(mesh, surface, checked(tool, poses));
      EXPECT_LE(report.bound_mm, 0.002);
      EXPECT_NEAR(report.gouge.mm, low, report.bound_mm);
      // Across the pass the rim is an ellipse about the corner's: sin(tilt) (R' - sqrt(R'^2 - (step / 2)^2)),
      // and the corner's circle adds nothing at its lowest place.
      const double flat = 8 - corner;
      if (corner == 0) {
        const double cusp = std::sin(tilt) * (flat - std::sqrt(flat * flat - step * step / 4)) - low;
        EXPECT_NEAR(report.excess.mm, std::max(0.0, cusp), report.bound_mm);
      }
    }
}

bool inside(const CheckedMill& tool, const cl::Pose& pose, Point3 p) {
  const Vec3 d = p - pose.tip;
  const double h = dot(d, pose.axis), rho = norm(d - h * pose.axis), r = tool.corner_radius;
  if (h < 0 || h > tool.length || rho > tool.radius) return false;
  return !(rho > tool.radius - r && h < r && std::hypot(rho - tool.radius + r, h - r) > r);
}

TEST(Deviation, AgreesWithBruteForce) {
  std::mt19937 engine(7);
  const auto in = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine()) / 4294967296.0;
  };
  const Mesh mesh = plate(6);
  const SampledSurface surface = sampled(mesh, 1.2);
  int gouged = 0, standing = 0;
  for (int n = 0; n < 6; ++n) {
    const double radius = in(0.6, 2.5);
    const CheckedMill tool{radius, n % 3 == 0 ? 0 : n % 3 == 1 ? radius / 2 : radius, 6, {}};
    std::vector<cl::Pose> poses;
    for (int i = 0; i < 3; ++i)
      poses.push_back({{in(0, 6), in(0, 6), in(-0.4, 1)}, unit(Vec3{in(-1, 1), in(-1, 1), 1.2})});
    DeviationOptions options;
    options.reach_mm = 1.5;
    const auto report = measured(mesh, surface, checked(tool, poses), options);
    ASSERT_EQ(report.deviation_mm.size(), surface.samples.size());
    constexpr double kFine = 0.01;
    for (std::size_t s = 0; s < surface.samples.size(); ++s) {
      double brute = 9;
      for (std::size_t m = 0; m + 1 < poses.size(); ++m) {
        const double angle = std::acos(dot(poses[m].axis, poses[m + 1].axis));
        for (int k = 0; k <= 150; ++k) {
          const double t = k / 150.0;
          const cl::Pose pose{
              lerp(poses[m].tip, poses[m + 1].tip, t),
              (std::sin((1 - t) * angle) * poses[m].axis + std::sin(t * angle) * poses[m + 1].axis) /
                  std::sin(angle)};
          double h = 0;
          const auto in_tool = [&](double at) {
            return inside(tool, pose, surface.samples[s].p + at * surface.samples[s].n);
          };
          if (in_tool(0)) {
            while (h > -1.5 && in_tool(h - kFine)) h -= kFine;
          } else {
            while (h < std::min(brute, 1.5) && !in_tool(h)) h += kFine;
            if (!in_tool(h)) continue;
          }
          brute = std::min(brute, h);
        }
      }
      const double mm = report.deviation_mm[s];
      if (std::isnan(mm)) {
        EXPECT_GT(brute, 1.5 - 1e-9);
        continue;
      }
      EXPECT_LE(mm, brute + options.resolution_mm + 1e-6);
      // Moments between those tried cut deeper by what a step of time does.
      EXPECT_TRUE(brute >= 1.4 || mm >= brute - 0.12) << mm << " " << brute;
      gouged += mm < -0.05;
      standing += mm > 0.05;
      EXPECT_LE(-mm, report.gouge.mm + 1e-6);
      EXPECT_LE(mm, report.excess.mm + 1e-6);
    }
  }
  EXPECT_GT(gouged, 20);
  EXPECT_GT(standing, 10);
}

TEST(Deviation, ThinWallAndUnmachined) {
  // A wall 1 mm thick, its faces z = 0 (up) and z = -1 (down); cut from below into its lower face.
  Mesh mesh = plate(10);
  const SampledSurface top = sampled(mesh, 0.7);
  const CheckedMill tool{2, 2, 10, {}};
  const std::vector<cl::Pose> below{{{-5, 5, -0.8}, {0, 0, -1}}, {{15, 5, -0.8}, {0, 0, -1}}};
  auto report = measured(mesh, top, checked(tool, below));
  EXPECT_EQ(report.gouge.mm, 0);
  EXPECT_EQ(report.excess.mm, 0);
  EXPECT_NEAR(report.unmachined_area_mm2, 100, 1e-3);
  for (const float mm : report.deviation_mm) EXPECT_TRUE(std::isnan(mm));
  // Through it: as deep as is looked at.
  const std::vector<cl::Pose> through{{{-5, 5, 0.5}, {0, 0, -1}}, {{15, 5, 0.5}, {0, 0, -1}}};
  report = measured(mesh, top, checked(tool, through));
  EXPECT_NEAR(report.gouge.mm, 5, 1e-9);
  // One pass above: a strip as wide as the ball is reached, the rest is not.
  report = measured(mesh, top, checked(tool, {{{-5, 5, 0}, {0, 0, 1}}, {{15, 5, 0}, {0, 0, 1}}}));
  EXPECT_NEAR(report.unmachined_area_mm2, 60, 6);
  EXPECT_EQ(report.gouge.mm, 0);
  EXPECT_LE(report.excess.mm, 2 + 1e-6);
  // A holder over it machines nothing, but may gouge; what must not be machined is not missed.
  CheckedMill held = tool;
  held.cylinders = {{4, 10, 20, true}};
  report = measured(mesh, top, checked(held, {{{5, 5, -10.2}, {0, 0, 1}}, {{5, 5, -10.2}, {0, 0, 1}}}));
  EXPECT_NEAR(report.gouge.mm, 0.2, report.bound_mm);
  report = measured(mesh, top, checked(held, {{{5, 5, -9.9}, {0, 0, 1}}, {{5, 5, -9.9}, {0, 0, 1}}}));
  EXPECT_GT(report.unmachined_area_mm2, 80);
  const auto kept = sample_surface(mesh, {false, false}, {}, {.spacing_mm = 0.7});
  ASSERT_TRUE(kept);
  report = measured(mesh, *kept, checked(tool, below));
  EXPECT_EQ(report.unmachined_area_mm2, 0);
  EXPECT_EQ(report.area_mm2, 0);
  // No motion at all.
  report = measured(mesh, top, {});
  EXPECT_NEAR(report.unmachined_area_mm2, 100, 1e-3);
}

TEST(Deviation, SameForAnyNumberOfThreads) {
  const Mesh mesh = grid(12, 12, [](double u, double v) {
    return Point3{8 * u, 8 * v, 0.3 * std::sin(3 * u + 2 * v)};
  });
  const SampledSurface surface = sampled(mesh, 0.4);
  std::vector<cl::Pose> poses = passes(8, 3, 0.9, 0.1, unit(Vec3{0.1, 0.05, 1}));
  for (std::size_t i = 0; i < poses.size(); ++i)
    poses[i].axis = unit(Vec3{0.1 * std::sin(double(i)), 0.1, 1});
  const CheckedPath path = checked({4, 1, 20, {{6, 20, 40, true}}}, poses);
  const auto one = measured(mesh, surface, path, {.threads = 1});
  EXPECT_GT(one.gouge.mm, 0.01);
  EXPECT_GT(one.excess.mm, 0.01);
  for (const unsigned threads : {2U, 5U}) {
    const auto other = measured(mesh, surface, path, {.threads = threads});
    EXPECT_EQ(one.deviation_mm, other.deviation_mm);
    EXPECT_EQ(one.gouge.mm, other.gouge.mm);
    EXPECT_EQ(one.gouge.at, other.gouge.at);
    EXPECT_EQ(one.excess.mm, other.excess.mm);
    EXPECT_EQ(one.excess.at, other.excess.at);
    EXPECT_EQ(one.bound_mm, other.bound_mm);
  }
}

TEST(Deviation, BadInputIsAnError) {
  const Mesh mesh = plate(10);
  const double nan = std::nan("");
  const auto sample = [&](const Mesh& m, SampleOptions options) {
    return sample_surface(m, {}, {}, options);
  };
  for (const double spacing : {0.0, -1.0, nan, 1e-9, 1e-200})
    EXPECT_FALSE(sample(mesh, {.spacing_mm = spacing})) << spacing;
  const auto many = sample(mesh, {.spacing_mm = 1e-4});
  ASSERT_FALSE(many);
  EXPECT_EQ(many.error().code, ErrorCode::range);
  EXPECT_NE(many.error().message.find("would do"), std::string::npos);
  EXPECT_FALSE(sample(mesh, {.count = 0}));
  EXPECT_FALSE(sample(mesh, {.count = 1'000'000'000'000}));
  EXPECT_FALSE(sample(mesh, {.least_radius_mm = 0}));
  EXPECT_FALSE(sample(mesh, {.max_samples = 1}));
  EXPECT_FALSE(sample({}, {}));
  Mesh bad = mesh;
  bad.vertices[1].x = nan;
  EXPECT_FALSE(sample(bad, {}));
  bad = mesh;
  bad.triangles[0][0] = 99;
  EXPECT_FALSE(sample(bad, {}));
  EXPECT_FALSE(sample_surface(mesh, {true}, {}, {}));
  EXPECT_FALSE(sample_surface(mesh, {}, {{0, 0, 1}}, {}));
  const auto counted = sample(mesh, {.count = 5000});
  ASSERT_TRUE(counted);
  EXPECT_GT(counted->samples.size(), 2500U);
  EXPECT_LT(counted->samples.size(), 10000U);

  const SampledSurface surface = sampled(mesh, 2);
  const CheckedMill tool{2, 0, 10, {}};
  const CheckedPath good = checked(tool, {{{0, 0, 1}, {0, 0, 1}}, {{5, 0, 1}, {0, 0, 1}}});
  EXPECT_TRUE(measure_deviation(mesh, surface, good, {}));
  EXPECT_FALSE(measure_deviation(mesh, surface, good, {.reach_mm = 0}));
  EXPECT_FALSE(measure_deviation(mesh, surface, good, {.resolution_mm = nan}));
  CheckedPath path = good;
  path.tools[0].pieces[0].to.tip.x = nan;
  EXPECT_FALSE(measure_deviation(mesh, surface, path, {}));
  path = good;
  path.tools[0].pieces[0].to.axis = {0, 0, -1};
  EXPECT_FALSE(measure_deviation(mesh, surface, path, {}));
  path = good;
  path.tools[0].tool.radius = 0;
  EXPECT_FALSE(measure_deviation(mesh, surface, path, {}));
  path = good;
  path.moves.clear();
  EXPECT_FALSE(measure_deviation(mesh, surface, path, {}));
  SampledSurface strange = surface;
  strange.cells.pop_back();
  EXPECT_FALSE(measure_deviation(mesh, strange, good, {}));
}

TEST(Deviation, HistogramHoldsTheWholeArea) {
  const Mesh mesh = plate(8);
  const SampledSurface surface = sampled(mesh, 0.6);
  const auto report = measured(mesh, surface, checked({3, 3, 30, {}}, passes(8, 5, 1.4, -0.01)));
  const Histogram h = histogram(surface, report, 20);
  ASSERT_EQ(h.area_mm2.size(), 20U);
  double area = 0;
  for (const double a : h.area_mm2) area += a;
  EXPECT_NEAR(area, 64, 1e-3);
  EXPECT_NEAR(h.from_mm + 10 * h.step_mm, 0, 1e-12);
  EXPECT_TRUE(histogram(surface, report, 0).area_mm2.empty());
}

}  // namespace
}  // namespace burin::verify
