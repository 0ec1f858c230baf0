// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/sweep.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "burin/geom/point_tools.h"

namespace burin::verify {
namespace {

using geom::Box3;
using geom::Point3;
using geom::Vec3;

constexpr std::uint32_t kLeaf = 4;
constexpr double kRounding = 1e-12;  // of the half diagonal of a box, as a bound

double middle(const Sweep::Segment& s, std::size_t axis) {
  return component(s.a, axis) + component(s.b, axis);
}

/// Where the line enters a ball, and leaves it.
struct Span {
  double in = 0, out = -1;
};
Span hull(Span a, Span b) {
  if (a.in > a.out) return b;
  if (b.in > b.out) return a;
  return {std::min(a.in, b.in), std::max(a.out, b.out)};
}
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

/// Bounds of where the line enters and leaves balls whose centres lie in a sphere; in > out: it meets none.
Span through_balls(Point3 q, Vec3 n, Point3 middle, double spread, double r) {
  const Vec3 d = middle - q;
  const double along = dot(d, n);
  const double aside = std::max(0.0, std::sqrt(std::max(0.0, dot(d, d) - along * along)) - spread);
  if (aside > r) return {};
  const double half = std::sqrt((r - aside) * (r + aside));
  return {along - spread - half, along + spread + half};
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
  if (begin < end) nodes_[node].middle = lerp(box.lo, box.hi, 0.5);
  nodes_[node].spread = 0.5 * box.diagonal() * (1 + kRounding);
  if (end - begin <= kLeaf) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  const Vec3 size = centers.hi - centers.lo;
  const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
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

std::optional<double> Sweep::entry(Point3 q, Vec3 n, double from, double to, double leaves_at) const {
  if (segments_.empty()) return std::nullopt;
  double best = to;
  bool found = false;
  const auto take = [&](Span span) {
    const double in = std::max(span.in, from);
    if (in <= span.out && in <= best && span.out >= leaves_at) best = in, found = true;
  };
  // Halving needs at most 32 levels; two children each wait at once, the one with the lower bound is next.
  std::array<std::uint32_t, 80> stack{};
  std::size_t depth = 0;
  stack[depth++] = 0;
  const auto bounds = [&](const Node& node) {
    return through_balls(q, n, node.middle, node.spread, radius_);
  };
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    const Span span = bounds(node);
    if (std::max(span.in, from) > std::min(span.out, best) || span.out < leaves_at) continue;
    if (node.count == 0) {
      const bool second_first = bounds(nodes_[node.first + 1]).in < bounds(nodes_[node.first]).in;
      stack[depth++] = node.first + (second_first ? 0 : 1);
      stack[depth++] = node.first + (second_first ? 1 : 0);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      // A capsule is convex: what the line has of its three parts is one span.
      take(
          hull(hull(through_ball(q, n, segments_[i].a, radius_), through_ball(q, n, segments_[i].b, radius_)),
               through_cylinder(q, n, segments_[i], radius_)));
    }
  }
  return found ? std::optional(best) : std::nullopt;
}

}  // namespace burin::verify
