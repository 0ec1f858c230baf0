// SPDX-License-Identifier: Apache-2.0
// Parts and centres for tests and benchmarks of reachable angles, and the plain formula. Shares nothing with
// reach.cpp but the mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "burin/geom/mesh/mesh.h"
#include "burin/geom/surface/surface_cases.h"
#include "burin/model/tool.h"

namespace burin::rotary::cases {

using geom::Mesh;
using geom::Point2;
using geom::Point3;
using geom::Vec3;
using geom::cases::Random;

/// A polygon (y, z), counter-clockwise, along X from 0, turned by `twist` radians on the way. Ends closed by
/// fans about the axis.
inline Mesh swept(const std::vector<Point2>& section, double length, double twist, int steps) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(section.size());
  for (int i = 0; i <= steps; ++i) {
    const double f = double(i) / steps, c = std::cos(f * twist), s = std::sin(f * twist);
    for (const Point2& p : section)
      mesh.vertices.push_back({f * length, p.x * c - p.y * s, p.x * s + p.y * c});
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(steps); ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * n + j, b = i * n + (j + 1) % n;
      mesh.triangles.push_back({a, b, b + n});
      mesh.triangles.push_back({a, b + n, a + n});
    }
  }
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({0, 0, 0});
  mesh.vertices.push_back({length, 0, 0});
  const std::uint32_t last = static_cast<std::uint32_t>(steps) * n;
  for (std::uint32_t j = 0; j < n; ++j) {
    mesh.triangles.push_back({first, (j + 1) % n, j});
    mesh.triangles.push_back({first + 1, last + j, last + (j + 1) % n});
  }
  return mesh;
}

/// radius(angle) round the axis.
template <class Radius>
std::vector<Point2> star(int n, Radius radius) {
  std::vector<Point2> out;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * geom::kPi * i / n, r = radius(a);
    out.push_back({r * std::cos(a), r * std::sin(a)});
  }
  return out;
}

/// Cams, slots and keyways, teeth with and without undercut; straight, twisted or like threads.
inline Mesh random_part(Random& r, int points = 48, int steps = 10) {
  const double size = r.between(6, 14), depth = r.between(0.1, 0.55), phase = r.between(0, 6);
  const int teeth = r.integer(2, 6), kind = r.integer(0, 4);
  std::vector<Point2> section;
  if (kind == 0) {  // cam
    section = star(points, [&](double a) { return size * (1 + 0.4 * depth * std::sin(2 * a + phase)); });
  } else if (kind == 1) {  // slots with steep walls
    section = star(points, [&](double a) {
      return size * (1 - depth * (std::sin(teeth * a + phase) > r.between(0.45, 0.55) ? 1 : 0));
    });
  } else if (kind == 2) {  // one keyway with walls that are parallel
    const double half = r.between(0.15, 0.3) * size, floor = size * (1 - depth);
    const double from = std::asin(half / size);
    section = {{floor, -half}, {floor, half}};
    for (int i = 0; i < points; ++i) {
      const double a = from + (2 * geom::kPi - 2 * from) * i / (points - 1);
      section.push_back({size * std::cos(a), size * std::sin(a)});
    }
  } else if (kind == 3) {  // round teeth
    section = star(points, [&](double a) { return size * (1 - depth * (0.5 + 0.5 * std::sin(teeth * a))); });
  } else {  // saw teeth that hang over
    section =
        star(points, [&](double a) { return size * (1 - depth * std::fmod(a * teeth, 6.2831) / 6.2831); });
    for (Point2& p : section) {
      const double rho = std::hypot(p.x, p.y), a = std::atan2(p.y, p.x) - 0.5 * depth * rho / size;
      p = {rho * std::cos(a), rho * std::sin(a)};
    }
  }
  const double length = r.between(10, 25);
  const double twist = r.integer(0, 2) == 0 ? 0 : r.between(-1, 1) * (r.integer(0, 3) == 0 ? 6 : 2);
  return swept(section, length, twist, steps);
}

