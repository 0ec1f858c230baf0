// SPDX-License-Identifier: Apache-2.0
// Meshes as they are drawn: few triangles with normals. Private to view.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "burin/geom/mesh/mesh.h"

namespace burin::view {

/// Triangles, three corners each. Only for looking at.
struct Shape {
  std::vector<geom::Point3> points;
  std::vector<geom::Vec3> normals;
};

/// A mesh with fewer triangles, and the triangle each came from.
struct ReducedMesh {
  geom::Mesh mesh;
  std::vector<std::size_t> source;
  /// Of each vertex of the whole mesh: the vertex it became, or kGone.
  std::vector<std::uint32_t> became;
  static constexpr std::uint32_t kGone = 0xffffffffu;
};
/// Triangles `first` to `end` of the mesh; where they are more than max_triangles, vertices that are near
/// each other are put together (edges keep their own vertices).
ReducedMesh reduced(const geom::Mesh& mesh, std::size_t first, std::size_t end, std::size_t max_triangles);

/// The reduced mesh with the normals of the whole one: each corner has the mean over the triangles about the
/// vertex it came from that meet its own below the angle of a crease.
Shape shaded(const geom::Mesh& mesh, const ReducedMesh& reduced);

}  // namespace burin::view
