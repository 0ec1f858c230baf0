// SPDX-License-Identifier: Apache-2.0
// One path of the profile as the moves that cut it. Internal to the laser planner.
#pragma once

#include <string>
#include <vector>

#include "burin/plan/laser/corners.h"
#include "burin/plan/laser/leads.h"
#include "burin/plan/laser/strokes.h"

namespace burin::laser::detail {

/// A path in its cutting direction with the start points it may have.
struct Job {
  std::uint32_t path = 0;  ///< index into Profile::paths
  geom::ArcSpline spline;
  Role role = Role::outer;
  Waste waste = Waste::none;  ///< none: open, engraved
  Sites sites;                ///< closed paths: at least one
};

/// The side of the waste and the direction that `options` ask for; closed paths are turned round if need be.
Job make_job(const Profile& profile, std::uint32_t path, const LaserOptions& options);

/// Moves from the pierce to where the beam goes off, in the order of cutting, each starting where the one
/// before ends.
struct ContourMoves {
  std::vector<Stroke> strokes;
  std::vector<geom::Point2> loops_without_room;
  int joints_missing = 0;
  bool lead_out_missing = false;
};

/// `site` of the job (closed) or the path forwards / backwards (`site` 0 / 1; open).
ContourMoves make_moves(const Job& job, std::size_t site, const LaserOptions& options, const LeadRoom& room);

}  // namespace burin::laser::detail
