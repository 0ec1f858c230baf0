// SPDX-License-Identifier: Apache-2.0
// Many sections x = const of one mesh: the triangles are sorted into slabs along X, each section asks only
// its own slab.
#pragma once

#include <cstdint>
#include <list>
#include <vector>

#include "burin/geom/mesh/slice.h"
#include "burin/plan/rotary/part.h"

namespace burin::rotary::detail {

/// A loop of a section as contacts, u from where it passes the angle 0 (+Y); closed: the first is not
/// repeated.
struct MeshRing {
  std::vector<Contact> points;
  bool closed = false;
  double length = 0;
};
/// By u (0 .. 1): a closed ring goes round.
Contact at_u(const MeshRing& ring, double u);

class Slicer {
 public:
  explicit Slicer(const Part& part, double ball_radius, double density);

  /// The loops at x, in a fixed order; at the ends of the part those just inside.
  std::vector<MeshRing> rings(double x);

 private:
  struct Slab {
    std::size_t number = 0;
    geom::Mesh mesh;
    std::vector<std::array<geom::Vec3, 3>> normals;
  };
  const Slab& slab_at(double x);

  const Part& part_;
  double radius_, density_;
  double lo_ = 0, width_ = 1;
  std::vector<std::vector<std::uint32_t>> triangles_;  ///< by slab
  std::list<Slab> recent_;                             ///< the last used first
};

}  // namespace burin::rotary::detail
