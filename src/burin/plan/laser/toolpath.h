// SPDX-License-Identifier: Apache-2.0
// Beam centre lines -> the sequence of moves: order, start points, leads, corners, micro-joints, overcut,
// copies.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/plan/laser/profile.h"

namespace burin::laser {

/// What one record of the program is for; for pictures and statistics. Parallel to Program::records.
enum class MoveKind : std::uint8_t { state, rapid, lead, cut, corner, overcut, engrave };

struct Toolpath {
  cl::Program program;               ///< source: index into Profile::paths
  std::vector<MoveKind> kind;        ///< parallel to program.records
  std::vector<std::uint32_t> order;  ///< paths in cutting order (of the first copy)
  std::vector<geom::Point2> pierces;
  double cut_mm = 0, rapid_mm = 0, lead_mm = 0;
  double machining_s = 0;  ///< with acceleration, corners, pierces
};

/// Guarantees: inner paths are cut before the paths that contain them (also among copies); no lead comes
/// nearer to any outline of the part than |offset| minus the path tolerance (they are shortened, moved along
/// the contour, or dropped with a warning "lead_shortened"/"no_lead"); with lead none, order file, corners
/// round and no overcut the beam-on moves are exactly the paths. Deterministic.
Result<Toolpath> make_toolpath(const Profile& profile, const LaserOptions& options, Diagnostics& diagnostics);

/// Time for a program on a machine with trapezoidal speed profiles: full look-ahead, the speed at a corner of
/// angle a limited so that the change of velocity takes no more than the acceleration allows in 1 ms,
/// centripetal acceleration on arcs within the limit. s.
double estimate_time(const cl::Program& program, const MotionLimits& limits, double feed_mm_min);

}  // namespace burin::laser
