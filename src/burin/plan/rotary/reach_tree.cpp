// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/reach_tree.h"
#include "burin/geom/point_tools.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace burin::rotary::detail {

namespace {

using geom::Point3;
using geom::Vec3;
using Corners3 = std::array<Point3, 3>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool before(const Point3& a, const Point3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

std::vector<Corners3> in_fixed_order(const geom::Mesh& mesh) {
  std::vector<Corners3> out;
  out.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    Corners3 c;
    bool good = true;
    for (std::size_t i = 0; i < 3 && good; ++i) {
      good = t[i] < mesh.vertices.size();
      if (!good) break;
      c[i] = mesh.vertices[t[i]];
      good = is_finite(c[i]);
    }
    if (!good) continue;
    std::sort(c.begin(), c.end(), before);
    out.push_back(c);
  }
  std::sort(out.begin(), out.end(), [](const Corners3& a, const Corners3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), before);
  });
  return out;
}

class Builder {
 public:
  explicit Builder(std::vector<Corners3> triangles) : triangles_(std::move(triangles)) {}

  ReachTree build() {
    const std::size_t n = triangles_.size();
    if (n == 0) return {};
    for (const Corners3& t : triangles_) {
      for (const Point3& p : t)
        tree_.size = std::max({tree_.size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    tree_.leaves.reserve(n / 3 + 1);
    tree_.nodes.reserve(n / 8 + 1);
    if (n <= 4) {
      tree_.nodes.push_back(empty_node());
      put(0, 0, 0, n);
    } else {
      node(0, n);
    }
    return std::move(tree_);
  }

 private:
  static NodeBlock empty_node() {
    NodeBlock b{};
    for (int i = 0; i < 4; ++i) {
      b.x0[i] = kInfinity;
      b.x1[i] = -kInfinity;
      b.c[i] = 1;
    }
    return b;
  }

  static double middle(const Corners3& t, int axis) {
    const auto of = [axis](const Point3& p) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; };
    return of(t[0]) + of(t[1]) + of(t[2]);
  }

  /// Halves [first, end) across the direction in which the triangles spread most, so that leaves get full.
  std::size_t split(std::size_t first, std::size_t end) {
    int axis = 0;
    double widest = -1;
    for (int a = 0; a < 3; ++a) {
      double lo = kInfinity, hi = -kInfinity;
      for (std::size_t i = first; i < end; ++i) {
        const double m = middle(triangles_[i], a);
        lo = std::min(lo, m);
        hi = std::max(hi, m);
      }
      if (hi - lo > widest) {
        widest = hi - lo;
        axis = a;
      }
    }
    const std::size_t half = ((end - first) / 2 + 3) / 4 * 4;
    // Equal middles: the order of the corners decides, so that the halves are the same sets every time.
    std::nth_element(triangles_.begin() + static_cast<std::ptrdiff_t>(first),
                     triangles_.begin() + static_cast<std::ptrdiff_t>(first + half),
                     triangles_.begin() + static_cast<std::ptrdiff_t>(end),
                     [axis](const Corners3& a, const Corners3& b) {
                       const double ma = middle(a, axis), mb = middle(b, axis);
                       if (ma != mb) return ma < mb;
                       return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), before);
                     });
    return first + half;
  }

  std::uint32_t node(std::size_t first, std::size_t end) {
    const auto at = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.push_back(empty_node());
    const std::size_t mid = split(first, end);
    std::array<std::size_t, 5> cuts{first, mid, mid, mid, end};
    if (mid - first > 4) cuts[1] = split(first, mid);
    if (end - mid > 4) cuts[3] = split(mid, end);
    int lane = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (cuts[k + 1] > cuts[k]) put(at, lane++, cuts[k], cuts[k + 1]);
    }
    return at;
  }

  void put(std::uint32_t at, int lane, std::size_t first, std::size_t end) {
    box(tree_.nodes[at], lane, first, end);
    const std::uint32_t child = end - first <= 4 ? kLeaf + leaf(first, end) : node(first, end);
    tree_.nodes[at].child[lane] = child;
  }

  std::uint32_t leaf(std::size_t first, std::size_t end) {
    LeafBlock b;
    for (std::size_t k = 0; k < 4; ++k) {
      const Corners3& t = triangles_[std::min(first + k, end - 1)];
      for (std::size_t i = 0; i < 3; ++i) {
        b.x[i][k] = t[i].x;
        b.y[i][k] = t[i].y;
        b.z[i][k] = t[i].z;
      }
    }
    tree_.leaves.push_back(b);
    return static_cast<std::uint32_t>(tree_.leaves.size() - 1);
  }

  /// Turned to the direction about which the normals gather (as lines, weighted by area), and tilted as they
  /// are tilted to X.
  void box(NodeBlock& out, int lane, std::size_t first, std::size_t end) const {
    constexpr double kSteepest = 4;  // of the tilt: faces steeper to X are as good as walls across it
    double zz = 0, yy = 0, yz = 0, xz = 0, xy = 0;
    for (std::size_t i = first; i < end; ++i) {
      const Corners3& t = triangles_[i];
      const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
      const double size = norm(n);
      if (!(size > 0) || !std::isfinite(size)) continue;
      zz += n.z * n.z / size;
      yy += n.y * n.y / size;
      yz += n.y * n.z / size;
      xz += n.x * n.z / size;
      xy += n.x * n.y / size;
    }
    const double angle = 0.5 * std::atan2(2 * yz, zz - yy), c = std::cos(angle), s = std::sin(angle);
    const double along = zz * c * c + 2 * yz * c * s + yy * s * s;
    const double slope = along > 0 ? -(xz * c + xy * s) / along : 0;
    const double tilt = std::isfinite(slope) ? std::clamp(slope, -kSteepest, kSteepest) : 0;
    double x0 = kInfinity, x1 = -kInfinity, u0 = x0, u1 = x1, v0 = x0, v1 = x1;
    for (std::size_t i = first; i < end; ++i) {
      for (const Point3& p : triangles_[i]) {
        const double u = p.z * c + p.y * s - tilt * p.x, v = p.y * c - p.z * s;
        x0 = std::min(x0, p.x);
        x1 = std::max(x1, p.x);
        u0 = std::min(u0, u);
        u1 = std::max(u1, u);
        v0 = std::min(v0, v);
        v1 = std::max(v1, v);
      }
    }
    out.c[lane] = c;
    out.s[lane] = s;
    out.tilt[lane] = tilt;
    out.x0[lane] = x0;
    out.x1[lane] = x1;
    out.u0[lane] = u0;
    out.u1[lane] = u1;
    out.v0[lane] = v0;
    out.v1[lane] = v1;
  }

  std::vector<Corners3> triangles_;
  ReachTree tree_;
};

}  // namespace

ReachTree make_reach_tree(const geom::Mesh& mesh) {
  return Builder(in_fixed_order(mesh)).build();
}

}  // namespace burin::rotary::detail
