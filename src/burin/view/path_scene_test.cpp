// SPDX-License-Identifier: Apache-2.0
#include "burin/view/path_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "burin/kinematics/joint_path.h"
#include "burin/model/machine.h"
#include "burin/view/outline_scene.h"

namespace burin::view {
namespace {

using geom::kPi;
using geom::Point3;
using geom::Vec3;

Scene shown(const cl::Program& program, PathView view = {}) {
  view.program = &program;
  Scene scene;
  const auto ok = put_path(view, scene);
  EXPECT_TRUE(ok) << ok.error().message;
  const auto valid = validate(scene);
  EXPECT_TRUE(valid) << valid.error().message;
  return scene;
}

cl::Pose at(double x, double y, double z, Vec3 axis = {0, 0, 1}) {
  return {{x, y, z}, geom::unit(axis)};
}

TEST(PathScene, TimesAreLengthsOverFeeds) {
  cl::Program p;
  p.from = at(0, 0, 50);
  p.add(cl::FeedRate{600}, 3);
  p.add(cl::Rapid{at(0, 0, 0)}, 4);
  p.add(cl::Feed{at(100, 0, 0)}, 5);
  p.add(cl::Dwell{2.5}, 6);
  p.add(cl::Arc{{100, 20, 0}, {0, 0, 1}, 20, at(100, 40, 0)}, 7);
  PathView view;
  view.rapid_mm_min = 3000;
  const Scene s = shown(p, view);
  const ScenePath& path = s.path;
  ASSERT_GT(path.point.size(), 10u);
  EXPECT_EQ(path.point[0], (Point3{0, 0, 50}));
  EXPECT_NEAR(path.time_s[1], 1, 1e-12);
  EXPECT_EQ(path.kind[1], WayKind::rapid);
  EXPECT_EQ(path.feed_mm_min[1], 0);
  EXPECT_NEAR(path.time_s[2], 11, 1e-12);
  EXPECT_EQ(path.kind[3], WayKind::dwell);
  EXPECT_EQ(path.move[3], 1u);
  EXPECT_NEAR(path.time_s[3], 13.5, 1e-12);
  EXPECT_NEAR(path.time_s.back(), 13.5 + 60 * 20 * kPi / 600, 1e-9);
  EXPECT_EQ(path.line[2], 5u);
  EXPECT_EQ(path.line.back(), 7u);
  EXPECT_EQ(path.move.back(), 2u);
  EXPECT_TRUE(path.axis.empty());
}

TEST(PathScene, ArcsLieOnTheirCircleAndLookRound) {
  cl::Program p;
  p.add(cl::FeedRate{1000});
  for (const double r : {0.05, 3.0, 200.0}) {
    p.records.resize(1);
    p.source.resize(1);
    p.add(cl::Feed{at(r, 0, 1)});
    p.add(cl::Arc{{0, 0, 1}, {0, 0, -1}, r, at(r, 0, 3)});
    const Scene s = shown(p);
    const auto& points = s.path.point;
    ASSERT_GT(points.size(), 50u);
    for (std::size_t i = 2; i < points.size(); ++i) {
      EXPECT_NEAR(std::hypot(points[i].x, points[i].y), r, 1e-9 * r + 1e-12);
      const Point3 middle = lerp(points[i - 1], points[i], 0.5);
      EXPECT_LT(r - std::hypot(middle.x, middle.y), 0.0101) << r;
    }
    EXPECT_LT(points[2].y, 0) << "clockwise about +Z";
    EXPECT_NEAR(points[points.size() / 2].z, 2, 0.1);
    EXPECT_EQ(points.back(), (Point3{r, 0, 3}));
    EXPECT_LT(points.size(), 2000u);
  }
}

TEST(PathScene, JointMovesFollowTheMachine) {
  const auto machine = kinematics::Kinematics::make(*model::find_machine("xyzac-trunnion"));
  ASSERT_TRUE(machine);
  cl::Program p;
  std::vector<kinematics::Joints> joints(2);
  joints[0].linear = {30, 0, 5};
  joints[1].linear = {30, 10, 5};
  joints[1].rotary = {kPi, 0.5};
  p.add(cl::FeedRate{1000});
  for (const auto& j : joints) p.add(cl::Feed{machine->forward(j)});
  PathView view;
  view.joints = &joints;
  view.machine = &*machine;
  const Scene s = shown(p, view);
  ASSERT_GT(s.path.point.size(), 80u);
  ASSERT_EQ(s.path.rotary_deg.size(), s.path.point.size());
  for (std::size_t i = 0; i < s.path.point.size(); ++i) {
    const double t = s.path.rotary_deg[i][0] / 180;
    const cl::Pose pose = machine->forward(kinematics::between(joints[0], joints[1], t));
    EXPECT_LT(distance(pose.tip, s.path.point[i]), 1e-9);
    EXPECT_LT(norm(pose.axis - s.path.axis[i]), 1e-9);
  }
  ASSERT_TRUE(s.machine);
  EXPECT_EQ(s.machine->axes[0].letter, 'C');
  EXPECT_TRUE(s.machine->axes[1].table);
  const std::vector<bool> straight{false, true};
  view.tip_straight = &straight;
  const Scene tcp = shown(p, view);
  const Point3 a = tcp.path.point.front(), b = tcp.path.point.back();
  for (const Point3& q : tcp.path.point) EXPECT_LT(norm(cross(unit(b - a), q - a)), 1e-9);
}

TEST(PathScene, PosesGetTheAnglesOfTheMachine) {
  const auto machine = kinematics::Kinematics::make(*model::find_machine("xyzac-trunnion"));
  cl::Program p;
  p.add(cl::FeedRate{1000});
  for (int i = 0; i < 40; ++i) p.add(cl::Feed{at(i, 0, 0, {std::sin(i * 0.3), std::cos(i * 0.3), 2})});
  PathView view;
  view.machine = &*machine;
  const Scene s = shown(p, view);
  for (std::size_t i = 0; i < s.path.point.size(); i += 7) {
    kinematics::Joints j;
    j.rotary = {geom::radians(s.path.rotary_deg[i][0]), geom::radians(s.path.rotary_deg[i][1])};
    // Between poses the axis turns along the great circle and the angles evenly: near, not the same.
    EXPECT_LT(norm(machine->forward(j).axis - s.path.axis[i]), 0.01);
  }
  // Half a turn of a machine that only turns about X cannot bring the axis to Y.
  const auto one = kinematics::Kinematics::make(*model::find_machine("xyza"));
  view.machine = &*one;
  const Scene cannot = shown(p, view);
  EXPECT_TRUE(cannot.path.rotary_deg.empty());
  EXPECT_FALSE(cannot.machine);
  ASSERT_EQ(cannot.findings.size(), 1u);
  EXPECT_NE(cannot.findings[0].detail.find("move"), std::string::npos);
}

TEST(PathScene, BeamOffIsALinkAndContoursAreGroups) {
  cl::Program p;
  p.add(cl::FeedRate{1000});
  p.add(cl::Rapid{at(0, 0, 0)});
  for (int i = 0; i < 3; ++i) {
    p.add(cl::Beam{true, 100});
    p.add(cl::Feed{at(10, i, 0)});
    p.add(cl::Beam{false, 0});
    p.add(cl::Feed{at(0, i + 1, 0)});
  }
  PathView view;
  view.kerf_mm = 0.28;
  const Scene s = shown(p, view);
  ASSERT_EQ(s.tools.size(), 1u);
  EXPECT_EQ(s.tools[0].kerf_mm, 0.28);
  EXPECT_EQ(s.tools[0].name, "beam, kerf 0.28 mm");
  EXPECT_EQ(s.groups, (std::vector<std::string>{"path", "contour 1", "contour 2", "contour 3"}));
  for (std::size_t i = 1; i < s.path.point.size(); ++i)
    EXPECT_EQ(s.path.kind[i], s.path.point[i].x == 10 ? WayKind::feed : WayKind::link);
}

TEST(PathScene, CommentsAndToolsMakeGroups) {
  cl::Program p;
  p.add(cl::Comment{"made by hand"});
  p.add(cl::ToolChange{3, 6, 3});
  p.add(cl::Comment{"roughing"});
  p.add(cl::FeedRate{1000});
  p.add(cl::Feed{at(0, 0, 0)});
  p.add(cl::Feed{at(1, 0, 0)});
  p.add(cl::ToolChange{4, 10, 0});
  p.add(cl::Feed{at(2, 0, 0)});
  p.add(cl::ToolChange{3, 6, 3});
  p.add(cl::Feed{at(3, 0, 0)});
  const Scene s = shown(p);
  EXPECT_EQ(s.groups, (std::vector<std::string>{"roughing", "tool 4", "tool 3"}));
  ASSERT_EQ(s.tools.size(), 2u);
  EXPECT_EQ(s.tools[0].name, "ball 6 mm");
  EXPECT_EQ(s.tools[1].name, "flat 10 mm");
  EXPECT_EQ(s.path.tool, (std::vector<std::uint8_t>{0, 0, 1, 0}));
  EXPECT_EQ(nodes_of_moves(s.path, 4), (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST(PathScene, NothingIsNeededButMotion) {
  const Scene empty = shown(cl::Program{});
  EXPECT_TRUE(empty.path.point.empty());
  cl::Program p;
  p.add(cl::Rapid{at(1, 2, 3)});
  const Scene s = shown(p);
  EXPECT_EQ(s.path.point.size(), 1u);
  EXPECT_EQ(s.groups.size(), 1u);
  std::vector<kinematics::Joints> joints(1);
  PathView view;
  view.program = &p;
  view.joints = &joints;
  Scene bad;
  EXPECT_FALSE(put_path(view, bad)) << "joints of no machine";
}

TEST(OutlineScene, CurvesAreFollowed) {
  io::Drawing drawing;
  io::Entity e;
  e.kind = "CIRCLE";
  e.id = "2F";
  e.paths = {{{geom::Arc2{{10, 0}, 5, 0, 2 * kPi}}, true}, {{}, false}};
  drawing.entities = {e};
  const auto made = scene_outlines(drawing);
  ASSERT_EQ(made.size(), 1u);
  EXPECT_EQ(made[0].name, "CIRCLE 2F");
  for (const Point3& p : made[0].points) EXPECT_NEAR(std::hypot(p.x - 10, p.y), 5, 1e-12);
  EXPECT_GT(made[0].points.size(), 100u);
  EXPECT_LE(scene_outlines(drawing, 20)[0].points.size(), 22u);
  const auto arc =
      scene_outline({geom::make_line({0, 0}, {1, 0}), geom::make_arc({1, 0}, {0, 1}, {0, 0}, true)}, false);
  EXPECT_EQ(arc.points.front(), (Point3{0, 0, 0}));
  for (std::size_t i = 1; i < arc.points.size(); ++i)
    EXPECT_NEAR(std::hypot(arc.points[i].x, arc.points[i].y), 1, 1e-12);
}

}  // namespace
}  // namespace burin::view
