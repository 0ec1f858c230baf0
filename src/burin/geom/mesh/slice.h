// SPDX-License-Identifier: Apache-2.0
// Sections of a mesh with planes x = const. mm.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burin/geom/mesh/mesh.h"

namespace burin::geom {

/// A place where the plane crosses an edge of the mesh. `normal` is that of the surface there on the side of
/// the piece that begins at this place (corner normals interpolated along the edge); where the piece before
/// has another one (a crease), `normal_before` differs from it.
struct SlicePoint {
  Point3 p;
  Vec3 normal, normal_before;
  std::uint32_t triangle = 0;  ///< of the piece that begins here
};
/// Counter-clockwise about +X (from +Y to +Z) when it bounds material inside; holes run clockwise.
struct SliceLoop {
  std::vector<SlicePoint> points;
  bool closed = false;  ///< open where the mesh has a hole
};
/// In a fixed order: by the lowest triangle number; closed loops begin there. An open one has the place where
/// it ends as its last point. Points at the same place are one. Vertices exactly in the plane count as lying
/// above it, so that a plane through an end face gives the loop just inside or nothing, never a broken one.
std::vector<SliceLoop> slice_x(const Mesh& mesh, const std::vector<std::array<Vec3, 3>>& normals, double x);

/// The same for many planes: knows which triangles may cross one. Keeps references to mesh and normals.
class Slicer {
 public:
  Slicer(const Mesh& mesh, const std::vector<std::array<Vec3, 3>>& normals);
  std::vector<SliceLoop> at(double x) const;

 private:
  const Mesh* mesh_;
  const std::vector<std::array<Vec3, 3>>* normals_;
  double lo_ = 0, scale_ = 0;                ///< bin of x: (x - lo) * scale
  std::vector<std::uint32_t> start_, list_;  ///< triangles that reach into each bin
};

}  // namespace burin::geom
