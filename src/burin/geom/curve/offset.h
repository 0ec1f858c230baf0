// SPDX-License-Identifier: Apache-2.0
// Offset of a plane region bounded by arc splines (Park & Ahn 2007, 4.2 steps 2-4), exact for lines and arcs.
//
// The region is what lies to the left of its contours: outer contours counter-clockwise, holes clockwise,
// islands in holes counter-clockwise again. Growing by d > 0 gives the region of all points within d of it
// (Minkowski sum with a disk: convex corners become arcs of radius d), shrinking by d < 0 the complement of
// the grown complement.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/base/result.h"
#include "burin/geom/curve/arc_spline.h"

namespace burin::geom {

struct OffsetOptions {
  /// Points closer than this are one point; parts of the result thinner than this may be dropped. mm.
  double point_mm = 1e-7;
};

struct OffsetResult {
  /// Closed, simple, pairwise disjoint (they may touch), outer counter-clockwise, holes clockwise; segments
  /// keep the `source` of the input segment they run beside, kCornerSource on arcs about convex corners.
  /// Sorted deterministically.
  std::vector<ArcSpline> contours;
  /// Parallel to `contours`: index of the input contour that gave its first segment.
  std::vector<std::uint32_t> from;
  /// Input contours of which nothing is left in the result (filled holes, eroded parts).
  std::vector<std::uint32_t> vanished;
  /// Number of places where the result was decided within `point_mm` (coincident or touching boundaries).
  std::size_t degenerate_places = 0;
};

/// Preconditions on the contours (checked: geometry error that names the contour): closed, at least two
/// segments, finite, consistent arcs. They may touch within tolerance, but must not cross deeper than
/// point_mm; where they do, only d = 0 keeps its promise and gives the region of positive winding: offset
/// that result (loops that wind negatively would otherwise hide corners, overlaps would shrink too late).
///
/// Guarantees: every point of the result's boundary is at distance |d| of the input's boundary within 1e-6 mm
/// and every point at less than |d| - 1e-6 mm is on the right side of it.
///
/// Cost: O(n log n) for drawings (n segments; more only when n boundary pieces come within d of each other).
Result<OffsetResult> offset_region(const std::vector<ArcSpline>& contours, double d_mm,
                                   const OffsetOptions& options = {});

}  // namespace burin::geom
