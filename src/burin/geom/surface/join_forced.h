// SPDX-License-Identifier: Apache-2.0
// Internal to joining: Koo & Jee's forced partial join (eq. 15 to 26). Where the control points (and weights)
// of a partial patch's edge are those of rows m_b .. m_f of a base, although the edge curves differ, the base
// is replaced by up to three patches that fit. That bends it.
#pragma once

#include <optional>

#include "burin/geom/surface/join_cells.h"

namespace burin::geom::detail {

/// Rows first .. last of the base along `side` are the edge of the partial patch.
struct Run {
  int first = 0, last = 0;
  bool reversed = false;
};

/// Lower rest (if any), middle, upper rest (if any), with their deviation from the base.
std::vector<Source> forced_parts(const Source& base, SideIndex base_side, const Run& run,
                                 std::vector<double> partial_knots, double tolerance_mm);

/// Replaces all bases for which that stays within options.max_deviation_mm; the others are reported.
void force_partial_joins(std::vector<Source>& sources, const JoinOptions& options, JoinReport& report,
                         Diagnostics& diagnostics);

}  // namespace burin::geom::detail
