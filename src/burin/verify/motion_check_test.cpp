// SPDX-License-Identifier: Apache-2.0
// Closed forms within the bound, and planted faults found where they are.
#include "burin/verify/motion_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace burin::verify {
namespace {

using geom::Mesh;
using geom::Point3;
using kinematics::Joints;

kinematics::Kinematics preset(const std::string& name) {
  return *kinematics::Kinematics::make(*model::find_machine(name));
}

/// z = 0 over [0, size]^2.
Mesh plate(double size) {
  Mesh m;
  m.vertices = {{0, 0, 0}, {size, 0, 0}, {size, size, 0}, {0, size, 0}};
  m.triangles = {{0, 1, 2}, {0, 2, 3}};
  return m;
}

/// Cylinder about X, radius r, x from 0 to length, n facets whose corners lie on it.
Mesh shaft(double r, double length, int n) {
  Mesh m;
  for (int i = 0; i < n; ++i)
    for (const double x : {0.0, length}) {
      const double a = 2 * geom::kPi * i / n;
      m.vertices.push_back({x, r * std::cos(a), r * std::sin(a)});
    }
  for (int i = 0; i < n; ++i) {
    const auto a = static_cast<std::uint32_t>(2 * i), b = static_cast<std::uint32_t>(2 * ((i + 1) % n));
    m.triangles.push_back({a, b, b + 1});
    m.triangles.push_back({a, b + 1, a + 1});
  }
  return m;
}

CheckedMove move(double x, double y, double z, double a_deg = 0, bool cutting = true) {
  Joints j;
  j.linear = {x, y, z};
  j.rotary[0] = geom::radians(a_deg);
  return {j, cutting};
}

TEST(MotionCheck, SamplesLeaveNoPlaceAlone) {
  std::mt19937 engine(1);
  const auto in = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine()) / 4294967296.0;
  };
  for (int n = 0; n < 20; ++n) {
    Mesh m;
    for (int i = 0; i < 3; ++i) m.vertices.push_back({in(0, 5), in(0, 5), in(0, 5)});
    m.triangles = {{0, 1, 2}};
    const SampledDesign design = sample_mesh(m, {}, 0.3);
    for (int k = 0; k < 200; ++k) {
      double a = in(0, 1), b = in(0, 1);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      const Point3 p =
          m.vertices[0] + a * (m.vertices[1] - m.vertices[0]) + b * (m.vertices[2] - m.vertices[0]);
      double nearest = 1e9;
      for (const DesignSample& s : design.samples) nearest = std::min(nearest, geom::distance(p, s.p));
      ASSERT_LE(nearest, 0.3 / std::sqrt(2.0));
    }
  }
  EXPECT_GT(sample_mesh(plate(100), {}, 0.01, 10000).spacing_mm, 0.9);
}

// Ball over a plane in parallel passes: gouge and cusp have closed forms.
TEST(MotionCheck, BallOverAPlane) {
  const auto machine = preset("xyz");
  const SampledDesign design = sample_mesh(plate(20), {}, 0.1);
  const double r = 3, step = 1.4;
  for (const double depth : {0.0, 0.05}) {
    std::vector<CheckedMove> moves{move(-5, -5, 30, 0, false)};
    bool back = false;
    for (double y = -1; y < 22; y += step, back = !back) {
      const double x0 = back ? 25 : -5, x1 = back ? -5 : 25;
      moves.push_back(move(x0, y, 10, 0, false));
      moves.push_back(move(x0, y, -depth));
      moves.push_back(move(x1, y, -depth));
      moves.push_back(move(x1, y, 10, 0, false));
    }
    const auto report = check_motion(design, moves, machine, {r, {}}, {});
    EXPECT_NEAR(report.ball.mm, depth, report.bound_mm);
    const double cusp = r - std::sqrt(r * r - step * step / 4) - depth;
    EXPECT_NEAR(report.excess_max_mm, cusp, report.bound_mm + 0.01 * step);
    EXPECT_LE(report.excess_max_mm, cusp + 1e-6);
    EXPECT_EQ(report.shank.mm, 0);
  }
}

