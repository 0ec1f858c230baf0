// SPDX-License-Identifier: Apache-2.0
// What some need of points and vectors beyond vec.h: whether they are finite, their parts by axis, the
// nearest place of a segment, places inside polygons.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "burin/geom/vec.h"

namespace burin::geom {

inline bool is_finite(Vec2 v) {
  return std::isfinite(v.x) && std::isfinite(v.y);
}
inline bool is_finite(Point2 p) {
  return std::isfinite(p.x) && std::isfinite(p.y);
}
inline bool is_finite(Vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline bool is_finite(Point3 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// Along an axis: 0 X, 1 Y, 2 Z.
constexpr double component(Vec3 v, std::size_t axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
constexpr double component(Point3 p, std::size_t axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}
constexpr void set_component(Point3& p, std::size_t axis, double value) {
  (axis == 0 ? p.x : axis == 1 ? p.y : p.z) = value;
}

/// The place of the segment a b nearest to p, in the plane or in space.
template <class Point>
constexpr Point nearest_on_segment(Point p, Point a, Point b) {
  const auto d = b - a;
  const double length2 = dot(d, d);
  return length2 > 0 ? a + std::clamp(dot(p - a, d) / length2, 0.0, 1.0) * d : a;
}
template <class Point>
double distance_to_segment(Point p, Point a, Point b) {
  return distance(p, nearest_on_segment(p, a, b));
}

/// Even-odd rule; a place on the border may count either way.
inline bool inside_polygon(std::span<const Point2> polygon, Point2 p) {
  bool in = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Point2 a = polygon[i], b = polygon[j];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) in = !in;
  }
  return in;
}

}  // namespace burin::geom
