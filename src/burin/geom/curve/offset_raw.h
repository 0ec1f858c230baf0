// SPDX-License-Identifier: Apache-2.0
// From contours to the raw curves of an offset: closed curves whose winding number counts how often a point
// is covered by the region and by the strips and sectors swept beside its boundary.
#pragma once

#include <vector>

#include "burin/base/result.h"
#include "burin/geom/curve/box_tree.h"

namespace burin::geom::detail {

/// Largest coordinate (and |offset|) taken, mm: the rounding of doubles there is still well below 1e-9 mm
/// times the margin that the arrangement keeps.
inline constexpr double kMaxCoordinate = 1e7;

/// Checked and put into the order and form in which the raw curves are made: arcs of at most a half turn, no
/// segment shorter than `point_mm`, ends that meet bit by bit.
struct CleanContours {
  std::vector<Segment> segments;
  std::vector<std::uint32_t> first;    ///< contour k is segments [first[k], first[k + 1])
  std::vector<std::uint32_t> contour;  ///< its index in the input
  double scale = 1;                    ///< largest coordinate or radius, mm

  std::size_t count() const { return contour.size(); }
};
/// `reverse`: every contour backwards, so that the complement lies to the left.
Result<CleanContours> clean_contours(const std::vector<ArcSpline>& contours, double point_mm, bool reverse);

/// Raw curves of growing by d >= 0. With w the winding number of the clean contours about p and c(p) the
/// number of strips (segment i swept by d to its right) and of sectors (about convex vertices) that hold p,
/// their winding number is w + c, except that at concave vertices what both neighbouring strips cover may be
/// counted once: where it is positive is unchanged. A gap up to `join_mm` between neighbouring pieces is
/// smooth.
RawCurves raw_curves(const CleanContours& contours, double d, double join_mm);

}  // namespace burin::geom::detail
