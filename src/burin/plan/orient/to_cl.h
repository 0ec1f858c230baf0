// SPDX-License-Identifier: Apache-2.0
// From oriented points to a tool path: feed moves along the paths, and ways through the air between them.
#pragma once

#include "burin/base/result.h"
#include "burin/plan/orient/orient.h"

namespace burin::orient {

struct AirOptions {
  double safety_mm = 20;
  double feed_mm_min = 1000;
  double spindle_rpm = 0;
  /// Feed of ways through the air; 0: rapids where the axis rests, five times the feed where it turns (what
  /// a rapid does with turning axes is the control's own affair).
  double air_mm_min = 0;
  unsigned threads = 1;  ///< 0: as many as the machine has; the result is the same for any number
};
struct ToolPath {
  cl::Program program;  ///< record sources: index of the point over all paths, kNoSource for ways between
  double cut_mm = 0, link_mm = 0, rapid_mm = 0;
  std::size_t links = 0;
  std::size_t inserted = 0;  ///< points between contact points
  std::vector<std::size_t>
      broken;  ///< feed moves between neighbours that would gouge or collide: retracted instead
  std::vector<std::size_t> stranded;  ///< points of runs that no clear way leads to or from: left out
};

/// Unreachable points end a run. Between two neighbours the tool moves as tool-centre-point control moves it
/// (tip straight, axis along the great circle): where that leaves the allowed set (gouge beyond the
/// tolerance, clearance) points are put between that follow the surface, or the run is broken. Between runs
/// the tool retracts along its axis until it is clear, goes over the part at safety_mm, its axis turning
/// there, and comes down along the next axis; what is possible is proven by the scene on the way, in steps
/// that cannot step over anything.
Result<ToolPath> to_cl(const Part& part, const Scene& scene, const MachineLimits& limits,
                       const std::vector<OrientedPath>& paths, const AirOptions& options);

}  // namespace burin::orient
