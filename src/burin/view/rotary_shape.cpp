// SPDX-License-Identifier: Apache-2.0
#include "burin/view/rotary_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "burin/geom/mesh/slice.h"

namespace burin::view {
namespace {

using geom::Point2;
using geom::Point3;
using geom::Vec2;
using geom::Vec3;

// --- swept parts: section x stations

/// A line of the grid along X: place and outward normal in the section.
struct Rail {
  Point2 p;
  Vec2 n;
};

/// Both sides of every corner, arcs so that the eye sees them round.
std::vector<std::array<Rail, 2>> facets_of(const geom::ArcSpline& section, std::size_t most) {
  constexpr double kStep = 0.14;  // radians of an arc that one facet covers
  std::size_t count = 0;
  const auto facets = [](const geom::Segment& s, double step) {
    return static_cast<std::size_t>(std::ceil(std::max(1.0, std::abs(geom::sweep_of(s)) / step)));
  };
  for (const geom::Segment& s : section.segments) count += facets(s, kStep);
  const double step = count > most ? kStep * static_cast<double>(count) / static_cast<double>(most) : kStep;
  std::vector<std::array<Rail, 2>> list;
  for (const geom::Segment& s : section.segments) {
    const std::size_t n = facets(s, step);
    const double sweep = geom::sweep_of(s);
    const Vec2 t = geom::start_tangent(s);
    const auto rail = [&](std::size_t i) {
      const double f = static_cast<double>(i) / static_cast<double>(n), a = f * sweep;
      const Vec2 d{t.x * std::cos(a) - t.y * std::sin(a), t.x * std::sin(a) + t.y * std::cos(a)};
      return Rail{geom::point_on(s, f), {d.y, -d.x}};
    };
    for (std::size_t i = 0; i < n; ++i) list.push_back({rail(i), rail(i + 1)});
  }
  return list;
}

std::vector<double> stations_of(const rotary::SweptSection& swept, std::size_t most) {
  constexpr double kTurn = 0.06;  // radians between stations
  std::vector<double> xs{swept.stations.front().x};
  double turn = 0;
  for (std::size_t i = 1; i < swept.stations.size(); ++i)
    turn += std::abs(swept.stations[i].turn - swept.stations[i - 1].turn);
  const double step = std::max(kTurn, turn / static_cast<double>(std::max<std::size_t>(1, most)));
  for (std::size_t i = 1; i < swept.stations.size(); ++i) {
    const rotary::Station &a = swept.stations[i - 1], &b = swept.stations[i];
    const auto n = static_cast<std::size_t>(std::max(1.0, std::ceil(std::abs(b.turn - a.turn) / step)));
    for (std::size_t k = 1; k <= n; ++k)
      xs.push_back(a.x + (b.x - a.x) * static_cast<double>(k) / static_cast<double>(n));
  }
  return xs;
}

struct Turned {
  double x, c, s, rate;  // rate: radians per mm
};

void add_swept(const rotary::SweptSection& swept, std::size_t max_triangles, Shape& shape) {
  const std::vector<double> xs = stations_of(swept, max_triangles / 160);
  const auto facets = facets_of(swept.section, max_triangles / (2 * xs.size()));
  const auto turned = [&](double x, double rate) {
    const double a = swept.turn_at(x);
    return Turned{x, std::cos(a), std::sin(a), rate};
  };
  const auto add = [&](const Rail& r, const Turned& at) {
    const double y = r.p.x * at.c - r.p.y * at.s, z = r.p.x * at.s + r.p.y * at.c;
    const double ny = r.n.x * at.c - r.n.y * at.s, nz = r.n.x * at.s + r.n.y * at.c;
    // The surface goes by rate (-z, y) per mm of x; its normal is square to that.
    const Vec3 n{-at.rate * (-z * ny + y * nz), ny, nz};
    shape.points.push_back({at.x, y, z});
    shape.normals.push_back(unit(n));
  };
  for (std::size_t i = 1; i < xs.size() && shape.points.size() / 3 < max_triangles; ++i) {
    const double rate = (swept.turn_at(xs[i]) - swept.turn_at(xs[i - 1])) / (xs[i] - xs[i - 1]);
    const Turned a = turned(xs[i - 1], rate), b = turned(xs[i], rate);
    for (const auto& [p, q] : facets) {
      add(p, a), add(q, a), add(q, b);
      add(p, a), add(q, b), add(p, b);
    }
  }
}

// --- any mesh

Vec3 normal_of(const geom::Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Point3 a = mesh.vertices[t[0]];
  return cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
}

void add_triangle(const rotary::Part& part, std::size_t t, Shape& shape) {
  const auto& corners = part.mesh.triangles[t];
  const Vec3 flat = unit(normal_of(part.mesh, corners));
  for (std::size_t k = 0; k < 3; ++k) {
    shape.points.push_back(part.mesh.vertices[corners[k]]);
    shape.normals.push_back(t < part.corner_normals.size() ? part.corner_normals[t][k] : flat);
  }
}

/// End faces of a swept part: they are in its mesh only.
void add_caps(const rotary::Part& part, std::size_t max_triangles, Shape& shape) {
  constexpr double kFlat = 0.9999;
  for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
    if (shape.points.size() / 3 >= max_triangles) return;
    const Vec3 n = normal_of(part.mesh, part.mesh.triangles[t]);
    if (std::abs(n.x) > kFlat * norm(n)) add_triangle(part, t, shape);
  }
}

// --- outlines

double distance2(Point2 p, Point2 a, Point2 b) {
  const Vec2 d = b - a;
  const double l = norm2(d), f = l > 0 ? std::clamp(dot(p - a, d) / l, 0.0, 1.0) : 0;
  return norm2(p - (a + f * d));
}

/// Douglas and Peucker, without recursion.
std::vector<Point2> simplified(const std::vector<Point2>& line, double tolerance) {
  if (line.size() < 4) return line;
  std::vector<bool> keep(line.size(), false);
  keep.front() = keep.back() = keep[line.size() / 2] = true;  // closed: the ends are the same place
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, line.size() / 2},
                                                        {line.size() / 2, line.size() - 1}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    std::size_t far = a;
    double worst = tolerance * tolerance;
    for (std::size_t i = a + 1; i < b; ++i) {
      const double d = distance2(line[i], line[a], line[b]);
      if (d > worst) worst = d, far = i;
    }
    if (far == a) continue;
    keep[far] = true;
    open.emplace_back(a, far);
    open.emplace_back(far, b);
  }
  std::vector<Point2> out;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (keep[i]) out.push_back(line[i]);
  return out;
}

}  // namespace