// Round a shaft with the table turning: one pass, the true way is a circle though only two poses are given.
TEST(MotionCheck, BallRoundAShaft) {
  const auto machine = preset("xyza");
  const double radius = 15, r = 2;
  const Mesh mesh = shaft(radius, 10, 720);
  const SampledDesign design = sample_mesh(mesh, {}, 0.1);
  const double deflection = radius * (1 - std::cos(geom::kPi / 720));
  std::vector<CheckedMove> moves{move(5, 0, radius + 20, 0, false), move(5, 0, radius + 0.02)};
  moves.push_back(move(5, 0, radius + 0.02, 180));
  moves.push_back(move(5, 0, radius - 0.08, 200));
  moves.push_back(move(5, 0, radius - 0.08, 360));
  BallEndTool tool{r, {{r, 0, 60, false}, {20, 60, 90, true}}};
  MotionCheckOptions options;
  const auto report = check_motion(design, moves, machine, tool, options);
  EXPECT_NEAR(report.ball.mm, 0.08, report.bound_mm + deflection);
  EXPECT_GE(report.ball.move, 3u);
  EXPECT_EQ(report.shank.mm, 0);
  EXPECT_EQ(report.holder.mm, 0);
  // The ends of the shaft are 5 mm from the ball's plane.
  EXPECT_NEAR(report.excess_max_mm, std::hypot(r + 0.02, 5.0) - r, 0.3);
}

TEST(MotionCheck, FindsShankAndHolderAndRapids) {
  const auto machine = preset("xyza");
  const Mesh mesh = shaft(15, 30, 360);
  const SampledDesign design = sample_mesh(mesh, {}, 0.2);
  BallEndTool tool{2, {{2, 0, 20, false}, {12, 20, 60, true}}};
  // The tool beside the shaft, upright: its shank 0.3 mm into the side.
  auto report = check_motion(design, {move(15, 16.7, 40, 0, false), move(15, 16.7, -10)}, machine, tool, {});
  EXPECT_NEAR(report.shank.mm, 0.3, report.bound_mm + 0.01);
  EXPECT_NEAR(report.shank.at.y, 14.7, 0.5);
  // Farther out the shank is clear and the holder is not.
  report = check_motion(design, {move(15, 20, 40, 0, false), move(15, 20, -25)}, machine, tool, {});
  EXPECT_EQ(report.shank.mm, 0);
  EXPECT_GT(report.holder.mm, 1);
  // A rapid straight through the part.
  report = check_motion(design, {move(5, -30, 5, 0, false), move(5, 30, 5, 0, false)}, machine, {2, {}}, {});
  EXPECT_GT(report.ball.mm, 1.9);
  EXPECT_EQ(report.ball.move, 1u);
  // Clear is clear.
  report = check_motion(design, {move(0, 0, 40, 0, false), move(30, 0, 18, 700, false)}, machine, tool, {});
  EXPECT_EQ(report.gouge_max_mm(), 0);
}

// The grid and the windows change nothing: brute force over all samples and dense moments.
TEST(MotionCheck, AgreesWithBruteForce) {
  const auto machine = preset("xyza");
  std::mt19937 engine(4);
  const auto in = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine()) / 4294967296.0;
  };
  const SampledDesign design = sample_mesh(shaft(10, 20, 40), {}, 0.8);
  const double r = 2.5;
  for (int n = 0; n < 3; ++n) {
    std::vector<CheckedMove> moves{move(in(0, 20), in(-5, 5), 20, 0)};
    for (int i = 0; i < 5; ++i) moves.push_back(move(in(0, 20), in(-3, 3), in(9, 13), in(-200, 200)));
    const auto report = check_motion(design, moves, machine, {r, {}}, {.motion_mm = 1e-4});
    std::vector<Point3> centers;
    for (std::size_t m = 1; m < moves.size(); ++m) {
      for (int k = 0; k <= 2000; ++k) {
        Joints j;
        const double t = k / 2000.0;
        for (std::size_t i = 0; i < 3; ++i)
          j.linear[i] = moves[m - 1].to.linear[i] + t * (moves[m].to.linear[i] - moves[m - 1].to.linear[i]);
        j.rotary[0] = moves[m - 1].to.rotary[0] + t * (moves[m].to.rotary[0] - moves[m - 1].to.rotary[0]);
        const cl::Pose pose = machine.forward(j);
        centers.push_back(pose.tip + r * pose.axis);
      }
    }
    for (std::size_t s = 0; s < design.samples.size(); s += 7) {
      double nearest = 1e9;
      for (const Point3& c : centers) nearest = std::min(nearest, geom::distance(c, design.samples[s].p) - r);
      ASSERT_NEAR(report.deviation_mm[s], std::min(nearest, 20.0), 2e-3 + 0.01 * std::abs(nearest)) << s;
    }
  }
}

}  // namespace
}  // namespace burin::verify
