// SPDX-License-Identifier: Apache-2.0
// How near the part comes to the tool's axis at one pose: what shank and holder are measured with along a
// move (ReachIndex answers for all angles at once, this one for one angle, and says how much room there is).
// mm.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "burin/geom/mesh/mesh.h"

namespace burin::rotary {

/// A tree of boxes over the triangles. Immutable: any number of threads may ask.
class BodyIndex {
 public:
  explicit BodyIndex(const geom::Mesh& mesh);

  /// The smallest distance, from the line through `center` along (0, sin theta, cos theta), of the part that
  /// lies at heights low to high above the centre; `within` when nothing there is nearer.
  double to_axis(geom::Point3 center, double theta, double low, double high, double within) const;
  /// Largest distance of a vertex from the X axis.
  double radius() const { return radius_; }

 private:
  struct Node {
    geom::Point3 middle;
    geom::Vec3 half;
    std::uint32_t first = 0, count = 0;  ///< triangles of a leaf
    std::uint32_t right = 0;             ///< the other child follows the node
  };
  struct Frame;
  using Triangle = std::array<geom::Point3, 3>;
  void build(std::uint32_t first, std::uint32_t end);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
  double radius_ = 0;
};

}  // namespace burin::rotary
