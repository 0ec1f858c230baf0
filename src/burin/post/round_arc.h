// SPDX-License-Identifier: Apache-2.0
// An exact arc -> arcs and lines whose ends and centres lie on the grid of a control's decimals, which the
// control accepts, turns the same way round, and which stay near the exact arc. See docs/cl-and-nc.md,
// "Rounding of arcs".
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::post {

/// A place in the plane of the arc, in steps of the last decimal.
struct GridPoint {
  std::int64_t a = 0, b = 0;
  bool operator==(const GridPoint&) const = default;
};

/// The exact arc, mm. `start` and `end` may lie on slightly different radii (arcs of other systems).
struct PlaneArc {
  geom::Point2 center, start, end;
  bool clockwise = false;
  double sweep = 0;  ///< (0, 2 pi]; exactly 2 pi: a full circle
};

struct ArcGrid {
  int decimals = 4;
  double absolute_mm = 0.005, relative = 0.001;  ///< the control's limit for the difference of the radii
  double min_radius_mm = 0, max_radius_mm = 1e5;
  double min_sweep = 0;  ///< radians
  bool lines_only = false;
};

struct ArcPiece {
  bool line = false;
  GridPoint end;
  GridPoint offset;  ///< from the start to the centre (I, J); arcs only
  double at = 1;     ///< how much of the sweep is done at `end`
};

/// What a control makes of a block: the angle it turns from `start` to `end` about `start + offset`, in (0, 2
/// pi].
double control_sweep(GridPoint start, GridPoint end, GridPoint offset, bool clockwise);
/// The difference of start and end radius, and the smaller of the two, in steps.
struct ControlRadii {
  double difference = 0, smaller = 0;
};
ControlRadii control_radii(GridPoint start, GridPoint end, GridPoint offset);

/// The largest distance between the exact arc and what goes out, in steps, that is taken before an arc is
/// split. Rounding an end moves it by up to 0.71 steps, rounding the centre moves the rest of a circle by as
/// much again.
inline constexpr double kMaxArcDeviation = 1.5;

/// From `start` (the rounded start) on. Pieces may be lines of no length (the caller drops them). Nothing
/// when more than a million pieces would be needed.
std::optional<std::vector<ArcPiece>> round_arc(const PlaneArc& arc, GridPoint start, const ArcGrid& grid);

}  // namespace burin::post
