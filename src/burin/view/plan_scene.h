// SPDX-License-Identifier: Apache-2.0
// What the scenes of planned paths share: nodes of the path that stand for points of the plan. Private to
// view.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "burin/view/path_scene.h"
#include "burin/view/scene.h"

namespace burin::view {

inline constexpr std::size_t kNoPoint = static_cast<std::size_t>(-1);

struct PlanNodes {
  std::vector<std::size_t> point_of;  ///< of each node; kNoPoint in the air
  std::vector<std::size_t> node_of;   ///< of each point: the node it is reached in
};

/// Fills the path with one tool. Sources of the program's records are numbers of points, below `points`; feed
/// moves without one are links. `line_to_record` as the posts give it. Errors: of put_path.
Result<PlanNodes> put_plan_path(const cl::Program& program, const kinematics::Kinematics* machine,
                                const std::vector<std::uint32_t>& line_to_record, SceneTool tool,
                                std::size_t points, Scene& scene);

/// `group_of` a point: an index into `names`. Ways through the air belong to the group they lead to.
void put_plan_groups(const PlanNodes& nodes, std::vector<std::string> names,
                     const std::function<std::size_t(std::size_t point)>& group_of, Scene& scene);

/// A value of each point; what is not finite is none.
void put_plan_series(const PlanNodes& nodes, const char* name, const char* unit, bool diverges,
                     const std::function<double(std::size_t point)>& value, Scene& scene);

}  // namespace burin::view
