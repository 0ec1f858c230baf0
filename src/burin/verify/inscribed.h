// SPDX-License-Identifier: Apache-2.0
// How far the material below a place of the surface is that place's own. Internal to verify. mm.
// docs/verify-deviation.md
//
// A gouge is as deep as what is gone lies below the surface: below the nearest place of it. Beside an edge
// the normal of one face runs along the other: a cutter that takes 0.005 mm off the other face takes 0.2 mm
// of that normal. So the depth along a normal counts as far as the ball about p - D n through p holds no
// other place of the surface (up to the medial axis).
#pragma once

#include <algorithm>

#include "burin/geom/mesh/mesh_index.h"

namespace burin::verify {

class Inscribed {
 public:
  explicit Inscribed(const geom::Mesh& mesh) : index_(mesh) {}

  /// The depth below p that counts, at most `depth`.
  double own(geom::Point3 p, geom::Vec3 n, double depth, double accuracy) const {
    if (depth <= accuracy || counts(p, n, depth)) return depth;
    // The balls through p lie within each other: what holds for one holds for all smaller ones.
    double low = 0, high = depth;
    while (high - low > 0.25 * accuracy) {
      const double middle = 0.5 * (low + high);
      (counts(p, n, middle) ? low : high) = middle;
    }
    return low;
  }
  /// No place within `radius` of one that lies `depth` below its own place counts.
  bool none_counts(geom::Point3 sunk, double radius, double depth) const {
    const double within = kOwn * depth - radius;
    return within > 0 && index_.nearest(sunk, within).has_value();
  }

 private:
  // Facets and blended normals: neighbouring triangles turned by up to 11 degrees against n are p's own.
  static constexpr double kOwn = 0.98;
  bool counts(geom::Point3 p, geom::Vec3 n, double depth) const {
    return !none_counts(p - depth * n, 0, depth);
  }
  geom::MeshIndex index_;
};

}  // namespace burin::verify
