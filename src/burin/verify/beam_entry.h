// SPDX-License-Identifier: Apache-2.0
// Where a ray enters what a disc sweeps along a line or an arc, for one ray and for all rays of a stretch.
// Internal to the check of beams. mm. docs/verify-beam.md
#pragma once

#include "burin/verify/flat.h"

namespace burin::verify {

/// The least s >= 0 at which p + s n (n a unit vector) is within `radius` of `piece`; flat::kNever when there
/// is none.
double entry_of(flat::Point2 p, flat::Vec2 n, const flat::Segment& piece, double radius);
/// None of the rays from the points of `s` along its outward normals enters later than this; flat::kNever
/// when that cannot be said.
double latest_entry(const flat::Segment& s, const flat::Segment& piece, double radius);

}  // namespace burin::verify
