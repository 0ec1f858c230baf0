// SPDX-License-Identifier: Apache-2.0
// Tool paths over parts with walls, bowls and roofs: what the tool does on the way, sampled far more densely
// than the library asks and at other places.
#include "burin/plan/orient/to_cl.h"

#include <gtest/gtest.h>

#include <cmath>

#include "burin/kinematics/feed_way.h"
#include "burin/plan/orient/contact_cases.h"

namespace burin::orient {
namespace {

using geom::Vec3;

constexpr double kTolerance = 0.02, kClearance = 0.5, kDegree = geom::kPi / 180;
// As motion_check.h says: a twentieth of the tolerance, and a tolerance between steps.
constexpr double kBound = 2.05;

struct Case {
  Part part;
  model::Mill mill{model::MillKind::flat, 10, 0, 25, {{14, 30}}};
  std::optional<Scene> scene;
  std::vector<OrientedPath> paths;

  Case(const std::string& name, double step) {
    for (const cases::Shape& shape : cases::shapes()) {
      if (shape.name != name) continue;
      part.mesh = cases::triangles(shape, 1.5);
      for (const geom::Point3& p : part.mesh.vertices) part.bounds.add(p);
      scene.emplace(part.mesh, mill, tool_body(mill, kTolerance, kClearance));
      plan(shape, step);
    }
  }

