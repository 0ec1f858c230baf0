// SPDX-License-Identifier: Apache-2.0
// Proven bounds of the derivatives of a Bezier piece. Internal to geom/surface.
#pragma once

#include "burin/geom/surface/modify.h"

namespace burin::geom::detail {

/// At least the largest |Su|, |Sv|, |Suu|, |Suv|, |Svv| over the piece.
struct SecondBounds {
  double u = 0, v = 0, uu = 0, uv = 0, vv = 0;
};

/// From the control nets of the derivatives; the piece is halved up to so many times as long as that makes
/// the bounds smaller.
inline constexpr int kMostHalvings = 80;
SecondBounds second_bounds(const BezierPatch& patch, int most_halvings = kMostHalvings);

/// The same for the distance from a chord to the surface alone: what runs along the surface does not count,
/// but for the slope of the surface against the mean normal. `all`: second_bounds(). For the inside of a
/// surface; gives `all` back where it is no better.
SecondBounds normal_bounds(const BezierPatch& patch, const SecondBounds& all);

}  // namespace burin::geom::detail
