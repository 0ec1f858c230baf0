// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/intersect.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace burin::geom {
namespace {

/// Position of p along s, in mm from its start (arcs: along the circle); p is near s.
double along(const Segment& s, Point2 p) {
  if (s.is_line()) return dot(p - s.a, unit(s.b - s.a));
  const Vec2 u = s.a - s.center, v = p - s.center;
  double angle = std::atan2(cross(u, v), dot(u, v));
  if (s.radius < 0) angle = -angle;
  if (angle < 0) angle += 2 * kPi;
  return angle * std::abs(s.radius);
}

bool on_segment(const Segment& s, Point2 p, double tolerance) {
  return nearest_on(s, p).distance <= tolerance;
}

/// Collects points, each once, that lie on both segments.
class Points {
 public:
  Points(const Segment& s, const Segment& t, double tolerance) : s_(s), t_(t), tolerance_(tolerance) {}
  void offer(Point2 p) {
    if (found_.count == 2 || !on_segment(s_, p, tolerance_) || !on_segment(t_, p, tolerance_)) return;
    if (found_.count == 1 && distance(p, found_.point[0]) <= 2 * tolerance_) return;
    found_.point[static_cast<std::size_t>(found_.count++)] = p;
  }
  Intersection result() const {
    return found_.count > 0 ? Intersection{found_} : Intersection{NoIntersection{}};
  }

 private:
  const Segment& s_;
  const Segment& t_;
  double tolerance_;
  PointIntersections found_;
};

void offer_ends(Points& points, const Segment& s, const Segment& t) {
  for (const Point2 p : {s.a, s.b, t.a, t.b}) points.offer(p);
}

/// The shared stretches of two segments with the same carrier.
Intersection overlap(const Segment& s, const Segment& t, double tolerance) {
  // Cut s at the ends of t that lie on it; a piece is shared when its middle lies on t.
  const double length = length_of(s);
  std::vector<double> cuts{0, length};
  for (const Point2 p : {t.a, t.b}) {
    if (on_segment(s, p, tolerance)) cuts.push_back(std::clamp(along(s, p), 0.0, length));
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<std::pair<Point2, Point2>> shared;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i + 1] - cuts[i] <= tolerance) continue;
    if (!on_segment(t, point_on(s, 0.5 * (cuts[i] + cuts[i + 1]) / length), tolerance)) continue;
    const Point2 a = point_on(s, cuts[i] / length), b = point_on(s, cuts[i + 1] / length);
    if (!shared.empty() && distance(shared.back().second, a) <= tolerance) {
      shared.back().second = b;
    } else {
      shared.emplace_back(a, b);
    }
  }
  if (shared.empty()) {
    Points points(s, t, tolerance);
    offer_ends(points, s, t);
    return points.result();
  }
  Overlap out{shared[0].first, shared[0].second};
  if (shared.size() > 1) out = {out.a, out.b, true, shared[1].first, shared[1].second};
  return out;
}

Intersection lines(const Segment& s, const Segment& t, double tolerance) {
  const Vec2 u = s.b - s.a, v = t.b - t.a;
  const double du = norm(u), dv = norm(v);
  Points points(s, t, tolerance);
  if (du > 0 && dv > 0) {
    const double sine = cross(u, v) / (du * dv);
    // Parallel within the tolerance over the shorter of the two: the same carrier, or no crossing.
    if (std::abs(sine) * std::min(du, dv) <= tolerance) {
      const Segment& shorter = du < dv ? s : t;
      const Segment& longer = du < dv ? t : s;
      const Vec2 w = unit(longer.b - longer.a);
      const double ha = cross(w, shorter.a - longer.a), hb = cross(w, shorter.b - longer.a);
      if (std::abs(ha) <= tolerance && std::abs(hb) <= tolerance) return overlap(s, t, tolerance);
    }
    if (sine != 0) points.offer(s.a + (cross(t.a - s.a, v) / cross(u, v)) * u);
  }
  offer_ends(points, s, t);
  return points.result();
}

Intersection line_arc(const Segment& line, const Segment& arc, const Segment& s, const Segment& t,
                      double tolerance) {
  const Vec2 u = unit(line.b - line.a);
  const double r = std::abs(arc.radius);
  const double mid = dot(arc.center - line.a, u);
  const double h = cross(u, arc.center - line.a);
  Points points(s, t, tolerance);
  const Point2 foot = line.a + mid * u;
  if (std::abs(h) <= r + tolerance) {
    const double half = std::sqrt(std::max(0.0, (r - h) * (r + h)));
    if (std::abs(std::abs(h) - r) <= tolerance && half <= tolerance) {
      points.offer(arc.center + r * unit(foot - arc.center));
    } else {
      points.offer(foot - half * u);
      points.offer(foot + half * u);
      // A line that stays outside within the tolerance touches in the foot.
      if (half == 0) points.offer(foot);
    }
  }
  offer_ends(points, s, t);
  return points.result();
}

Intersection arcs(const Segment& s, const Segment& t, double tolerance) {
  const Vec2 w = t.center - s.center;
  const double d = norm(w), r = std::abs(s.radius), q = std::abs(t.radius);
  // The same circle: no point of one is further than d + |r - q| from the other.
  if (d + std::abs(r - q) <= tolerance) return overlap(s, t, tolerance);
  Points points(s, t, tolerance);
  if (d > 0 && d <= r + q + tolerance && d >= std::abs(r - q) - tolerance) {
    const Vec2 e = w / d;
    const double x = 0.5 * (d + (r - q) * (r + q) / d);
    const double h2 = (r - x) * (r + x);
    if (h2 <= 0) {
      points.offer(s.center + (x < 0 ? -r : r) * e);  // tangent within the tolerance
      points.offer(t.center + (x > d ? q : -q) * e);
    } else {
      const double h = std::sqrt(h2);
      points.offer(s.center + x * e + h * left(e));
      points.offer(s.center + x * e - h * left(e));
    }
  }
  offer_ends(points, s, t);
  return points.result();
}

}  // namespace

Intersection intersect(const Segment& s, const Segment& t, double tolerance) {
  if (!bounds_of(s).grown(tolerance).overlaps(bounds_of(t))) return NoIntersection{};
  if (s.is_line() && t.is_line()) return lines(s, t, tolerance);
  if (s.is_line()) return line_arc(s, t, s, t, tolerance);
  if (t.is_line()) return line_arc(t, s, s, t, tolerance);
  return arcs(s, t, tolerance);
}

}  // namespace burin::geom
