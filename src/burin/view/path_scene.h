// SPDX-License-Identifier: Apache-2.0
// A tool path as the viewer plays it: nodes fine enough to look smooth, times, tools, groups. mm, degrees, s.
#pragma once

#include <vector>

#include "burin/cl/program.h"
#include "burin/kinematics/kinematics.h"
#include "burin/verify/path.h"
#include "burin/view/scene.h"

namespace burin::view {

/// What is known of a path beside its CL data. Nothing of it has to be there.
struct PathView {
  const cl::Program* program = nullptr;
  /// joints[i] belongs to motion i and all axes run evenly; empty: poses, as tool-centre-point control runs
  /// them. `tip_straight[i]` (empty: never): the tip straight on the part, the rotary axes evenly.
  const std::vector<kinematics::Joints>* joints = nullptr;
  const std::vector<bool>* tip_straight = nullptr;
  /// Gives rotary angles and times of rapids. With poses the solution nearest to the one before.
  const kinematics::Kinematics* machine = nullptr;
  /// Shapes of the tools; else what CUTTER/ says.
  const verify::CheckedPath* checked = nullptr;
  double kerf_mm = 0;  ///< of a beam
  /// Line of each record in the listing, from 1; empty: Program::source is the line.
  std::vector<std::uint32_t> lines;
  double chord_mm = 0.01;        ///< of arcs and turning axes
  double rapid_mm_min = 10'000;  ///< where no machine says it
  double turn_deg_min = 3'600;   ///< the same, of turns of the tool axis
};

/// Fills path, tools, groups and machine of the scene. A move that the machine cannot take leaves the rotary
/// axes out, which becomes a finding. Errors: more nodes than a scene may have (range), joints that do not
/// fit the program (internal).
Result<void> put_path(const PathView& view, Scene& scene);

SceneTool scene_tool(const verify::CheckedMill& mill, int number);
SceneTool beam_tool(double kerf_mm);
/// The rotary axes; nothing when there are none.
std::optional<SceneMachine> scene_machine(const kinematics::Kinematics& machine);

/// Line of each record, from 1, from the record behind each line as posts give it; 0: none.
std::vector<std::uint32_t> lines_of_records(const std::vector<std::uint32_t>& line_to_record,
                                            std::size_t records);

/// The last node of each GOTO: where a finding of a move is shown. Moves without a node: that of the move
/// before.
std::vector<std::uint32_t> nodes_of_moves(const ScenePath& path, std::size_t moves);

}  // namespace burin::view
