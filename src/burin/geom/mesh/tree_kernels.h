// SPDX-License-Identifier: Apache-2.0
// The walks through the tree of a MeshIndex, compiled twice: for any processor and for AVX2. Both do the same
// operations in the same order on every number (no fused multiply-add), so their results are the same bits;
// which one runs is decided once by the processor. Plain C types only: nothing inline may be shared with
// other translation units, or code for AVX2 could end up in the program for all. Internal to geom/mesh.
#pragma once

namespace burin::geom::detail {

/// Eight children: boxes in single precision, rounded outwards, about the tree's centre. Unused ones are
/// empty (lo = +infinity, hi = -infinity). child >= 0: a node; else ~child is a packet.
struct alignas(32) TreeNode {
  float lo[3][8];
  float hi[3][8];
  int child[8];
};

/// Up to four triangles (the last repeated), each in a frame of its own: the longest edge from `a` along the
/// unit vector u for `base`, the third corner at (px, py) with v perpendicular to u, py >= 0. That keeps its
/// accuracy for needles and for triangles without area, where no normal can be had from the corners.
struct alignas(32) TreePacket {
  double a[3][4], u[3][4], v[3][4];
  double base[4], px[4], py[4];
  double side1[4], side2[4];  ///< 1 / length^2 of the sides from (0, 0) and (base, 0) to (px, py); 0 for 0
  unsigned triangle[4];
};

struct TreeView {
  const TreeNode* nodes;
  const TreePacket* packets;
  const double* vertices;     ///< x, y, z
  const unsigned* triangles;  ///< three corners
};

/// The place in double precision, and about the tree's centre rounded down and up.
struct TreePlace {
  double c[3];
  float lo[3], hi[3];
};

struct TreeNearest {
  double distance2;  ///< in: only what is nearer or as near; out: of what was found
  unsigned triangle, packet;
  int lane;  ///< -1: nothing found
};

/// Levels of a tree at most (see mesh_tree.cpp), and what a walk has to remember.
inline constexpr int kTreeLevels = 40;
inline constexpr int kTreeStack = 7 * kTreeLevels + 8;

struct TreeKernels {
  /// Of equally near triangles the lowest.
  void (*nearest)(const TreeView&, const TreePlace&, TreeNearest&);
  /// Sum over the triangles above the place (in +Z): 1 where they face up, -1 where down. A line through
  /// edges and corners is taken as slightly beside them, the same for all triangles that meet there.
  int (*turns_above)(const TreeView&, const TreePlace&);
};
const TreeKernels& tree_kernels_any();
/// The same as tree_kernels_any() when the build or the processor has no AVX2.
const TreeKernels& tree_kernels_avx2();

}  // namespace burin::geom::detail
