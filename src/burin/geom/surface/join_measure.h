// SPDX-License-Identifier: Apache-2.0
// Internal to joining: what is measured on the result.
#pragma once

#include <vector>

#include "burin/geom/surface/join.h"

namespace burin::geom::detail {

/// Along the whole line: tangent planes within 1e-6 rad are G1, normal curvatures across it within 1e-4 G2.
Continuity continuity_along(const NurbsSurface& surface, Direction direction, double at);

/// Deviations below this share of the tolerance are as good as none: no closer look.
inline constexpr double kNegligible = 1e-3;

/// A rectangle of parameters.
struct Region {
  Interval u, v;
};
/// Largest distance between `joined` over `region` and `source` over what `map` makes of it, both ways. 9 x 9
/// points in every span; where corresponding points are farther apart than `negligible_mm`, the nearest place
/// by Newton counts.
double distance_by_samples(const NurbsSurface& joined, const Region& region, const NurbsSurface& source,
                           const Member& map, double negligible_mm);

/// Largest distance between a surface and parts that replace it; maps lead from each part to the whole.
/// Sampled in the same way, both ways.
double distance_to_parts(const NurbsSurface& whole, const std::vector<NurbsSurface>& parts,
                         const std::vector<Member>& maps, double negligible_mm);

}  // namespace burin::geom::detail
