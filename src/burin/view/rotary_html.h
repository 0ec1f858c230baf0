// SPDX-License-Identifier: Apache-2.0
// Report of a rotary job: one HTML file without network, and a plain picture. mm, degrees.
#pragma once

#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/cl/program.h"
#include "burin/kinematics/kinematics.h"
#include "burin/model/tool.h"
#include "burin/plan/rotary/rotary.h"

namespace burin::view {

struct RotaryPicture {
  std::string title, command_line;
  const rotary::Part* part = nullptr;
  const rotary::RotaryPlan* plan = nullptr;
  const model::BallTool* tool = nullptr;
  const rotary::RotaryOptions* options = nullptr;
  const Diagnostics* diagnostics = nullptr;
  struct Figure {
    std::string group, name, value;
  };
  std::vector<Figure> figures;
  std::string nc_text;
  // For the viewer (rotary_scene): the program with the number of the point as source, as rotary::to_cl makes
  // it, its machine, and the NC lines of its records.
  const cl::Program* program = nullptr;
  const kinematics::Kinematics* machine = nullptr;
  std::vector<std::uint32_t> nc_line_to_record;
};

/// Part, tool path and axes in space; sections with the initial axes (those that interfere marked) and the
/// resolved ones (Suh & Lee, figure 8 b and c); reachable angles over the path with theta before and after
/// smoothing; places left uncut; figures, messages, NC text.
std::string rotary_html(const RotaryPicture& picture);

/// Two sections, initial and resolved axes, side by side.
std::string rotary_svg(const rotary::Part& part, const rotary::RotaryPlan& plan, const model::BallTool& tool);

}  // namespace burin::view
