// SPDX-License-Identifier: Apache-2.0
// Stretches -> polynomial pieces without gaps, cut into runs where the tool has to stop. Part of the planner.
#pragma once

#include <vector>

#include "burin/base/result.h"
#include "burin/servo/plan.h"

namespace burin::servo {

/// Derivatives with respect to arc length: unit tangent, curvature vector, its rate.
struct ArcDerivatives {
  geom::Vec3 d1, d2, d3;
};
/// Where the speed of the parameter vanishes (a cusp, a node with d1 = 0) those a little further inside.
ArcDerivatives arc_derivatives(const Piece& piece, double x);

/// |d/dx| integrated over [x0, x1].
double arc_length(const Piece& piece, double x0, double x1);

/// A speed at which no path, however rough, passes a limit in the setpoints: 4 v / T^2 <= J / 2 and so on.
double safe_speed(const Limits& limits);

/// What changes at once between two pieces, per axis: |tangent|, |curvature vector|.
struct Junction {
  double turn[3] = {0, 0, 0};
  double bend[3] = {0, 0, 0};
  bool stop = false;
};
Junction junction(const Piece& before, const Piece& after);

struct TrackRun {
  std::size_t first = 0, end = 0;
  double length = 0;
};

struct Track {
  std::vector<Piece> pieces;
  std::vector<double> feed;         ///< of each piece, mm/s
  std::vector<Junction> junctions;  ///< [i]: between piece i and i + 1
  std::vector<TrackRun> runs;
  geom::Point3 start;
};

Result<Track> make_track(const std::vector<Stretch>& stretches, const Limits& limits);

}  // namespace burin::servo
