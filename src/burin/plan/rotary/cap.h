// SPDX-License-Identifier: Apache-2.0
// A simple polygon cut into triangles with no vertices but its own: the ends of a part.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::rotary::detail {

/// Ear clipping, vertices that stand in the way looked up in a grid: about n log n for sections as they
/// occur. n - 2 triangles of indices into `polygon`, counter-clockwise like the polygon. A polygon that
/// touches itself still gives n - 2 triangles (some of them folded), so that a mesh closed with them is
/// closed.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<geom::Point2>& polygon);

}  // namespace burin::rotary::detail
