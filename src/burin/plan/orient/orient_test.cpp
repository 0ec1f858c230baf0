// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/orient.h"

#include <gtest/gtest.h>

#include <cmath>

#include "burin/geom/surface/interpolate.h"
#include "burin/geom/surface/tessellate.h"
#include "burin/plan/orient/path_task.h"

namespace burin::orient {
namespace {

using geom::Point3;

/// A face of 100 x 80 mm, bent by the two curvatures and a wave, that looks up.
Part bent(double kx, double ky, double wave) {
  geom::PointGrid grid{15, 13, {}};
  for (int j = 0; j < grid.count_v; ++j) {
    for (int i = 0; i < grid.count_u; ++i) {
      const double x = -50 + 100.0 * i / (grid.count_u - 1), y = -40 + 80.0 * j / (grid.count_v - 1);
      grid.points.push_back({x, y, 0.5 * (kx * x * x + ky * y * y) + wave * std::sin(x / 15)});
    }
  }
  Part part;
  DesignFace face;
  face.surface = geom::interpolate(grid).value();
  face.number = 1;
  auto triangles = geom::tessellate(face.surface, false, {}, {0.0005, 0, 2'000'000});
  part.mesh = std::move(triangles->mesh);
  part.design_triangles = part.mesh.triangles.size();
  part.deflection_mm = triangles->deflection_mm;
  for (const Point3& p : part.mesh.vertices) part.bounds.add(p);
  part.faces.push_back(std::move(face));
  return part;
}

model::Mill mill() {
  return {model::MillKind::flat, 12, 0, 30, {{25, 60}}};
}

OrientOptions coarse() {
  OrientOptions options;
  options.paths.chord_mm = 0.05;
  options.paths.max_step_mm = 8;
  options.path_count = 5;
  options.range.alpha_hi = geom::radians(40);
  return options;
}

Scene scene_of(const Part& part) {
  return {part.mesh, mill(), tool_body(mill(), 0.01, 1)};
}

OrientPlan planned(const Part& part, const OrientOptions& options, unsigned threads = 1,
                   const std::vector<CcPath>& contacts = {}) {
  LocalWorkers workers(threads);
  Diagnostics diagnostics;
  auto result =
      plan(part, scene_of(part), MachineLimits(), contacts, nullptr, options, workers, diagnostics, nullptr);
  EXPECT_TRUE(result) << (result ? "" : result.error().message);
  return result ? std::move(*result) : OrientPlan{};
}

TEST(OrientPlan, TheSameBytesForAnyNumberOfThreads) {
  const Part part = bent(0.004, -0.003, 1);
  for (const Objective objective : {Objective::radius, Objective::strip}) {
    OrientOptions options = coarse();
    options.objective = objective;
    options.path_count.reset();
    options.scallop_mm = 0.4;
    const OrientPlan one = planned(part, options, 1);
    ASSERT_GT(one.contact_points, 50U);
    EXPECT_EQ(one.unreachable, 0U);
    const std::string bytes = to_bytes(one.paths);
    for (const unsigned threads : {2U, 5U}) EXPECT_EQ(to_bytes(planned(part, options, threads).paths), bytes);
  }
}

TEST(OrientPlan, NumbersAndGainsAddUp) {
  const Part part = bent(0.006, 0.004, 0);
  const OrientPlan plan = planned(part, coarse());
  ASSERT_EQ(plan.paths.size(), 5U);
  ASSERT_EQ(plan.gain_per_path.size(), 5U);
  std::size_t points = 0;
  for (std::size_t i = 0; i < plan.paths.size(); ++i) {
    EXPECT_EQ(plan.paths[i].number, static_cast<int>(i));
    points += plan.paths[i].points.size();
    EXPECT_GE(plan.gain_per_path[i], 0);
    for (const OrientedPoint& p : plan.paths[i].points) {
      ASSERT_TRUE(p.reachable);
      EXPECT_NEAR(p.rho, effective_radius(p.angles, mill()), 1e-12 * p.rho);
      EXPECT_GE(p.rho, (1 - 1e-9) * p.rho_initial);
    }
  }
  EXPECT_EQ(points, plan.contact_points);
}

/// On a bowl the least tilt that suits all is that of the deepest bend; the optimum follows the surface.
TEST(OrientPlan, FewerPathsThanOneTiltForAll) {
  const Part part = bent(0.002, 0.002, 2.5);
  OrientOptions options = coarse();
  options.objective = Objective::strip;
  options.path_count.reset();
  const OrientPlan plan = planned(part, options);
  ASSERT_EQ(plan.comparisons.size(), 2U);
  const Comparison& sturz = plan.comparisons[0];
  ASSERT_TRUE(sturz.possible);
  EXPECT_EQ(sturz.unreachable, 0U);
  EXPECT_LT(plan.cut_mm, sturz.cut_mm);
  EXPECT_LT(sturz.cut_mm, plan.comparisons[1].cut_mm);
}

TEST(OrientPlan, ContactsOffTheDesignAreNamed) {
  const Part part = bent(0, 0, 0);
  CcPath path;
  for (const double z : {0.0, -0.5, 0.3}) path.points.push_back({{0, 0, z}, {0, 0, 1}, {1, 0, 0}});
  LocalWorkers workers(1);
  Diagnostics diagnostics;
  const auto result =
      plan(part, scene_of(part), MachineLimits(), {path}, nullptr, coarse(), workers, diagnostics, nullptr);
  ASSERT_TRUE(result);
  EXPECT_EQ(diagnostics.count("contact_inside"), 1U);
  EXPECT_EQ(diagnostics.count("contact_off"), 1U);
  EXPECT_EQ(result->unreachable, 1U);
  EXPECT_TRUE(result->paths[0].points[0].reachable);
  EXPECT_FALSE(result->paths[0].points[1].reachable);
  EXPECT_EQ(result->paths[0].points[1].cause, Cause::gouge);
}

TEST(OrientPlan, RefusesWhatCannotBe) {
  const Part part = bent(0, 0, 0);
  const Scene scene = scene_of(part);
  LocalWorkers workers(1);
  Diagnostics diagnostics;
  const auto refused = [&](auto&& change) {
    OrientOptions options = coarse();
    change(options);
    const auto result =
        plan(part, scene, MachineLimits(), {}, nullptr, options, workers, diagnostics, nullptr);
    return !result && !result.error().message.empty();
  };
  EXPECT_TRUE(refused([](OrientOptions& o) { o.range.alpha_hi = 0.01; }));
  EXPECT_TRUE(refused([](OrientOptions& o) { o.range.beta_lo = -2; }));
  EXPECT_TRUE(refused([](OrientOptions& o) { o.tolerance_mm = 0; }));
  EXPECT_TRUE(refused([](OrientOptions& o) { o.feed_mm_min = std::nan(""); }));
  EXPECT_TRUE(refused([](OrientOptions& o) { o.scallop_mm = -1; }));
  EXPECT_TRUE(refused([](OrientOptions& o) {
    o.search = Search::contour;
    o.objective = Objective::strip;
  }));
  EXPECT_TRUE(refused([](OrientOptions& o) { o.max_points = 10; }));
  Part no_faces = part;
  no_faces.faces.clear();
  EXPECT_FALSE(plan(no_faces, scene, MachineLimits(), {}, nullptr, coarse(), workers, diagnostics, nullptr));
}

}  // namespace
}  // namespace burin::orient
