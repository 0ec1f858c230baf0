// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/flat.h"

#include <algorithm>
#include <cmath>

namespace burin::verify::flat {
namespace {

using geom::cross;
using geom::distance;
using geom::dot;
using geom::norm;

constexpr double kQuarter = 0.5 * geom::kPi;

/// Unit vector from the centre of an arc to where the tangents of its ends meet, and how far that is.
Point2 tangents_meet(const Segment& s) {
  const Vec2 u = s.a - s.center, v = s.b - s.center;
  const Vec2 w = u + v;
  // |w| = 2 R cos(half), the tangents meet at R / cos(half) along w.
  return s.center + (2 * s.radius * s.radius / norm2(w)) * w;
}

/// The points whose hull holds the segment.
struct Hull {
  Point2 p[3];
  int n = 2;
};
Hull hull_of(const Segment& s) {
  Hull h{{s.a, s.b, s.b}, 2};
  if (!s.is_line()) h.p[h.n++] = tangents_meet(s);
  return h;
}

template <class F>
double most_at(const Hull& h, const F& f) {
  double most = f(h.p[0]);
  for (int i = 1; i < h.n; ++i) most = std::max(most, f(h.p[i]));
  return most;
}

/// Whether p lies in the sector of a quarter arc at most, which is a convex cone.
bool in_cone(const Segment& k, Point2 p) {
  const double side = k.radius > 0 ? 1 : -1;
  const Vec2 v = p - k.center;
  return side * cross(k.a - k.center, v) >= 0 && side * cross(v, k.b - k.center) >= 0;
}

void take(Pair& best, double d, Point2 p, Point2 q) {
  if (d < best.distance) best = {d, p, q};
}

void ends(const Segment& s, const Segment& k, Pair& best) {
  for (const Point2 p : {s.a, s.b}) {
    const geom::Nearest near = nearest_on(k, p);
    take(best, near.distance, p, near.point);
  }
  for (const Point2 q : {k.a, k.b}) {
    const geom::Nearest near = nearest_on(s, q);
    take(best, near.distance, near.point, q);
  }
}

void lines(const Segment& s, const Segment& k, Pair& best) {
  const Vec2 u = s.b - s.a, v = k.b - k.a;
  const double d = cross(u, v);
  if (d == 0) return;
  const double t = cross(k.a - s.a, v) / d, w = cross(k.a - s.a, u) / d;
  if (t < 0 || t > 1 || w < 0 || w > 1) return;
  const Point2 p = lerp(s.a, s.b, t);
  best = {0, p, p};
}

/// `line` first in the pair.
void line_arc(const Segment& line, const Segment& arc, Pair& best) {
  const Vec2 v = line.b - line.a;
  const double length = norm(v), radius = std::abs(arc.radius);
  if (length == 0) return;
  const Vec2 u = v / length;
  const double foot = dot(arc.center - line.a, u);
  const Vec2 off = line.a + foot * u - arc.center;
  const double d = norm(off);
  if (d <= radius) {
    const double half = std::sqrt(std::max(0.0, radius * radius - d * d));
    for (const double t : {foot - half, foot + half}) {
      const Point2 p = line.a + t * u;
      if (t >= 0 && t <= length && in_sweep(arc, p)) best = {0, p, p};
    }
    return;
  }
  const Point2 p = arc.center + off;
  if (foot > 0 && foot < length && in_sweep(arc, p))
    take(best, d - radius, p, arc.center + (radius / d) * off);
}

void arcs(const Segment& s, const Segment& k, Pair& best) {
  const double r = std::abs(s.radius), q = std::abs(k.radius);
  const Vec2 between = k.center - s.center;
  const double d = norm(between);
  if (d == 0) return;
  const Vec2 u = between / d;
  if (d <= r + q && d >= std::abs(r - q)) {
    const double along = 0.5 * (d + (r - q) * (r + q) / d);
    const double off = std::sqrt(std::max(0.0, r * r - along * along));
    for (const double side : {-off, off}) {
      const Point2 p = s.center + along * u + side * left(u);
      if (in_sweep(s, p) && in_sweep(k, p)) best = {0, p, p};
    }
    return;
  }
  for (const double a : {-r, r}) {
    const Point2 p = s.center + a * u;
    if (!in_sweep(s, p)) continue;
    for (const double b : {-q, q}) {
      const Point2 other = k.center + b * u;
      if (in_sweep(k, other)) take(best, distance(p, other), p, other);
    }
  }
}

Range sorted(double a, double b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Of w . n where n turns from `from` to `to` by less than a half turn.
Range cone_dots(Vec2 w, Vec2 from, Vec2 to) {
  Range r = sorted(dot(w, from), dot(w, to));
  const double turn = cross(from, to) >= 0 ? 1 : -1;
  const auto between = [&](Vec2 v) { return turn * cross(from, v) > 0 && turn * cross(v, to) > 0; };
  if (between(w)) r.hi = norm(w);
  if (between(-w)) r.lo = -norm(w);
  return r;
}

}  // namespace

void quarters(const Segment& s, std::vector<Segment>& out) {
  const double turn = std::abs(sweep_of(s));
  const int n = std::max(1, static_cast<int>(std::ceil(turn / kQuarter - kRounding)));
  for (int i = 0; i < n; ++i) out.push_back(n == 1 ? s : stretch(s, double(i) / n, double(i + 1) / n));
}

Segment stretch(const Segment& s, double f0, double f1) {
  Segment part = s;
  part.a = point_on(s, f0);
  part.b = point_on(s, f1);
  return part;
}

Vec2 normal_at(const Segment& s, double f) {
  if (s.is_line()) return right(unit(s.b - s.a));
  const Vec2 out = unit(point_on(s, f) - s.center);
  return s.radius > 0 ? out : -out;
}

Pair nearest_pair(const Segment& s, const Segment& k) {
  Pair best;
  ends(s, k, best);
  if (best.distance == 0) return best;
  if (s.is_line() && k.is_line()) {
    lines(s, k, best);
  } else if (s.is_line()) {
    line_arc(s, k, best);
  } else if (k.is_line()) {
    Pair turned{best.distance, best.q, best.p};
    line_arc(k, s, turned);
    best = {turned.distance, turned.q, turned.p};
  } else {
    arcs(s, k, best);
  }
  return best;
}

Range distances_from(Point2 c, const Segment& s) {
  Range r = sorted(distance(c, s.a), distance(c, s.b));
  if (s.is_line()) {
    r.lo = std::min(r.lo, nearest_on(s, c).distance);
    return r;
  }
  const Vec2 v = c - s.center;
  const double d = norm(v), radius = std::abs(s.radius);
  if (d == 0) return {radius, radius};
  if (in_sweep(s, s.center + v)) r.lo = std::min(r.lo, std::abs(d - radius));
  if (in_sweep(s, s.center - v)) r.hi = std::max(r.hi, d + radius);
  return r;
}

double most_distance(const Segment& s, const Segment& k) {
  const Hull hull = hull_of(s);
  if (k.is_line()) return most_at(hull, [&](Point2 p) { return nearest_on(k, p).distance; });
  double most = std::min(distances_from(k.a, s).hi, distances_from(k.b, s).hi);
  if (in_cone(k, s.a) && in_cone(k, s.b) && (hull.n < 3 || in_cone(k, hull.p[2]))) {
    const Range d = distances_from(k.center, s);
    const double radius = std::abs(k.radius);
    most = std::min(most, std::max(d.hi - radius, radius - d.lo));
  }
  const double da = nearest_on(k, s.a).distance, db = nearest_on(k, s.b).distance;
  return std::min(most, 0.5 * (da + db + length_of(s)));
}

Range normal_dots(Vec2 w, const Segment& s) {
  if (s.is_line()) {
    const double d = dot(w, normal_at(s, 0));
    return {d, d};
  }
  return cone_dots(w, normal_at(s, 0), normal_at(s, 1));
}
Range normal_crosses(Vec2 w, const Segment& s) {
  return normal_dots(left(w), s);  // w x n = left(w) . n
}

Range heights(Point2 q, Vec2 m, const Segment& s) {
  if (s.is_line()) return sorted(dot(s.a - q, m), dot(s.b - q, m));
  const Range d = cone_dots(m, s.a - s.center, s.b - s.center);
  const double middle = dot(s.center - q, m);
  return {middle + d.lo, middle + d.hi};
}

// --- tree
// ------------------------------------------------------------------------------------------------------

Tree::Tree(std::vector<Segment> segments) : segments_(std::move(segments)) {
  if (segments_.empty()) return;
  std::vector<Box2> boxes;
  boxes.reserve(segments_.size());
  order_.resize(segments_.size());
  for (std::uint32_t i = 0; i < segments_.size(); ++i) {
    boxes.push_back(bounds_of(segments_[i]));
    order_[i] = i;
  }
  nodes_.reserve(segments_.size());
  build(0, static_cast<std::uint32_t>(segments_.size()), boxes);
}

void Tree::build(std::uint32_t first, std::uint32_t end, const std::vector<Box2>& boxes) {
  constexpr std::uint32_t kLeaf = 4;
  const std::size_t at = nodes_.size();
  nodes_.push_back({{}, first, end, 0});
  Box2 box, middles;
  const auto middle = [&](std::uint32_t i) { return lerp(boxes[i].lo, boxes[i].hi, 0.5); };
  for (std::uint32_t i = first; i < end; ++i) {
    box.add(boxes[order_[i]]);
    middles.add(middle(order_[i]));
  }
  nodes_[at].box = box;
  if (end - first <= kLeaf) return;
  const bool by_x = middles.width() >= middles.height();
  const std::uint32_t half = first + (end - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + end,
                   [&](std::uint32_t i, std::uint32_t j) {
                     const double a = by_x ? middle(i).x : middle(i).y, b = by_x ? middle(j).x : middle(j).y;
                     return a != b ? a < b : i < j;
                   });
  build(first, half, boxes);
  nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
  build(half, end, boxes);
}

/// Nearest first: key(box) is a lower bound for what leaf(index) can find; leaf lowers `limit`.
template <class Key, class Leaf>
void Tree::search(const Key& key, const Leaf& leaf, double& limit) const {
  if (nodes_.empty()) return;
  struct Open {
    std::uint32_t node;
    double least;
  };
  Open stack[kDepth];
  int top = 0;
  stack[top++] = {0, key(nodes_.front().box)};
  while (top > 0) {
    const Open open = stack[--top];
    if (open.least > limit) continue;
    const Node& node = nodes_[open.node];
    if (node.right == 0) {
      for (std::uint32_t i = node.first; i < node.end; ++i) leaf(order_[i]);
      continue;
    }
    const Open l{open.node + 1, key(nodes_[open.node + 1].box)}, r{node.right, key(nodes_[node.right].box)};
    stack[top++] = l.least <= r.least ? r : l;
    stack[top++] = l.least <= r.least ? l : r;
  }
}

namespace {

double distance_to(const Box2& box, Point2 p) {
  const double x = std::max({box.lo.x - p.x, 0.0, p.x - box.hi.x});
  const double y = std::max({box.lo.y - p.y, 0.0, p.y - box.hi.y});
  return std::hypot(x, y);
}

/// Crossings of the ray from p to the right, upwards 1, downwards -1. A segment holds its lower end only, and
/// arcs are taken in rising and falling parts that share their turning points exactly: no crossing is lost or
/// counted twice.
int crossings(const Segment& s, Point2 p) {
  const auto rising = [&](double from, double to) {
    return from <= p.y && p.y < to ? 1 : to <= p.y && p.y < from ? -1 : 0;
  };
  if (s.is_line()) {
    const int step = rising(s.a.y, s.b.y);
    if (step == 0) return 0;
    const double side = cross(s.b - s.a, p - s.a);
    return step * (step > 0 ? side > 0 : side < 0);
  }
  // A quarter passes one turning point at most.
  const double radius = std::abs(s.radius);
  const auto part = [&](double from, double to, bool right_half) {
    const int step = rising(from, to);
    if (step == 0) return 0;
    const double dy = p.y - s.center.y;
    const double half = std::sqrt(std::max(0.0, radius * radius - dy * dy));
    return s.center.x + (right_half ? half : -half) > p.x ? step : 0;
  };
  for (const double turning : {s.center.y - radius, s.center.y + radius}) {
    if (!in_sweep(s, {s.center.x, turning})) continue;
    // Between its ends: the travel along the circle says on which half each part lies.
    const bool top = turning > s.center.y;
    const bool before_right = (s.radius > 0) == top;
    return part(s.a.y, turning, before_right) + part(turning, s.b.y, !before_right);
  }
  const bool right_half = s.a.x + s.b.x > 2 * s.center.x;
  return part(s.a.y, s.b.y, right_half);
}

}  // namespace

Tree::Near Tree::nearest(Point2 p, double limit) const {
  Near best;
  search([&](const Box2& box) { return distance_to(box, p); },
         [&](std::uint32_t i) {
           const geom::Nearest near = nearest_on(segments_[i], p);
           if (near.distance > limit || !(near.distance < best.distance)) return;
           best = {near.distance, near.point, i};
           limit = near.distance;
         },
         limit);
  return best;
}

Tree::NearPair Tree::nearest(const Segment& s, double limit) const {
  NearPair best;
  const Box2 own = bounds_of(s);
  const auto least = [&](const Box2& box) {
    const double x = std::max({box.lo.x - own.hi.x, 0.0, own.lo.x - box.hi.x});
    const double y = std::max({box.lo.y - own.hi.y, 0.0, own.lo.y - box.hi.y});
    const double boxes = std::hypot(x, y);
    if (boxes > limit) return boxes;
    // Long slanted segments fill little of their box.
    return std::max(boxes, nearest_on(s, lerp(box.lo, box.hi, 0.5)).distance -
                               0.5 * std::hypot(box.width(), box.height()));
  };
  search(
      least,
      [&](std::uint32_t i) {
        if (best.distance == 0) return;
        const Pair pair = nearest_pair(s, segments_[i]);
        if (pair.distance > limit || !(pair.distance < best.distance)) return;
        best = {pair, i};
        limit = pair.distance;
      },
      limit);
  return best;
}

int Tree::winding(Point2 p, std::uint32_t first, std::uint32_t end) const {
  int sum = 0;
  std::uint32_t stack[kDepth];
  int top = 0;
  if (!nodes_.empty()) stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t at = stack[--top];
    const Node& node = nodes_[at];
    if (node.box.lo.y > p.y || node.box.hi.y < p.y || node.box.hi.x < p.x) continue;
    if (node.right != 0) {
      stack[top++] = node.right;
      stack[top++] = at + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.end; ++i) {
      if (order_[i] < first || order_[i] >= end) sum += crossings(segments_[order_[i]], p);
    }
  }
  return sum;
}

}  // namespace burin::verify::flat
