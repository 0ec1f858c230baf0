// SPDX-License-Identifier: Apache-2.0
#include "burin/view/plan_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace burin::view {
namespace {

constexpr std::size_t kMostGroups = 65'000;

}  // namespace

Result<PlanNodes> put_plan_path(const cl::Program& program, const kinematics::Kinematics* machine,
                                const std::vector<std::uint32_t>& line_to_record, SceneTool tool,
                                std::size_t points, Scene& scene) {
  PathView view;
  view.program = &program;
  view.machine = machine;
  view.lines = lines_of_records(line_to_record, program.records.size());
  if (auto ok = put_path(view, scene); !ok) return ok.error();
  scene.tools = {std::move(tool)};
  ScenePath& path = scene.path;
  std::fill(path.tool.begin(), path.tool.end(), std::uint8_t{0});
  std::vector<std::uint32_t> source_of_move;
  for (std::size_t r = 0; r < program.records.size(); ++r)
    if (cl::is_motion(program.records[r])) source_of_move.push_back(program.source[r]);
  PlanNodes nodes;
  nodes.node_of.assign(points, kNoPoint);
  for (std::size_t n = 0; n < path.point.size(); ++n) {
    const std::uint32_t source = source_of_move[path.move[n]];
    const bool cuts = source != cl::Program::kNoSource && source < points;
    nodes.point_of.push_back(cuts ? source : kNoPoint);
    if (cuts) nodes.node_of[source] = n;
    if (!cuts && path.kind[n] == WayKind::feed) path.kind[n] = WayKind::link;
  }
  return nodes;
}

void put_plan_groups(const PlanNodes& nodes, std::vector<std::string> names,
                     const std::function<std::size_t(std::size_t point)>& group_of, Scene& scene) {
  if (names.empty()) names.emplace_back("path");
  if (names.size() > kMostGroups) names.resize(kMostGroups);
  scene.groups = std::move(names);
  std::size_t group = 0;
  for (std::size_t n = nodes.point_of.size(); n-- > 0;) {
    if (nodes.point_of[n] != kNoPoint) group = std::min(group_of(nodes.point_of[n]), scene.groups.size() - 1);
    scene.path.group[n] = static_cast<std::uint16_t>(group);
  }
}

void put_plan_series(const PlanNodes& nodes, const char* name, const char* unit, bool diverges,
                     const std::function<double(std::size_t point)>& value, Scene& scene) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  SceneSeries s{name, unit, std::vector<float>(nodes.point_of.size(), kNaN), diverges};
  for (std::size_t n = 0; n < nodes.point_of.size(); ++n) {
    if (nodes.point_of[n] == kNoPoint) continue;
    const auto v = static_cast<float>(value(nodes.point_of[n]));
    if (std::isfinite(v)) s.value[n] = v;
  }
  scene.series.push_back(std::move(s));
}

}  // namespace burin::view
