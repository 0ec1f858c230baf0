// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/segment_meet.h"

#include <cmath>

namespace burin::geom::detail {
namespace {

/// Positive on the arc's side of its chord.
double arc_side(const Segment& s, Point2 p) {
  const double side = cross(p - s.a, s.b - s.a);
  return s.radius > 0 ? side : -side;
}

Candidates lines_meet(const Segment& s, const Segment& t) {
  const Vec2 u = s.b - s.a, v = t.b - t.a;
  const double den = cross(u, v);
  if (den == 0) return {};
  const double f = cross(t.a - s.a, v) / den;
  // Parallel within rounding: the point may lie anywhere, the caller checks it against both.
  if (!(f > -1 && f < 2)) return {};
  return {{s.a + f * u, {}}, 1};
}

Candidates line_meets_circle(const Segment& line, const Segment& arc, double eps) {
  const Vec2 u = unit(line.b - line.a);
  const double along = dot(arc.center - line.a, u);
  const double off = cross(arc.center - line.a, u);
  const double r = std::abs(arc.radius);
  if (std::abs(off) > r + eps) return {};
  const double half2 = (r - off) * (r + off);
  if (half2 <= 0) return {{line.a + along * u, {}}, 1};
  const double half = std::sqrt(half2);
  return {{line.a + (along - half) * u, line.a + (along + half) * u}, 2};
}

Candidates circles_meet(const Segment& s, const Segment& t, double eps) {
  // Measured from the smaller circle: from a much larger one the cancellation would cost all precision.
  const bool s_smaller = std::abs(s.radius) <= std::abs(t.radius);
  const Point2 c = s_smaller ? s.center : t.center;
  const Vec2 w = s_smaller ? t.center - s.center : s.center - t.center;
  const double r = std::min(std::abs(s.radius), std::abs(t.radius));
  const double big = std::max(std::abs(s.radius), std::abs(t.radius));
  const double dd = norm(w);
  // One circle within rounding of the other: what they share begins and ends at segment ends.
  if (dd > r + big + eps || dd + r + eps < big || dd < 1e-2 * eps) return {};
  const Vec2 e = w / dd;
  const double x = 0.5 * ((dd - big) * ((dd + big) / dd) + r * (r / dd));
  const double half2 = (r - x) * (r + x);
  if (half2 <= 0) return {{c + (x > 0 ? r : -r) * e, {}}, 1};
  const double half = std::sqrt(half2);
  const Point2 foot = c + x * e;
  return {{foot + half * left(e), foot - half * left(e)}, 2};
}

/// Bound of the height of an arc above its chord: for up to half a turn h = (c^2 / 4) / (r + sqrt(r^2 - c^2 /
/// 4)).
double height_bound(const Segment& s) {
  return s.is_line() ? 0.0 : distance2(s.a, s.b) / (4 * std::abs(s.radius));
}

/// All of t on one side of s's chord, further away than both heights and eps together.
bool beside(const Segment& s, const Segment& t, double reach) {
  const Vec2 u = s.b - s.a;
  const double side_a = cross(u, t.a - s.a), side_b = cross(u, t.b - s.a);
  const double nearer = std::min(std::abs(side_a), std::abs(side_b));
  return side_a * side_b > 0 && nearer * nearer > reach * reach * norm2(u);
}

class Collector {
 public:
  explicit Collector(double eps) : eps2_(eps * eps) {}
  void crossing(Point2 p) { add(p); }
  void end(Point2 p) {
    overlap_ = true;
    add(p);
  }
  Meeting meeting() const {
    if (points_.count == 0) return NoMeet{};
    if (overlap_) return points_;
    if (points_.count == 1) return OneMeet{points_.points[0]};
    return TwoMeets{points_.points[0], points_.points[1]};
  }

