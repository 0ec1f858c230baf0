// SPDX-License-Identifier: Apache-2.0
// Maps, initial solutions and optima against a referee that shares nothing with the library
// (contact_cases.h). BURIN_CASES=2000 runs more contact points, BURIN_FIRST=1234 starts there.
#include "burin/plan/orient/cspace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>

#include "burin/plan/orient/contact_cases.h"

namespace burin::orient {
namespace {

using cases::Referee;
using cases::Shape;
using geom::radians;

constexpr double kTolerance = 0.01, kClearance = 1;
// mm: the triangles leave the formula by less.
constexpr double kMeshStep = 0.4, kDeflection = 1e-3;

int from_environment(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : otherwise;
}

struct World {
  World(Shape a_shape, model::Mill a_mill, double step = kMeshStep)
      : shape(std::move(a_shape)),
        mill(std::move(a_mill)),
        scene(cases::triangles(shape, step), mill, tool_body(mill, kTolerance, kClearance)),
        referee(shape, mill, kTolerance, kClearance) {}
  Setting setting(const AngleRange& range) const { return {&scene, &limits, range}; }

  Shape shape;
  model::Mill mill;
  Scene scene;
  MachineLimits limits;
  Referee referee;
};

double uniform(std::mt19937& random, double lo, double hi) {
  return lo + (hi - lo) * static_cast<double>(random()) / 4294967296.0;
}

AngleRange degrees(double a, double b, double c, double d) {
  return {radians(a), radians(b), radians(c), radians(d)};
}
const AngleRange kPaper = degrees(1.5, 20, -90, 90);

std::string text(const Angles& a) {
  return "(" + std::to_string(geom::degrees(a.alpha)) + ", " + std::to_string(geom::degrees(a.beta)) + ")";
}

struct Figures {
  int cases = 0, unreachable = 0;
  double worst = 1, worst_contour = 1, sum_contour = 0;
  std::uint64_t tests = 0, contour_tests = 0, most = 0;
  std::vector<int> histogram = std::vector<int>(12);
};

/// Four neighbours along a path, so that what one learnt is used by the next; the last one is judged.
void judge(World& world, std::mt19937& random, Figures& figures) {
  const auto ranges = cases::ranges();
  const AngleRange range = ranges[random() % ranges.size()];
  const Setting setting = world.setting(range);
  const RadiusGoal goal(world.mill);
  const double x = uniform(random, -8, 8), y = uniform(random, -8, 8), feed = uniform(random, -3.2, 3.2);
  Experience experience;
  Scene::Memory memory;
  CcPoint at;
  Optimum best;
  for (int k = 0; k < 4; ++k) {
    at = cases::contact(world.shape, x + k * std::cos(feed), y + k * std::sin(feed), feed);
    best = find_optimal(setting, goal, at, memory, experience);
    figures.tests += best.tests;
    figures.most = std::max<std::uint64_t>(figures.most, best.tests);
    ++figures.histogram[std::min<std::size_t>(best.tests / 5, figures.histogram.size() - 1)];
  }
  ++figures.cases;
  Angles where;
  const double least = best.found ? 0.98 * best.value : 0;
  const double exhaustive = world.referee.exhaustive(at, range, least, -kDeflection, &where);
  if (!best.found) {
    ++figures.unreachable;
    EXPECT_EQ(exhaustive, 0) << "allowed: " << text(where);
    EXPECT_NE(best.cause, Cause::none);
    return;
  }
  EXPECT_TRUE(range.contains(best.angles)) << text(best.angles);
  EXPECT_TRUE(world.referee.free(at, best.angles, kDeflection)) << text(best.angles);
  EXPECT_DOUBLE_EQ(best.value, world.referee.radius(best.angles));
  const double share = exhaustive > 0 ? best.value / exhaustive : 1;
  EXPECT_GE(share, 0.999) << "found " << text(best.angles) << ", best " << text(where);
  figures.worst = std::min(figures.worst, share);

  EXPECT_TRUE(best.initial_found);
  Scene::Memory other;
  const Optimum initial = find_initial(setting, goal, at, other);
  EXPECT_NEAR(initial.angles.alpha, best.initial.alpha, 1e-6);
  EXPECT_NEAR(initial.angles.beta, best.initial.beta, 1e-6);
  EXPECT_TRUE(world.referee.free(at, initial.angles, kDeflection));
  EXPECT_LE(initial.value, best.value * (1 + 1e-12));

  const Optimum contour = find_by_contour(setting, at, other);
  EXPECT_TRUE(contour.found);
  EXPECT_TRUE(world.referee.free(at, contour.angles, kDeflection)) << text(contour.angles);
  EXPECT_LE(contour.value, best.value / (1 - kOptimumShare));
  EXPECT_GE(contour.value, contour.initial_value);
  figures.worst_contour = std::min(figures.worst_contour, contour.value / best.value);
  figures.sum_contour += contour.value / best.value;
  figures.contour_tests += contour.tests;
}

TEST(CSpace, OptimaAgainstExhaustiveSearch) {
  const int count = from_environment("BURIN_CASES", 56), first = from_environment("BURIN_FIRST", 0);
  const auto shapes = cases::shapes();
  const auto mills = cases::mills();
  Figures figures;
  // Few cases: one mill a shape. Scenes are built once, so cases of one scene follow each other.
  const std::size_t scenes = shapes.size() * (count > 500 ? mills.size() : 1);
  for (std::size_t k = 0; k < scenes; ++k) {
    const std::size_t s = k % shapes.size();
    World world(shapes[s], mills[(s + k / shapes.size()) % mills.size()]);
    for (int i = first; i < first + count; ++i) {
      if (static_cast<std::size_t>(i) % scenes != k) continue;
      SCOPED_TRACE(world.shape.name + ", case " + std::to_string(i));
      std::mt19937 random(static_cast<unsigned>(i));
      judge(world, random, figures);
    }
  }
  const int found = figures.cases - figures.unreachable;
  const double points = 4.0 * figures.cases;
  EXPECT_GT(found, figures.cases / 2);
  EXPECT_LE(static_cast<double>(figures.tests) / points, 40);
  std::printf("%d cases, %d unreachable: worst share %.6f; tests %.1f in the mean, %d at most\n",
              figures.cases, figures.unreachable, figures.worst, static_cast<double>(figures.tests) / points,
              static_cast<int>(figures.most));
  std::printf("contour: worst %.4f, mean %.5f of the optimum, %.1f tests\nhistogram of tests by fives:",
              figures.worst_contour, figures.sum_contour / found,
              static_cast<double>(figures.contour_tests) / found);
  for (const int n : figures.histogram) std::printf(" %d", n);
  std::printf("\n");
}

/// Every node, against the referee; nodes nearer to the boundary than the triangles' deflection may go either
/// way. That is more than a boundary within half a cell.
void judge_map(World& world, const CcPoint& at, const AngleRange& range, int tilts, int yaws) {
  Scene::Memory memory;
  const CSpaceMap map = make_map(world.setting(range), at, tilts, yaws, memory);
  ASSERT_EQ(map.cells.size(), static_cast<std::size_t>(tilts * yaws));
  EXPECT_EQ(map.node(0, 0), (Angles{range.alpha_lo, range.beta_lo}));
  EXPECT_EQ(map.node(tilts - 1, yaws - 1), (Angles{range.alpha_hi, range.beta_hi}));
  const auto word_of = [](Referee::Hit hit) {
    return hit == Referee::Hit::none    ? Cause::none
           : hit == Referee::Hit::gouge ? Cause::gouge
                                        : Cause::collision;
  };
  int open = 0, wrong = 0;
  for (int j = 0; j < yaws; ++j)
    for (int i = 0; i < tilts; ++i) {
      const Angles node = map.node(i, j);
      const Cause near = word_of(world.referee.hit(at, node, -kDeflection));
      const Cause far = word_of(world.referee.hit(at, node, kDeflection));
      open += near != far;
      if (map.at(i, j) == near || map.at(i, j) == far) continue;
      if (++wrong < 5)
        ADD_FAILURE() << world.shape.name << text(node) << ": " << word(map.at(i, j)) << " instead of "
                      << word(near);
    }
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(open, tilts * yaws / 50) << "the referee decides nothing";
}

TEST(CSpace, MapsAgainstBruteForce) {
  const auto shapes = cases::shapes();
  const auto mills = cases::mills();
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    World world(shapes[s], mills[(s + 1) % mills.size()]);
    const CcPoint at = cases::contact(world.shape, 3, 4, 0.3 + 0.5 * static_cast<double>(s));
    judge_map(world, at, degrees(1, 45, -90, 90), 15, 19);
  }
}

}  // namespace
}  // namespace burin::orient