Shape drawn_shape(const rotary::Part& part, std::size_t max_triangles) {
  Shape shape;
  if (part.swept && part.swept->stations.size() > 1) {
    add_swept(*part.swept, max_triangles * 3 / 4, shape);
    add_caps(part, max_triangles, shape);
    return shape;
  }
  const ReducedMesh drawn = reduced(part.mesh, 0, part.mesh.triangles.size(), max_triangles);
  for (std::size_t i = 0; i < drawn.source.size(); ++i) {
    const auto& t = drawn.mesh.triangles[i];
    const Vec3 flat = unit(normal_of(drawn.mesh, t));
    const bool known = drawn.source[i] < part.corner_normals.size();
    for (std::size_t k = 0; k < 3; ++k) {
      shape.points.push_back(drawn.mesh.vertices[t[k]]);
      // A triangle that was pulled far from where it lay is drawn flat.
      const Vec3 n = known ? part.corner_normals[drawn.source[i]][k] : flat;
      shape.normals.push_back(dot(n, flat) > 0.5 ? n : flat);
    }
  }
  return shape;
}

std::vector<Outline> outlines(const rotary::Part& part, const std::vector<double>& stations,
                              double tolerance_mm) {
  std::vector<Outline> all;
  if (part.mesh.triangles.empty()) return std::vector<Outline>(stations.size());
  const geom::Slicer slicer(part.mesh, part.corner_normals);
  const double inset = 1e-6 * (part.x_max - part.x_min);  // not in the plane of an end face
  for (const double x : stations) {
    Outline outline;
    for (const geom::SliceLoop& loop : slicer.at(std::clamp(x, part.x_min + inset, part.x_max - inset))) {
      std::vector<Point2> line;
      for (const geom::SlicePoint& p : loop.points) line.push_back({p.p.y, p.p.z});
      if (loop.closed && !line.empty()) line.push_back(line.front());
      if (line.size() > 1) outline.push_back(simplified(line, tolerance_mm));
    }
    all.push_back(std::move(outline));
  }
  return all;
}

}  // namespace burin::view
