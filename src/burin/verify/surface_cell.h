// SPDX-License-Identifier: Apache-2.0
// A part of a triangle with a normal at each corner. Internal to verify. mm.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "burin/geom/mesh/mesh.h"
#include "burin/verify/deviation.h"

namespace burin::verify {

struct Patch {
  std::array<geom::Point3, 3> p;
  std::array<geom::Vec3, 3> n;  ///< unit

  geom::Point3 middle() const { return lerp(lerp(p[0], p[1], 0.5), p[2], 1.0 / 3); }
  geom::Vec3 normal() const { return unit(n[0] + n[1] + n[2]); }
  /// Of the flat triangle, unit.
  geom::Vec3 plane() const { return unit(cross(p[1] - p[0], p[2] - p[0])); }
  double area() const { return 0.5 * norm(cross(p[1] - p[0], p[2] - p[0])); }
  /// No place is farther from the middle.
  double radius() const {
    const geom::Point3 m = middle();
    return std::max({distance(m, p[0]), distance(m, p[1]), distance(m, p[2])});
  }
  /// How far, for each mm of height above the patch, p + h n between the corners can be from what the corners
  /// say: every halving of a side that turns by a puts the normal in its middle a^2 / 8 beside the mean of
  /// its ends, and two halvings halve all sides, so that the sum is at most 8 / 3 of that.
  double bulge() const {
    const geom::Vec3 a = n[1] - n[0], b = n[2] - n[1], c = n[0] - n[2];
    return std::max({dot(a, a), dot(b, b), dot(c, c)}) / 3;
  }
  /// Both parts when side `at` (from corner at to the next) is cut at `share` of it; the first one holds its
  /// first corner.
  std::array<Patch, 2> parts(std::size_t at, double share) const {
    const std::size_t j = (at + 1) % 3, k = (at + 2) % 3;
    const geom::Point3 m = lerp(p[at], p[j], share);
    const geom::Vec3 sum = (1 - share) * n[at] + share * n[j];
    const geom::Vec3 between = norm(sum) > 0 ? unit(sum) : n[at];
    return {Patch{{p[at], m, p[k]}, {n[at], between, n[k]}}, Patch{{m, p[j], p[k]}, {between, n[j], n[k]}}};
  }
  /// Both halves of the longest side.
  std::array<Patch, 2> halves() const {
    std::size_t at = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (distance(p[i], p[(i + 1) % 3]) > distance(p[at], p[(at + 1) % 3])) at = i;
    return parts(at, 0.5);
  }
};

/// A normal of a vertex that is none, or points to the other side of the triangle, is replaced by the
/// triangle's.
inline Patch patch_of(const geom::Mesh& mesh, const std::vector<geom::Vec3>& normals, std::size_t triangle) {
  Patch patch;
  const auto& t = mesh.triangles[triangle];
  for (std::size_t i = 0; i < 3; ++i) patch.p[i] = mesh.vertices[t[i]];
  const geom::Vec3 flat = patch.plane();
  for (std::size_t i = 0; i < 3; ++i) {
    patch.n[i] = flat;
    if (normals.empty()) continue;
    const geom::Vec3 n = unit(normals[t[i]]);
    if (dot(n, flat) > 0) patch.n[i] = n;
  }
  return patch;
}
inline Patch patch_of(const geom::Mesh& mesh, const std::vector<geom::Vec3>& normals,
                      const SurfaceCell& cell) {
  Patch patch = patch_of(mesh, normals, cell.triangle);
  int bit = 63;
  while (bit > 0 && !(cell.path >> bit & 1)) --bit;
  while (bit > 0) patch = patch.halves()[cell.path >> --bit & 1];
  return patch;
}

}  // namespace burin::verify
