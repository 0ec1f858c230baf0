// SPDX-License-Identifier: Apache-2.0
// What the check says of a program by poses and by joints, with planted faults.
#include "burin/job/orient_check.h"

#include <gtest/gtest.h>

#include <cmath>

namespace burin::job {
namespace {

using geom::Point3;
using geom::Vec3;

/// A plate, and a wall beside it as an obstacle.
orient::Part plate_and_wall() {
  orient::Part part;
  part.mesh.vertices = {{-50, -50, 0},  {50, -50, 0},  {50, 50, 0},  {-50, 50, 0},
                        {-50, 60, -50}, {50, 60, -50}, {50, 60, 90}, {-50, 60, 90}};
  part.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
  part.design_triangles = 2;
  part.deflection_mm = 0.002;
  return part;
}
const model::Mill kMill{model::MillKind::bull, 20, 2, 30, {{15, 20}, {40, 60}}};

/// Along x at y, `deep` below the plate in the middle; leaning back by 0.1.
cl::Program program(double y, double deep) {
  cl::Program p;
  const Vec3 axis{std::sin(0.1), 0, std::cos(0.1)};
  const auto at = [&](double x, double z) {
    return cl::Pose{{x, y, z + 2 + 18 * std::sin(0.1) - 2 * std::cos(0.1)}, axis};
  };
  p.add(cl::Comment{"plate"});
  p.add(cl::Rapid{at(-40, 30)});
  p.add(cl::FeedRate{500});
  p.add(cl::Feed{at(-40, 0)});
  p.add(cl::Feed{at(0, -deep)});
  p.add(cl::Feed{at(40, 0)});
  p.add(cl::Rapid{at(40, 30)});
  return p;
}

TEST(OrientCheck, ByPosesAndByJoints) {
  const orient::Part part = plate_and_wall();
  const auto machine = *kinematics::Kinematics::make(*model::find_machine("xyzac-trunnion"));
  for (const double deep : {0.0, 0.05}) {
    const cl::Program p = program(0, deep);
    const auto by_poses = check_orient_job(part, kMill, p);
    ASSERT_TRUE(by_poses) << by_poses.error().message;
    EXPECT_NEAR(by_poses->cutter.mm, deep, 0.001);
    EXPECT_NEAR(by_poses->bound_mm, 0.003, 1e-12);
    EXPECT_EQ(by_poses->moves, 5u);
    if (deep > 0) {
      EXPECT_TRUE(by_poses->cutter.move == 4 || by_poses->cutter.move == 5);
      EXPECT_LT(by_poses->cutter.triangle, part.design_triangles);
    }
    EXPECT_EQ(by_poses->holder.mm, 0);
    const auto path = kinematics::make_joint_path(machine, p, {.tolerance_mm = 0.002});
    ASSERT_TRUE(path) << path.error().message;
    const auto by_joints = check_orient_job(part, kMill, machine, *path);
    ASSERT_TRUE(by_joints) << by_joints.error().message;
    EXPECT_NEAR(by_joints->cutter.mm, deep, 0.004);
    EXPECT_EQ(by_joints->holder.mm, 0);
  }
}

TEST(OrientCheck, HolderAndObstacle) {
  const orient::Part part = plate_and_wall();
  // The wall is at y = 60, the upper piece of the holder reaches 40 to the side.
  const auto report = check_orient_job(part, kMill, program(20.5, 0));
  ASSERT_TRUE(report);
  EXPECT_NEAR(report->holder.mm, 0.5, 0.002);
  EXPECT_GE(report->holder.triangle, part.design_triangles);
  EXPECT_NEAR(report->gouge_max_mm(), 0.5, 0.002);
  EXPECT_EQ(check_orient_job(part, kMill, program(19.9, 0))->holder.mm, 0);
}

TEST(OrientCheck, BadInputIsAnError) {
  const orient::Part part = plate_and_wall();
  cl::Program p = program(0, 0);
  model::Mill mill = kMill;
  mill.length = 0;
  EXPECT_FALSE(check_orient_job(part, mill, p));
  p.add(cl::Arc{});
  EXPECT_FALSE(check_orient_job(part, kMill, p));
  EXPECT_TRUE(check_orient_job(part, kMill, cl::Program{}));
}

}  // namespace
}  // namespace burin::job
