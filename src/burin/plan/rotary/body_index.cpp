// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/body_index.h"

#include <algorithm>
#include <cmath>

#include "burin/geom/vec.h"

namespace burin::rotary {
namespace {

using geom::Point3;
using geom::Vec2;
using geom::Vec3;

constexpr std::uint32_t kLeaf = 4;

/// Squared distance of the origin from a polygon of the plane with up to five corners, 0 inside.
double distance2(const Vec2* p, int n) {
  double least = 1e300, area = 0;
  for (int i = 0; i < n; ++i) area += cross(p[i], p[i + 1 < n ? i + 1 : 0]);
  const double sense = area < 0 ? -1 : 1;
  bool inside = area != 0;
  for (int i = 0; i < n; ++i) {
    const Vec2 a = p[i], d = p[i + 1 < n ? i + 1 : 0] - a;
    if (sense * cross(d, -a) < 0) inside = false;
    const double dd = dot(d, d);
    const double t = dd > 0 ? std::clamp(-dot(a, d) / dd, 0.0, 1.0) : 0;
    least = std::min(least, norm2(a + t * d));
  }
  return inside ? 0 : least;
}

}  // namespace

/// The tool's frame: across is (x, side), up along the axis.
struct BodyIndex::Frame {
  Point3 center;
  double sin, cos, low, high;

  Vec2 across(Vec3 d) const { return {d.x, d.y * cos - d.z * sin}; }
  double up(Vec3 d) const { return d.y * sin + d.z * cos; }

  /// Squared distance from the axis that a node's box keeps; huge outside of the heights.
  double bound(const Node& node) const {
    const Vec3 d = node.middle - center;
    const double es = std::abs(cos) * node.half.y + std::abs(sin) * node.half.z;
    const double eu = std::abs(sin) * node.half.y + std::abs(cos) * node.half.z;
    const double h = up(d);
    if (h + eu < low || h - eu > high) return 1e300;
    const Vec2 a = across(d);
    const double dx = std::max(0.0, std::abs(a.x) - node.half.x), ds = std::max(0.0, std::abs(a.y) - es);
    return dx * dx + ds * ds;
  }

  double triangle(const Triangle& t) const {
    Vec2 p[3];
    double h[3];
    for (int i = 0; i < 3; ++i) {
      const Vec3 d = t[static_cast<std::size_t>(i)] - center;
      p[i] = across(d);
      h[i] = up(d);
    }
    const double least = std::min({h[0], h[1], h[2]}), most = std::max({h[0], h[1], h[2]});
    if (most < low || least > high) return 1e300;
    if (least >= low && most <= high) return distance2(p, 3);
    return clipped(p, h);
  }

  double clipped(const Vec2* p, const double* h) const {
    Vec2 q[8], r[8];
    double hq[8], hr[8];
    const int n = cut(p, h, 3, low, 1, q, hq);
    const int m = cut(q, hq, n, high, -1, r, hr);
    return m > 0 ? distance2(r, m) : 1e300;
  }
  /// Keeps what is above (sense 1) or below (-1) a height.
  static int cut(const Vec2* p, const double* h, int n, double at, double sense, Vec2* out, double* h_out) {
    int m = 0;
    for (int i = 0; i < n; ++i) {
      const int j = i + 1 < n ? i + 1 : 0;
      const double a = sense * (h[i] - at), b = sense * (h[j] - at);
      if (a >= 0) {
        out[m] = p[i];
        h_out[m++] = h[i];
      }
      if ((a < 0) == (b < 0)) continue;
      const double t = a / (a - b);
      out[m] = p[i] + t * (p[j] - p[i]);
      h_out[m++] = at;
    }
    return m;
  }
};

BodyIndex::BodyIndex(const geom::Mesh& mesh) {
  triangles_.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    triangles_.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  for (const Point3& v : mesh.vertices) radius_ = std::max(radius_, std::hypot(v.y, v.z));
  if (!triangles_.empty()) build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void BodyIndex::build(std::uint32_t first, std::uint32_t end) {
  geom::Box3 box, middles;
  const auto middle = [](const Triangle& t) {
    return Point3{t[0].x + t[1].x + t[2].x, t[0].y + t[1].y + t[2].y, t[0].z + t[1].z + t[2].z};
  };
  for (std::uint32_t i = first; i < end; ++i) {
    for (const Point3& p : triangles_[i]) box.add(p);
    middles.add(middle(triangles_[i]));
  }
  const std::size_t at = nodes_.size();
  Node node;
  node.middle = lerp(box.lo, box.hi, 0.5);
  // Rounding of the middle must not leave a corner outside.
  node.half = 0.5 * (box.hi - box.lo) + 1e-12 * (1 + box.diagonal()) * Vec3{1, 1, 1};
  nodes_.push_back(node);
  if (end - first <= kLeaf) {
    nodes_[at].first = first;
    nodes_[at].count = end - first;
    return;
  }
  const Vec3 size = middles.hi - middles.lo;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto key = [&](const Triangle& t) {
    const Point3 m = middle(t);
    return axis == 0 ? m.x : axis == 1 ? m.y : m.z;
  };
  const std::uint32_t half = first + (end - first) / 2;
  std::nth_element(triangles_.begin() + first, triangles_.begin() + half, triangles_.begin() + end,
                   [&](const Triangle& a, const Triangle& b) { return key(a) < key(b); });
  build(first, half);
  nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
  build(half, end);
}

double BodyIndex::to_axis(Point3 center, double theta, double low, double high, double within) const {
  const Frame frame{center, std::sin(theta), std::cos(theta), low, high};
  double best = within * within;
  if (nodes_.empty() || !(low <= high) || !(within > 0)) return within;
  struct Open {
    std::uint32_t node;
    double bound;
  };
  // Median splits of 2^32 triangles: 32 levels, one sibling each.
  Open stack[72];
  int top = 0;
  stack[top++] = {0, frame.bound(nodes_[0])};
  while (top > 0) {
    const Open open = stack[--top];
    if (open.bound >= best) continue;
    const Node& node = nodes_[open.node];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        best = std::min(best, frame.triangle(triangles_[i]));
      if (best <= 0) return 0;
      continue;
    }
    const Open a{open.node + 1, frame.bound(nodes_[open.node + 1])};
    const Open b{node.right, frame.bound(nodes_[node.right])};
    const bool first = a.bound <= b.bound;
    if ((first ? b : a).bound < best) stack[top++] = first ? b : a;
    if ((first ? a : b).bound < best) stack[top++] = first ? a : b;
  }
  return std::sqrt(best);
}

}  // namespace burin::rotary