 private:
  void add(Point2 p) {
    for (int i = 0; i < points_.count; ++i) {
      if (distance2(points_.points[static_cast<std::size_t>(i)], p) <= 1e-6 * eps2_) return;
    }
    points_.points[static_cast<std::size_t>(points_.count++)] = p;
  }
  double eps2_;
  bool overlap_ = false;
  Overlap points_;
};

/// Whether p is within eps of the segment.
bool near_segment(const Segment& s, Point2 p, double eps) {
  const double eps2 = eps * eps;
  if (s.is_line()) {
    const Vec2 u = s.b - s.a, v = p - s.a;
    const double uu = norm2(u), along = dot(u, v);
    if (along <= 0 || uu == 0) return norm2(v) <= eps2;
    if (along >= uu) return distance2(p, s.b) <= eps2;
    const double off = cross(u, v);
    return off * off <= eps2 * uu;
  }
  if (arc_side(s, p) >= 0) {
    const double r = std::abs(s.radius);
    const double off2 = distance2(p, s.center);
    const double lo = r - eps, hi = r + eps;
    if (off2 <= hi * hi && (lo <= 0 || off2 >= lo * lo)) return true;
  }
  return distance2(p, s.a) <= eps2 || distance2(p, s.b) <= eps2;
}

}  // namespace

Candidates carriers_meet(const Segment& s, const Segment& t, double eps) {
  if (s.is_line()) return t.is_line() ? lines_meet(s, t) : line_meets_circle(s, t, eps);
  return t.is_line() ? line_meets_circle(t, s, eps) : circles_meet(s, t, eps);
}

Meeting meet(const Segment& s, const Segment& t, double eps) {
  const double reach = height_bound(s) + height_bound(t) + eps;
  if (beside(s, t, reach) || beside(t, s, reach)) return NoMeet{};
  Collector found(eps);
  const Candidates c = carriers_meet(s, t, eps);
  for (int i = 0; i < c.count; ++i) {
    const Point2 p = c.p[static_cast<std::size_t>(i)];
    if (near_segment(s, p, 2 * eps) && near_segment(t, p, 2 * eps)) found.crossing(p);
  }
  if (near_segment(t, s.a, eps)) found.end(s.a);
  if (near_segment(t, s.b, eps)) found.end(s.b);
  if (near_segment(s, t.a, eps)) found.end(t.a);
  if (near_segment(s, t.b, eps)) found.end(t.b);
  return found.meeting();
}

Meeting meet_neighbours(const Segment& s, const Segment& t, double eps) {
  const Point2 joint = s.b;
  const double eps2 = eps * eps;
  // Lines share another point only when the second turns back.
  if (s.is_line() && t.is_line() && dot(s.b - s.a, t.b - t.a) >= 0) return NoMeet{};
  Collector found(eps);
  // Two segments that make a whole loop meet at both ends.
  const bool loop = s.a == t.b;
  const auto consider = [&](Point2 p) {
    if (loop && distance2(p, s.a) <= eps2) return;
    if (distance2(p, joint) > eps2 && near_segment(s, p, 2 * eps) && near_segment(t, p, 2 * eps)) {
      found.crossing(p);
    }
  };
  // The joint is one of the two points the carriers share; the other is its mirror image.
  if (s.is_line() != t.is_line()) {
    const Vec2 u = s.is_line() ? s.a - joint : t.b - joint;  // from the joint along the line
    const Point2 center = s.is_line() ? t.center : s.center;
    const double f = 2 * dot(center - joint, u);
    if (f > 0) consider(joint + (f / norm2(u)) * u);
  } else if (!s.is_line()) {
    const Vec2 w = t.center - s.center;
    const double ww = norm2(w);
    if (ww > 0) consider(joint - (2 * cross(w, joint - s.center) / ww) * left(w));
  }
  if (loop) return found.meeting();
  if (distance2(s.a, joint) > eps2 && near_segment(t, s.a, eps)) found.end(s.a);
  if (distance2(t.b, joint) > eps2 && near_segment(s, t.b, eps)) found.end(t.b);
  return found.meeting();
}

Segment refitted(Segment s) {
  if (s.is_line()) return s;
  const Vec2 chord = s.b - s.a;
  const double length = norm(chord);
  if (length == 0) return make_line(s.a, s.b, s.source);
  const Point2 middle = lerp(s.a, s.b, 0.5);
  const Vec2 n = left(chord) / length;
  const double h = dot(s.center - middle, n);
  s.center = middle + h * n;
  const double r = std::sqrt(h * h + 0.25 * length * length);
  s.radius = s.radius > 0 ? r : -r;
  return s;
}

bool more_than_half_turn(const Segment& s) {
  const double inner = cross(s.b - s.a, s.center - s.a);
  return s.radius > 0 ? inner < 0 : inner > 0;
}

Point2 middle_of(const Segment& s) {
  const Point2 chord_middle = lerp(s.a, s.b, 0.5);
  if (s.is_line()) return chord_middle;
  // For short arcs the direction of the chord is unsure when the ends are; that to its middle is not.
  const Vec2 v = chord_middle - s.center;
  const double length = norm(v), r = std::abs(s.radius);
  if (length > 0.5 * r && !more_than_half_turn(s)) return s.center + (r / length) * v;
  return s.center + s.radius * right(unit(s.b - s.a));
}

Box2 quick_bounds(const Segment& s) {
  Box2 box;
  box.add(s.a);
  box.add(s.b);
  if (s.is_line()) return box;
  // side(center + r e) for the four axis directions e, up to the common part.
  const Vec2 chord = s.b - s.a;
  const double r = std::abs(s.radius), sign = s.radius > 0 ? 1 : -1;
  const double base = sign * cross(s.center - s.a, chord);
  const double rx = sign * r * chord.x, ry = sign * r * chord.y;
  if (base + ry >= 0) box.hi.x = std::max(box.hi.x, s.center.x + r);
  if (base - ry >= 0) box.lo.x = std::min(box.lo.x, s.center.x - r);
  if (base - rx >= 0) box.hi.y = std::max(box.hi.y, s.center.y + r);
  if (base + rx >= 0) box.lo.y = std::min(box.lo.y, s.center.y - r);
  return box;
}

}  // namespace burin::geom::detail
