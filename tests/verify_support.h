// SPDX-License-Identifier: Apache-2.0
// All that verify says of a program on a part: what tests of whole operations end with. mm.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "burin/kinematics/joint_path.h"
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
/// As a machine without it runs it: `joints` of the program, whose moves the pieces belong to.
inline verify::CheckedPath path_of(const cl::Program& program, const kinematics::JointPath& joints,
                                   const kinematics::Kinematics& machine, const verify::CheckedMill& tool) {
  cl::Program posted;
  std::vector<kinematics::Joints> to;
  for (const kinematics::JointMove& move : joints.moves) {
    const cl::Pose pose = machine.forward(move.to);
    if (move.rapid)
      posted.add(cl::Rapid{pose});
    else
      posted.add(cl::Feed{pose});
    to.push_back(move.to);
  }
  auto path =
      verify::make_checked_path(posted, to, {}, machine, [&](const cl::ToolChange&) { return tool; }, {});
  EXPECT_TRUE(path.ok()) << path.error().to_string();
  if (!path) return {};
  std::vector<std::uint32_t> goto_of(program.records.size());
  for (std::size_t i = 0, count = 0; i < program.records.size(); ++i)
    if (cl::is_motion(program.records[i])) goto_of[i] = static_cast<std::uint32_t>(count++);
  for (verify::ToolPath& t : path->tools)
    for (verify::PathPiece& piece : t.pieces) piece.move = goto_of[joints.moves[piece.move].record];
  return *std::move(path);
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
/// it reached (unless `ends` of it need not be), nothing touched.
inline void expect_clean(const Says& says, double gouge_mm, double excess_mm, bool ends = false) {
  const auto at = [](const verify::WorstDeviation& w) {
    return " at " + std::to_string(w.at.x) + " " + std::to_string(w.at.y) + " " + std::to_string(w.at.z) +
           ", move " + std::to_string(w.move);
  };
  EXPECT_LE(says.deviation.gouge.mm, gouge_mm + says.bound_mm) << at(says.deviation.gouge);
  EXPECT_LE(says.deviation.excess.mm, excess_mm + says.bound_mm) << at(says.deviation.excess);
  EXPECT_LE(says.deviation.unmachined_area_mm2, ends ? 0.2 * says.deviation.area_mm2 : 0);
  EXPECT_EQ(says.collisions.count, 0U);
  if (!says.collisions.collisions.empty()) {
    const verify::Collision& c = says.collisions.collisions.front();
    ADD_FAILURE() << verify::name(c.body) << " in " << verify::name(c.against) << " by " << c.depth_mm
                  << " in move " << c.move;
  }
}

}  // namespace burin::verified
