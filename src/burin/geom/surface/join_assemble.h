// SPDX-License-Identifier: Apache-2.0
// Internal to joining: one surface from a rectangle of cells.
#pragma once

#include <string>

#include "burin/base/result.h"
#include "burin/geom/surface/join_groups.h"

namespace burin::geom::detail {

/// Exact but for the gaps that are closed: where rows of control points meet, those of the lowest-numbered
/// cell stay. Error: what stands against it (too large).
Result<JoinedSurface> assemble(const std::vector<Source>& sources, const CellGraph& graph,
                               const Rectangle& rectangle, double tolerance_mm);

/// Of the higher-numbered source when both are joined along the contact alone; infinite when that cannot be.
double deviation_of_contact(const std::vector<Source>& sources, const Contact& contact, double tolerance_mm);

}  // namespace burin::geom::detail
