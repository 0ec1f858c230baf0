// SPDX-License-Identifier: Apache-2.0
// Report of a tool-orientation job: one HTML file without network. mm, degrees.
#pragma once

#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/model/tool.h"
#include "burin/plan/orient/orient.h"

namespace burin::view {

struct OrientPicture {
  std::string title, command_line;
  const orient::Part* part = nullptr;
  const orient::OrientPlan* plan = nullptr;
  const model::Mill* mill = nullptr;
  const orient::OrientOptions* options = nullptr;
  const Diagnostics* diagnostics = nullptr;
  /// Maps of some contact points (every one, or as many as the page can hold: most of them coarse).
  struct PointMap {
    std::size_t path = 0, point = 0;
    orient::CSpaceMap map;
  };
  std::vector<PointMap> maps;
  struct Figure {
    std::string group, name, value;
  };
  std::vector<Figure> figures;
  std::string nc_text;
  // For the viewer (orient_scene): the program with the index of the point over all paths as source, as
  // orient::to_cl makes it, its machine, and the NC lines of its records.
  const cl::Program* program = nullptr;
  const kinematics::Kinematics* machine = nullptr;
  std::vector<std::uint32_t> nc_line_to_record;
};

/// Part, paths and tool axes in space (tool shown at the picked point); effective radius initial and optimal
/// along each path and their ratio (Park & Lee, figures 11 and 12); the C-space of the point that is picked
/// with its contours; gain table by path; machining time against sturz milling and a ball end; figures,
/// messages, NC text.
std::string orient_html(const OrientPicture& picture);

}  // namespace burin::view
