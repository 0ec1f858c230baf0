// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/arc_spline.h"

#include <cmath>

namespace burin::geom {
namespace {

/// Angle from u to v, turning counter-clockwise, in [0, 2 pi).
double turn_ccw(Vec2 u, Vec2 v) {
  const double angle = std::atan2(cross(u, v), dot(u, v));
  return angle < 0 ? angle + 2 * kPi : angle;
}

Point2 on_circle(const Segment& s, Vec2 direction) {
  return s.center + std::abs(s.radius) * direction;
}

/// Radii from the centre to start and end, in the order in which they are met counter-clockwise.
struct CcwEnds {
  Vec2 from, to;
};
CcwEnds ccw_ends(const Segment& s) {
  return s.radius > 0 ? CcwEnds{s.a - s.center, s.b - s.center} : CcwEnds{s.b - s.center, s.a - s.center};
}

/// Whether direction v lies in the counter-clockwise turn from u to w (ends included); u == w is a full turn.
bool between_ccw(Vec2 u, Vec2 w, Vec2 v) {
  const double uw = cross(u, w);
  if (uw > 0 || (uw == 0 && dot(u, w) < 0)) {  // up to a half turn
    if (uw == 0) return cross(u, v) >= 0;
    return cross(u, v) >= 0 && cross(v, w) >= 0;
  }
  return !(cross(w, v) > 0 && cross(v, u) > 0);  // more than a half turn: not in the open rest
}

}  // namespace

Segment make_line(Point2 a, Point2 b, std::uint32_t source) {
  return {a, b, {}, 0, source};
}

Segment make_arc(Point2 a, Point2 b, Point2 center, bool counter_clockwise, std::uint32_t source) {
  const double r = distance(a, center);
  return {a, b, center, counter_clockwise ? r : -r, source};
}

Segment from_bulge(Point2 a, Point2 b, double bulge, std::uint32_t source) {
  const Vec2 chord = b - a;
  const double length = norm(chord);
  // A sagitta below the rounding of the coordinates is a line; its centre could not be computed.
  if (bulge == 0 || length == 0 || std::abs(bulge) < 1e-14) return make_line(a, b, source);
  // With h = chord / 2: sagitta = h |bulge|, radius = h (1 + bulge^2) / (2 |bulge|), and the centre lies left
  // of the chord's middle by h (1 - bulge^2) / (2 bulge).
  const Point2 middle = lerp(a, b, 0.5);
  const Point2 center = middle + ((1 - bulge * bulge) / (4 * bulge)) * left(chord);
  const double radius = 0.25 * length * (1 + bulge * bulge) / bulge;
  return {a, b, center, radius, source};
}

double bulge_of(const Segment& s) {
  return s.is_line() ? 0.0 : std::tan(0.25 * sweep_of(s));
}

double sweep_of(const Segment& s) {
  if (s.is_line()) return 0;
  const double turn =
      s.radius > 0 ? turn_ccw(s.a - s.center, s.b - s.center) : turn_ccw(s.b - s.center, s.a - s.center);
  return s.radius > 0 ? turn : -turn;
}

double length_of(const Segment& s) {
  return s.is_line() ? distance(s.a, s.b) : std::abs(s.radius * sweep_of(s));
}

bool in_sweep(const Segment& s, Point2 p) {
  if (s.is_line()) return false;
  const CcwEnds e = ccw_ends(s);
  return between_ccw(e.from, e.to, p - s.center);
}

Box2 bounds_of(const Segment& s) {
  Box2 box;
  box.add(s.a);
  box.add(s.b);
  if (s.is_line()) return box;
  const CcwEnds e = ccw_ends(s);
  for (const Vec2 axis : {Vec2{1, 0}, Vec2{0, 1}, Vec2{-1, 0}, Vec2{0, -1}}) {
    if (between_ccw(e.from, e.to, axis)) box.add(on_circle(s, axis));
  }
  return box;
}

Vec2 start_tangent(const Segment& s) {
  if (s.is_line()) return unit(s.b - s.a);
  const Vec2 r = unit(s.a - s.center);
  return s.radius > 0 ? left(r) : right(r);
}

Vec2 end_tangent(const Segment& s) {
  if (s.is_line()) return unit(s.b - s.a);
  const Vec2 r = unit(s.b - s.center);
  return s.radius > 0 ? left(r) : right(r);
}

Point2 point_on(const Segment& s, double f) {
  if (f <= 0) return s.a;
  if (f >= 1) return s.b;
  if (s.is_line()) return lerp(s.a, s.b, f);
  const double angle = f * sweep_of(s);
  const Vec2 r = s.a - s.center;
  return s.center + std::cos(angle) * r + std::sin(angle) * left(r);
}

Segment reversed(const Segment& s) {
  return {s.b, s.a, s.center, s.radius == 0 ? 0 : -s.radius, s.source};
}

Nearest nearest_on(const Segment& s, Point2 p) {
  const double da = distance(p, s.a);
  const double db = distance(p, s.b);
  Nearest best = da <= db ? Nearest{da, s.a} : Nearest{db, s.b};
  if (s.is_line()) {
    const Vec2 v = s.b - s.a;
    const double vv = norm2(v);
    if (vv == 0) return best;
    const double t = dot(p - s.a, v) / vv;
    if (t <= 0 || t >= 1) return best;
    const Point2 foot = lerp(s.a, s.b, t);
    return {distance(p, foot), foot};
  }
  if (!in_sweep(s, p)) return best;
  const Vec2 r = p - s.center;
  const double n = norm(r);
  if (n == 0) return best;
  const double d = std::abs(n - std::abs(s.radius));
  return d < best.distance ? Nearest{d, on_circle(s, r / n)} : best;
}

double signed_area(const ArcSpline& s) {
  if (s.segments.empty()) return 0;
  // Shoelace about the first vertex (cancellation is least near the figure), plus the arcs' circular
  // segments.
  const Point2 o = s.segments.front().a;
  double area = 0;
  for (const Segment& seg : s.segments) {
    area += 0.5 * cross(seg.a - o, seg.b - o);
    if (!seg.is_line()) {
      const double sweep = sweep_of(seg);
      area += 0.5 * seg.radius * seg.radius * (sweep - std::sin(sweep));
    }
  }
  return area;
}

double length_of(const ArcSpline& s) {
  double length = 0;
  for (const Segment& seg : s.segments) length += length_of(seg);
  return length;
}

Box2 bounds_of(const ArcSpline& s) {
  Box2 box;
  for (const Segment& seg : s.segments) box.add(bounds_of(seg));
  return box;
}

ArcSpline reversed(const ArcSpline& s) {
  ArcSpline out;
  out.closed = s.closed;
  out.segments.reserve(s.segments.size());
  for (auto it = s.segments.rbegin(); it != s.segments.rend(); ++it) out.segments.push_back(reversed(*it));
  return out;
}

int winding_number(const ArcSpline& s, Point2 p) {
  // Winding of the chord polygon by crossings of the ray to the right, plus a full turn for every circular
  // segment (between chord and arc) that holds p.
  int winding = 0;
  for (const Segment& seg : s.segments) {
    const double side = cross(seg.b - seg.a, p - seg.a);
    if (seg.a.y <= p.y && seg.b.y > p.y && side > 0) ++winding;
    if (seg.a.y > p.y && seg.b.y <= p.y && side < 0) --winding;
    if (seg.is_line() || distance2(p, seg.center) >= seg.radius * seg.radius) continue;
    // Inside the circle: between chord and arc when on the arc's side of the chord. A point on the chord
    // itself is on the side that the crossing rule above gave it: left of an upward chord is strict.
    const bool upward = seg.b.y > seg.a.y || (seg.b.y == seg.a.y && seg.b.x < seg.a.x);
    if (seg.radius > 0 && (side < 0 || (side == 0 && upward))) ++winding;
    if (seg.radius < 0 && (side > 0 || (side == 0 && !upward))) --winding;
  }
  return winding;
}

double distance_to(const ArcSpline& s, Point2 p) {
  double best = std::numeric_limits<double>::infinity();
  for (const Segment& seg : s.segments) best = std::min(best, nearest_on(seg, p).distance);
  return best;
}

int count_g1_breaks(const ArcSpline& s, double tangent_rad) {
  int breaks = 0;
  const std::size_t n = s.segments.size();
  for (std::size_t i = 0; i + (s.closed ? 0 : 1) < n; ++i) {
    const Vec2 u = end_tangent(s.segments[i]);
    const Vec2 v = start_tangent(s.segments[(i + 1) % n]);
    if (std::abs(std::atan2(cross(u, v), dot(u, v))) > tangent_rad) ++breaks;
  }
  return breaks;
}

}  // namespace burin::geom
