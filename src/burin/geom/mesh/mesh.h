// SPDX-License-Identifier: Apache-2.0
// Indexed triangle meshes. mm. Triangles are counter-clockwise seen from outside.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::geom {

struct Mesh {
  std::vector<Point3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

}  // namespace burin::geom
