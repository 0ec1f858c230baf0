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
  int cases = 0, unreachable = 0, no_initial = 0;
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

  Scene::Memory other;
  const Optimum initial = find_initial(setting, goal, at, other);
  EXPECT_EQ(initial.found, best.initial_found);
  // The walks that find them begin at different tilts, each right within 1e-9 (Scene::first_free).
  EXPECT_NEAR(initial.angles.alpha, best.initial.alpha, 2e-9);
  EXPECT_NEAR(initial.angles.beta, best.initial.beta, 2e-9);
  // Allowed sets narrower than the steps of the enumeration may be missed by the paper's way.
  figures.no_initial += !initial.found;
  if (!initial.found) return;
  EXPECT_TRUE(world.referee.free(at, initial.angles, kDeflection));
  EXPECT_LE(initial.value, best.value * (1 + 1e-12));

  const Optimum contour = find_by_contour(setting, at, other);
  EXPECT_TRUE(contour.found);
  EXPECT_TRUE(world.referee.free(at, contour.angles, kDeflection)) << text(contour.angles);
  // Facets make steps of the first allowed tilt that are narrower than any sampling of the yaw.
  EXPECT_LE(contour.value, best.value / 0.998) << text(contour.angles) << text(best.angles);
  EXPECT_GE(contour.value, contour.initial_value);
  figures.worst_contour = std::min(figures.worst_contour, contour.value / best.value);
  figures.sum_contour += contour.value / best.value;
  figures.contour_tests += contour.tests;
}

TEST(CSpace, OptimaAgainstExhaustiveSearch) {
  const int count = from_environment("BURIN_CASES", 28), first = from_environment("BURIN_FIRST", 0);
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
  EXPECT_LE(figures.no_initial, figures.cases / 20 + 1);
  EXPECT_LE(static_cast<double>(figures.tests) / points, 40);
  std::printf(
      "%d cases, %d unreachable, %d without initial: worst share %.6f; tests %.1f in the mean, %d at most\n",
      figures.cases, figures.unreachable, figures.no_initial, figures.worst,
      static_cast<double>(figures.tests) / points, static_cast<int>(figures.most));
  std::printf("contour: worst %.4f, mean %.5f of the optimum, %.1f tests\nhistogram of tests by fives:",
              figures.worst_contour, figures.sum_contour / (found - figures.no_initial),
              static_cast<double>(figures.contour_tests) / (found - figures.no_initial));
  for (const int n : figures.histogram) std::printf(" %d", n);
  std::printf("\n");
}

/// Every node, against the referee; nodes nearer to the boundary than the triangles' deflection may go either
/// way. That is more than a boundary within half a cell.
void judge_map(World& world, const CcPoint& at, const AngleRange& range, int tilts, int yaws,
               double deflection) {
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
      const Cause near = word_of(world.referee.hit(at, node, -deflection));
      const Cause far = word_of(world.referee.hit(at, node, deflection));
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
    World world(shapes[s], mills[(s + 1) % mills.size()], 2 * kMeshStep);
    const CcPoint at = cases::contact(world.shape, 3, 4, 0.3 + 0.5 * static_cast<double>(s));
    judge_map(world, at, degrees(1, 45, -90, 90), 15, 19, 4 * kDeflection);
  }
}

/// A part of a few blocks on a flat ground, coarse triangles: no deflection at all.
World blocks(std::vector<cases::Block> all, std::size_t mill = 0) {
  return World({"blocks", cases::flat, std::move(all)}, cases::mills()[mill], 10);
}
const CcPoint kUpright = cases::contact({"flat", cases::flat, {}}, 0, 0, 0);

Optimum optimum(const World& world, const AngleRange& range, const CcPoint& at = kUpright) {
  Experience experience;
  Scene::Memory memory;
  return find_optimal(world.setting(range), RadiusGoal(world.mill), at, memory, experience);
}

TEST(CSpace, EverythingAllowedTakesTheWidestCorner) {
  const World world = blocks({});
  for (const AngleRange& range :
       {kPaper, degrees(2, 30, 15, 85), degrees(2, 30, -60, -20), degrees(3, 3, 7, 7)}) {
    const Optimum best = optimum(world, range);
    EXPECT_TRUE(best.found);
    EXPECT_EQ(best.angles, range.widest());
    EXPECT_EQ(best.initial, range.widest());
    EXPECT_EQ(best.cause, Cause::bound);
    EXPECT_EQ(best.tests, 1U);
    Scene::Memory memory;
    EXPECT_EQ(find_by_contour(world.setting(range), kUpright, memory).angles, range.widest());
  }
}

