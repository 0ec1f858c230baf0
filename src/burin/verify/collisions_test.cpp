// SPDX-License-Identifier: Apache-2.0
// Closed forms, dense sampling of random scenes, clean cases just clear, and what must not blow up.
#include "burin/verify/collisions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "burin/verify/mill_cases.h"

namespace burin::verify {
namespace {

using geom::Mesh;
using geom::Point3;
using geom::Vec3;

const Vec3 kUp{0, 0, 1};

using cases::box;
using cases::path_of;

CollisionReport found(const Mesh& part, const Mesh& obstacles, const CheckedPath& path,
                      const CollisionOptions& options = {}) {
  const auto report = find_collisions(part, obstacles, path, options);
  if (!report) {
    ADD_FAILURE() << report.error().message;
    return {};
  }
  return *report;
}

const CheckedMill kTool{10, 2, 40, {{8, 40, 90, false}, {30, 90, 150, true}}};

// Down beside a wall x >= 0: the holder of radius 30 first, on every move that stands low enough.
TEST(Collisions, HolderPassesAWall) {
  const Mesh wall = box({-50, -100, 0}, {0, 100, 300});
  for (const double clearance : {1.0, 0.011, -0.0115, -0.5, -5.0}) {
    SCOPED_TRACE(clearance);
    const double x = 30 + clearance;
    const auto report = found(
        wall, {},
        path_of(kTool, {{{x, 0, 500}, kUp}, {{x, 0, 400}, kUp}, {{x, 0, 10}, kUp}, {{x, 20, 10}, kUp}}));
    EXPECT_EQ(report.bound_mm, 0.001);
    if (clearance > 0) {
      EXPECT_EQ(report.count, 0U);
      continue;
    }
    ASSERT_EQ(report.count, 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      const Collision& c = report.collisions[i];
      EXPECT_EQ(c.move, i + 2);
      EXPECT_EQ(c.body, Body::holder);
      EXPECT_EQ(c.against, Against::part);
      EXPECT_NEAR(c.depth_mm, -clearance, report.bound_mm);
      EXPECT_NEAR(c.at.x, 0, 1e-9);
      EXPECT_GE(c.at.z, 10 + 90);
    }
  }
}

// The same block as part and as obstacle: the cutter may go into the part when it feeds, never into
// obstacles.
TEST(Collisions, RapidThroughABlock) {
  const Mesh block = box({-20, -20, -5}, {20, 20, 0});
  const CheckedMill tool{3, 0, 200, {}};
  const std::vector<cl::Pose> poses{{{-50, 0, -1}, kUp}, {{50, 0, -1}, kUp}, {{-50, 0, -1}, kUp}};
  const auto on_part = found(block, {}, path_of(tool, poses, {false, false, true}));
  ASSERT_EQ(on_part.count, 1U);
  EXPECT_EQ(on_part.collisions[0].move, 2U);
  EXPECT_EQ(on_part.collisions[0].body, Body::cutter);
  // The top of the block goes through 1 above the bottom of the cutter.
  EXPECT_NEAR(on_part.collisions[0].depth_mm, 1, on_part.bound_mm);
  const auto on_obstacle = found({}, block, path_of(tool, poses, {false, false, true}));
  ASSERT_EQ(on_obstacle.count, 2U);
  for (const Collision& c : on_obstacle.collisions) {
    EXPECT_EQ(c.against, Against::obstacle);
    EXPECT_NEAR(c.depth_mm, 1, on_obstacle.bound_mm);
  }
  // Above it by less than the tolerance allows, and by more.
  const auto at = [&](double z) {
    return found(block, {}, path_of(tool, {{{-50, 0, z}, kUp}, {{50, 0, z}, kUp}}, {false, true})).count;
  };
  EXPECT_EQ(at(0), 0U);
  EXPECT_EQ(at(-0.01), 0U);
  EXPECT_EQ(at(-0.0115), 1U);
}

// A shank wider than the cutter rubs on a boss (a prism of many sides) that the cutter goes round.
TEST(Collisions, ShankRubsOnABoss) {
  Mesh boss;
  constexpr std::uint32_t kSides = 720;
  const double radius = 25;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double a = 2 * geom::kPi * i / kSides;
    boss.vertices.push_back({radius * std::cos(a), radius * std::sin(a), 0});
    boss.vertices.push_back({radius * std::cos(a), radius * std::sin(a), 50});
    const std::uint32_t j = (i + 1) % kSides;
    boss.triangles.push_back({2 * i, 2 * j, 2 * j + 1});
    boss.triangles.push_back({2 * i, 2 * j + 1, 2 * i + 1});
  }
  const CheckedMill tool{6, 0, 20, {{6.3, 20, 60, false}}};
  const double round = radius + 6.05;
  std::vector<cl::Pose> poses;
  for (int i = 0; i <= 90; ++i) {
    const double a = geom::radians(4.0 * i);
    poses.push_back({{round * std::cos(a), round * std::sin(a), 5}, kUp});
  }
  const auto report = found(boss, {}, path_of(tool, poses));
  ASSERT_EQ(report.count, 90U);
  // On the chords between the poses the tool comes nearer by the sagitta.
  const double want = 0.25 + round * (1 - std::cos(geom::radians(2.0)));
  for (const Collision& c : report.collisions) {
    EXPECT_EQ(c.body, Body::shank);
    EXPECT_LE(c.depth_mm, want + 1e-9);
    EXPECT_GE(c.depth_mm,
              want - report.bound_mm - 2 * radius * geom::kPi * geom::kPi / (2.0 * kSides * kSides));
    EXPECT_GE(c.at.z, 25);
  }
}

// The tip stands, the axis turns towards a wall: the upper rim of the holder reaches farthest, in the middle
// of the turn if that is where the axis leans most.
TEST(Collisions, AxisTurnsIntoAWall) {
  const CheckedMill tool{5, 0, 30, {{20, 30, 80, true}}};
  const double lean = geom::radians(20.0), reach = 80 * std::sin(lean) + 20 * std::cos(lean);
  for (const double depth : {0.2, 3.0}) {
    const Mesh wall = box({reach - depth, -200, -200}, {reach + 100, 200, 200});
    const auto turn = [&](double a) {
      return std::vector<cl::Pose>{{{0, 0, 0}, kUp}, {{0, 0, 0}, {std::sin(a), 0, std::cos(a)}}};
    };
    const auto report = found({}, wall, path_of(tool, turn(lean)));
    ASSERT_EQ(report.count, 1U);
    EXPECT_EQ(report.collisions[0].body, Body::holder);
    // A sharp rim: deepest where side and top are equally near.
    const double want = depth / (std::sin(lean) + std::cos(lean));
    EXPECT_NEAR(report.collisions[0].depth_mm, want, report.bound_mm);
    EXPECT_EQ(found({}, wall, path_of(tool, turn(-lean))).count, 0U);
  }
  // Over the top from one side to the other: nearest the wall half way.
  const Vec3 side{0, std::sin(1.0), std::cos(1.0)}, back{0, -side.y, side.z};
  const Mesh roof = box({-200, -200, 79.7}, {200, 200, 300});
  const auto report = found({}, roof, path_of(tool, {{{0, 0, 0}, side}, {{0, 0, 0}, back}}));
  ASSERT_EQ(report.count, 1U);
  EXPECT_GE(report.collisions[0].depth_mm, 0.3 - report.bound_mm);
}

/// Depth at height h and distance d from the axis in each body of the tool, 0 outside.
double depth_in(const CheckedMill& tool, Body body, double d, double h) {
  if (body == Body::cutter) {
    const double r = tool.corner_radius, out = d - (tool.radius - r), below = r - h;
    if (out > 0 && below > 0) return std::max(0.0, std::min(r - std::hypot(out, below), tool.length - h));
    return std::max(0.0, std::min({h, tool.radius - d, tool.length - h}));
  }
  double depth = 0;
  for (const ToolCylinder& c : tool.cylinders)
    if (c.holder == (body == Body::holder))
      depth = std::max(depth, std::min({h - c.from, c.radius - d, c.to - h}));
  return depth;
}
double depth_at(const CheckedMill& tool, Body body, const cl::Pose& a, const cl::Pose& b, double t,
                Point3 p) {
  const Point3 tip = lerp(a.tip, b.tip, t);
  const double angle = std::acos(std::clamp(dot(a.axis, b.axis), -1.0, 1.0));
  const Vec3 axis = angle < 1e-9 ? a.axis
                                 : (std::sin((1 - t) * angle) / std::sin(angle)) * a.axis +
                                       (std::sin(t * angle) / std::sin(angle)) * b.axis;
  const double h = dot(p - tip, axis);
  return depth_in(tool, body, norm(p - tip - h * axis), h);
}

struct Scene {
  Mesh part, obstacles;
  CheckedMill tool;
  std::vector<cl::Pose> poses;
  std::vector<bool> rapid;
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double in(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(engine_()) / 4294967296.0; }
  Vec3 vec(double most) { return {in(-most, most), in(-most, most), in(-most, most)}; }
  Mesh triangles(int count) {
    Mesh m;
    for (int t = 0; t < count; ++t) {
      const Point3 p = Point3{} + vec(30);
      for (int i = 0; i < 3; ++i) m.vertices.push_back(p + vec(2));
      const auto v = static_cast<std::uint32_t>(3 * t);
      m.triangles.push_back({v, v + 1, v + 2});
    }
    return m;
  }
  /// A walk of many short moves that turn and some far ones.
  Scene scene(int moves) {
    Scene s{triangles(60), triangles(30), {}, {}, {}};
    const double radius = in(1, 4);
    s.tool = {radius, in(0, 1) < 0.3 ? radius : in(0, radius), in(5, 9), {}};
    s.tool.cylinders = {{in(1, 5), 9, 20, false}, {in(4, 9), 20, 24, true}, {in(6, 12), 24, 35, true}};
    cl::Pose pose{Point3{} + vec(30), unit(vec(1))};
    for (int i = 0; i <= moves; ++i) {
      s.poses.push_back(pose);
      s.rapid.push_back(in(0, 1) < 0.5);
      pose = in(0, 1) < 0.2 ? cl::Pose{Point3{} + vec(30), unit(vec(1))}
                            : cl::Pose{pose.tip + vec(2), unit(pose.axis + vec(0.2))};
    }
    return s;
  }

