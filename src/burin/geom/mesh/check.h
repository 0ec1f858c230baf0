// SPDX-License-Identifier: Apache-2.0
// What a mesh is worth before anything is planned on it: holes, edges shared by more than two triangles,
// sense, and normals at its corners. mm.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "burin/geom/mesh/mesh.h"

namespace burin::geom {

/// A closed chain of edges that only one triangle has. (Beside edges that many triangles share it may be
/// open: then its last point is not its first neighbour.)
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

/// In their order, vertices no farther than `tolerance_mm` from one that stays become that one (0: the same
/// place). Triangles that lose a corner go, and of triangles with the same corners one stays, none when they
/// face each other; the rest keeps its order. Triangles without area but with three corners stay: they close
/// the mesh.
Mesh welded(const Mesh& mesh, double tolerance_mm);
/// Closes gaps narrower than `tolerance_mm`: open corners no farther apart become one, and open edges that
/// pass an open corner within it are bent through the corner (T-junctions), narrow holes that stay are
/// filled. What is closed already stays.
Mesh stitched(const Mesh& mesh, double tolerance_mm);
/// Turns triangles so that neighbours agree and every outermost shell has its outside outwards; a shell
/// within keeps its sense against the outermost one (hollows stay hollow). False, and the mesh as it was,
/// when that is impossible (a Moebius strip, edges shared by many).
bool orient(Mesh& mesh);

/// For each corner of each triangle the mean of the normals around its vertex, weighted by angle, over the
/// fan of triangles that meet across edges bent by less than `crease_rad`; a crease keeps one normal a side.
/// Triangles too low to have a normal of their own are looked through; (0, 0, 0) where there are only such.
std::vector<std::array<Vec3, 3>> corner_normals(const Mesh& mesh, double crease_rad);

}  // namespace burin::geom
