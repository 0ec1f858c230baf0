// SPDX-License-Identifier: Apache-2.0
// All that verify says of a program on a part: what tests of whole operations end with. mm.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "burin/verify/collisions.h"
#include "burin/verify/deviation.h"
#include "burin/verify/path.h"

namespace burin::verified {

/// What must become of the stock, and what must not be touched.
struct Design {
  geom::Mesh mesh, obstacles;
  std::vector<bool> machined;  ///< a triangle; empty: all
  double deflection_mm = 0;
};

struct Says {
  verify::SampledSurface surface;
  verify::DeviationReport deviation;
  verify::CollisionReport collisions;
  double bound_mm = 0;  ///< of gouge and excess, deflection included
};

/// The program as tool-centre-point control runs it.
inline verify::CheckedPath path_of(const cl::Program& program, const verify::CheckedMill& tool) {
  auto path = verify::make_checked_path(program, [&](const cl::ToolChange&) { return tool; }, {});
  EXPECT_TRUE(path.ok()) << path.error().to_string();
  return path.ok() ? *std::move(path) : verify::CheckedPath{};
}
/// As a machine without it runs it.
inline verify::CheckedPath path_of(const cl::Program& program, const std::vector<kinematics::Joints>& joints,
                                   const kinematics::Kinematics& machine, const verify::CheckedMill& tool) {
  auto path = verify::make_checked_path(program, joints, {}, machine,
                                        [&](const cl::ToolChange&) { return tool; }, {});
  EXPECT_TRUE(path.ok()) << path.error().to_string();
  return path.ok() ? *std::move(path) : verify::CheckedPath{};
}

inline Says say(const Design& design, const verify::CheckedPath& path, double spacing_mm,
                double tolerance_mm = 0.01) {
  Says says;
  auto surface = verify::sample_surface(design.mesh, design.machined, {}, {.spacing_mm = spacing_mm});
  EXPECT_TRUE(surface.ok()) << surface.error().to_string();
  if (!surface) return says;
  says.surface = *std::move(surface);
  auto deviation = verify::measure_deviation(design.mesh, says.surface, path,
                                             {.tolerance_mm = tolerance_mm, .threads = 0});
  EXPECT_TRUE(deviation.ok()) << deviation.error().to_string();
  if (deviation) says.deviation = *std::move(deviation);
  auto collisions = verify::find_collisions(design.mesh, design.obstacles, path,
                                            {.tolerance_mm = tolerance_mm, .threads = 0});
  EXPECT_TRUE(collisions.ok()) << collisions.error().to_string();
  if (collisions) says.collisions = *std::move(collisions);
  says.bound_mm = says.deviation.bound_mm + design.deflection_mm;
  return says;
}

/// Nothing below the surface by more than `gouge_mm`, nothing left above it by more than `excess_mm`, all of
/// it reached, nothing touched.
inline void expect_clean(const Says& says, double gouge_mm, double excess_mm) {
  const auto at = [](const verify::WorstDeviation& w) {
    return " at " + std::to_string(w.at.x) + " " + std::to_string(w.at.y) + " " + std::to_string(w.at.z) +
           ", move " + std::to_string(w.move);
  };
  EXPECT_LE(says.deviation.gouge.mm, gouge_mm + says.bound_mm) << at(says.deviation.gouge);
  EXPECT_LE(says.deviation.excess.mm, excess_mm + says.bound_mm) << at(says.deviation.excess);
  EXPECT_EQ(says.deviation.unmachined_area_mm2, 0);
  EXPECT_EQ(says.collisions.count, 0U);
  if (!says.collisions.collisions.empty()) {
    const verify::Collision& c = says.collisions.collisions.front();
    ADD_FAILURE() << verify::name(c.body) << " in " << verify::name(c.against) << " by " << c.depth_mm
                  << " in move " << c.move;
  }
}

}  // namespace burin::verified
