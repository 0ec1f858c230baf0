// SPDX-License-Identifier: Apache-2.0
// The material before the first cut. mm, part frame.
#pragma once

#include <variant>

#include "burin/base/result.h"
#include "burin/geom/mesh/mesh.h"
#include "burin/geom/vec.h"

namespace burin::removal {

struct BlockStock {
  geom::Point3 lo, hi;
};
struct CylinderStock {
  geom::Point3 base;         ///< centre of one end
  geom::Vec3 axis{1, 0, 0};  ///< unit, to the other end
  double radius = 0, length = 0;
};
/// Closed, triangles counter-clockwise from outside.
struct MeshStock {
  geom::Mesh mesh;
};
using Stock = std::variant<BlockStock, CylinderStock, MeshStock>;

/// Error (range, geometry): numbers not finite or not positive, a mesh that is open or inside out (says how
/// many edges; names what would be accepted).
Result<void> validate(const Stock& stock);
geom::Box3 bounds(const Stock& stock);

}  // namespace burin::removal
