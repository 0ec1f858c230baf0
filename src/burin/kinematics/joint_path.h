// SPDX-License-Identifier: Apache-2.0
// CL data -> joint moves that run linearly, as a control without tool-centre-point control makes them: points
// between where the tip or the axis would leave the CL motion, and the time of each move from the feed of the
// tip on the part. mm, radians, minutes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/kinematics/kinematics.h"

namespace burin::kinematics {

struct JointMove {
  bool rapid = false;
  Joints to;
  double minutes = 0;        ///< of a feed move
  std::uint32_t record = 0;  ///< the CL record it belongs to
};

struct JointPathOptions {
  /// The tip leaves the CL motion by at most this; the axis by at most axis_tolerance_rad.
  double tolerance_mm = 0.01;
  double axis_tolerance_rad = 0.1 * geom::kPi / 180;
  /// The records already mean joint-linear motion (the rotary planner's do): no points between for the shape.
  bool joint_linear = false;
  /// Tool-centre-point control moves the tip straight by itself: points between only where the axis would
  /// leave its great circle, rotary axes turning evenly.
  bool tool_centre = false;
  /// Moves take longer where a rotary axis would need more than its acceleration.
  bool keep_acceleration = false;
  /// The tip's speed within a move is within this share of the feed; points between where it is not.
  double speed_share = 0.01;
  Joints start;  ///< of the machine when the program begins: which solution is near
  std::size_t max_moves = 20'000'000;
};

struct JointPath {
  std::vector<JointMove> moves;
  std::size_t inserted = 0;  ///< points between
  std::size_t feed_limited =
      0;  ///< moves that take longer than the feed says: an axis is at its highest speed
  std::size_t acceleration_limited = 0;  ///< feed moves made slower for the acceleration of a rotary axis
  std::size_t pole_turns = 0;            ///< turns of the first rotary axis in place, at a pole
  double deviation_mm = 0;               ///< of the tip, largest measured
};

/// Errors: a tool axis the machine cannot reach (unsupported), a position beyond its limits (range; names CL
/// move and axis), a first move at feed from nowhere (usage), a motion through a pole that no step
/// however small follows (geometry), too many moves (range). Rapids go joint-linear in one move. Arcs become
/// lines within half the tolerance.
Result<JointPath> make_joint_path(const Kinematics& machine, const cl::Program& program,
                                  const JointPathOptions& options);

/// Largest shares of the rotary axes' speed and acceleration in feed moves as they are timed. Acceleration:
/// of the motion with its corners rounded by at most the tolerance (joint_times.cpp). Axes without the figure
/// do not count; rapids part what is looked at.
struct RotaryShares {
  std::array<double, 2> speed{}, acceleration{};
};
RotaryShares rotary_shares(const Kinematics& machine, const std::vector<JointMove>& moves,
                           double axis_tolerance_rad);
/// Makes moves longer until the acceleration is kept; how many.
std::size_t keep_acceleration(const Kinematics& machine, std::vector<JointMove>& moves,
                              double axis_tolerance_rad);

/// Joints at t in [0, 1] of a linear move.
Joints between(const Joints& a, const Joints& b, double t);
/// Length of the tip's way on the part during a joint-linear move, and its least and greatest speed (mm per
/// unit of t).
struct TipMotion {
  double length = 0, slowest = 0, fastest = 0;
};
/// Time that the slowest axis needs at its highest speed; axes without a speed do not count.
double least_minutes(const Kinematics& machine, const Joints& from, const Joints& to);
TipMotion tip_motion(const Kinematics& machine, const Joints& from, const Joints& to);
/// Time of all moves: rapids as fast as the axes go, but for the first one, which begins anywhere.
double total_minutes(const Kinematics& machine, const std::vector<JointMove>& moves);

}  // namespace burin::kinematics
