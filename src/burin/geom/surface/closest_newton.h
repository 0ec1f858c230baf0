// SPDX-License-Identifier: Apache-2.0
// Local search for the closest point: Newton within the parts of the surface that are twice continuously
// differentiable, from part to part while the distance falls. Internal to geom/surface.
#pragma once

#include <vector>

#include "burin/geom/surface/closest.h"
#include "burin/geom/surface/evaluate.h"

namespace burin::geom::detail {

class Newton {
 public:
  explicit Newton(const NurbsSurface& surface);
  SurfacePoint refine(const NurbsSurface& surface, Point3 p, double u, double v) const;

 private:
  /// Knots where the second derivative may jump, with both ends of the domain.
  std::vector<double> walls_u_, walls_v_;
};

}  // namespace burin::geom::detail
