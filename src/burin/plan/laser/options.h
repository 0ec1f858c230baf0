// SPDX-License-Identifier: Apache-2.0
// What the laser planner is asked to do, with the defaults of the command-line contract. mm, mm/min, W, s.
#pragma once

#include <map>
#include <string>

#include "burin/base/tolerance.h"
#include "burin/geom/curve/fit.h"

namespace burin::laser {

enum class Treatment { cut, engrave, ignore };
/// automatic: by nesting; outside/inside: every contour to that side; on: on the line.
enum class Side { automatic, outside, inside, on };
enum class Corners {
  round,  ///< convex corners get the arc of the offset, nothing else
  loop,   ///< the beam overshoots the corner on the waste side and comes back: full speed at the corner
  slow,   ///< the feed drops before a sharp corner and rises after it
  power,  ///< the power drops with the feed near a sharp corner
};
enum class LeadKind { arc, line, none };
enum class Order { inner_first, file };
/// climb (and automatic): the part lies to the right of the travel, the waste to the left (outer contours
/// clockwise, holes counter-clockwise); conventional: the other way round.
enum class Direction { automatic, climb, conventional };

struct LeadOptions {
  LeadKind kind = LeadKind::arc;
  double length_mm = 2.0;  ///< of lead-in; shortened where there is no room
  double out_mm = 0.0;     ///< lead-out; 0: none
};
struct CornerOptions {
  Corners kind = Corners::round;
  double angle_deg = 30.0;   ///< corners of the outline that turn by more are sharp
  double loop_mm = 1.5;      ///< size of the loop
  double slow_mm = 1.0;      ///< length before and after the corner
  double slow_factor = 0.5;  ///< of feed; `power` scales power by the same
};
struct MicroJointOptions {
  int per_contour = 0;
  double width_mm = 0.3;  ///< of the material that stays: the beam is off for this and the kerf
};
struct CopyOptions {
  int columns = 1, rows = 1;
  double gap_mm = 5.0;  ///< between the bounding boxes of the cut paths
};
/// For the time estimate.
struct MotionLimits {
  double rapid_mm_min = 20000;
  double acceleration_mm_s2 = 3000;
  double pierce_s = 0.3;
};

struct LaserOptions {
  double offset_mm = 0;  ///< d = kerf / 2; may be negative
  double feed_mm_min = 1000;
  double power_w = 0;  ///< 0: unknown, beam on without power value
  double engrave_power_factor = 0.2;
  Side side = Side::automatic;
  Order order = Order::inner_first;
  Direction direction = Direction::automatic;
  bool arcs = true;  ///< false: lines only (--no-arcs)
  geom::FitMethod fit = geom::FitMethod::minimal;
  Tolerance tolerance;
  std::map<std::string, Treatment> layers;  ///< by layer name; others are cut
  LeadOptions lead;
  CornerOptions corners;
  MicroJointOptions micro_joints;
  double overcut_mm = 0;  ///< past the start of a closed contour, beam on
  CopyOptions copies;
  MotionLimits motion;
};

}  // namespace burin::laser
