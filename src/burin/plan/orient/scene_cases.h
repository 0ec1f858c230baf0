// SPDX-License-Identifier: Apache-2.0
// Meshes, tools and contact points for the tests of the scene, and an answer to "is it blocked" by another
// way: triangles cut in four until the distance of the middle, which changes by at most the way gone,
// decides.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "burin/plan/orient/scene.h"

namespace burin::orient::cases {

using geom::Mesh;
using geom::Point3;
using geom::Vec3;

struct Random {
  explicit Random(unsigned seed) : engine(seed) {}
  std::mt19937 engine;
  double between(double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(engine()) / 4294967296.0);
  }
  double normal() {
    return std::sqrt(-2 * std::log(between(1e-300, 1))) * std::cos(between(0, 2 * geom::kPi));
  }
  Vec3 direction() { return geom::unit({normal(), normal(), normal()}); }
  Vec3 vector(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
};

inline void add(Mesh& m, Point3 a, Point3 b, Point3 c) {
  const auto n = static_cast<std::uint32_t>(m.vertices.size());
  m.vertices.insert(m.vertices.end(), {a, b, c});
  m.triangles.push_back({n, n + 1, n + 2});
}
inline void add_quad(Mesh& m, Point3 o, Vec3 u, Vec3 v, int nu, int nv) {
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      const auto at = [&](int a, int b) { return o + (double(i + a) / nu) * u + (double(j + b) / nv) * v; };
      add(m, at(0, 0), at(1, 0), at(1, 1));
      add(m, at(0, 0), at(1, 1), at(0, 1));
    }
}
/// z(x, y) over a square of half width `half`, cells x cells x 2 triangles with shared corners.
template <class Height>
Mesh height_field(double half, int cells, Height z) {
  Mesh m;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const double x = half * (2.0 * i / cells - 1), y = half * (2.0 * j / cells - 1);
      m.vertices.push_back({x, y, z(x, y)});
    }
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t j = 0; j + 1 < row; ++j)
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t k = j * row + i;
      m.triangles.push_back({k, k + 1, k + row + 1});
      m.triangles.push_back({k, k + row + 1, k + row});
    }
  return m;
}
/// Triangles of all shapes about the origin: small, large, needles, segments, points.
inline Mesh soup(Random& r, int count, double spread, double size) {
  Mesh m;
  for (int i = 0; i < count; ++i) {
    const Point3 a = Point3{} + r.vector(spread);
    const double s = size * std::pow(10, r.between(-1.5, 0.3));
    const Vec3 u = s * r.direction(), v = s * r.direction();
    const int kind = static_cast<int>(r.between(0, 12));
    if (kind == 0)
      add(m, a, a + u, a + u + 1e-7 * v);
    else if (kind == 1)
      add(m, a, a + u, a + 0.3 * u);
    else if (kind == 2)
      add(m, a, a, a);
    else
      add(m, a, a + u, a + v);
  }
  return m;
}

inline model::Mill flat(double radius, double length) {
  model::Mill m;
  m.kind = model::MillKind::flat;
  m.radius = radius;
  m.length = length;
  return m;
}
inline model::Mill bull(double radius, double corner, double length) {
  model::Mill m = flat(radius, length);
  m.kind = model::MillKind::bull;
  m.corner_radius = corner;
  return m;
}
inline CcPoint contact(Point3 c, Vec3 n, Vec3 towards) {
  CcPoint at;
  at.c = c;
  at.n = geom::unit(n);
  at.f = geom::unit(towards - dot(towards, at.n) * at.n);
  return at;
}

/// Distance into (negative) or out of a grown cylinder; its rate of change is at most 1.
inline double outside(const Point3& q, const cl::Pose& pose, const BodyPiece& p) {
  const Vec3 v = q - pose.tip;
  const double h = dot(v, pose.axis), r = norm(v - h * pose.axis);
  const double out = r - p.radius, end = std::max(p.from - h, h - p.to);
  if (out <= 0 || end <= 0) return std::max(out, end) - p.grow;
  return std::hypot(out, end) - p.grow;
}

/// -1: some place is inside by more than `band`; 1: all are outside by more; 0: neither, or it takes too
/// long.
inline int decide(const std::array<Point3, 3>& triangle, const cl::Pose& pose, const BodyPiece& piece,
                  double band) {
  int left = 3000;
  bool close = false;
  std::vector<std::array<Point3, 3>> todo{triangle};
  while (!todo.empty()) {
    const auto [a, b, c] = todo.back();
    todo.pop_back();
    const Point3 m = Point3{} + ((a - Point3{}) + (b - Point3{}) + (c - Point3{})) / 3.0;
    const double value = outside(m, pose, piece);
    if (value < -band) return -1;
    const double reach = std::max({distance(m, a), distance(m, b), distance(m, c)});
    if (value - reach > band) continue;
    if (reach < 0.1 * band || --left < 0) {
      close = true;
      if (left < 0) break;
      continue;
    }
    const Point3 ab = lerp(a, b, 0.5), bc = lerp(b, c, 0.5), ca = lerp(c, a, 0.5);
    todo.push_back({a, ab, ca});
    todo.push_back({b, bc, ab});
    todo.push_back({c, ca, bc});
    todo.push_back({ab, bc, ca});
  }
  return close ? 0 : 1;
}

/// The same over a mesh and a body.
inline int decide(const Mesh& mesh, const cl::Pose& pose, const std::vector<BodyPiece>& body, double band) {
  int out = 1;
  for (const BodyPiece& p : body)
    for (const auto& t : mesh.triangles) {
      const int one = decide({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}, pose, p, band);
      if (one < 0) return -1;
      out = std::min(out, one);
    }
  return out;
}

}  // namespace burin::orient::cases
