// SPDX-License-Identifier: Apache-2.0
// From passes to runs of the tool: zigzag, links on the surface where they are short and stay inside.
#pragma once

#include <vector>

#include "burin/plan/cycle/lift.h"
#include "burin/plan/cycle/passes.h"

namespace burin::cycle {

/// A pass inside the region.
struct Stretch {
  int pass = 0;
  Track track;
  geom::Point2 from, to;  ///< (t, w) at its ends
  Point3 start, end;      ///< tips
};

/// Cuts the passes to the region. The tracks are moved out of `passes`.
std::vector<Stretch> stretches(Passes& passes, const Region& region, geom::Direction along);

/// Every chain begins after a plunge and ends before a retract.
std::vector<Chain> order(const Sheet& sheet, int surface, std::vector<Stretch> parts,
                         const std::vector<PairFigures>& pairs, const Region& region, double path_mm);

}  // namespace burin::cycle
