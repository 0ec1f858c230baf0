// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/beam_entry.h"

#include <algorithm>
#include <cmath>

namespace burin::verify {
namespace {

using flat::kNever;
using flat::kRounding;
using flat::Range;
using geom::Point2;
using geom::Segment;
using geom::Vec2;

/// Into the disc about c; kNever past it.
double into_disc(Point2 p, Vec2 n, Point2 c, double radius) {
  const Vec2 w = c - p;
  const double y = dot(w, n), x = cross(w, n);
  if (norm2(w) <= radius * radius) return 0;
  if (y < 0 || std::abs(x) > radius) return kNever;
  return std::max(0.0, y - std::sqrt((radius - x) * (radius + x)));
}

bool in_sector(const Segment& arc, Point2 p) {
  const double side = arc.radius > 0 ? 1 : -1;
  const Vec2 v = p - arc.center;
  return side * cross(arc.a - arc.center, v) >= 0 && side * cross(v, arc.b - arc.center) >= 0;
}

/// Into the rectangle along a line.
double into_strip(Point2 p, Vec2 n, const Segment& line, double radius) {
  const Vec2 v = line.b - line.a;
  const double length = norm(v);
  if (length == 0) return kNever;
  const Vec2 t = v / length;
  double h = dot(p - line.a, left(t)), slope = dot(n, left(t));
  if (h < 0) h = -h, slope = -slope;
  double s = 0;
  if (h > radius) {
    if (slope >= 0) return kNever;
    s = (h - radius) / -slope;
  }
  const double along = dot(p - line.a, t) + s * dot(n, t);
  return along >= 0 && along <= length ? s : kNever;
}

/// Into the ring's part beside an arc.
double into_ring(Point2 p, Vec2 n, const Segment& arc, double radius) {
  const double middle = std::abs(arc.radius), outer = middle + radius, inner = middle - radius;
  const Vec2 w = arc.center - p;
  const double y = dot(w, n), x = cross(w, n), d = norm(w);
  if (d <= outer && d >= inner) {
    if (in_sector(arc, p)) return 0;
  }
  double best = kNever;
  const auto take = [&](double s) {
    // On the edge of the ring rounding decides whether p is within.
    if (s >= -kRounding && s < best && in_sector(arc, p + s * n)) best = std::max(0.0, s);
  };
  if (d > outer && std::abs(x) <= outer) take(y - std::sqrt((outer - x) * (outer + x)));
  if (inner > 0 && std::abs(x) <= inner) take(y + std::sqrt((inner - x) * (inner + x)));
  return best;
}

// --- for all rays of a stretch
// ---------------------------------------------------------------------------------

/// Rays of `s` seen from a point: height of the point along the ray, its distance from the ray, from the
/// start.
struct View {
  Range y, x, d;
};
View seen_from(Point2 c, const Segment& s) {
  View v;
  v.d = flat::distances_from(c, s);
  if (s.is_line()) {
    const Vec2 n = flat::normal_at(s, 0), w0 = c - s.a, w1 = c - s.b;
    v.y = {std::min(dot(w0, n), dot(w1, n)), std::max(dot(w0, n), dot(w1, n))};
    v.x = {std::min(cross(w0, n), cross(w1, n)), std::max(cross(w0, n), cross(w1, n))};
    return v;
  }
  // p = o + radius n (the sign of the radius is that of the normal's): c - p = (c - o) - radius n.
  v.y = flat::normal_dots(c - s.center, s);
  v.y.lo -= s.radius;
  v.y.hi -= s.radius;
  v.x = flat::normal_crosses(c - s.center, s);
  return v;
}

double most(Range r) {
  return std::max(std::abs(r.lo), std::abs(r.hi));
}
double least(Range r) {
  return r.lo <= 0 && r.hi >= 0 ? 0 : std::min(std::abs(r.lo), std::abs(r.hi));
}

double latest_into_disc(const Segment& s, Point2 c, double radius) {
  const View v = seen_from(c, s);
  if (v.d.hi <= radius) return 0;
  const double x = most(v.x);
  if (x > radius || v.y.lo < 0) return kNever;
  return std::max(0.0, v.y.hi - std::sqrt((radius - x) * (radius + x)));
}

/// Whether p + e n stays at heights >= 0 over q along m for all rays of s and 0 <= e <= latest.
bool stays_above(const Segment& s, double latest, Point2 q, Vec2 m) {
  const double slope = flat::normal_dots(m, s).lo;
  const double rise = std::min(0.0, slope) * latest;
  return flat::heights(q, m, s).lo + rise >= -kRounding * (1 + norm(m));
}

double latest_into_strip(const Segment& s, const Segment& line, double radius) {
  const Vec2 v = line.b - line.a;
  const double length = norm(v);
  if (length == 0) return kNever;
  const Vec2 t = v / length;
  Vec2 m = left(t);
  if (dot(geom::point_on(s, 0.5) - line.a, m) < 0) m = -m;
  const Range h = flat::heights(line.a, m, s);
  if (h.lo < -radius) return kNever;
  double latest = 0;
  if (h.hi > radius) {
    const double fall = -flat::normal_dots(m, s).hi;
    if (fall <= 0) return kNever;
    latest = (h.hi - radius) / fall;
  }
  return stays_above(s, latest, line.a, t) && stays_above(s, latest, line.b, -t) ? latest : kNever;
}

double latest_into_ring(const Segment& s, const Segment& arc, double radius) {
  const double middle = std::abs(arc.radius), outer = middle + radius, inner = middle - radius;
  const View v = seen_from(arc.center, s);
  double latest = kNever;
  if (v.d.lo >= inner) {
    const double x = most(v.x);
    if (v.d.hi <= outer) {
      latest = 0;
    } else if (x <= outer && v.y.lo >= 0) {
      latest = std::max(0.0, v.y.hi - std::sqrt((outer - x) * (outer + x)));
    }
  } else if (v.d.hi <= outer && inner > 0) {
    const double x = least(v.x);
    if (most(v.x) <= inner) latest = std::max(0.0, v.y.hi + std::sqrt((inner - x) * (inner + x)));
  }
  if (latest == kNever) return kNever;
  // The sector is where both cross products with its ends' radii are positive.
  const double side = arc.radius > 0 ? 1 : -1;
  return stays_above(s, latest, arc.center, side * left(unit(arc.a - arc.center))) &&
                 stays_above(s, latest, arc.center, side * right(unit(arc.b - arc.center)))
             ? latest
             : kNever;
}

}  // namespace

double entry_of(Point2 p, Vec2 n, const Segment& piece, double radius) {
  double s = std::min(into_disc(p, n, piece.a, radius), into_disc(p, n, piece.b, radius));
  if (s == 0) return 0;
  return std::min(s, piece.is_line() ? into_strip(p, n, piece, radius) : into_ring(p, n, piece, radius));
}

double latest_entry(const Segment& s, const Segment& piece, double radius) {
  const double band =
      piece.is_line() ? latest_into_strip(s, piece, radius) : latest_into_ring(s, piece, radius);
  return std::min({band, latest_into_disc(s, piece.a, radius), latest_into_disc(s, piece.b, radius)});
}

}  // namespace burin::verify
