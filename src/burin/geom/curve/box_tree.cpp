// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/box_tree.h"

#include <algorithm>
#include <cmath>

#include "burin/geom/curve/segment_meet.h"

namespace burin::geom::detail {

BoxTree::BoxTree(const RawCurves& curves, double eps) : curves_(curves) {
  const std::size_t n = curves.segments.size();
  loop_of_.resize(n);
  for (std::size_t k = 0; k < curves.loops(); ++k) {
    std::fill(loop_of_.begin() + curves.first[k], loop_of_.begin() + curves.first[k + 1],
              static_cast<std::uint32_t>(k));
  }
  levels_.emplace_back(n);
  for (std::size_t i = 0; i < n; ++i) levels_[0][i] = quick_bounds(curves.segments[i]).grown(eps);
  while (levels_.back().size() > 1) {
    const std::vector<Box2>& below = levels_.back();
    std::vector<Box2> level((below.size() + kFan - 1) / kFan);
    for (std::size_t i = 0; i < below.size(); ++i) level[i / kFan].add(below[i]);
    levels_.push_back(std::move(level));
  }
}

namespace {

/// Whether an end counts as above the ray: half open, so that a vertex on the ray is counted once.
int above(double y, double ray_y) {
  return y > ray_y ? 1 : 0;
}

}  // namespace

void BoxTree::cast_segment(std::size_t i, Ray& ray) const {
  const Segment& s = curves_.segments[i];
  const bool swap = ray.axis == 1;
  // Axis 1 is axis 0 in the mirrored plane (x and y exchanged), which also turns arcs the other way.
  const Point2 a = swap ? Point2{s.a.y, s.a.x} : s.a, b = swap ? Point2{s.b.y, s.b.x} : s.b;
  const Point2 p = ray.p;
  const bool is_on = std::find(ray.on.begin(), ray.on.end(), static_cast<std::uint32_t>(i)) != ray.on.end();
  const int rise = above(b.y, p.y) - above(a.y, p.y);
  double side = cross(b - a, p - a);
  const auto near_chord = [&] { return side * side <= ray.tolerance * ray.tolerance * distance2(a, b); };
  if (s.is_line()) {
    if (is_on || rise == 0) return;
    if (near_chord()) ray.close.push_back(static_cast<std::uint32_t>(i));
    // Beyond the point when the point is left of an upward line, right of a downward one.
    if (rise > 0 ? side > 0 : side < 0) ray.number += rise;
    return;
  }
  // Chord by crossing, and a full turn when the point is between chord and arc.
  const Point2 c = swap ? Point2{s.center.y, s.center.x} : s.center;
  const double radius = swap ? -s.radius : s.radius, r = std::abs(radius);
  if (is_on) side = radius > 0 ? -1 : 1;  // on the arc's side of the chord, however flat the arc
  if (rise > 0 ? side > 0 : rise < 0 && side < 0) ray.number += rise;
  const bool upward = b.y > a.y || (b.y == a.y && b.x < a.x);
  const bool arc_side = radius > 0 ? side < 0 || (side == 0 && upward) : side > 0 || (side == 0 && !upward);
  bool inside = c.x > p.x;
  if (!is_on) {
    const double off2 = distance2(p, c);
    inside = off2 < r * r;
    if (std::abs(off2 - r * r) <= 2 * r * ray.tolerance && (arc_side || (rise != 0 && near_chord()))) {
      ray.close.push_back(static_cast<std::uint32_t>(i));
    }
  }
  if (!arc_side) return;
  if (inside) ray.number += radius > 0 ? 1 : -1;
}

void BoxTree::cast(std::size_t level, std::size_t node, Ray& ray) const {
  const Box2& box = levels_[level][node];
  const bool swap = ray.axis == 1;
  const double y_lo = swap ? box.lo.x : box.lo.y, y_hi = swap ? box.hi.x : box.hi.y;
  const double x_lo = swap ? box.lo.y : box.lo.x, x_hi = swap ? box.hi.y : box.hi.x;
  if (ray.p.y > y_hi || ray.p.y < y_lo || ray.p.x > x_hi) return;
  if (x_lo > ray.p.x) {
    // Wholly beyond: a run counts by its two ends alone, and loops that lie in it as a whole count nothing.
    const std::size_t lo = node << (kFanBits * level);
    const std::size_t hi = std::min((node + 1) << (kFanBits * level), curves_.segments.size());
    const auto run = [&](std::size_t first, std::size_t end) {
      const Point2 from = curves_.segments[first].a, to = curves_.segments[end - 1].b;
      return above(swap ? to.x : to.y, ray.p.y) - above(swap ? from.x : from.y, ray.p.y);
    };
    const std::uint32_t first_loop = loop_of_[lo], last_loop = loop_of_[hi - 1];
    ray.number += first_loop == last_loop
                      ? run(lo, hi)
                      : run(lo, curves_.first[first_loop + 1]) + run(curves_.first[last_loop], hi);
    return;
  }
  if (level == 0) {
    cast_segment(node, ray);
    return;
  }
  const std::size_t end = std::min((node + 1) * kFan, levels_[level - 1].size());
  for (std::size_t i = node * kFan; i < end; ++i) cast(level - 1, i, ray);
}

int BoxTree::winding_beyond(Point2 p, int axis, std::span<const std::uint32_t> on, double tolerance,
                            std::vector<std::uint32_t>& close) const {
  Ray ray{axis == 1 ? Point2{p.y, p.x} : p, axis, on, tolerance, close};
  close.clear();
  if (!curves_.segments.empty()) cast(levels_.size() - 1, 0, ray);
  return axis == 1 ? -ray.number : ray.number;
}

}  // namespace burin::geom::detail
