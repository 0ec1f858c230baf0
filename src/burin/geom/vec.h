// SPDX-License-Identifier: Apache-2.0
// Points and vectors of the plane and of space, as different types: a point has a place, a vector a direction
// and a length. mm, right-handed frames. Everything here is constexpr-cheap and never fails.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace burin::geom {

struct Vec2 {
  double x = 0, y = 0;
  bool operator==(const Vec2&) const = default;
};
constexpr Vec2 operator+(Vec2 a, Vec2 b) {
  return {a.x + b.x, a.y + b.y};
}
constexpr Vec2 operator-(Vec2 a, Vec2 b) {
  return {a.x - b.x, a.y - b.y};
}
constexpr Vec2 operator-(Vec2 a) {
  return {-a.x, -a.y};
}
constexpr Vec2 operator*(double s, Vec2 a) {
  return {s * a.x, s * a.y};
}
constexpr Vec2 operator*(Vec2 a, double s) {
  return s * a;
}
constexpr Vec2 operator/(Vec2 a, double s) {
  return {a.x / s, a.y / s};
}
constexpr double dot(Vec2 a, Vec2 b) {
  return a.x * b.x + a.y * b.y;
}
/// z component of the cross product: positive when b lies to the left of a.
constexpr double cross(Vec2 a, Vec2 b) {
  return a.x * b.y - a.y * b.x;
}
constexpr double norm2(Vec2 a) {
  return dot(a, a);
}
inline double norm(Vec2 a) {
  return std::sqrt(dot(a, a));
}
/// Unit vector; (0, 0) stays (0, 0).
inline Vec2 unit(Vec2 a) {
  const double n = norm(a);
  return n > 0 ? a / n : Vec2{};
}
/// A quarter turn to the left, to the right.
constexpr Vec2 left(Vec2 a) {
  return {-a.y, a.x};
}
constexpr Vec2 right(Vec2 a) {
  return {a.y, -a.x};
}

struct Point2 {
  double x = 0, y = 0;
  bool operator==(const Point2&) const = default;
};
constexpr Vec2 operator-(Point2 a, Point2 b) {
  return {a.x - b.x, a.y - b.y};
}
constexpr Point2 operator+(Point2 a, Vec2 v) {
  return {a.x + v.x, a.y + v.y};
}
constexpr Point2 operator-(Point2 a, Vec2 v) {
  return {a.x - v.x, a.y - v.y};
}
constexpr Point2 lerp(Point2 a, Point2 b, double t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
}
inline double distance(Point2 a, Point2 b) {
  return norm(a - b);
}
constexpr double distance2(Point2 a, Point2 b) {
  return norm2(a - b);
}

