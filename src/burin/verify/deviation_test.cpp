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

TEST(Deviation, BallOverAPlane) {
  const Mesh mesh = plate(20);
  const SampledSurface surface = sampled(mesh, 0.2);
  const double r = 3, step = 1.4;
  for (const double depth : {0.0, 0.05, -0.03}) {
    const auto report = measured(mesh, surface, checked({r, r, 30, {}}, passes(20, 5, step, -depth)));
    const double cusp = r - std::sqrt(r * r - step * step / 4) - depth;
    EXPECT_NEAR(report.gouge.mm, std::max(0.0, depth), report.bound_mm);
    EXPECT_NEAR(report.excess.mm, std::max(0.0, cusp), report.bound_mm);
    EXPECT_NEAR(report.area_mm2, 400, 0.01);
    EXPECT_EQ(report.unmachined_area_mm2, 0);
  }
}

}  // namespace
}  // namespace burin::verify
