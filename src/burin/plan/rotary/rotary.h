// SPDX-License-Identifier: Apache-2.0
// 4-axis ball-end paths around the X axis, free of step-size, tool-size and tool-axis interference (Suh &
// Lee). See docs/rotary.md. mm, radians, part frame: theta is the tool axis (0, sin theta, cos theta) and the
// position of the A axis.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/model/tool.h"
#include "burin/plan/rotary/axis.h"
#include "burin/plan/rotary/center_path.h"
#include "burin/plan/rotary/motion.h"
#include "burin/plan/rotary/part.h"
#include "burin/plan/rotary/reach.h"

namespace burin::rotary {

enum class Tai { exact, section };

struct RotaryOptions {
  Pattern pattern = Pattern::rings;
  double tolerance_mm = 0.01;
  double scallop = 0.05;
  std::optional<double> side_step;
  Tsi tsi = Tsi::surface;
  Tai tai = Tai::exact;
  double clearance = 0.5 * 3.14159265358979323846 / 180;
  double lean = 10 * 3.14159265358979323846 / 180;
  bool smooth = true;
  double feed_mm_min = 600;
  double theta_min = -1e9, theta_max = 1e9;  ///< of the machine's A axis
  double safety_mm = 2;                      ///< links and rapids keep this from part and stock
  double stock_radius = 0;  ///< rapids round the part outside of this about the axis; 0: the part's own
  unsigned threads = 0;     ///< to plan with, 0: all of the machine; the plan does not depend on it
};

/// One row of points.csv, in cutting order.
struct RotaryPoint {
  Place place;
  std::size_t path = 0, index = 0;
  double initial = 0;  ///< the paper's first axis, radians
  double theta = 0;    ///< chosen, unwrapped
  bool initial_interferes = false;
  AngleSet reachable;
};

/// A stretch of the tool's way in joint-linear moves through `poses`; each starts where the one before ended.
enum class LegKind { rapid, approach, cut, retract, link };
struct Leg {
  LegKind kind = LegKind::cut;
  std::vector<AxisPose> poses;
  std::size_t path = 0;
  std::vector<std::size_t> points;  ///< cut: the RotaryPoint behind each pose
  /// approach: poses up to this one are reached in the air along the axis, as fast as the machine can (0:
  /// everything at the feed). retract: the last pose is reached like that.
  std::size_t descent = 0;
};

struct RotaryCounts {
  /// contact_points are the rows of points.csv; planned_contacts those given to TSI (dense), of which `tsi`
  /// would gouge.
  std::size_t contact_points = 0, planned_contacts = 0, ssi_split = 0, tsi = 0, tai = 0, moved = 0,
              unreachable = 0, cl_points = 0, axis_reversals = 0, halving_points = 0, broken = 0;
};
struct RotaryQuality {
  double ssi_max_mm = 0, gouge_max_mm = 0, excess_max_mm = 0, axis_step_max = 0, axis_turn_total = 0;
  double scallop_mm = 0, side_step_min_mm = 0, side_step_max_mm = 0;
};
struct RotaryLengths {
  double cut = 0, link = 0, rapid = 0;  ///< of the tip, part frame
};

struct RotaryPlan {
  std::vector<RotaryPoint> points;
  std::vector<Leg> legs;
  RotaryCounts counts;
  RotaryQuality quality;
  RotaryLengths lengths_mm;
};

/// Errors (geometry, usage): a tool larger than the part, a holder that fits nowhere (says the length that
/// would), nothing reachable at all. Diagnostics (left_out): "unreachable" with counts and the first places.
Result<RotaryPlan> plan(const Part& part, const model::BallTool& tool, const RotaryOptions& options,
                        Diagnostics& diagnostics);

/// Tips and axes of the legs as CL data; `source` is the index of the point.
cl::Program to_cl(const RotaryPlan& plan, const model::BallTool& tool, const RotaryOptions& options,
                  const std::string& name);

}  // namespace burin::rotary
