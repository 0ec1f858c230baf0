// SPDX-License-Identifier: Apache-2.0
// Internal to joining: what is measured on the result.
#pragma once

#include <functional>
#include <vector>

#include "burin/geom/surface/join.h"

namespace burin::geom::detail {

/// Along the whole line: tangent planes within 1e-6 rad are G1, normal curvatures across it within 1e-4 G2.
Continuity continuity_along(const NurbsSurface& surface, Direction direction, double at);

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

/// The largest of `distance_at` over 9 x 9 places in every span of the surface, and uphill from there.
/// `distance_at` may stop early with a value that is not above `most`.
double largest_over(const NurbsSurface& surface, const Region& region,
                    const std::function<double(Point2 at, double most)>& distance_at, double negligible_mm);

/// Distance of p to the surface, by Newton from (u, v): never more than from there.
double local_distance(const NurbsSurface& surface, Point3 p, Point2 start);

}  // namespace burin::geom::detail
