// SPDX-License-Identifier: Apache-2.0
// What the beam does at sharp corners. Internal to the laser planner.
#pragma once

#include <vector>

#include "burin/plan/laser/leads.h"
#include "burin/plan/laser/options.h"
#include "burin/plan/laser/strokes.h"

namespace burin::laser::detail {

/// A sharp corner of the outline as the beam path shows it: a vertex before segment `first` (first == end),
/// or the arcs first..end-1 that the offset put around it.
struct SharpCorner {
  std::size_t first = 0, end = 0;
  double turn = 0;  ///< of the direction, positive to the left; radians
  geom::Point2 at;  ///< vertex, or middle of the arc
};

/// In the order of the path; a vertex at the start of a closed spline is corner 0 with first == end == 0.
std::vector<SharpCorner> sharp_corners(const geom::ArcSpline& spline, double angle_rad);

struct CornerResult {
  std::vector<Stroke> strokes;
  std::vector<geom::Point2> no_room;  ///< corners that were to get a loop and are cut slowly instead
  std::vector<Span> zones;            ///< of the strokes: corners and what belongs to them
};

/// The strokes of a path with its corners treated as the options say.
CornerResult treat_corners(const geom::ArcSpline& spline, Waste waste, const CornerOptions& options,
                           const LeadRoom& room);

}  // namespace burin::laser::detail
