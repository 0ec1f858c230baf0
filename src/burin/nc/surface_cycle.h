// SPDX-License-Identifier: Apache-2.0
// The words of the blocks G106.1 and G106.2.
#pragma once

#include "burin/nc/modal.h"
#include "burin/nc/place.h"
#include "burin/nc/surface_program.h"

namespace burin::nc {

struct SurfaceCycle {
  Place place;        ///< of the G word
  bool join = false;  ///< G106.2
  PathMethod method = PathMethod::iso_parametric;
  geom::Grouping grouping = geom::Grouping::largest;
  int first = 0, last = 0;  ///< P and Q
  Place first_place, last_place;
  double safety_z = 0;  ///< W0 already resolved to where the tool stood
  std::optional<double> tool_diameter, side_step, scallop, feed;
  int repeats = 1;  ///< L of G106.1, for each motion block
};

/// Repeats that one block may ask for.
inline constexpr int kMaxRepeats = 9999;

/// Reads the block that is open in `machine`, and carries out what else stands in it.
Result<SurfaceCycle> read_cycle(const Source& source, const Block& block, ModalMachine& machine);

}  // namespace burin::nc
