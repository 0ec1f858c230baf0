// SPDX-License-Identifier: Apache-2.0
// Closed forms, brute force, and planted faults found where they are.
#include "burin/verify/mill_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "burin/verify/mill_cases.h"

namespace burin::verify {
namespace {

using geom::Mesh;
using geom::Point3;
using geom::Vec3;

Mesh plate(double size) {
  Mesh m;
  m.vertices = {{-size, -size, 0}, {size, -size, 0}, {size, size, 0}, {-size, size, 0}};
  m.triangles = {{0, 1, 2}, {0, 2, 3}};
  return m;
}

using cases::grid;
using cases::path_of;
using Poses = std::vector<cl::Pose>;

/// Leaning by `tilt` from +z towards +x: the lowest place of the bottom is on the side of -x... of the rim at
/// +x for a lean back.
Vec3 leaning(double tilt) {
  return {std::sin(tilt), 0, std::cos(tilt)};
}
/// The tip so that the lowest place of a mill that leans towards +x is at height z. It is on the side of +x.
Point3 tip_at(const CheckedMill& tool, double tilt, double x, double y, double z) {
  const double flat = tool.radius - tool.corner_radius, r = tool.corner_radius;
  return {x, y, z + r + flat * std::sin(tilt) - r * std::cos(tilt)};
}

MillCheckReport checked(const Mesh& mesh, const CheckedPath& path, const MillCheckOptions& options = {}) {
  const auto report = check_mill(mesh, path, options);
  if (!report) {
    ADD_FAILURE() << report.error().message;
    return {};
  }
  return *report;
}

MillCheckReport checked(const Mesh& mesh, const CheckedMill& tool, const Poses& poses,
                        const MillCheckOptions& options = {}) {
  return checked(mesh, path_of(tool, poses), options);
}

TEST(MillCheck, TiltedEndsOverAPlane) {
  const Mesh mesh = plate(500);
  for (const double tilt : {0.0, geom::radians(1.5), geom::radians(10.0), geom::radians(45.0)})
    for (const double corner : {0.0, 6.0, 125.0})
      for (const double depth : {-0.05, 0.0, 0.05, 2.0}) {
        SCOPED_TRACE(std::to_string(tilt) + " " + std::to_string(corner) + " " + std::to_string(depth));
        const CheckedMill tool{125, corner, 200, {}};
        const auto at = [&](double x) { return cl::Pose{tip_at(tool, tilt, x, 0, -depth), leaning(tilt)}; };
        // A sharp rim: deepest where bottom and side are equally near.
        double want = depth;
        if (corner == 0) want /= std::sin(tilt) + std::cos(tilt);
        for (const Poses& motion : {Poses{at(0), at(0)}, Poses{at(-40), at(90)}}) {
          const MillCheckReport report = checked(mesh, tool, motion);
          EXPECT_NEAR(report.cutter.mm, std::max(0.0, want), report.bound_mm + 1e-9);
          EXPECT_LE(report.cutter.mm, std::max(0.0, want) + 1e-9);
          EXPECT_EQ(report.bound_mm, 0.001);
        }
      }
}

TEST(MillCheck, AxisTurnsEvenlyAlongTheGreatCircle) {
  const CheckedMill tool{50, 0, 60, {}};
  const double a = geom::radians(8.0);
  // The tip stands still above the plane; in the middle of the turn the rim is highest, at the ends lowest.
  const double height = 50 * std::sin(a) - 0.04;
  const auto report =
      checked(plate(200), tool, Poses{{{0, 0, height}, leaning(a)}, {{0, 0, height}, leaning(-a)}});
  EXPECT_NEAR(report.cutter.mm, 0.04 / (std::sin(a) + std::cos(a)), report.bound_mm);
  EXPECT_NEAR(std::abs(report.cutter.at.x), 50 * std::cos(a), 1);
  // Over the pole from one lean to another one square to it, both just clear: the chord of the circle is
  // tilted less, and clear.
  const Vec3 side{0, std::sin(a), std::cos(a)};
  const auto clear = checked(plate(200), tool,
                             Poses{{{0, 0, 50 * std::sin(a)}, leaning(a)}, {{0, 0, 50 * std::sin(a)}, side}});
  EXPECT_LE(clear.cutter.mm, 1e-9);
}

TEST(MillCheck, BallOnSphereAndCylinder) {
  const double big = 80;
  const Mesh ball = grid(300, 200, [&](double u, double v) {
    const double a = 0.6 * (u - 0.5), b = 0.6 * (v - 0.5);
    return Point3{big * std::sin(a) * std::cos(b), big * std::sin(b), big * std::cos(a) * std::cos(b)};
  });
  const double deflection = big * 0.6 * 0.6 / (8 * 200 * 200) * 2;
  const CheckedMill tool{8, 8, 30, {}};
  for (const double depth : {0.05, 0.3}) {
    // Any lean of a ball does the same: centre over the top.
    const Vec3 axis = unit(Vec3{0.3, -0.2, 1});
    const Point3 tip = Point3{0, 0, big + 8 - depth} - 8 * axis;
    const auto report = checked(ball, tool, Poses{{{0, 0, 200}, axis}, {tip, axis}});
    EXPECT_LE(report.cutter.mm, depth + 1e-9);
    EXPECT_GE(report.cutter.mm, depth - report.bound_mm - deflection);
    EXPECT_LT(std::hypot(report.cutter.at.x, report.cutter.at.y), 0.5);
  }
  // Inside a cylinder about x of radius 200, a flat end upright, cutting along x: its rim cuts in on both
  // sides.
  const double inside = 200, r = 20;
  const Mesh trough = grid(4, 1500, [&](double u, double v) {
    const double a = 0.4 * (v - 0.5);
    return Point3{-100 + 200 * u, inside * std::sin(a), inside * (1 - std::cos(a))};
  });
  const double rise = inside - std::sqrt(inside * inside - r * r);
  const auto clear =
      checked(trough, {r, 0, 60, {}}, Poses{{{-30, 0, rise}, {0, 0, 1}}, {{30, 0, rise}, {0, 0, 1}}});
  EXPECT_LE(clear.cutter.mm, inside * 0.4 * 0.4 / (8 * 1500 * 1500.0) + 1e-9);
  const auto cut = checked(trough, {r, 0, 60, {}},
                           Poses{{{-30, 0, rise - 0.05}, {0, 0, 1}}, {{30, 0, rise - 0.05}, {0, 0, 1}}});
  // As deep as where the distances to bottom and side agree on a line of that slope.
  const double slope = std::asin(r / inside);
  EXPECT_NEAR(cut.cutter.mm, 0.05 * std::cos(slope) / (std::sin(slope) + std::cos(slope)),
              cut.bound_mm + 1e-4);
}

TEST(MillCheck, FindsPlantedFaults) {
  const Mesh mesh = plate(400);
  const double tilt = geom::radians(5.0);
  CheckedMill tool{60, 4, 50, {}};
  Poses motion;
  for (int i = 0; i <= 100; ++i) motion.push_back({tip_at(tool, tilt, -200 + 4 * i, 0, 0), leaning(tilt)});
  EXPECT_LE(checked(mesh, tool, motion).cutter.mm, 1e-9);
  // One point 0.05 too deep.
  Poses deep = motion;
  deep[37].tip.z -= 0.05;
  auto report = checked(mesh, tool, deep);
  EXPECT_NEAR(report.cutter.mm, 0.05, report.bound_mm);
  EXPECT_TRUE(report.cutter.move == 37 || report.cutter.move == 38);
  // The program of another radius: the rim stands lower by the difference times the sine.
  CheckedMill larger = tool;
  larger.radius += 1;
  report = checked(mesh, larger, motion);
  EXPECT_NEAR(report.cutter.mm, std::sin(tilt), report.bound_mm);
  // One axis leaning a degree more.
  Poses wrong = motion;
  wrong[70].axis = leaning(tilt + geom::radians(1.0));
  report = checked(mesh, tool, wrong);
  const Point3 needed = tip_at(tool, tilt + geom::radians(1.0), 0, 0, 0);
  EXPECT_NEAR(report.cutter.mm, needed.z - motion[70].tip.z, report.bound_mm);
  EXPECT_TRUE(report.cutter.move == 70 || report.cutter.move == 71);
}

TEST(MillCheck, ShankAndHolder) {
  // A wall x = 0 to the left of an upright tool.
  const Mesh wall = grid(1, 1, [](double u, double v) { return Point3{0, -100 + 200 * u, 300 * v}; });
  CheckedMill tool{10, 0, 40, {{12, 40, 90, false}, {30, 90, 150, true}}};
  const auto at = [](double x) { return Poses{{{x, 0, 500}, {0, 0, 1}}, {{x, 0, 10}, {0, 0, 1}}}; };
  auto report = checked(wall, tool, at(30));
  EXPECT_EQ(report.gouge_max_mm(), 0);
  report = checked(wall, tool, at(29.5));
  EXPECT_EQ(report.cutter.mm, 0);
  EXPECT_EQ(report.shank.mm, 0);
  EXPECT_NEAR(report.holder.mm, 0.5, report.bound_mm);
  EXPECT_GE(report.holder.at.z, 100 - 0.1);
  report = checked(wall, tool, at(11.8));
  EXPECT_EQ(report.cutter.mm, 0);
  EXPECT_NEAR(report.shank.mm, 0.2, report.bound_mm);
  EXPECT_NEAR(report.gouge_max_mm(), 18.2, report.bound_mm);
}

/// Distance to the outline of a piece in (distance from the axis, height), from inside, by trying places of
/// the outline.
double depth_by_trial(const CheckedMill& tool, double rho, double h) {
  const double R = tool.radius, r = tool.corner_radius;
  double nearest = 1e9;
  const auto to = [&](double x, double y) { nearest = std::min(nearest, std::hypot(rho - x, h - y)); };
  constexpr int kPlaces = 400;
  for (int i = 0; i <= kPlaces; ++i) {
    const double s = double(i) / kPlaces, a = s * geom::kPi / 2;
    to(s * (R - r), 0);
    to(R - r + r * std::sin(a), r - r * std::cos(a));
    to(R, r + s * (tool.length - r));
    to(s * R, tool.length);
  }
  const bool inside =
      rho < R && h > 0 && h < tool.length && !(rho > R - r && h < r && std::hypot(rho - R + r, h - r) > r);
  return inside ? nearest : 0;
}

// Random triangles, random moves: dense places at dense moments, the depth by trial.
TEST(MillCheck, AgreesWithBruteForce) {
  std::mt19937 engine(3);
  const auto in = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine()) / 4294967296.0;
  };
  int deep = 0;
  for (int n = 0; n < 40; ++n) {
    SCOPED_TRACE(n);
    Mesh m;
    for (std::uint32_t t = 0; t < 6; ++t) {
      const Point3 p{in(-20, 20), in(-20, 20), in(-20, 20)};
      for (int i = 0; i < 3; ++i) m.vertices.push_back(p + Vec3{in(-3, 3), in(-3, 3), in(-3, 3)});
      m.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    const double radius = in(3, 12);
    const CheckedMill tool{radius, n % 3 == 0 ? 0 : n % 3 == 1 ? in(0, radius) : radius, in(12, 20), {}};
    const auto pose = [&] {
      return cl::Pose{{in(-15, 15), in(-15, 15), in(-15, 15)}, unit(Vec3{in(-1, 1), in(-1, 1), in(-1, 1)})};
    };
    const Poses motion{pose(), pose()};
    const MillCheckReport report = checked(m, tool, motion);
    double brute = 0;
    const double angle = std::acos(std::clamp(dot(motion[0].axis, motion[1].axis), -1.0, 1.0));
    for (int k = 0; k <= 60; ++k) {
      const double t = k / 60.0;
      const Point3 tip = lerp(motion[0].tip, motion[1].tip, t);
      const Vec3 axis = (std::sin((1 - t) * angle) * motion[0].axis + std::sin(t * angle) * motion[1].axis) /
                        std::sin(angle);
      for (const auto& tri : m.triangles)
        for (int i = 0; i <= 8; ++i)
          for (int j = 0; i + j <= 8; ++j) {
            const Point3 a = m.vertices[tri[0]];
            const Vec3 d =
                a + (i / 8.0) * (m.vertices[tri[1]] - a) + (j / 8.0) * (m.vertices[tri[2]] - a) - tip;
            const double h = dot(d, axis), rho = norm(d - h * axis);
            if (std::min({h, tool.length - h, tool.radius - rho}) > brute)
              brute = std::max(brute, depth_by_trial(tool, rho, h));
          }
    }
    // Trial places are up to 0.03 mm apart from the nearest one.
    EXPECT_GE(report.cutter.mm, brute - report.bound_mm - 0.03);
    // Half a step of time and of place.
    EXPECT_LE(report.cutter.mm, brute + 1.3);
    deep += brute > 0.5;
  }
  EXPECT_GT(deep, 15);
}

// A machine's joint moves: the same as many short poses on them.
TEST(MillCheck, JointMovesAreFollowed) {
  const auto machine = *kinematics::Kinematics::make(*model::find_machine("xyzac-trunnion"));
  const Mesh mesh = grid(40, 40, [](double u, double v) {
    return Point3{-40 + 80 * u, -40 + 80 * v, 5 * std::sin(4 * u) * std::cos(3 * v)};
  });
  CheckedMill tool{20, 3, 40, {{35, 40, 90, true}}};
  cl::Program program;
  std::vector<kinematics::Joints> joints;
  Poses poses;
  std::mt19937 engine(8);
  const auto in = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine()) / 4294967296.0;
  };
  kinematics::Joints near;
  for (int i = 0; i < 8; ++i) {
    const double tilt = in(0.05, 0.4), round = in(-3, 3);
    const cl::Pose pose{{in(-30, 30), in(-30, 30), in(8, 12)},
                        {std::sin(tilt) * std::cos(round), std::sin(tilt) * std::sin(round), std::cos(tilt)}};
    const auto j = machine.inverse(pose, near);
    ASSERT_TRUE(j);
    if (i > 0) {
      constexpr int kDense = 3000;
      for (int k = 1; k <= kDense; ++k) {
        kinematics::Joints b;
        for (std::size_t a = 0; a < 3; ++a)
          b.linear[a] = near.linear[a] + (j->linear[a] - near.linear[a]) * k / kDense;
        for (std::size_t a = 0; a < 2; ++a)
          b.rotary[a] = near.rotary[a] + (j->rotary[a] - near.rotary[a]) * k / kDense;
        poses.push_back(machine.forward(b));
      }
    } else {
      poses.push_back(machine.forward(*j));
    }
    near = *j;
    joints.push_back(*j);
    program.add(cl::Feed{pose});
  }
  const auto path =
      make_checked_path(program, joints, {}, machine, [&](const cl::ToolChange&) { return tool; }, {});
  ASSERT_TRUE(path) << path.error().message;
  const MillCheckReport by_joints = checked(mesh, *path), by_poses = checked(mesh, tool, poses);
  EXPECT_LE(by_joints.bound_mm, 0.0015);
  EXPECT_GT(by_poses.cutter.mm, 1);
  EXPECT_NEAR(by_joints.cutter.mm, by_poses.cutter.mm, by_joints.bound_mm + by_poses.bound_mm);
  EXPECT_NEAR(by_joints.holder.mm, by_poses.holder.mm, by_joints.bound_mm + by_poses.bound_mm);
  EXPECT_EQ(by_joints.cutter.move, 1 + (by_poses.cutter.move - 1) / 3000);
}

