// SPDX-License-Identifier: Apache-2.0
// The way of the beam's centre while it is on. Internal to the check of beams. mm.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/verify/flat.h"

namespace burin::verify {

struct BeamMotion {
  std::vector<flat::Segment> pieces;  ///< in order; arcs turn by a quarter at most
  std::vector<std::uint32_t> moves;   ///< GOTO of each piece
  double motion_mm = 0;               ///< arcs of unequal radii are left by at most this
};

/// A beam that is on without a move is a piece of no length. Errors: numbers that are not finite (range), an
/// arc that is not in the plane (geometry).
Result<BeamMotion> beam_motion(const cl::Program& program, bool rapids_cut);

}  // namespace burin::verify
