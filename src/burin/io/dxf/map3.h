// SPDX-License-Identifier: Apache-2.0
// Affine maps of space, for chains of block insertions and entity coordinate systems.
#pragma once

#include <cmath>

#include "burin/geom/vec.h"

namespace burin::io::dxf {

/// p -> o + p.x * x + p.y * y + p.z * z.
struct Map3 {
  geom::Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  geom::Point3 o{0, 0, 0};

  geom::Vec3 operator()(geom::Vec3 v) const { return v.x * x + v.y * y + v.z * z; }
  geom::Point3 operator()(geom::Point3 p) const { return o + (p.x * x + p.y * y + p.z * z); }

  static Map3 scale(double sx, double sy, double sz) {
    return {{sx, 0, 0}, {0, sy, 0}, {0, 0, sz}, {0, 0, 0}};
  }
  static Map3 shift(geom::Vec3 v) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {v.x, v.y, v.z}}; }
  static Map3 turn_z(double degrees);
};

/// First `inner`, then `outer`.
inline Map3 operator*(const Map3& outer, const Map3& inner) {
  return {outer(inner.x), outer(inner.y), outer(inner.z), outer(inner.o)};
}

/// Quarter turns come out exact, so that axis-parallel parts stay so.
inline Map3 Map3::turn_z(double degrees) {
  const double turned = std::fmod(degrees, 360.0);
  const double quarter = turned / 90.0;
  double c = std::cos(geom::radians(turned)), s = std::sin(geom::radians(turned));
  if (quarter == std::floor(quarter)) {
    c = std::round(c);
    s = std::round(s);
  }
  return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}, {0, 0, 0}};
}

/// Entity coordinate system of an extrusion direction, by the arbitrary axis algorithm of the DXF reference:
/// its x axis is Y x N when N is within 1/64 of the Z axis, else Z x N. The zero vector counts as +Z.
inline Map3 entity_system(geom::Vec3 extrusion) {
  const geom::Vec3 n = geom::unit(extrusion);
  if (geom::norm(n) == 0) return {};
  constexpr double kNearZ = 1.0 / 64;
  const bool near_z = std::abs(n.x) < kNearZ && std::abs(n.y) < kNearZ;
  const geom::Vec3 x = geom::unit(cross(near_z ? geom::Vec3{0, 1, 0} : geom::Vec3{0, 0, 1}, n));
  return {x, geom::unit(cross(n, x)), n, {0, 0, 0}};
}

/// The map of the plane at height z of the map's source, seen from above.
inline geom::Affine2 seen_from_above(const Map3& m, double z) {
  return {m.x.x, m.x.y, m.y.x, m.y.y, m.o.x + z * m.z.x, m.o.y + z * m.z.y};
}

}  // namespace burin::io::dxf
