// SPDX-License-Identifier: Apache-2.0
// What of the second derivatives leaves the surface. docs/surfaces.md, Triangles.
#include <algorithm>
#include <cmath>

#include "burin/geom/surface/second_bounds.h"

namespace burin::geom::detail {
namespace {

/// Pieces of high degree have too many pairs of tangents to look at.
constexpr std::size_t kMostPairs = 2500;
/// Cosine of the cone of normals from which on nothing is gained.
constexpr double kWidest = 0.8;

struct Tangents {
  std::vector<Vec3> u, v;
};

Tangents tangents(const std::vector<Point3>& p, int nu, int nv) {
  const auto at = [&](int i, int j) { return p[static_cast<std::size_t>(i + j * nu)]; };
  Tangents out;
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i + 1 < nu; ++i) out.u.push_back(at(i + 1, j) - at(i, j));
  for (int j = 0; j + 1 < nv; ++j)
    for (int i = 0; i < nu; ++i) out.v.push_back(at(i, j + 1) - at(i, j));
  return out;
}

}  // namespace

SecondBounds normal_bounds(const BezierPatch& patch, const SecondBounds& all) {
  const NurbsSurface& s = patch.surface;
  const double w = s.points.front().w;
  std::vector<Point3> p;
  for (const HPoint& h : s.points) {
    if (h.w != w) return all;
    p.push_back(project(h));
  }
  const int nu = s.count_u, nv = s.count_v;
  const Tangents t = tangents(p, nu, nv);
  if (t.u.size() * t.v.size() > kMostPairs) return all;
  // Chords along u and v are means of tangents: all pairs hold the normals of surface and triangles.
  Vec3 sum;
  for (const Vec3& a : t.u)
    for (const Vec3& b : t.v) sum = sum + cross(a, b);
  const Vec3 n = unit(sum);
  double cosine = 1;
  for (const Vec3& a : t.u) {
    for (const Vec3& b : t.v) {
      const Vec3 c = cross(a, b);
      const double length = norm(c);
      if (!(length > 0)) return all;
      cosine = std::min(cosine, dot(c, n) / length);
    }
  }
  if (!(cosine > kWidest)) return all;
  const double slope = std::sqrt(std::max(0.0, 1 - cosine * cosine)) / cosine;
  const auto height = [&](int i, int j) { return dot(p[static_cast<std::size_t>(i + j * nu)] - p[0], n); };
  const int pu = s.degree_u, pv = s.degree_v;
  const double du = patch.u.length(), dv = patch.v.length();
  SecondBounds m = all;
  m.uu = m.uv = m.vv = 0;
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i + 2 < nu; ++i)
      m.uu = std::max(m.uu, std::abs(height(i, j) - 2 * height(i + 1, j) + height(i + 2, j)));
  for (int j = 0; j + 2 < nv; ++j)
    for (int i = 0; i < nu; ++i)
      m.vv = std::max(m.vv, std::abs(height(i, j) - 2 * height(i, j + 1) + height(i, j + 2)));
  for (int j = 0; j + 1 < nv; ++j)
    for (int i = 0; i + 1 < nu; ++i)
      m.uv =
          std::max(m.uv, std::abs(height(i, j) - height(i + 1, j) - height(i, j + 1) + height(i + 1, j + 1)));
  m.uu = m.uu * pu * (pu - 1) / (du * du) + slope * all.uu;
  m.vv = m.vv * pv * (pv - 1) / (dv * dv) + slope * all.vv;
  m.uv = m.uv * pu * pv / (du * dv) + slope * all.uv;
  return m;
}

}  // namespace burin::geom::detail