struct Vec3 {
  double x = 0, y = 0, z = 0;
  bool operator==(const Vec3&) const = default;
};
constexpr Vec3 operator+(Vec3 a, Vec3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3 operator-(Vec3 a, Vec3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3 operator-(Vec3 a) {
  return {-a.x, -a.y, -a.z};
}
constexpr Vec3 operator*(double s, Vec3 a) {
  return {s * a.x, s * a.y, s * a.z};
}
constexpr Vec3 operator*(Vec3 a, double s) {
  return s * a;
}
constexpr Vec3 operator/(Vec3 a, double s) {
  return {a.x / s, a.y / s, a.z / s};
}
constexpr double dot(Vec3 a, Vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(Vec3 a) {
  return std::sqrt(dot(a, a));
}
inline Vec3 unit(Vec3 a) {
  const double n = norm(a);
  return n > 0 ? a / n : Vec3{};
}

struct Point3 {
  double x = 0, y = 0, z = 0;
  bool operator==(const Point3&) const = default;
};
constexpr Vec3 operator-(Point3 a, Point3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Point3 operator+(Point3 a, Vec3 v) {
  return {a.x + v.x, a.y + v.y, a.z + v.z};
}
constexpr Point3 operator-(Point3 a, Vec3 v) {
  return {a.x - v.x, a.y - v.y, a.z - v.z};
}
inline double distance(Point3 a, Point3 b) {
  return norm(a - b);
}

constexpr Point3 lerp(Point3 a, Point3 b, double t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

constexpr Point2 xy(Point3 p) {
  return {p.x, p.y};
}
constexpr Point3 at_z(Point2 p, double z) {
  return {p.x, p.y, z};
}

/// Axis-parallel box; empty as constructed.
struct Box2 {
  Point2 lo{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point2 hi{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  constexpr bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y); }
  constexpr void add(Point2 p) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
  }
  constexpr void add(const Box2& b) {
    lo = {std::min(lo.x, b.lo.x), std::min(lo.y, b.lo.y)};
    hi = {std::max(hi.x, b.hi.x), std::max(hi.y, b.hi.y)};
  }
  constexpr Box2 grown(double by) const { return {{lo.x - by, lo.y - by}, {hi.x + by, hi.y + by}}; }
  constexpr bool overlaps(const Box2& b) const {
    return lo.x <= b.hi.x && b.lo.x <= hi.x && lo.y <= b.hi.y && b.lo.y <= hi.y;
  }
  constexpr bool contains(Point2 p) const { return lo.x <= p.x && p.x <= hi.x && lo.y <= p.y && p.y <= hi.y; }
  constexpr double width() const { return empty() ? 0 : hi.x - lo.x; }
  constexpr double height() const { return empty() ? 0 : hi.y - lo.y; }
};

/// Axis-parallel box in space; empty as constructed.
struct Box3 {
  Point3 lo{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
            std::numeric_limits<double>::infinity()};
  Point3 hi{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
            -std::numeric_limits<double>::infinity()};

  constexpr bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  constexpr void add(Point3 p) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  constexpr void add(const Box3& b) {
    lo = {std::min(lo.x, b.lo.x), std::min(lo.y, b.lo.y), std::min(lo.z, b.lo.z)};
    hi = {std::max(hi.x, b.hi.x), std::max(hi.y, b.hi.y), std::max(hi.z, b.hi.z)};
  }
  constexpr Box3 grown(double by) const {
    return {{lo.x - by, lo.y - by, lo.z - by}, {hi.x + by, hi.y + by, hi.z + by}};
  }
  constexpr bool overlaps(const Box3& b) const {
    return lo.x <= b.hi.x && b.lo.x <= hi.x && lo.y <= b.hi.y && b.lo.y <= hi.y && lo.z <= b.hi.z &&
           b.lo.z <= hi.z;
  }
  constexpr bool contains(Point3 p) const {
    return lo.x <= p.x && p.x <= hi.x && lo.y <= p.y && p.y <= hi.y && lo.z <= p.z && p.z <= hi.z;
  }
  /// Length of the diagonal, 0 when empty: the size that relative tolerances refer to.
  double diagonal() const { return empty() ? 0 : norm(hi - lo); }
};

/// Affine map of the plane: p -> (a x + c y + e, b x + d y + f), the order of SVG's matrix(a b c d e f).
struct Affine2 {
  double a = 1, b = 0, c = 0, d = 1, e = 0, f = 0;

  constexpr Point2 operator()(Point2 p) const { return {a * p.x + c * p.y + e, b * p.x + d * p.y + f}; }
  constexpr Vec2 operator()(Vec2 v) const { return {a * v.x + c * v.y, b * v.x + d * v.y}; }
  constexpr double determinant() const { return a * d - b * c; }
  bool operator==(const Affine2&) const = default;
};
/// First `inner`, then `outer`.
constexpr Affine2 operator*(const Affine2& outer, const Affine2& inner) {
  return {outer.a * inner.a + outer.c * inner.b,           outer.b * inner.a + outer.d * inner.b,
          outer.a * inner.c + outer.c * inner.d,           outer.b * inner.c + outer.d * inner.d,
          outer.a * inner.e + outer.c * inner.f + outer.e, outer.b * inner.e + outer.d * inner.f + outer.f};
}

inline constexpr double kPi = 3.14159265358979323846;
constexpr double radians(double degrees) {
  return degrees * (kPi / 180.0);
}
constexpr double degrees(double radians) {
  return radians * (180.0 / kPi);
}

}  // namespace burin::geom
