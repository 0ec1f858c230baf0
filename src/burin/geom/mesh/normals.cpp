// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/edges.h"

namespace burin::geom {

namespace {

/// Corners that share a normal. A corner has the number of the half-edge that leaves it.
class Fans {
 public:
  explicit Fans(std::size_t corners) : parent_(corners) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Unit normals; none for triangles so low that single precision (STL) decides where they face.
std::vector<Vec3> face_normals(const Mesh& mesh) {
  constexpr double kLowest = 2e-7;  // a few steps of single precision
  double largest = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!is_triangle(mesh, t)) continue;
    for (const std::uint32_t i : mesh.triangles[t]) {
      const Point3 p = mesh.vertices[i];
      largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
  }
  std::vector<Vec3> out(mesh.triangles.size());
  for (std::size_t t = 0; t < out.size(); ++t) {
    if (!is_triangle(mesh, t) || !(height_of(mesh, t) > kLowest * largest)) continue;
    const auto& c = mesh.triangles[t];
    out[t] =
        unit(cross(mesh.vertices[c[1]] - mesh.vertices[c[0]], mesh.vertices[c[2]] - mesh.vertices[c[0]]));
  }
  return out;
}

bool is_zero(Vec3 n) {
  return n == Vec3{};
}

/// The corner of the triangle of `h` at a vertex of it.
std::uint32_t corner_at(const Mesh& mesh, HalfEdge h, std::uint32_t vertex) {
  const std::uint32_t first = h - h % 3;
  for (std::uint32_t k = 0; k < 2; ++k) {
    if (from(mesh, first + k) == vertex) return first + k;
  }
  return first + 2;
}

double angle(Vec3 a, Vec3 b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

class Joining {
 public:
  Joining(const Mesh& mesh, const Edges& edges, const std::vector<Vec3>& faces, double crease)
      : mesh_(mesh), twin_(edges.twin), faces_(faces), crease_(crease), fans_(twin_.size()) {
    for (HalfEdge h = 0; h < twin_.size(); ++h) {
      if (is_zero(faces_[h / 3])) {
        across_flat(h);
      } else if (is_pair(twin_[h]) && h < twin_[h]) {
        across(h, twin_[h], from(mesh_, h));
        across(h, twin_[h], to(mesh_, h));
      }
    }
  }
  Fans& fans() { return fans_; }

 private:
  /// Joins the corners of two sides' triangles at a vertex.
  void across(HalfEdge a, HalfEdge b, std::uint32_t vertex) {
    const Vec3 na = faces_[a / 3], nb = faces_[b / 3];
    if (is_zero(na) || is_zero(nb) || !(angle(na, nb) < crease_)) return;
    fans_.join(corner_at(mesh_, a, vertex), corner_at(mesh_, b, vertex));
  }
  /// What lies on either side of a triangle without normal, at the corner that h leaves.
  void across_flat(HalfEdge h) {
    const HalfEdge a = twin_[h], b = twin_[side_before(h)];
    if (is_pair(a) && is_pair(b)) across(a, b, from(mesh_, h));
  }

  const Mesh& mesh_;
  const std::vector<HalfEdge>& twin_;
  const std::vector<Vec3>& faces_;
  double crease_;
  Fans fans_;
};

}  // namespace

std::vector<std::array<Vec3, 3>> corner_normals(const Mesh& mesh, double crease_rad) {
  const std::vector<Vec3> faces = face_normals(mesh);
  const Edges edges = find_edges(mesh);
  Joining joining(mesh, edges, faces, crease_rad);
  Fans& fans = joining.fans();
  std::vector<Vec3> sum(edges.twin.size());
  for (HalfEdge h = 0; h < sum.size(); ++h) {
    if (is_zero(faces[h / 3])) continue;
    const Point3 p = mesh.vertices[from(mesh, h)];
    const double weight =
        angle(mesh.vertices[to(mesh, h)] - p, mesh.vertices[from(mesh, side_before(h))] - p);
    Vec3& s = sum[fans.find(h)];
    s = s + weight * faces[h / 3];
  }
  std::vector<std::array<Vec3, 3>> out(mesh.triangles.size());
  for (HalfEdge h = 0; h < sum.size(); ++h) out[h / 3][h % 3] = unit(sum[fans.find(h)]);
  // Triangles without a normal take that of a neighbour.
  for (HalfEdge h = 0; h < sum.size(); ++h) {
    Vec3& n = out[h / 3][h % 3];
    for (const HalfEdge side : {h, side_before(h)}) {
      if (is_zero(n) && is_pair(edges.twin[side])) {
        const std::uint32_t corner = corner_at(mesh, edges.twin[side], from(mesh, h));
        n = out[corner / 3][corner % 3];
      }
    }
  }
  return out;
}

}  // namespace burin::geom
