// SPDX-License-Identifier: Apache-2.0
// The triangles of a scene in blocks of four under a tree of oriented boxes, eight to a node. Internal to
// plan/orient. See docs/tool-interference.md.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burin/geom/mesh/mesh.h"
#include "burin/plan/orient/scene_kernels.h"

namespace burin::orient::detail {

/// Corners of up to four triangles: [corner][x, y, z][lane]. The last one repeated in lanes without one.
struct alignas(32) ScenePacket {
  double at[3][3][4];
  std::uint32_t triangle[4];
  std::array<geom::Point3, 3> corners(int lane) const {
    const auto corner = [&](int i) { return geom::Point3{at[i][0][lane], at[i][1][lane], at[i][2][lane]}; };
    return {corner(0), corner(1), corner(2)};
  }
};

/// Levels of a tree, at most, and what a walk has to remember.
inline constexpr int kSceneLevels = 100;
inline constexpr int kSceneStack = 7 * kSceneLevels + 8;

/// Of a triangle that is left out.
inline constexpr std::uint32_t kNoPlace = 0xffffffffU;

struct SceneTree {
  std::vector<SceneNode> nodes;  ///< the first is the root; none without triangles
  std::vector<ScenePacket> packets;
  std::vector<std::uint32_t> place;  ///< of a triangle: packet * 4 + lane
};

/// Triangles with corners that do not exist, or are not finite (or beyond 1e15 mm), are left out.
SceneTree build_scene_tree(const geom::Mesh& mesh);

}  // namespace burin::orient::detail
