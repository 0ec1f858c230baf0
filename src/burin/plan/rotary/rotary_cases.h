// SPDX-License-Identifier: Apache-2.0
// Sections and parts for tests.
#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "burin/plan/rotary/part.h"

namespace burin::rotary::cases {

using geom::ArcSpline;
using geom::Point2;
using geom::Vec2;

inline Point2 polar(double r, double angle) {
  return {r * std::cos(angle), r * std::sin(angle)};
}

inline ArcSpline circle(double r, Point2 c = {}) {
  const Point2 e{c.x + r, c.y}, w{c.x - r, c.y};
  return {{geom::make_arc(e, w, c, true), geom::make_arc(w, e, c, true)}, true};
}

/// Straight lines between corners, each rounded with its radius (0: sharp). Counter-clockwise when the
/// corners are.
struct Corner {
  Point2 p;
  double radius = 0;
};
inline ArcSpline rounded(const std::vector<Corner>& corners) {
  const std::size_t n = corners.size();
  std::vector<Point2> in(n), out(n);
  std::vector<geom::Segment> arcs(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 p = corners[i].p;
    const Vec2 a = unit(p - corners[(i + n - 1) % n].p), b = unit(corners[(i + 1) % n].p - p);
    const double turn = std::atan2(cross(a, b), dot(a, b));
    const double back = corners[i].radius * std::tan(std::abs(turn) / 2);
    in[i] = p - back * a;
    out[i] = p + back * b;
    if (back > 0) arcs[i] = geom::from_bulge(in[i], out[i], std::tan(turn / 4));
  }
  ArcSpline s;
  s.closed = true;
  for (std::size_t i = 0; i < n; ++i) {
    if (corners[i].radius > 0) s.segments.push_back(arcs[i]);
    s.segments.push_back(geom::make_line(out[i], in[(i + 1) % n]));
  }
  return s;
}

inline ArcSpline polygon(const std::vector<Point2>& points) {
  std::vector<Corner> corners;
  for (const Point2 p : points) corners.push_back({p, 0});
  return rounded(corners);
}

/// Many short arcs on an ellipse: they meet smoothly within rounding of their fit through three points.
inline ArcSpline ellipse(double a, double b, int n = 400) {
  const auto at = [&](double t) { return Point2{a * std::cos(t), b * std::sin(t)}; };
  ArcSpline s;
  s.closed = true;
  for (int i = 0; i < n; ++i) {
    const double t0 = 2 * geom::kPi * i / n, t1 = 2 * geom::kPi * (i + 1) / n;
    const Point2 p = at(t0), q = i + 1 == n ? at(0) : at(t1), m = at(0.5 * (t0 + t1));
    // Bulge from the sagitta.
    const Vec2 chord = q - p;
    const double sagitta = -cross(unit(chord), m - p);
    s.segments.push_back(geom::from_bulge(p, q, 2 * sagitta / norm(chord)));
  }
  return s;
}

/// Base circle, nose and the two common tangents.
inline ArcSpline cam(double base, double nose, double lift) {
  const double d = base + lift - nose;  // of the nose's centre
  const double a = std::acos((base - nose) / d);
  const Point2 c{0, d};
  const Point2 right_base = polar(base, geom::kPi / 2 - a), left_base = polar(base, geom::kPi / 2 + a);
  const Point2 right_nose = c + nose * (polar(1, geom::kPi / 2 - a) - Point2{}),
               left_nose = c + nose * (polar(1, geom::kPi / 2 + a) - Point2{});
  return {{geom::make_line(right_base, right_nose), geom::make_arc(right_nose, left_nose, c, true),
           geom::make_line(left_nose, left_base), geom::make_arc(left_base, right_base, {0, 0}, true)},
          true};
}

/// A shaft with a keyway of the given width and depth on top.
inline ArcSpline keyway(double r, double width, double depth) {
  const double h = std::sqrt(r * r - width * width / 4);
  const Point2 a{width / 2, h}, b{-width / 2, h}, c{-width / 2, r - depth}, d{width / 2, r - depth};
  // Counter-clockwise: round from the left edge to the right one, then down, along and up to the left.
  return {{geom::make_arc(b, a, {0, 0}, true), geom::make_line(a, d), geom::make_line(d, c),
           geom::make_line(c, b)},
          true};
}

/// Like a side-milling cutter: teeth with a steep face, a land, a sloping back and a rounded bottom.
inline ArcSpline cutter(int teeth, double outer, double root, double bottom_radius) {
  std::vector<Corner> corners;
  for (int i = 0; i < teeth; ++i) {
    const double a = 2 * geom::kPi * i / teeth, step = 2 * geom::kPi / teeth;
    corners.push_back({polar(outer, a), 0});
    corners.push_back({polar(outer, a + 0.18 * step), 0});
    corners.push_back({polar(0.5 * (outer + root), a + 0.5 * step), 0});
    corners.push_back({polar(root, a + 0.92 * step), bottom_radius});
  }
  return rounded(corners);
}

/// A star about the axis with random corners, some rounded.
inline ArcSpline random_star(std::mt19937_64& random) {
  std::uniform_real_distribution<double> radius(8, 20), place(0.1, 0.9), unit_(0, 1);
  const int n = 5 + int(7 * unit_(random));
  std::vector<Corner> corners;
  for (int i = 0; i < n; ++i) {
    corners.push_back({polar(radius(random), 2 * geom::kPi * (i + 0.6 * place(random)) / n),
                       unit_(random) < 0.5 ? 0.0 : 0.8 * unit_(random)});
  }
  return rounded(corners);
}

inline SweptSection swept(ArcSpline s, double length, double turn) {
  return {std::move(s), {{0, 0}, {length, turn}}};
}

}  // namespace burin::rotary::cases