TEST(CSpace, NothingAllowedSaysWhy) {
  // A lid over the contact point: the cutter's body runs into it at any angles.
  const World world = blocks({{{-45, -45, 8}, {45, 45, 14}}});
  const Optimum best = optimum(world, kPaper);
  EXPECT_FALSE(best.found);
  EXPECT_FALSE(best.initial_found);
  EXPECT_EQ(best.cause, Cause::gouge);
  Scene::Memory memory;
  EXPECT_FALSE(find_by_contour(world.setting(kPaper), kUpright, memory).found);
  EXPECT_FALSE(first_allowed(world.setting(kPaper), kUpright, 0.2, kPaper.alpha_lo, memory).found);
  const CSpaceMap map = make_map(world.setting(kPaper), kUpright, 5, 7, memory);
  EXPECT_EQ(std::count(map.cells.begin(), map.cells.end(), Cause::gouge), 35);
}

TEST(CSpace, ALyingToolHasAnInfiniteRadius) {
  const World world = blocks({});
  const Optimum best = optimum(world, degrees(0, 20, -90, 90));
  EXPECT_TRUE(best.found);
  EXPECT_EQ(best.angles.alpha, 0);
  EXPECT_TRUE(std::isinf(best.value));
  // In a bowl it may not lie.
  World bowl(cases::shapes()[1], cases::mills()[0]);
  Optimum tilted = optimum(bowl, degrees(0, 20, -90, 90), cases::contact(bowl.shape, 2, 1, 0.4));
  ASSERT_TRUE(tilted.found);
  EXPECT_TRUE(std::isfinite(tilted.value));
  EXPECT_TRUE(bowl.referee.free(cases::contact(bowl.shape, 2, 1, 0.4), tilted.angles, kDeflection));
}

TEST(CSpace, YawAcrossTheFeedOnly) {
  const World world = blocks({});
  const Optimum best = optimum(world, degrees(1.5, 20, 90, 90));
  EXPECT_TRUE(best.found);
  EXPECT_NEAR(best.value, 0, 1e-12);
}

TEST(CSpace, AWallBesideThePathLeavesOneSide) {
  // With the wall at y = 8 the tool must turn towards -y: its centre lies at -R d.
  const World world = blocks({{{-45, 8, -5}, {45, 40, 40}}});
  const Optimum best = optimum(world, kPaper);
  ASSERT_TRUE(best.found);
  EXPECT_GT(best.angles.beta, 0);
  EXPECT_EQ(best.cause, Cause::gouge);
  // Closed form, tilt a at the lower end: the cylinder's bottom rim reaches R (1 - ...) beyond its centre;
  // the yaw at which the referee lets it pass, by bisection.
  Referee referee(world.shape, world.mill, kTolerance, kClearance);
  double blocked = 0, free = geom::kPi / 2;
  for (int k = 0; k < 40; ++k) {
    const double middle = (blocked + free) / 2;
    (referee.free(kUpright, {kPaper.alpha_lo, middle}) ? free : blocked) = middle;
  }
  EXPECT_NEAR(best.angles.beta, free, 5e-4);
  EXPECT_NEAR(best.angles.alpha, kPaper.alpha_lo, 1e-6);
}

TEST(CSpace, TwoPiecesAndTheBetterOneIsTaken) {
  // A post where the tool would stand at yaw 0: both sides of it are open, the nearer end of the yaws is not.
  World world = blocks({{{-26, -6, -5}, {-14, 2, 30}}});
  const Optimum best = optimum(world, kPaper);
  ASSERT_TRUE(best.found);
  Angles where;
  const double exhaustive = world.referee.exhaustive(kUpright, kPaper, 0.9 * best.value, 0, &where);
  EXPECT_GE(best.value, 0.999 * exhaustive) << text(best.angles) << text(where);
  EXPECT_TRUE(world.referee.free(kUpright, best.angles, 1e-9));
}

