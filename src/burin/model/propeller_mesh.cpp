// SPDX-License-Identifier: Apache-2.0
// Triangles of blades and hub.
#include <algorithm>
#include <array>
#include <cmath>

#include "burin/geom/mesh/check.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/tessellate.h"
#include "burin/model/propeller.h"

namespace burin::model {
namespace {

using geom::Direction;
using geom::Mesh;
using geom::NurbsSurface;
using geom::Point3;

/// A closed blade never takes more, whatever the deflection.
constexpr std::size_t kMostTriangles = 2'000'000;
constexpr int kFewestSides = 24, kMostSides = 20000;  ///< of the hub

/// Lines over the spans of the knots, in each as many as the surface that needs most.
std::vector<double> common_lines(const std::vector<double>& knots,
                                 const std::vector<std::vector<double>>& each) {
  std::vector<double> ends = knots, out;
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    std::size_t most = 1;
    for (const auto& lines : each)
      most = std::max(most, static_cast<std::size_t>(std::count_if(lines.begin(), lines.end(), [&](double t) {
                        return ends[k] <= t && t < ends[k + 1];
                      })));
    for (std::size_t i = 0; i < most; ++i)
      out.push_back(ends[k] + (ends[k + 1] - ends[k]) * (double(i) / double(most)));
  }
  out.push_back(ends.back());
  return out;
}

std::vector<Point3> row(const NurbsSurface& surface, const std::vector<double>& u, double v) {
  std::vector<Point3> points(u.size());
  geom::SurfaceEvaluator(surface).iso_points(Direction::u, v, u, points);
  return points;
}

/// A closed tube of rings (side, trailing edge, other side, leading edge) with two ends; the triangles of the
/// side come first.
struct BladeMesh {
  Mesh mesh;
  std::size_t side_triangles = 0;
};

BladeMesh blade_mesh(const Propeller& blade, double deflection_mm) {
  const geom::TessellateOptions options{deflection_mm, 0, kMostTriangles};
  const std::array<const NurbsSurface*, 4> surfaces{&blade.side, &blade.trailing_edge, &blade.other_side,
                                                    &blade.leading_edge};
  std::vector<std::vector<double>> us, vs;
  for (const NurbsSurface* surface : surfaces) {
    auto lines = geom::grid_lines(*surface, options);
    if (!lines) return {};  // surfaces of make_propeller are few pieces
    us.push_back(std::move(lines->u)), vs.push_back(std::move(lines->v));
  }
  const std::vector<double> v = common_lines(blade.side.knots_v, vs);
  const std::vector<double> chord = common_lines(blade.side.knots_u, {us[0], us[2]});
  const std::size_t n = chord.size() - 1, trailing = us[1].size() - 1, leading = us[3].size() - 1;
  const std::size_t ring = 2 * n + trailing + leading;
  BladeMesh out;
  for (const double at : v) {
    std::vector<Point3> a = row(blade.side, chord, at), b = row(blade.trailing_edge, us[1], at);
    std::vector<Point3> c = row(blade.other_side, chord, at), d = row(blade.leading_edge, us[3], at);
    std::reverse(c.begin(), c.end()), std::reverse(d.begin(), d.end());
    for (const auto* part : {&a, &b, &c, &d})
      out.mesh.vertices.insert(out.mesh.vertices.end(), part->begin(), part->end() - 1);
  }
  const auto at = [ring](std::size_t i, std::size_t j) {
    return static_cast<std::uint32_t>(i % ring + j * ring);
  };
  auto& triangles = out.mesh.triangles;
  const auto strip = [&](std::size_t first, std::size_t end) {
    for (std::size_t j = 0; j + 1 < v.size(); ++j) {
      for (std::size_t i = first; i < end; ++i) {
        triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  };
  strip(0, n);
  out.side_triangles = triangles.size();
  strip(n, ring);
  for (const std::size_t j : {std::size_t{0}, v.size() - 1}) {
    const auto add = [&](std::size_t p, std::size_t q, std::size_t r) {
      if (j == 0) std::swap(q, r);
      triangles.push_back({at(p, j), at(q, j), at(r, j)});
    };
    // Across the thickness: place i of the side faces place far - i of the other one.
    const std::size_t far = 2 * n + trailing;
    for (std::size_t i = 0; i < n; ++i) add(i, i + 1, far - i), add(i + 1, far - i - 1, far - i);
    for (std::size_t i = n + 1; i + 1 <= n + trailing; ++i) add(n, i, i + 1);
    for (std::size_t i = far; i + 1 < ring; ++i) add(0, i, i + 1);
  }
  geom::orient(out.mesh);
  return out;
}

void append(Mesh& to, const Mesh& mesh, double angle) {
  const auto base = static_cast<std::uint32_t>(to.vertices.size());
  const double c = std::cos(angle), s = std::sin(angle);
  for (const Point3& p : mesh.vertices) to.vertices.push_back({c * p.x - s * p.y, s * p.x + c * p.y, p.z});
  for (const auto& t : mesh.triangles) to.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

}  // namespace

Mesh neighbour_blades(const PropellerData& data, const Propeller& propeller, double deflection_mm) {
  const Mesh blade = blade_mesh(propeller, deflection_mm).mesh;
  Mesh out;
  for (int k = 1; k < data.blades; ++k) append(out, blade, 2 * geom::kPi * k / data.blades);
  return out;
}

Mesh blade_back(const PropellerData&, const Propeller& propeller, double deflection_mm) {
  BladeMesh blade = blade_mesh(propeller, deflection_mm);
  auto& triangles = blade.mesh.triangles;
  triangles.erase(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(blade.side_triangles));
  return std::move(blade.mesh);
}

Mesh hub_mesh(const PropellerData&, const Propeller& propeller, double deflection_mm) {
  const double r = propeller.hub_radius, share = std::clamp(deflection_mm / r, 0.0, 1.0);
  // The chord of an n-th of the circle lies r (1 - cos(pi / n)) inside.
  const double wanted = std::ceil(geom::kPi / std::acos(1 - share));
  const int n = wanted < kMostSides ? std::max(kFewestSides, static_cast<int>(wanted)) : kMostSides;
  const auto count = static_cast<std::uint32_t>(n);
  Mesh mesh;
  const double bottom = propeller.hub_bottom, top = bottom + propeller.hub_height;
  for (const double z : {bottom, top}) {
    for (int i = 0; i < n; ++i) {
      const double a = 2 * geom::kPi * i / n;
      mesh.vertices.push_back({r * std::cos(a), r * std::sin(a), z});
    }
  }
  mesh.vertices.push_back({0, 0, bottom});
  mesh.vertices.push_back({0, 0, top});
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t k = (i + 1) % count;
    mesh.triangles.push_back({i, k, count + k});
    mesh.triangles.push_back({i, count + k, count + i});
    mesh.triangles.push_back({2 * count, k, i});
    mesh.triangles.push_back({2 * count + 1, count + i, count + k});
  }
  return mesh;
}

}  // namespace burin::model
