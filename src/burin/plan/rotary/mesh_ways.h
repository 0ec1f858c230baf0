// SPDX-License-Identifier: Apache-2.0
// Spiral and lines on a general part. Both need sections of one piece around the axis.
#pragma once

#include <vector>

#include "burin/plan/rotary/patterns.h"

namespace burin::rotary::detail {

/// The side step that is asked for, or that of a flat surface.
double flat_or_side_step(const PatternOptions& options);

/// Climbs from ring to ring; `xs` are the places of the rings, `result` carries their figures.
Result<PatternResult> mesh_spiral(const Part& part, const PatternOptions& options,
                                  const std::vector<double>& xs, PatternResult result);
Result<PatternResult> mesh_lines(const Part& part, const PatternOptions& options);

}  // namespace burin::rotary::detail
