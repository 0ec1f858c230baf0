// SPDX-License-Identifier: Apache-2.0
// Oriented boxes that fit patches of surface: thin along the mean normal. Internal to plan/orient.
#pragma once

#include <array>
#include <cstddef>
#include <functional>

#include "burin/geom/vec.h"
#include "burin/plan/orient/scene_kernels.h"

namespace burin::orient::detail {

/// Longest direction first, thinnest last; orthonormal up to rounding.
struct FittedBox {
  geom::Point3 middle;
  std::array<geom::Vec3, 3> axis;
  std::array<double, 3> half{};
};

using TriangleAt = std::function<std::array<geom::Point3, 3>(std::size_t)>;
/// `roughly`: of a sample of many; need not hold the others.
FittedBox fit_box(std::size_t count, const TriangleAt& triangle, bool roughly = false);

/// Writes the box into a lane, rounded outwards.
void put_box(const FittedBox& box, const geom::Point3& origin, int lane, SceneNode& node);

}  // namespace burin::orient::detail
