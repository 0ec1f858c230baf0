// SPDX-License-Identifier: Apache-2.0
// Evaluation of a piece held as Bezier points: all weights of the sums are positive, so that the weight w
// keeps its relative accuracy however far the weights of the control points differ. Slower than powers; any
// degree. Internal to geom/surface.
#pragma once

#include "burin/geom/surface/kernels.h"

namespace burin::geom::detail {

/// `order` 0: Point3 (3 numbers), 2: SurfaceDerivatives (18), 3: SurfaceDerivatives3 (30).
void bernstein(const Piece& piece, double u, double v, int order, double* out);

}  // namespace burin::geom::detail