TEST(CSpace, ASliverIsFound) {
  // Walls on both sides leave a few degrees of yaw.
  World world = blocks({{{-45, 4, -5}, {45, 40, 40}}, {{-45, -40, -5}, {45, -29.2, 40}}});
  const Optimum best = optimum(world, kPaper);
  Angles where;
  const double exhaustive = world.referee.exhaustive(kUpright, kPaper, 0.9 * best.value, 0, &where);
  ASSERT_GT(exhaustive, 0);
  ASSERT_TRUE(best.found);
  EXPECT_GE(best.value, 0.999 * exhaustive) << text(best.angles) << text(where);
}

/// Falls with the tilt and is greatest at a yaw of 40 degrees.
class OtherGoal final : public Goal {
 public:
  double value(const CcPoint&, const Angles& a) const override {
    return (2 - a.alpha) * (2 + std::cos(a.beta - radians(40)));
  }
};

TEST(CSpace, GoalsNeedNoFormulaForTheirTilts) {
  const OtherGoal goal;
  const double tilt = goal.tilt_of(kUpright, goal.value(kUpright, {0.3, 0.1}), 0.1, 0, 1);
  EXPECT_NEAR(tilt, 0.3, 2e-6);
  EXPECT_GE(tilt, 0.3 - 1e-12);
  World bowl(cases::shapes()[1], cases::mills()[0]);
  const CcPoint at = cases::contact(bowl.shape, 1, 2, 0);
  Experience experience;
  Scene::Memory memory;
  const Optimum best = find_optimal(bowl.setting(kPaper), goal, at, memory, experience);
  double exhaustive = 0;
  for (double beta = -geom::kPi / 2; beta <= geom::kPi / 2; beta += radians(0.5)) {
    const auto free = first_allowed(bowl.setting(kPaper), at, beta, kPaper.alpha_lo, memory);
    if (free.found) exhaustive = std::max(exhaustive, goal.value(at, {free.alpha, beta}));
  }
  EXPECT_GE(best.value, (1 - 2 * kOptimumShare) * exhaustive) << text(best.angles);
  EXPECT_NEAR(best.angles.beta, radians(40), radians(3));
}

/// A head that leans by [least, most] degrees and turns all around.
MachineLimits leaning(double least, double most) {
  model::Machine machine = *model::find_machine("propeller-head-head");
  int rotary = 0;
  for (model::Axis& axis : machine.axes) {
    if (axis.kind != model::AxisKind::rotary) continue;
    axis.min = rotary == 0 ? -400 : least;
    axis.max = rotary == 0 ? 400 : most;
    ++rotary;
  }
  return MachineLimits(*kinematics::Kinematics::make(machine));
}

TEST(CSpace, TheMachinesTravelIsALimit) {
  const World world = blocks({});
  const RadiusGoal goal(world.mill);
  Scene::Memory memory;
  Experience experience;
  const MachineLimits some = leaning(5, 45);
  const Setting setting{&world.scene, &some, kPaper};
  const Optimum best = find_optimal(setting, goal, kUpright, memory, experience);
  ASSERT_TRUE(best.found);
  EXPECT_NEAR(best.angles.alpha, radians(5), 2e-6);
  EXPECT_TRUE(some.within(pose(kUpright, best.angles, world.mill)));
  EXPECT_GE(best.value, (1 - kOptimumShare) * goal.value(kUpright, {radians(5), 0}));
  EXPECT_EQ(best.cause, Cause::limit);
  EXPECT_EQ(cause_at(setting, kUpright, {radians(4), 0.3}, memory), Cause::limit);
  EXPECT_EQ(cause_at(setting, kUpright, {radians(6), 0.3}, memory), Cause::none);
  EXPECT_NEAR(first_allowed(setting, kUpright, 0.7, radians(2), memory).alpha, radians(5), 2e-6);
  EXPECT_NEAR(find_by_contour(setting, kUpright, memory).angles.alpha, radians(5), 1e-3);

  const MachineLimits none = leaning(30, 45);
  const Setting shut{&world.scene, &none, kPaper};
  const Optimum nothing = find_optimal(shut, goal, kUpright, memory, experience);
  EXPECT_FALSE(nothing.found);
  EXPECT_EQ(nothing.cause, Cause::limit);
}

}  // namespace
}  // namespace burin::orient
