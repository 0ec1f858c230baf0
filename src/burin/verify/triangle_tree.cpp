// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/triangle_tree.h"

#include <algorithm>
#include <limits>

#include "burin/geom/point_tools.h"

namespace burin::verify {
namespace {

constexpr std::uint32_t kLeaf = 4;

double middle(const TriangleTree::Triangle& t, std::size_t axis) {
  return component(t.corners[0], axis) + component(t.corners[1], axis) + component(t.corners[2], axis);
}

}  // namespace

TriangleTree::TriangleTree(const geom::Mesh& mesh) {
  triangles_.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    triangles_.push_back({{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}, i});
  }
  if (triangles_.empty()) return;
  nodes_.reserve(2 * triangles_.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(triangles_.size()));
}

void TriangleTree::lay_plane(Node& node, std::uint32_t begin, std::uint32_t end) const {
  geom::Vec3 sum;
  for (std::uint32_t i = begin; i < end; ++i) {
    const auto& c = triangles_[i].corners;
    sum = sum + cross(c[1] - c[0], c[2] - c[0]);
  }
  node.normal = norm(sum) > 0 ? unit(sum) : geom::Vec3{0, 0, 1};
  node.most = -std::numeric_limits<double>::infinity();
  node.least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = begin; i < end; ++i)
    for (const geom::Point3& p : triangles_[i].corners) {
      const double height = dot(node.normal, p - node.center);
      node.most = std::max(node.most, height);
      node.least = std::min(node.least, height);
    }
}

void TriangleTree::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
  geom::Box3 box;
  for (std::uint32_t i = begin; i < end; ++i)
    for (const geom::Point3& p : triangles_[i].corners) box.add(p);
  nodes_[node].center = lerp(box.lo, box.hi, 0.5);
  nodes_[node].half = 0.5 * (box.hi - box.lo);
  lay_plane(nodes_[node], begin, end);
  if (end - begin <= kLeaf) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (component(nodes_[node].half, k) > component(nodes_[node].half, axis)) axis = k;
  const std::uint32_t half = begin + (end - begin) / 2;
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + half, triangles_.begin() + end,
                   [axis](const Triangle& a, const Triangle& b) {
                     const double x = middle(a, axis), y = middle(b, axis);
                     return x != y ? x < y : a.index < b.index;
                   });
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = first;
  nodes_.resize(nodes_.size() + 2);
  split(first, begin, half);
  split(first + 1, half, end);
}

}  // namespace burin::verify
