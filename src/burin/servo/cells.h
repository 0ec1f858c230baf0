// SPDX-License-Identifier: Apache-2.0
// The run as a row of short cells with what bounds the speed there: the largest derivatives of the path with
// respect to arc length, per axis, and what changes at once at a point. Part of the planner.
#pragma once

#include <vector>

#include "burin/servo/track.h"

namespace burin::servo {

struct Cell {
  double key0 = 0, key1 = 0;  ///< place in the run: Piece::start + x Piece::length
  double s0 = 0, s1 = 0;      ///< the same in chords travelled
  double length = 0;          ///< of the arc; 0: a point
  double d1[3] = {0, 0, 0}, d2[3] = {0, 0, 0}, d3[3] = {0, 0, 0};  ///< largest of each axis
  double turn[3] = {0, 0, 0}, bend[3] = {0, 0, 0};                 ///< Junction's
  double curvature = 0;
  double feed = 0;  ///< commanded, mm/s
  double slow = 1;  ///< lowered when the setpoints passed a limit here
  double soft = 1;  ///< the same for the tangential acceleration
  double hit = 0;   ///< how far the last run through passed a limit, relative (1: at the limit)
};

std::vector<Cell> make_cells(const Track& track, const TrackRun& run, const Limits& limits);

/// Speed and tangential acceleration that a cell allows.
struct CellLimit {
  double v = 0, a = 0;
};
/// For a profile smoothed over `tau` s, of which the share `reserve` of acceleration and jerk is kept for the
/// tangential part.
CellLimit cell_limit(const Cell& cell, const Limits& limits, double tau, double reserve);

}  // namespace burin::servo
