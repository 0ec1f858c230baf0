// SPDX-License-Identifier: Apache-2.0
// What every check walks along: the motion of one or more tools as straight pieces. mm, radians, part frame.
//
// Whatever moved the tool (tool-centre-point control, joints that run linearly, arcs, helices), here it is
// pieces on which the tip goes straight and the axis turns evenly along the great circle; they leave the true
// motion by at most `motion_mm` at every place of the tool. docs/verify.md
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/kinematics/kinematics.h"
#include "burin/verify/mill_check.h"

namespace burin::verify {

/// From the end of the piece before to `to`.
struct PathPiece {
  cl::Pose to;
  std::uint32_t move = 0;  ///< GOTO it belongs to, from 0: index into CheckedPath::moves
  bool rapid = false;
};

/// What one tool does. The way to the first GOTO after a tool change is unknown: the motion begins in it, and
/// its piece has no length. The same after a move that ends nobody knows where.
struct ToolPath {
  CheckedMill tool;
  int tool_number = 0;
  cl::Pose from;
  std::vector<PathPiece> pieces;
};

/// Where a move comes from.
struct MoveOrigin {
  std::uint32_t record = 0;  ///< of the CL program
  std::uint32_t line = 0;    ///< of the CL or NC file, from 1; 0: unknown
  bool rapid = false;
};

struct CheckedPath {
  std::vector<ToolPath> tools;    ///< in the order of the program; a tool loaded again comes again
  std::vector<MoveOrigin> moves;  ///< by GOTO number
  double motion_mm = 0;           ///< the pieces leave the true motion by at most this
  std::size_t piece_count() const;
};

/// What every check asks of a path: tools as check_mill takes them, numbers that are numbers (range); poses
/// that are finite with unit axes, turns that a great circle decides (geometry; names the move).
Result<void> validate(const CheckedPath& path);

struct PathOptions {
  double motion_mm = 0.0005;
  std::size_t max_pieces = 20'000'000;
  std::vector<bool> unknown;  ///< by move (empty: none): where it ends only the machine knows; no piece then
};
/// Shape of tool `number`: the job's, or what CUTTER/ says. Error: none is known (names what would be
/// accepted).
using ToolSource = std::function<Result<CheckedMill>(const cl::ToolChange&)>;

/// Loading the tool that is loaded already changes nothing.
/// The program as tool-centre-point control runs it: tip straight or along its arc, axis along the great
/// circle, rapids the same. Errors: not finite, axis not a unit vector (geometry, names the move), a feed
/// move that turns the axis by half a turn, no tool, too many pieces (range).
Result<CheckedPath> make_checked_path(const cl::Program& program, const ToolSource& tool,
                                      const PathOptions& options);
/// As a machine without it runs it: joints[i] belongs to motion i, all axes run evenly. `tip_straight[i]`
/// (empty: never): under G43.4 the rotary axes run evenly, the tip straight on the part.
Result<CheckedPath> make_checked_path(const cl::Program& program,
                                      const std::vector<kinematics::Joints>& joints,
                                      const std::vector<bool>& tip_straight,
                                      const kinematics::Kinematics& machine, const ToolSource& tool,
                                      const PathOptions& options);

}  // namespace burin::verify