 private:
  std::mt19937 engine_;
};

// Nothing that dense places at dense moments show is missed, and what is reported is there.
TEST(Collisions, AgreeWithDenseSamplingOfRandomScenes) {
  Random random(11);
  std::size_t seen = 0, clear = 0;
  for (int n = 0; n < 12; ++n) {
    const Scene s = random.scene(30);
    const CheckedPath path = path_of(s.tool, s.poses, s.rapid);
    CollisionOptions options;
    options.tolerance_mm = n % 2 == 0 ? 0.01 : 0;
    const auto report = found(s.part, s.obstacles, path, options);
    EXPECT_EQ(report.count, report.collisions.size());
    for (std::uint32_t move = 1; move < s.poses.size(); ++move)
      for (const Body body : {Body::cutter, Body::shank, Body::holder})
        for (const Against against : {Against::part, Against::obstacle}) {
          SCOPED_TRACE(std::to_string(n) + " " + std::to_string(move) + " " + std::string(name(body)) + " " +
                       std::string(name(against)));
          const auto depth = [&](double t, Point3 p) {
            return depth_at(s.tool, body, s.poses[move - 1], s.poses[move], t, p);
          };
          double reported = 0, there = 0, brute = 0;
          for (const Collision& c : report.collisions)
            if (c.move == move && c.body == body && c.against == against) {
              reported = c.depth_mm;
              for (int k = 0; k <= 2000; ++k) there = std::max(there, depth(k / 2000.0, c.at));
            }
          const bool counts = body != Body::cutter || against == Against::obstacle || s.rapid[move];
          if (!counts) {
            EXPECT_EQ(reported, 0);
            continue;
          }
          const Mesh& m = against == Against::part ? s.part : s.obstacles;
          for (const auto& t : m.triangles)
            for (const double u : {0.0, 1.0 / 3, 0.5, 1.0})
              for (const double v : {0.0, 1.0 / 3, 0.5, 1.0}) {
                if (u + v > 1) continue;
                const Point3 a = m.vertices[t[0]];
                const Point3 p = a + u * (m.vertices[t[1]] - a) + v * (m.vertices[t[2]] - a);
                for (int k = 0; k <= 12; ++k) brute = std::max(brute, depth(k / 12.0, p));
              }
          EXPECT_LE(brute, std::max(reported, options.tolerance_mm) + report.bound_mm);
          // Half a step of the time in which it is looked for again.
          EXPECT_GE(there, reported - 0.03);
          EXPECT_TRUE(reported == 0 || reported > options.tolerance_mm);
          (reported > 0 ? seen : clear) += 1;
        }
  }
  EXPECT_GT(seen, 300U);
  EXPECT_GT(clear, 300U);
}

// A micrometre on either side of what is proven decides.
TEST(Collisions, CleanWhenJustClear) {
  Random random(5);
  for (int n = 0; n < 20; ++n) {
    SCOPED_TRACE(n);
    // A floor under the holder that leans along its way, in a frame of its own.
    const Vec3 z = unit(random.vec(1)), x = unit(cross(z, random.vec(1))), y = cross(z, x);
    const auto placed = [&](double a, double b, double c) { return Point3{} + a * x + b * y + c * z; };
    Mesh floor;
    floor.vertices = {placed(-300, -300, 0), placed(300, -300, 0), placed(300, 300, 0), placed(-300, 300, 0)};
    floor.triangles = {{0, 1, 2}, {0, 2, 3}};
    const double radius = random.in(10, 40), from = random.in(30, 60), lean = random.in(0.1, 1.2);
    const CheckedMill tool{1, 0, 10, {{radius, from, from + 50, true}}};
    // The lowest place of the rim of the holder stands at height 0.
    const double height = radius * std::sin(lean) - from * std::cos(lean);
    const Vec3 axis = std::sin(lean) * x + std::cos(lean) * z;
    const double tolerance = 0.01, sharp = std::sin(lean) + std::cos(lean);
    const auto at = [&](double depth) {
      std::vector<cl::Pose> poses;
      for (int i = 0; i <= 40; ++i)
        poses.push_back({placed(3.0 * i - 60, 5 * std::sin(i), height - depth * sharp), axis});
      return found({}, floor, path_of(tool, poses), {.tolerance_mm = tolerance}).count;
    };
    if (height > 0) {  // else the cutter is in it, too
      EXPECT_EQ(at(-0.001), 0U);
      EXPECT_EQ(at(tolerance - 1e-9), 0U);
      EXPECT_EQ(at(tolerance + 0.001 + 1e-6), 40U);
    }
  }
}

// Every move deep in a part: time and list stay bounded, and what is listed is the deepest.
TEST(Collisions, ManyDeepOnes) {
  const Mesh part = cases::grid(100, 100, [](double u, double v) {
    return Point3{200 * u - 100, 200 * v - 100, 3 * std::sin(20 * u) * std::cos(15 * v)};
  });
  std::vector<cl::Pose> poses;
  for (int i = 0; i <= 1000; ++i)
    poses.push_back({{80 * std::cos(0.01 * i), 80 * std::sin(0.013 * i), -100 + 0.01 * i},
                     unit(Vec3{0.3 * std::sin(0.02 * i), 0.2, 1})});
  const CheckedPath path = path_of(kTool, poses);
  const auto all = found(part, part, path, {.threads = 2});
  EXPECT_GE(all.count, 2000U);
  EXPECT_EQ(all.count, all.collisions.size());
  EXPECT_LE(all.bound_mm, 0.1);
  const auto few = found(part, part, path, {.max_listed = 10});
  EXPECT_EQ(few.count, all.count);
  ASSERT_EQ(few.collisions.size(), 10U);
  double least = 1e9;
  for (std::size_t i = 0; i < few.collisions.size(); ++i) {
    least = std::min(least, few.collisions[i].depth_mm);
    EXPECT_TRUE(i == 0 || few.collisions[i - 1].move <= few.collisions[i].move);
  }
  // Chosen by a first look that sees nine tenths of each.
  std::size_t deeper = 0;
  for (const Collision& c : all.collisions) deeper += 0.9 * c.depth_mm > least + all.bound_mm;
  EXPECT_LE(deeper, 10U);
  EXPECT_EQ(found(part, {}, path, {.max_listed = 0}).collisions.size(), 0U);
}

// A move of many pieces is one move; the tool that is loaded next begins where it is said.
TEST(Collisions, PiecesAndTools) {
  const Mesh wall = box({-50, -100, 0}, {0, 100, 300});
  CheckedPath path;
  path.motion_mm = 0.0005;
  path.moves.resize(2);
  path.tools.push_back({kTool, 1, {{80, 0, 10}, kUp}, {}});
  for (int i = 1; i <= 2000; ++i)
    path.tools[0].pieces.push_back({{{80 - 0.03 * i, 0.02 * i, 10}, kUp}, 0, false});
  path.tools.push_back({{5, 5, 400, {}}, 2, {{10, 0, 10}, kUp}, {}});
  path.tools[1].pieces.push_back({{{4.5, 0, 10}, kUp}, 1, true});
  const auto report = found(wall, {}, path);
  EXPECT_EQ(report.bound_mm, 0.0015);
  ASSERT_EQ(report.count, 2U);
  EXPECT_EQ(report.collisions[0].body, Body::holder);
  EXPECT_NEAR(report.collisions[0].depth_mm, 10, report.bound_mm);
  EXPECT_EQ(report.collisions[1].body, Body::cutter);
  EXPECT_EQ(report.collisions[1].move, 1U);
  EXPECT_NEAR(report.collisions[1].depth_mm, 0.5, report.bound_mm);
}

TEST(Collisions, SameForAnyNumberOfThreads) {
  Random random(23);
  const Scene s = random.scene(3000);
  const CheckedPath path = path_of(s.tool, s.poses, s.rapid);
  const auto one = found(s.part, s.obstacles, path, {.max_listed = 500});
  const auto three = found(s.part, s.obstacles, path, {.threads = 3, .max_listed = 500});
  EXPECT_GT(one.count, 500U);
  EXPECT_EQ(one.count, three.count);
  EXPECT_EQ(one.bound_mm, three.bound_mm);
  ASSERT_EQ(one.collisions.size(), three.collisions.size());
  for (std::size_t i = 0; i < one.collisions.size(); ++i) {
    EXPECT_EQ(one.collisions[i].move, three.collisions[i].move);
    EXPECT_EQ(one.collisions[i].depth_mm, three.collisions[i].depth_mm);
    EXPECT_EQ(one.collisions[i].at, three.collisions[i].at);
  }
}

TEST(Collisions, BadInputIsAnError) {
  const Mesh wall = box({-50, -100, 0}, {0, 100, 300});
  const std::vector<cl::Pose> still{{{100, 0, 0}, kUp}, {{100, 0, 5}, kUp}};
  const double nan = std::nan("");
  EXPECT_TRUE(find_collisions(wall, {}, {}, {}));
  EXPECT_TRUE(find_collisions({}, {}, path_of(kTool, still), {}));
  EXPECT_FALSE(find_collisions(wall, {}, path_of({0, 0, 10, {}}, still), {}));
  EXPECT_FALSE(find_collisions(wall, {}, path_of({5, 0, 10, {{5, 20, 10, true}}}, still), {}));
  EXPECT_FALSE(find_collisions(wall, {}, path_of(kTool, still), {.tolerance_mm = -1}));
  EXPECT_FALSE(find_collisions(wall, {}, path_of(kTool, still), {.resolution_mm = 0}));
  EXPECT_FALSE(find_collisions(wall, {}, path_of(kTool, {{{0, 0, nan}, kUp}, {{0, 0, 0}, kUp}}), {}));
  EXPECT_FALSE(find_collisions(wall, {}, path_of(kTool, {still[0], {{0, 0, 0}, {0, 0, 2}}}), {}));
  const auto half =
      find_collisions(wall, {}, path_of(kTool, {still[0], still[1], {{0, 0, 0}, {0, 0, -1}}}), {});
  ASSERT_FALSE(half);
  EXPECT_EQ(half.error().code, ErrorCode::geometry);
  EXPECT_NE(half.error().message.find("move 2"), std::string::npos);
  Mesh broken = wall;
  broken.triangles.push_back({0, 1, 99});
  EXPECT_FALSE(find_collisions(broken, {}, path_of(kTool, still), {}));
  EXPECT_FALSE(find_collisions({}, broken, path_of(kTool, still), {}));
  broken = wall;
  broken.vertices[3].y = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(find_collisions(broken, {}, path_of(kTool, still), {}));
  struct Stop : ProgressSink {
    bool progress(std::string_view, double) override { return false; }
  } stop;
  EXPECT_FALSE(find_collisions(wall, {}, path_of(kTool, still), {}, &stop));
}

}  // namespace
}  // namespace burin::verify