  void plan(const cases::Shape& shape, double step) {
    const MachineLimits limits;
    const Setting setting{
        scene.operator->(), &limits, {2 * kDegree, 30 * kDegree, -geom::kPi / 2, geom::kPi / 2}};
    const RadiusGoal goal(mill);
    for (const double y : {-12.0, 0.0, 8.0}) {
      OrientedPath path;
      Scene::Memory memory;
      Experience experience;
      for (double x = -24; x <= 24; x += step) {
        OrientedPoint point;
        point.cc = cases::contact(shape, x, y, 0.1);
        const Optimum best = find_optimal(setting, goal, point.cc, memory, experience);
        point.reachable = best.found;
        point.angles = best.angles;
        point.pose = pose(point.cc, best.angles, mill);
        path.points.push_back(point);
      }
      paths.push_back(path);
    }
  }
};

bool is_cut(const ToolPath& path, std::size_t record) {
  return path.program.source[record] != cl::Program::kNoSource;
}

struct Walked {
  double cut = 0, link = 0, rapid = 0;
  std::size_t links = 0, samples = 0;
};

/// Goes along the program; every sample is free of the loosened tool and, through the air, rapids keep their
/// axis.
Walked walk(const Case& c, const ToolPath& path) {
  const Scene bound(c.part.mesh, c.mill, tool_body(c.mill, kBound * kTolerance, 0.5 * kClearance));
  Scene::Memory memory;
  Walked walked;
  const cl::Pose* at = nullptr;
  bool in_air = true;
  for (std::size_t i = 0; i < path.program.records.size(); ++i) {
    const cl::Record& record = path.program.records[i];
    const cl::Pose* to = cl::pose_of(record);
    if (to == nullptr) continue;
    if (at != nullptr) {
      const kinematics::FeedWay way(*at, *to);
      const bool rapid = std::holds_alternative<cl::Rapid>(record);
      if (rapid) {
        EXPECT_LT(way.turn(), 1e-9) << "record " << i;
      }
      (rapid ? walked.rapid : is_cut(path, i) ? walked.cut : walked.link) += way.length();
      if (is_cut(path, i) && in_air) ++walked.links;
      in_air = !is_cut(path, i);
      const int samples =
          3 + static_cast<int>((way.length() + 60 * way.turn()) / (is_cut(path, i) ? 0.011 : 0.07));
      for (int s = 0; s <= samples; ++s) {
        ++walked.samples;
        const auto blocker = bound.blocker(way.at(static_cast<double>(s) / samples), memory);
        EXPECT_FALSE(blocker) << "record " << i << " sample " << s << " of " << samples;
        if (blocker) return walked;
      }
    }
    at = to;
  }
  return walked;
}

std::vector<cl::Pose> cut_poses(const ToolPath& path) {
  std::vector<cl::Pose> poses;
  for (const cl::Record& record : path.program.records)
    if (const cl::Pose* pose = cl::pose_of(record)) poses.push_back(*pose);
  return poses;
}

void expect_all_visited(const Case& c, const ToolPath& path) {
  const std::vector<cl::Pose> poses = cut_poses(path);
  std::size_t index = 0;
  for (const OrientedPath& p : c.paths)
    for (const OrientedPoint& point : p.points) {
      const bool stranded =
          std::find(path.stranded.begin(), path.stranded.end(), index) != path.stranded.end();
      const bool visited = std::find(poses.begin(), poses.end(), point.pose) != poses.end();
      EXPECT_EQ(visited, point.reachable && !stranded) << "point " << index;
      ++index;
    }
}

TEST(ToCl, NothingIsHitOnTheWay) {
  for (const char* name : {"bowl", "hill", "blade", "wall", "slot", "post", "overhang"}) {
    const Case c(name, 2.4);
    const auto path = to_cl(c.part, *c.scene, MachineLimits(), c.paths, {5, 900, 8000, 0});
    ASSERT_TRUE(path.ok()) << path.error().to_string();
    ASSERT_TRUE(cl::validate(path->program).ok()) << name;
    SCOPED_TRACE(name);
    const Walked walked = walk(c, *path);
    EXPECT_NEAR(walked.cut, path->cut_mm, 1e-6);
    EXPECT_NEAR(walked.link, path->link_mm, 1e-6);
    EXPECT_NEAR(walked.rapid, path->rapid_mm, 1e-6);
    expect_all_visited(c, *path);
    EXPECT_TRUE(path->stranded.empty()) << path->stranded.size();
    EXPECT_LE(path->broken.size(), 6u);
    EXPECT_EQ(path->links, 2 + path->broken.size());
  }
}

TEST(ToCl, UnreachablePointsEndRuns) {
  Case c("plane", 3);
  const std::size_t each = c.paths[0].points.size();
  for (const std::size_t i : {0u, 5u, 6u, 9u}) c.paths[1].points[i].reachable = false;
  const auto path = to_cl(c.part, *c.scene, MachineLimits(), c.paths, {10, 900, 0, 0});
  ASSERT_TRUE(path.ok());
  EXPECT_EQ(path->links, 4u);  // three paths, the second in three runs
  EXPECT_TRUE(path->broken.empty());
  walk(c, *path);
  expect_all_visited(c, *path);
  std::size_t last = 0;
  bool linked = true;
  for (std::size_t i = 0; i < path->program.records.size(); ++i) {
    if (cl::pose_of(path->program.records[i]) == nullptr) continue;
    if (is_cut(*path, i)) {
      const std::size_t source = path->program.source[i];
      // Cutting goes on to the next point only; after a gap through the air.
      EXPECT_TRUE(linked || source == last || source == last + 1) << source;
      for (const std::size_t gone : {0u, 5u, 6u, 9u}) EXPECT_NE(source, each + gone);
      last = source;
    }
    linked = !is_cut(*path, i);
  }
  // Straight on the plane: every run as long as its contacts (the angles are the same throughout).
  EXPECT_NEAR(path->cut_mm, 3.0 / std::cos(0) * static_cast<double>(2 * (each - 1) + 3 + 1 + (each - 11)),
              1e-6);
}

// A sheet between two points that are both free: the straight way would go through it.
TEST(ToCl, BreaksARunThatCannotGoOn) {
  Case c("plane", 24);
  const auto base = static_cast<std::uint32_t>(c.part.mesh.vertices.size());
  for (const geom::Point3 p : {geom::Point3{1.5, -40, 0}, geom::Point3{1.5, 40, 0}, geom::Point3{1.5, 0, 20}})
    c.part.mesh.vertices.push_back(p), c.part.bounds.add(p);
  c.part.mesh.triangles.push_back({base, base + 1, base + 2});
  c.scene.emplace(c.part.mesh, c.mill, tool_body(c.mill, kTolerance, kClearance));
  for (const OrientedPath& path : c.paths)
    for (const OrientedPoint& point : path.points) {
      Scene::Memory memory;
      ASSERT_EQ(c.scene->cause(point.pose, memory), Cause::none);
    }
  const auto path = to_cl(c.part, *c.scene, MachineLimits(), c.paths, {5, 900, 0, 3000});
  ASSERT_TRUE(path.ok());
  walk(c, *path);
  expect_all_visited(c, *path);
  EXPECT_EQ(path->broken, (std::vector<std::size_t>{1, 4, 7}));
  EXPECT_EQ(path->links, 5u);
  EXPECT_EQ(path->rapid_mm, 0);  // with a feed for the air there are no rapids but the first
}

TEST(ToCl, TakesNoNonsense) {
  const Case c("plane", 12);
  EXPECT_FALSE(to_cl(c.part, *c.scene, MachineLimits(), c.paths, {5, 0, 0, 0}).ok());
  EXPECT_FALSE(to_cl(c.part, *c.scene, MachineLimits(), c.paths, {-1, 100, 0, 0}).ok());
  const auto nothing = to_cl(c.part, *c.scene, MachineLimits(), {}, {});
  ASSERT_TRUE(nothing.ok());
  EXPECT_EQ(nothing->program.move_count(), 0u);
}

}  // namespace
}  // namespace burin::orient