TEST(MillCheck, SameForAnyNumberOfThreads) {
  const Mesh mesh = grid(60, 60, [](double u, double v) {
    return Point3{200 * u, 200 * v, 8 * std::sin(5 * u + 3 * v)};
  });
  Poses motion;
  for (int i = 0; i <= 300; ++i)
    motion.push_back({{200.0 * i / 300, 100, 7 + std::sin(0.1 * i)}, leaning(0.1)});
  const CheckedMill tool{30, 2, 40, {{20, 40, 100, true}}};
  const auto one = checked(mesh, tool, motion), three = checked(mesh, tool, motion, {.threads = 3});
  EXPECT_GT(one.cutter.mm, 0.1);
  EXPECT_EQ(one.cutter.mm, three.cutter.mm);
  EXPECT_EQ(one.cutter.at, three.cutter.at);
  EXPECT_EQ(one.cutter.move, three.cutter.move);
  EXPECT_EQ(one.evaluations, three.evaluations);
}

TEST(MillCheck, BadInputIsAnError) {
  const Mesh mesh = plate(10);
  const CheckedMill tool{5, 1, 20, {}};
  const Poses still{{{0, 0, 5}, {0, 0, 1}}, {{0, 0, 5}, {0, 0, 1}}};
  const double nan = std::nan("");
  EXPECT_FALSE(check_mill(mesh, path_of({0, 0, 20, {}}, still)));
  EXPECT_FALSE(check_mill(mesh, path_of({5, 6, 20, {}}, still)));
  EXPECT_FALSE(check_mill(mesh, path_of({5, 0, 0, {}}, still)));
  EXPECT_FALSE(check_mill(mesh, path_of({5, 0, 20, {{5, 30, 20, true}}}, still)));
  EXPECT_FALSE(check_mill(mesh, path_of(tool, still), {.resolution_mm = 0}));
  EXPECT_FALSE(check_mill(mesh, path_of(tool, Poses{{{0, 0, nan}, {0, 0, 1}}})));
  EXPECT_FALSE(check_mill(mesh, path_of(tool, Poses{{{0, 0, 0}, {0, 0, 2}}})));
  const auto half = check_mill(mesh, path_of(tool, Poses{{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, -1}}}));
  ASSERT_FALSE(half);
  EXPECT_NE(half.error().message.find("move 1"), std::string::npos);
  Mesh broken = mesh;
  broken.triangles.push_back({0, 1, 9});
  EXPECT_FALSE(check_mill(broken, path_of(tool, still)));
  EXPECT_TRUE(check_mill({}, path_of(tool, still)));
  EXPECT_TRUE(check_mill(mesh, path_of(tool, Poses{})));
}

}  // namespace
}  // namespace burin::verify
