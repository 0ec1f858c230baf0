// SPDX-License-Identifier: Apache-2.0
// A rotational part as it is drawn: few triangles with normals, and outlines of sections. Private to view.
#pragma once

#include <cstddef>
#include <vector>

#include "burin/geom/vec.h"
#include "burin/plan/rotary/part.h"
#include "burin/view/mesh_shape.h"

namespace burin::view {

/// At most `max_triangles`. A swept part is a grid of its own section; of others the mesh, with vertices that
/// are near each other put together when there are too many triangles (edges keep their own vertices).
Shape drawn_shape(const rotary::Part& part, std::size_t max_triangles);

/// Closed polylines in the plane x = const, (y, z), within `tolerance_mm` of the mesh's own section.
using Outline = std::vector<std::vector<geom::Point2>>;
std::vector<Outline> outlines(const rotary::Part& part, const std::vector<double>& stations,
                              double tolerance_mm);

}  // namespace burin::view
