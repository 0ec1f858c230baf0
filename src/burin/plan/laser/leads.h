// SPDX-License-Identifier: Apache-2.0
// Where closed paths may start, and the leads there. Internal to the laser planner.
#pragma once

#include <optional>
#include <vector>

#include "burin/plan/laser/clearance.h"
#include "burin/plan/laser/options.h"
#include "burin/plan/laser/strokes.h"

namespace burin::laser::detail {

/// What leads must keep away from.
struct LeadRoom {
  const Clearance* outlines = nullptr;
  const Clearance* paths = nullptr;  ///< other beam paths: no pierce in their kerf if it can be helped
  double distance_mm = 0;            ///< to every outline: |offset| - path tolerance; <= 0: only no crossing
  double kerf_mm = 0;
  double path_mm = 0.01, point_mm = 1e-7;
  double sagitta_mm = 0;  ///< > 0: leads are made of chords
};

struct Site {
  std::size_t segment = 0;  ///< start of the path: this fraction of this segment
  double fraction = 0;
  geom::Point2 point;
  std::optional<geom::Segment> lead_in;  ///< ends at `point`
};

enum class Fit { full, shortened, none };

struct Sites {
  std::vector<Site> sites;  ///< at least one
  Fit fit = Fit::full;
  double length_mm = 0;  ///< of the leads
};

/// Start points of a closed path, all with leads of the same fit. `fixed_start`: only where the path starts.
Sites plan_sites(const geom::ArcSpline& path, std::uint32_t owner, Waste waste, const LeadOptions& options,
                 bool fixed_start, const LeadRoom& room);

/// Away from `point` to the waste side, shortened until there is room; nothing when there is none.
std::optional<geom::Segment> plan_lead_out(geom::Point2 point, geom::Vec2 tangent, Waste waste,
                                           const LeadOptions& options, const LeadRoom& room);

/// Whether a move that touches the path at its start or end (or both) keeps the distance. With a distance of
/// 0 or less the move must not cross an outline; path_mm at the ends that touch are not looked at.
bool has_room(const geom::Segment& move, bool touches_start, bool touches_end, const LeadRoom& room);

}  // namespace burin::laser::detail
