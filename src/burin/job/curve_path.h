// SPDX-License-Identifier: Apache-2.0
// A NURBS curve (G06.2) as smooth paths.
#pragma once

#include <vector>

#include "burin/geom/quintic.h"
#include "burin/geom/surface/nurbs.h"

namespace burin::job {

struct CurvePiece {
  geom::QuinticPath path;
  geom::QuinticPath parameter;  ///< (t, not a number, 0): what the setpoints say as u and v
};

/// One piece between knots at which the curve is less than C2; the distance from the curve at equal
/// parameters is below `tolerance_mm`.
std::vector<CurvePiece> curve_path(const geom::NurbsCurve& curve, double tolerance_mm);

}  // namespace burin::job
