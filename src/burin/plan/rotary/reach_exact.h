// SPDX-License-Identifier: Apache-2.0
// One triangle against one piece of the tool without any assumption: the angles at which they may touch from
// outside are all written down, and between two neighbours of them the middle decides. Slow and sure: for the
// cases that the kernels (reach_kernels.h) leave, and to check them. Internal to plan/rotary.
#pragma once

#include <array>
#include <limits>

#include "burin/geom/vec.h"
#include "burin/plan/rotary/reach_arcs.h"

namespace burin::rotary::detail {

/// A cylinder about the tool axis from h0 to h1, heights from the ball's centre.
struct Piece {
  double h0 = 0, h1 = std::numeric_limits<double>::infinity();
  double radius = 0;
};

/// Corners relative to the ball's centre.
using Corners = std::array<geom::Vec3, 3>;

/// Whether the triangle has points inside the piece when the axis stands at the angle of (cosine, sine).
bool touches(const Corners& triangle, const Piece& piece, double cosine, double sine);

/// Adds the angles at which the triangle meets the piece.
void forbid_exactly(const Corners& triangle, const Piece& piece, Arcs& arcs);

}  // namespace burin::rotary::detail
