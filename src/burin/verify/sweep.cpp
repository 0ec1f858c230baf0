// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/sweep.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace burin::verify {
namespace {

using geom::Box3;
using geom::Point3;
using geom::Vec3;

constexpr std::uint32_t kLeaf = 8;

double middle(const Sweep::Segment& s, int axis) {
  return axis == 0 ? s.a.x + s.b.x : axis == 1 ? s.a.y + s.b.y : s.a.z + s.b.z;
}

/// Where the line enters a ball, and leaves it.
struct Span {
  double in = 0, out = -1;
};
Span through_ball(Point3 q, Vec3 n, Point3 c, double r) {
  const Vec3 d = c - q;
  const double b = dot(d, n), disc = b * b - dot(d, d) + r * r;
  if (!(disc >= 0)) return {};
  const double root = std::sqrt(disc);
  return {b - root, b + root};
}
/// The part of an endless cylinder about the segment that lies between its ends.
Span through_cylinder(Point3 q, Vec3 n, const Sweep::Segment& s, double r) {
  const Vec3 axis = s.b - s.a;
  const double length = norm(axis);
  if (!(length > 0)) return {};
  const Vec3 e = axis / length, d = q - s.a;
  const double ne = dot(n, e), de = dot(d, e);
  const Vec3 np = n - ne * e, dp = d - de * e;
  const double a = dot(np, np), b = dot(np, dp), c = dot(dp, dp) - r * r;
  double in = -1e300, out = 1e300;
  if (a > 1e-24) {
    const double disc = b * b - a * c;
    if (!(disc >= 0)) return {};
    const double root = std::sqrt(disc);
    in = (-b - root) / a, out = (-b + root) / a;
  } else if (c > 0) {
    return {};
  }
  // Between the end planes: 0 <= de + h ne <= length.
  if (std::abs(ne) < 1e-15) return de >= 0 && de <= length ? Span{in, out} : Span{};
  const double h0 = -de / ne, h1 = (length - de) / ne;
  return {std::max(in, std::min(h0, h1)), std::min(out, std::max(h0, h1))};
}

Point3 nearest_in(const Box3& box, Point3 p) {
  return {std::clamp(p.x, box.lo.x, box.hi.x), std::clamp(p.y, box.lo.y, box.hi.y),
          std::clamp(p.z, box.lo.z, box.hi.z)};
}
double squared_distance(Point3 p, const Box3& box) {
  const Vec3 d = p - nearest_in(box, p);
  return dot(d, d);
}

/// Whether every place of the box is farther than r from all q + h n with from <= h <= to. The distance is
/// convex in h: where it still falls at `to` it is least there. Else the ball about the box says something.
/// False also means "not known".
bool out_of_reach(Point3 q, Vec3 n, double from, double to, const Box3& box, double r) {
  const Point3 p = q + to * n;
  const Vec3 away = p - nearest_in(box, p);
  if (dot(away, n) <= 0) return dot(away, away) > r * r;
  const Point3 middle = lerp(box.lo, box.hi, 0.5);
  const double far = distance(middle, q + std::clamp(dot(middle - q, n), from, to) * n);
  return far > r + 0.5 * box.diagonal();
}

}  // namespace

Sweep::Sweep(std::vector<Segment> segments, double radius) : segments_(std::move(segments)), radius_(radius) {
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(segments_.size()));
}

void Sweep::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
  Box3 box, centers;
  for (std::uint32_t i = begin; i < end; ++i) {
    box.add(segments_[i].a);
    box.add(segments_[i].b);
    centers.add(lerp(segments_[i].a, segments_[i].b, 0.5));
  }
  nodes_[node].box = box;
  if (end - begin <= kLeaf) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  const Vec3 size = centers.hi - centers.lo;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t half = begin + (end - begin) / 2;
  std::nth_element(segments_.begin() + begin, segments_.begin() + half, segments_.begin() + end,
                   [axis](const Segment& a, const Segment& b) { return middle(a, axis) < middle(b, axis); });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = child;
  nodes_[node].count = 0;
  split(child, begin, half);
  split(child + 1, half, end);
}

std::optional<double> Sweep::entry(Point3 q, Vec3 n, double from, double to) const {
  if (segments_.empty()) return std::nullopt;
  double best = to;
  bool found = false;
  const auto take = [&](Span span) {
    const double in = std::max(span.in, from);
    if (in <= span.out && in <= best) best = in, found = true;
  };
  // Halving needs at most 32 levels; two children each wait at once.
  std::array<std::uint32_t, 80> stack{};
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (out_of_reach(q, n, from, best, node.box, radius_)) continue;
    if (node.count == 0) {
      // The nearer child first: what it gives rules most of the other out.
      const bool first =
          squared_distance(q, nodes_[node.first].box) <= squared_distance(q, nodes_[node.first + 1].box);
      stack[depth++] = node.first + (first ? 1 : 0);
      stack[depth++] = node.first + (first ? 0 : 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      take(through_ball(q, n, segments_[i].a, radius_));
      take(through_ball(q, n, segments_[i].b, radius_));
      take(through_cylinder(q, n, segments_[i], radius_));
    }
  }
  return found ? std::optional(best) : std::nullopt;
}

}  // namespace burin::verify