inline double distance_to_triangle(Point3 p, Point3 a, Point3 b, Point3 c) {
  const Vec3 n = cross(b - a, c - a);
  if (dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
      dot(cross(a - c, p - c), n) >= 0 && norm(n) > 0)
    return std::abs(dot(p - a, n)) / norm(n);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
    const Vec3 d = to - from;
    const double t = dot(d, d) > 0 ? std::clamp(dot(p - from, d) / dot(d, d), 0.0, 1.0) : 0.0;
    least = std::min(least, distance(p, from + t * d));
  }
  return least;
}
inline double distance_to(const Mesh& m, Point3 p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : m.triangles)
    least = std::min(least, distance_to_triangle(p, m.vertices[t[0]], m.vertices[t[1]], m.vertices[t[2]]));
  return least;
}

/// A place of the ball that touches the mesh and gouges nothing (nothing found in 60 attempts: radius 0).
struct Touch {
  Point3 center;
  Vec3 normal;
  double radius = 0;
};
inline Touch random_touch(Random& r, const Mesh& m, double radius) {
  for (int attempt = 0; attempt < 60; ++attempt) {
    const auto& t = m.triangles[static_cast<std::size_t>(r.integer(0, int(m.triangles.size()) - 1))];
    const Point3 a = m.vertices[t[0]], b = m.vertices[t[1]], c = m.vertices[t[2]];
    const Vec3 n = unit(cross(b - a, c - a));
    double u = r.between(0, 1), v = r.between(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Point3 center = a + u * (b - a) + v * (c - a) + radius * n;
    if (norm(n) > 0.5 && distance_to(m, center) > radius - 1e-9) return {center, n, radius};
  }
  return {};
}

/// How deep the mesh reaches into the cylinder h0 <= h <= h1 at an angle: radius less the smallest distance
/// from the axis (below 0: free). Clips every triangle, then measures.
inline double depth(const Mesh& m, Point3 center, double theta, double h0, double h1, double radius) {
  const Vec3 axis{0, std::sin(theta), std::cos(theta)}, side{0, std::cos(theta), -std::sin(theta)};
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : m.triangles) {
    const std::array<Vec3, 3> v{m.vertices[t[0]] - center, m.vertices[t[1]] - center,
                                m.vertices[t[2]] - center};
    if (std::min({v[0].x, v[1].x, v[2].x}) > radius || std::max({v[0].x, v[1].x, v[2].x}) < -radius) continue;
    std::vector<Vec3> polygon(v.begin(), v.end());
    for (const auto& [limit, sign] : {std::pair{h0, 1.0}, std::pair{h1, -1.0}}) {
      std::vector<Vec3> kept;
      for (std::size_t i = 0; i < polygon.size() && std::isfinite(limit); ++i) {
        const Vec3 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        const double hp = sign * (dot(p, axis) - limit), hq = sign * (dot(q, axis) - limit);
        if (hp >= 0) kept.push_back(p);
        if (hp * hq < 0) kept.push_back(p + hp / (hp - hq) * (q - p));
      }
      if (std::isfinite(limit)) polygon = kept;
    }
    double turned = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 p = polygon[i], d = polygon[(i + 1) % polygon.size()] - p;
      const double px = p.x, pl = dot(p, side), dx = d.x, dl = dot(d, side), dd = dx * dx + dl * dl;
      const double at = dd > 0 ? std::clamp(-(px * dx + pl * dl) / dd, 0.0, 1.0) : 0;
      least = std::min(least, std::hypot(px + at * dx, pl + at * dl));
      turned += std::remainder(std::atan2(pl + dl, px + dx) - std::atan2(pl, px), 2 * geom::kPi);
    }
    if (std::abs(turned) > 3) least = 0;  // the axis goes through
  }
  return radius - least;
}
/// The whole tool without the ball.
inline double depth(const Mesh& m, Point3 center, double theta, const model::BallTool& tool) {
  double most = depth(m, center, theta, 0, std::numeric_limits<double>::infinity(), tool.shank_radius);
  double at = tool.shank_length;
  for (const auto& piece : tool.holder) {
    most = std::max(most, depth(m, center, theta, at, at + piece.height, piece.radius));
    at += piece.height;
  }
  return most;
}

}  // namespace burin::rotary::cases
