// SPDX-License-Identifier: Apache-2.0
// Boxes over triangles, halved at the median. Internal to verify.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burin/geom/mesh/mesh.h"

namespace burin::verify {

class TriangleTree {
 public:
  explicit TriangleTree(const geom::Mesh& mesh);

  struct Node {
    geom::Point3 center;
    geom::Vec3 half;
    geom::Vec3 normal;           ///< unit: the mean of the triangles', by area
    double most = 0, least = 0;  ///< of normal . (place - center)
    std::uint32_t first = 0;  ///< leaf: into triangles(); inner: the first of two children next to each other
    std::uint32_t count = 0;  ///< of triangles; 0: inner
  };
  struct Triangle {
    std::array<geom::Point3, 3> corners;
    std::uint32_t index = 0;  ///< in the mesh
  };
  /// nodes()[0] is the root; none without triangles.
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  void lay_plane(Node& node, std::uint32_t begin, std::uint32_t end) const;
  void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
};

}  // namespace burin::verify
