// SPDX-License-Identifier: Apache-2.0
// The NURBS part of curve.h (Piegl & Tiller, The NURBS Book, chapters 2-5). Internal to geom/curve.
#pragma once

#include "burin/geom/curve/curve.h"

namespace burin::geom {

inline constexpr int kMaxDegree = 25;

Result<void> validate_nurbs(const Nurbs2& n);
/// Point and `order` (0..2) derivatives with respect to t in [0, 1]; at an inner knot the piece to the right
/// counts.
Derivatives2 nurbs_derivatives(const Nurbs2& n, double t, int order);
/// Clamped curve over [t0, t1] of the unit parameter, by knot insertion: the shape does not change.
Nurbs2 nurbs_part(const Nurbs2& n, double t0, double t1);
std::vector<double> nurbs_corners(const Nurbs2& n, double tangent_rad);

}  // namespace burin::geom
