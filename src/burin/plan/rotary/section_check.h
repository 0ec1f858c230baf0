// SPDX-License-Identifier: Apache-2.0
// Whether a drawn section can be a part around the X axis.
#pragma once

#include "burin/base/result.h"
#include "burin/geom/curve/arc_spline.h"

namespace burin::rotary::detail {

/// The section as it is worked with: counter-clockwise, without segments of no length. Error (geometry), with
/// the place: open, crossing or touching itself, too small, axis not inside by more than `margin_mm`.
Result<geom::ArcSpline> checked_section(const geom::ArcSpline& section, double margin_mm);

}  // namespace burin::rotary::detail
