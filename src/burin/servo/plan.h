// SPDX-License-Identifier: Apache-2.0
// Look-ahead: a path of smooth pieces -> a feed profile that keeps chord error, acceleration and jerk of
// every axis within limits, from rest to rest. Runs outside the real-time part; what it makes (Plan) is
// immutable and is all that the per-period tick (interpolator.h) reads. See docs/servo.md. mm, s, mm/min only
// where the name says so.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/geom/quintic.h"

namespace burin::servo {

/// What the axes and the program allow. Per axis: X, Y, Z.
struct Limits {
  double period_s = 0.001;
  double chord_error_mm = 0.001;
  double accel_mm_s2 = 5000;
  double jerk_mm_s3 = 50000;
  double axis_velocity_mm_s = 1e6;
  double rapid_mm_min = 10000;
};

/// One stretch of motion with a constant commanded feed. Stretches follow each other without gap (ends within
/// 1e-9 mm); where the direction turns between them, or within one at a node, the tool slows down or stops.
struct Stretch {
  geom::QuinticPath path;
  /// (u, v, 0) along `path`, the same nodes; empty: u and v are not a number in the setpoints.
  geom::QuinticPath uv;
  double feed_mm_min = 0;  ///< 0: rapid
  std::int32_t surface = -1, pass = -1;
};

/// Polynomial piece for the tick: position x, y, z and the parameters u, v as polynomials of degree 5 in
/// x = (t - t0) / (t1 - t0) in [0, 1].
struct Piece {
  double c[5][6];
  double end[3];      ///< position at x = 1: where the next piece starts
  double start = 0;   ///< arc length from the start of its run, mm
  double length = 0;  ///< arc length, mm
  std::int32_t surface = -1, pass = -1;
  bool has_uv = false;
  bool rest_after = false;  ///< a stop at its end
};

/// Part of the feed profile of constant jerk: from `time` on, s = s0 + v0 d + a0 d^2/2 + j d^3/6, d = t -
/// time; time counts from the start of the run.
struct ProfilePiece {
  double time = 0, s = 0, v = 0, a = 0, j = 0;
};

/// What the tick needs. `profile` counts s in chords travelled (see docs/servo.md), piecewise constant jerk,
/// from rest at 0 to rest at the end; runs between stops are separate. Each starts and ends with a setpoint,
/// so that every corner is one.
struct Plan {
  Limits limits;
  std::vector<Piece> pieces;
  struct Run {
    std::size_t first_piece = 0, end_piece = 0;
    std::size_t first_profile = 0, end_profile = 0;
    std::int64_t first_tick = 0, end_tick = 0;  ///< setpoints at its start and its end
    double length = 0;                          ///< of its chords
  };
  std::vector<Run> runs;
  std::vector<ProfilePiece> profile;
  std::size_t setpoints =
      0;  ///< how many ticks give a setpoint: 0 (at rest at the start) .. at rest at the end
  double duration_s = 0;
};

/// Coordinates that are accepted: within +-1e7 mm. Largest number of setpoints of a plan.
inline constexpr double kMaxCoordinate = 1e7;
inline constexpr std::int64_t kMaxSetpoints = 1'000'000'000;

/// Errors (usage, geometry): limits not positive, a stretch without nodes or with a gap before it, a number
/// that is not finite, a profile of more than 1e9 setpoints. Every plan is run through the tick once before
/// it is returned; where a limit would be passed the feed there is lowered and planned again, so that what is
/// returned keeps the limits in the setpoints themselves.
Result<Plan> plan(const std::vector<Stretch>& stretches, const Limits& limits, Diagnostics& diagnostics);

}  // namespace burin::servo
