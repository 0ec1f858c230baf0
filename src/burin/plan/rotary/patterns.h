// SPDX-License-Identifier: Apache-2.0
// The two ways to contact paths: from the sweep itself, from sections of the mesh.
#pragma once

#include "burin/plan/rotary/part.h"

namespace burin::rotary::detail {

Result<PatternResult> swept_paths(const SweptSection& swept, const PatternOptions& options);
Result<PatternResult> meshed_paths(const Part& part, const PatternOptions& options, Diagnostics& diagnostics);

/// More than allowed: says how many, and with which scallop (or side step) it would do.
Error too_many(const PatternOptions& options, double paths, double points_a_path);

/// The side step that a flat surface takes for the cusp.
double flat_step(double ball_radius, double scallop);

}  // namespace burin::rotary::detail
