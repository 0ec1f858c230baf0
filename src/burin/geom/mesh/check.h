// SPDX-License-Identifier: Apache-2.0
// What a mesh is worth before anything is planned on it: holes, edges shared by more than two triangles,
// sense, and normals at its corners. mm.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "burin/geom/mesh/mesh.h"

namespace burin::geom {

/// A closed chain of edges that only one triangle has.
struct MeshHole {
  std::vector<Point3> points;
  Box3 box;
};

struct MeshReport {
  Box3 bounds;
  double signed_volume =
      0;  ///< mm^3, positive when triangles are counter-clockwise from outside (closed meshes)
  std::vector<MeshHole> holes;
  std::size_t shared_by_many = 0;  ///< edges of more than two triangles
  std::size_t against_sense = 0;   ///< edges whose two triangles run the same way
  std::size_t degenerate = 0;      ///< triangles without area
};
MeshReport examine(const Mesh& mesh);

/// Vertices nearer than `tolerance_mm` become one, triangles without area go, the rest keeps its order.
Mesh welded(const Mesh& mesh, double tolerance_mm);
/// Turns triangles so that neighbours agree and every closed shell has its outside outwards. False when that
/// is impossible (a Moebius strip, edges shared by many).
bool orient(Mesh& mesh);

/// For each corner of each triangle the mean of the normals around its vertex, weighted by angle, over the
/// fan of triangles that meet across edges bent by less than `crease_rad`; a crease keeps one normal a side.
std::vector<std::array<Vec3, 3>> corner_normals(const Mesh& mesh, double crease_rad);

}  // namespace burin::geom
