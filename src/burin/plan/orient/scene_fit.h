// SPDX-License-Identifier: Apache-2.0
// Oriented boxes that fit patches of surface: thin along the mean normal. Internal to plan/orient.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "burin/geom/mesh/mesh.h"
#include "burin/geom/vec.h"
#include "burin/plan/orient/scene_kernels.h"

namespace burin::orient::detail {

/// Longest direction first, thinnest last; orthonormal up to rounding.
struct FittedBox {
  geom::Point3 middle;
  std::array<geom::Vec3, 3> axis;
  std::array<double, 3> half{};
};

/// Of at least one triangle. Directions are chosen from `sample` of them at most; extents are those of all.
FittedBox fit_box(const geom::Mesh& mesh, std::span<const std::uint32_t> triangles, std::size_t sample);

/// Writes the box into a lane, rounded outwards.
void put_box(const FittedBox& box, const geom::Point3& origin, int lane, SceneNode& node);

}  // namespace burin::orient::detail
