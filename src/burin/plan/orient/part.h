// SPDX-License-Identifier: Apache-2.0
// The design surface and its obstacles. mm, part frame.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "burin/geom/mesh/mesh.h"
#include "burin/geom/surface/nurbs.h"

namespace burin::orient {

struct DesignFace {
  geom::NurbsSurface surface;
  bool reversed = false;  ///< the tool stands on the side of -(Su x Sv)
  /// Closed polygons in (u, v), outer counter-clockwise, holes clockwise; none: the whole domain.
  std::vector<std::vector<geom::Point2>> trims;
  int number = 0;  ///< in its file, from 1
};

struct Part {
  std::string name;
  std::vector<DesignFace> faces;  ///< none: the design is triangles, contacts come from a file
  geom::Mesh mesh;  ///< everything the tool may not run into: first the design, then the obstacles
  std::size_t design_triangles = 0;
  double deflection_mm = 0;  ///< the design's triangles leave its faces by at most this
  geom::Box3 bounds;         ///< of mesh
};

}  // namespace burin::orient
