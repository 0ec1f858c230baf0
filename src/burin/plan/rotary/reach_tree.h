// SPDX-License-Identifier: Apache-2.0
// The triangles of a part in blocks of four, under boxes in blocks of four. Boxes are turned about X so that
// they lie flat on the faces in them: seen from a ball that touches a face, the rest of the face must not
// stick out. Internal to plan/rotary.
#pragma once

#include <vector>

#include "burin/geom/mesh/mesh.h"
#include "burin/plan/rotary/reach_kernels.h"

namespace burin::rotary::detail {

struct ReachTree {
  std::vector<NodeBlock> nodes;  ///< the first is the root; empty when there are no triangles
  std::vector<LeafBlock> leaves;
  double size = 0;  ///< largest coordinate
};

/// Triangles with corners that do not exist or are not finite are left out. The tree, and the numbers in it,
/// do not depend on the order of the triangles, nor of the corners in each.
ReachTree make_reach_tree(const geom::Mesh& mesh);

}  // namespace burin::rotary::detail
