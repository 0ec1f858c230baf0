// SPDX-License-Identifier: Apache-2.0
// Bent faces -> tool angles and side steps -> CL, measured by verify, which shares nothing with the planner:
// gouges of the whole motion, and what stands between the paths, beside one tilt for all at the same scallop.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "burin/geom/surface/interpolate.h"
#include "burin/geom/surface/tessellate.h"
#include "burin/job/orient_check.h"
#include "burin/plan/orient/orient.h"
#include "burin/plan/orient/to_cl.h"
#include "burin/verify/strip_check.h"
#include "verify_support.h"

namespace burin {
namespace {

using geom::Point3;
using orient::OrientOptions;
using orient::OrientPlan;
using orient::Part;

/// A face of 90 x 60 mm that looks up: bent by two curvatures, with a wave along x and one along y.
struct Bend {
  const char* name;
  double kx, ky, wave_x, wave_y;
  double share;  ///< of the length cut with one tilt for all
  double corner = 0;
};
constexpr double kRadius = 8;
std::ostream& operator<<(std::ostream& out, const Bend& bend) {
  return out << bend.name;
}

Part bent(const Bend& bend) {
  geom::PointGrid grid{19, 15, {}};
  for (int j = 0; j < grid.count_v; ++j) {
    for (int i = 0; i < grid.count_u; ++i) {
      const double x = -45 + 90.0 * i / (grid.count_u - 1), y = -30 + 60.0 * j / (grid.count_v - 1);
      const double z = 0.5 * (bend.kx * x * x + bend.ky * y * y) + bend.wave_x * std::sin(x / 14) +
                       bend.wave_y * std::sin(y / 12);
      grid.points.push_back({x, y, z});
    }
  }
  Part part;
  orient::DesignFace face;
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

model::Mill mill_of(const Bend& bend) {
  const auto kind = bend.corner > 0 ? model::MillKind::bull : model::MillKind::flat;
  return {kind, kRadius, bend.corner, 30, {{20, 60}}};
}

OrientOptions options_of(orient::Objective objective, orient::Search search, bool smooth) {
  OrientOptions options;
  options.range.alpha_hi = geom::radians(40);
  options.objective = objective;
  options.search = search;
  options.smooth = smooth;
  options.scallop_mm = 0.05;
  options.paths.max_step_mm = 3;
  return options;
}

struct Milled {
  OrientPlan plan;
  job::OrientCheck check;
  verify::StripReport strips;
  cl::Program program;
};

Milled milled(const Part& part, const model::Mill& mill, const OrientOptions& options) {
  const orient::Scene scene(part.mesh, mill,
                            orient::tool_body(mill, options.tolerance_mm, options.clearance_mm));
  const orient::MachineLimits limits;
  LocalWorkers workers(0);
  Diagnostics diagnostics;
  Milled out;
  out.plan = orient::plan(part, scene, limits, {}, nullptr, options, workers, diagnostics, nullptr).value();
  const auto path = orient::to_cl(part, scene, limits, out.plan.paths, {});
  out.check = job::check_orient_job(part, mill, path->program, {.threads = 0}).value();
  out.program = path->program;
  std::vector<verify::StripPass> passes;
  for (const orient::OrientedPath& from : out.plan.paths) {
    verify::StripPass pass;
    pass.runs.emplace_back();
    for (const orient::OrientedPoint& point : from.points)
      if (point.reachable) pass.runs.back().push_back({point.cc.c, point.pose});
    passes.push_back(std::move(pass));
  }
  out.strips =
      verify::measure_strips(part.faces[0].surface, passes, job::checked_mill(mill),
                             {.window_mm = 1, .resolution_mm = 1e-3, .max_stations = 150, .threads = 0})
          .value();
  return out;
}

/// Highest place between passes, but where the disc, which trails the contact point, has not come to yet or
/// the next pass is not abreast.
double scallop_inside(const Milled& m, double length) {
  double highest = 0;
  for (const auto& station : m.strips.stations)
    if (station.square && std::abs(station.contact.x) < 0.5 * length - kRadius)
      highest = std::max(highest, station.mm);
  return highest;
}

class OrientJob : public testing::TestWithParam<Bend> {};

/// What a motion between two allowed poses may gouge beyond the tolerance (plan/orient/motion_check.h).
constexpr double kMotionShare = 0.3;
/// Of the scallop: strips know the surface beside a contact by its curvature only.
constexpr double kStripShare = 0.1;

TEST_P(OrientJob, StripsLeaveTheScallopAndNoGouge) {
  const Part part = bent(GetParam());
  const OrientOptions options = options_of(orient::Objective::strip, orient::Search::optimal, false);
  const Milled strip = milled(part, mill_of(GetParam()), options);
  const Milled sturz =
      milled(part, mill_of(GetParam()), options_of(orient::Objective::radius, orient::Search::sturz, false));
  EXPECT_EQ(strip.plan.unreachable, 0U);
  for (const Milled* m : {&strip, &sturz}) {
    EXPECT_LE(m->check.gouge_max_mm(), (1 + kMotionShare) * options.tolerance_mm + m->check.bound_mm);
    EXPECT_LE(scallop_inside(*m, 90), (1 + kStripShare) * options.scallop_mm);
  }
  // The program as a whole: nothing collides, and the deviation agrees with the two others of verify. (What
  // the disc has not come to at the ends of the passes is left.)
  const verified::Says says =
      verified::say({part.mesh, {}, {}, part.deflection_mm},
                    verified::path_of(strip.program, job::checked_mill(mill_of(GetParam()))), 2);
  verified::expect_clean(says, (1 + kMotionShare) * options.tolerance_mm, 5, true);
  EXPECT_GE(says.deviation.excess.mm, scallop_inside(strip, 90) - says.bound_mm - 0.001);
  // Nowhere a longer way than with one tilt for all, and a shorter one where the bend differs from path to
  // path.
  EXPECT_LE(strip.plan.cut_mm, 1.02 * sturz.plan.cut_mm);
  EXPECT_LE(strip.plan.cut_mm, GetParam().share * sturz.plan.cut_mm);
}

INSTANTIATE_TEST_SUITE_P(Faces, OrientJob,
                         testing::Values(Bend{"plane", 0, 0, 0, 0, 1.02},
                                         Bend{"bowl", 0.004, 0.004, 0, 0, 1.02},
                                         Bend{"waves", 0.002, -0.002, 1.2, 0.6, 1.02},
                                         Bend{"across", 0.001, 0, 0, 1.5, 0.95},
                                         Bend{"bull", 0.002, -0.002, 1.2, 0.6, 1.02, 2}),
                         [](const auto& face) { return std::string(face.param.name); });

}  // namespace
}  // namespace burin
