// SPDX-License-Identifier: Apache-2.0
// Building of the tree that MeshIndex asks. Internal to geom/mesh.
#pragma once

#include <vector>

#include "burin/geom/mesh/mesh.h"
#include "burin/geom/mesh/tree_kernels.h"

namespace burin::geom::detail {

/// Coordinates beyond this (mm) and triangles with them are left aside: single precision holds their squares.
inline constexpr double kTreeLargest = 1e12;

struct MeshTree {
  std::vector<TreeNode> nodes;  ///< [0] is the root; none without triangles
  std::vector<TreePacket> packets;
  Box3 bounds;    ///< of the triangles in it
  Point3 center;  ///< of bounds: the origin of the nodes' boxes
};

/// Splits by surface area (binned), four triangles a packet. Corners that do not exist or are not finite
/// leave their triangle aside.
MeshTree build_tree(const Mesh& mesh);

/// c about the centre rounded down and up; everything when it is too far for single precision.
TreePlace place_in(const MeshTree& tree, Point3 c);

}  // namespace burin::geom::detail
