// SPDX-License-Identifier: Apache-2.0
// Contours as arc splines. Internal to the laser planner.
#pragma once

#include <vector>

#include "burin/plan/laser/profile.h"

namespace burin::laser::detail {

/// The contour in its drawn direction, its curves fitted so that their offset by `offset_mm` to the right of
/// the drawn direction is certified within `tolerance_mm`; ends moved onto the joints. Appends to `pieces`;
/// Segment::source is an index into it.
Result<geom::ArcSpline> outline_of(const Contour& contour, const io::Drawing& drawing, double offset_mm,
                                   double tolerance_mm, const LaserOptions& options,
                                   std::vector<Piece>& pieces);

/// Whether any of its curves needs a fit.
bool has_free_curves(const Contour& contour);

}  // namespace burin::laser::detail
