// SPDX-License-Identifier: Apache-2.0
// The exact tool path along a parameter curve as quintic pieces, and the nearest centre on it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "burin/base/result.h"
#include "burin/plan/cycle/graph.h"
#include "burin/plan/cycle/sheet.h"

namespace burin::cycle {

/// A smooth (C2) part of a tool path. `swing`: the ball rolls about a convex crease or turns in a concave
/// one; the surface parameters stand still meanwhile.
struct TrackPiece {
  geom::QuinticPath tip;  ///< t: the parameter s of the curve (an angle when `swing`)
  geom::QuinticPath uv;
  double s0 = 0, s1 = 0;  ///< range of s; equal when `swing`
  bool swing = false;
  bool over = false;  ///< beyond the edge of the surface: the parameters stay on it, and say nothing
};
using Track = std::vector<TrackPiece>;

/// The path along a graph: nodes so near that the quintics stay within `path_mm` of the exact tool path,
/// pieces split where the tool path is less than C2.
Track build_track(const Sheet& sheet, const Graph& graph, double path_mm);
/// The same along the straight line of parameters from a to b (x = t, y = w), s from 0 to 1.
Track build_track(const Sheet& sheet, geom::Point2 a, geom::Point2 b, double path_mm);

/// The ball turns about the point `touch` of a crease, from one tip to another; (u, v) stand still. `across`:
/// the axis where both centres face each other over the point.
TrackPiece turn_about(Point3 touch, double radius, Point3 from, Point3 to, Vec3 across, Point3 uv);

/// The part of a track between two values of s (shorter pieces, the same curve).
Track cut_track(const Track& track, double s0, double s1);
std::size_t node_count(const Track& track);

/// The piece of `path` between two parameters: the same polynomial, nodes added at the ends.
geom::QuinticPath cut_path(const geom::QuinticPath& path, double t0, double t1);

/// Finds the nearest ball centre of a track.
class NearestCentre {
 public:
  NearestCentre() = default;
  NearestCentre(const Track& track, double radius);

  struct Place {
    Point3 c;
    Vec3 tangent;  ///< not normalised; 0 for a point
    double s = 0;
    bool at_end = false;  ///< an end of the whole track
  };
  bool empty() const { return samples_.empty(); }
  Place find(Point3 p) const;

 private:
  struct Sample {
    Point3 c;
    std::size_t piece = 0, node = 0;
  };
  /// Samples that follow each other; the first half is the next run, the second half is `right` (0: a leaf).
  struct Run {
    geom::Box3 box;
    std::uint32_t first = 0, last = 0, right = 0;
  };
  std::uint32_t build(std::uint32_t first, std::uint32_t last);
  Place polish(Point3 p, std::size_t piece, std::size_t interval) const;

  const Track* track_ = nullptr;
  double radius_ = 0;
  std::vector<Sample> samples_;
  std::vector<Run> runs_;
  mutable std::uint32_t hint_ = 0;  ///< of the last answer; one planner, one thread
};

}  // namespace burin::cycle
