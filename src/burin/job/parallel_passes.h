// SPDX-License-Identifier: Apache-2.0
// What parallel passes, the usual finishing of other CAM systems, would need: the length to compare with.
#pragma once

#include <optional>

#include "burin/geom/surface/join.h"

namespace burin::job {

/// Length on the surfaces of passes in parallel vertical planes (along X or Y, the shorter), a constant
/// distance apart that leaves at most `scallop` (mm) at the worst place, as ball-end passes of that radius
/// over the untrimmed surfaces. By the co-area formula: passes of distance p in y have the length (1/p) *
/// integral of sqrt(1 - n_y^2) over the surface, and their distance on the surface is p / sqrt(1 - n_y^2).
/// Sampled. Nothing when a place would need more than a thousand times as many passes as a plane.
std::optional<double> parallel_length(const geom::Composite& composite, double radius, double scallop,
                                      std::optional<double> side_step);

}  // namespace burin::job
