// SPDX-License-Identifier: Apache-2.0
// One triangle against one piece of the tool, exactly: the tool's frame, double precision. Internal to
// plan/orient. See docs/tool-interference.md.
#pragma once

#include <array>

#include "burin/geom/vec.h"

namespace burin::orient::detail {

/// x, y across the tool axis, h along it above the tip centre.
struct Local {
  double x = 0, y = 0, h = 0;
};
using Corners = std::array<Local, 3>;

struct Piece {
  double radius = 0, from = 0, to = 0, grow = 0;
};

/// Negative: the point blocks. grow > 0: distance from the cylinder less `grow`; else how far outside of the
/// cylinder (inside: of its nearest face), as the largest of the distances from its three faces.
double excess(const Local& q, const Piece& piece);

/// Whether some point of the triangle has a negative excess.
bool meets(const Corners& t, const Piece& piece);

/// value < 0 exactly when meets(): the least distance from the axis less the radius, of what lies in the
/// slab (grow 0), or the least excess. Then `at` is a place of the triangle that blocks, a deep one.
struct Deepest {
  double value = 0;
  Local at;
};
Deepest deepest(const Corners& t, const Piece& piece);

}  // namespace burin::orient::detail
