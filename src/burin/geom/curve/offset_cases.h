// SPDX-License-Identifier: Apache-2.0
// Shapes that have broken offset programs, made by rule and by chance, for tests and benchmarks only. Every
// region is simple by construction; solid to the left.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "burin/geom/curve/arc_spline.h"

namespace burin::geom::cases {

using Random = std::mt19937_64;
using Region = std::vector<ArcSpline>;

inline double uniform(Random& random, double lo, double hi) {
  return lo + (hi - lo) * (static_cast<double>(random() >> 11) * 0x1.0p-53);
}
inline int between(Random& random, int lo, int hi) {
  return lo + static_cast<int>(random() % static_cast<std::uint64_t>(hi - lo + 1));
}

inline ArcSpline polygon(const std::vector<Point2>& v, const std::vector<double>& bulge = {}) {
  ArcSpline s;
  s.closed = true;
  for (std::size_t i = 0; i < v.size(); ++i) {
    s.segments.push_back(from_bulge(v[i], v[(i + 1) % v.size()], bulge.empty() ? 0.0 : bulge[i],
                                    static_cast<std::uint32_t>(i)));
  }
  return s;
}
inline ArcSpline circle(Point2 c, double r, bool ccw) {
  const Point2 e{c.x + r, c.y}, w{c.x - r, c.y};
  return {{make_arc(e, w, c, ccw, 0), make_arc(w, e, c, ccw, 1)}, true};
}
/// Rotated by `angle` and moved, which takes all round numbers out of the coordinates.
inline ArcSpline moved(const ArcSpline& s, double angle, Vec2 by) {
  const Affine2 m{std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle), by.x, by.y};
  ArcSpline out;
  out.closed = s.closed;
  std::vector<Point2> start;
  for (const Segment& g : s.segments) start.push_back(m(g.a));
  for (std::size_t i = 0; i < s.segments.size(); ++i) {
    Segment g = s.segments[i];
    g.a = start[i];
    g.b = start[(i + 1) % start.size()];
    if (!g.is_line()) g.center = m(g.center);
    out.segments.push_back(g);
  }
  return out;
}

/// Family 1. Vertices at growing angles about the origin, joined by lines and arcs that stay in their wedge.
inline Region star(Random& random) {
  const int n = between(random, 3, 40);
  std::vector<Point2> v;
  std::vector<double> bulge;
  const double inner = uniform(random, 0.05, 0.9), turn = uniform(random, 0, 6.28);
  for (int i = 0; i < n; ++i) {
    const double angle = turn + 2 * kPi * (i + uniform(random, -0.35, 0.35)) / n;
    const double r = 10 * uniform(random, inner, 1);
    v.push_back(Point2{} + r * Vec2{std::cos(angle), std::sin(angle)});
  }
  for (int i = 0; i < n; ++i) {
    const Point2 a = v[static_cast<std::size_t>(i)], b = v[static_cast<std::size_t>((i + 1) % n)];
    // A circle meets the ray through its end a second time on the arc only if its tangent leaves the wedge
    // there.
    const auto room = [](Point2 p, Point2 q) {
      const Vec2 chord = q - p, ray = p - Point2{};
      const double t = std::abs(std::atan2(cross(ray, chord), dot(ray, chord)));
      return std::min(t, kPi - t);
    };
    const double most = std::tan(0.45 * std::min(room(a, b), room(b, a)));
    bulge.push_back(between(random, 0, 2) == 0 ? 0.0 : uniform(random, -most, most));
  }
  return {polygon(v, bulge)};
}

/// Family 2. Boundaries of random sets of grid cells, cell size a small multiple of d: many offset edges fall
/// together. `dirt` moves vertices by rounding-sized amounts.
inline Region rectilinear(Random& random, double cell, double dirt) {
  constexpr int kSize = 9;
  bool full[kSize + 2][kSize + 2] = {};
  const double density = uniform(random, 0.3, 0.85);
  for (int i = 1; i <= kSize; ++i) {
    for (int j = 1; j <= kSize; ++j) full[i][j] = uniform(random, 0, 1) < density;
  }
  // Cells that touch at a corner only would make contours touch: fill one of them.
  for (bool again = true; again;) {
    again = false;
    for (int i = 0; i <= kSize; ++i) {
      for (int j = 0; j <= kSize; ++j) {
        if (full[i][j] == full[i + 1][j + 1] && full[i + 1][j] == full[i][j + 1] &&
            full[i][j] != full[i + 1][j]) {
          for (const auto& [a, b] : {std::pair{i, j}, {i + 1, j}, {i, j + 1}, {i + 1, j + 1}}) {
            if (a >= 1 && a <= kSize && b >= 1 && b <= kSize && !full[a][b]) {
              full[a][b] = true;
              again = true;
              break;
            }
          }
        }
      }
    }
  }
  // Directed boundary edges with the full cell on the left; at every vertex exactly one leaves.
  struct Next {
    int x = -1, y = -1;
  };
  std::vector<Next> next(static_cast<std::size_t>((kSize + 3) * (kSize + 3)));
  const auto at = [](int x, int y) { return static_cast<std::size_t>(x * (kSize + 3) + y); };
  for (int i = 1; i <= kSize; ++i) {
    for (int j = 1; j <= kSize; ++j) {
      if (!full[i][j]) continue;
      if (!full[i][j - 1]) next[at(i, j)] = {i + 1, j};
      if (!full[i + 1][j]) next[at(i + 1, j)] = {i + 1, j + 1};
      if (!full[i][j + 1]) next[at(i + 1, j + 1)] = {i, j + 1};
      if (!full[i - 1][j]) next[at(i, j + 1)] = {i, j};
    }
  }
  Region region;
  for (int x = 0; x < kSize + 3; ++x) {
    for (int y = 0; y < kSize + 3; ++y) {
      if (next[at(x, y)].x < 0) continue;
      std::vector<Point2> v;
      int cx = x, cy = y;
      while (next[at(cx, cy)].x >= 0) {
        v.push_back({cell * cx + dirt * uniform(random, -1, 1), cell * cy + dirt * uniform(random, -1, 1)});
        const Next n = std::exchange(next[at(cx, cy)], Next{});
        cx = n.x, cy = n.y;
      }
      region.push_back(polygon(v));
    }
  }
  return region;
}

/// Family 3. Gears: teeth with straight or bowed flanks, round or flat tips and roots, a bore.
inline Region gear(Random& random) {
  const int teeth = between(random, 5, 60);
  const double root = 10, tip = root * (1 + uniform(random, 0.5, 3.0) / teeth), pitch = 2 * kPi / teeth;
  const double top = uniform(random, 0.15, 0.4), foot = uniform(random, 0.05, 0.95 - top - 0.1);
  const double flank = 0.5 * (1 - top - foot);
  const bool round = between(random, 0, 1) == 1;
  const double bow = uniform(random, -0.15, 0.15);
  std::vector<Point2> v;
  std::vector<double> bulge;
  const auto polar = [](double r, double a) { return Point2{r * std::cos(a), r * std::sin(a)}; };
  for (int i = 0; i < teeth; ++i) {
    const double a = i * pitch;
    v.push_back(polar(root, a));
    bulge.push_back(round ? std::tan(foot * pitch / 4) : 0);
    v.push_back(polar(root, a + foot * pitch));
    bulge.push_back(bow);
    v.push_back(polar(tip, a + (foot + flank) * pitch));
    bulge.push_back(round ? std::tan(top * pitch / 4) : 0);
    v.push_back(polar(tip, a + (foot + flank + top) * pitch));
    bulge.push_back(bow);
  }
  Region region{polygon(v, bulge)};
  if (between(random, 0, 1) == 1) region.push_back(circle({0, 0}, uniform(random, 0.05, 7), false));
  return region;
}

/// Family 4. A plate with slots, webs and gaps of exactly 2 d (up to rounding), turned by a random angle.
inline Region slots(Random& random, double d) {
  const double w = std::abs(d);
  Region region;
  const int count = between(random, 1, 5);
  const double length = w * uniform(random, 3, 12);
  // Comb: grooves of width 2 w, open to the outside, between fingers of width `finger`.
  std::vector<Point2> v;
  std::vector<double> bulge;
  const double finger = between(random, 0, 1) ? 2 * w : w * uniform(random, 1.0, 6.0);
  const bool round_ends = between(random, 0, 1) == 1;
  const double height = length + 4 * w;
  double x = 0;
  v.push_back({0, 0}), bulge.push_back(0);
  const double width = (count + 1) * finger + count * 2 * w;
  v.push_back({width, 0}), bulge.push_back(0);
  x = width;
  for (int i = 0; i < count; ++i) {
    v.push_back({x, height}), bulge.push_back(0);
    x -= finger;
    v.push_back({x, height}), bulge.push_back(0);
    v.push_back({x, height - length}), bulge.push_back(round_ends ? -1.0 : 0.0);
    x -= 2 * w;
    v.push_back({x, height - length}), bulge.push_back(0);
  }
  v.push_back({x, height}), bulge.push_back(0);
  v.push_back({0, height}), bulge.push_back(0);
  region.push_back(polygon(v, bulge));
  // Round-ended hole of width 2 w in the back, and a second part beside at a gap of exactly 2 w.
  if (finger > 0 && width > 6 * w && height - length > 3.9 * w) {
    const double y = 0.5 * (height - length) - w;
    region.push_back(polygon({{2 * w, y}, {2 * w, y + 2 * w}, {width - 2 * w, y + 2 * w}, {width - 2 * w, y}},
                             {-1.0, 0.0, -1.0, 0.0}));
    // Half circles of radius w at both ends would leave the plate for narrow plates: 2 w - w = w stays
    // inside.
  }
  region.push_back(polygon({{width + 2 * w, 0},
                            {width + 2 * w + length, 0},
                            {width + 2 * w + length, height},
                            {width + 2 * w, height}}));
  const double angle = between(random, 0, 2) == 0 ? 0.0 : uniform(random, 0, 6.28);
  const Vec2 by{uniform(random, -100, 100), uniform(random, -100, 100)};
  for (ArcSpline& s : region) s = moved(s, angle, by);
  return region;
}

/// Family 5. A star of lines with extra vertices 1e-9 to 1e-3 away from its own, in scattered directions.
inline Region near_vertices(Random& random) {
  const ArcSpline base = star(random).front();
  std::vector<Point2> v;
  std::vector<double> bulge;
  for (std::size_t i = 0; i < base.segments.size(); ++i) {
    const Segment& s = base.segments[i];
    v.push_back(s.a);
    const Vec2 along = unit(s.b - s.a);
    // In the tip of a spike the scattered points would cross the edge that comes in.
    const Vec2 in = unit(s.a - base.segments[(i + base.segments.size() - 1) % base.segments.size()].a);
    const bool spike = dot(in, along) < -0.6;
    double run = 0;
    Point2 last = s.a;
    for (int k = between(random, 0, 3); k > 0; --k) {
      const double step = std::pow(10.0, uniform(random, -9, -3));
      const double aside = spike ? 0.0 : uniform(random, -0.5, 0.5);
      run += step;
      const Point2 q = s.a + run * along + (aside * step) * left(along);
      if (q == last) continue;
      bulge.push_back(0);
      v.push_back(q);
      last = q;
    }
    bulge.push_back(0);
  }
  return {polygon(v, bulge)};
}

/// Wavy ring of about n segments 0.6 mm long, three of ten arcs, outer boundary and hole. 40 long waves, and
/// a ripple of the size of the segments, so that half of the vertices are concave whatever n is.
inline Region wavy_ring(int n) {
  const double radius = n / 20.0;
  const auto loop = [](int m, double r, double wave, bool ccw) {
    std::vector<Point2> v;
    std::vector<double> bulge;
    const double ripple = 0.4 * 2 * kPi * r / m;
    for (int i = 0; i < m; ++i) {
      const double a = (ccw ? 2 : -2) * kPi * i / m;
      const double rr = r + wave * std::sin(40 * a) + ripple * std::sin(m / 7 * a);
      v.push_back({rr * std::cos(a), rr * std::sin(a)});
      bulge.push_back(i % 10 < 3 ? (ccw ? 0.02 : -0.02) : 0.0);
    }
    return polygon(v, bulge);
  };
  return {loop(n / 2, radius, 0.02 * radius, true), loop(n - n / 2, 0.7 * radius, 0.014 * radius, false)};
}

/// Plate 210 x 210 with 20 x 20 round holes.
inline Region plate() {
  Region region{polygon({{0, 0}, {210, 0}, {210, 210}, {0, 210}})};
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) region.push_back(circle({10.0 + 10 * i, 10.0 + 10 * j}, 3.0, false));
  }
  return region;
}

}  // namespace burin::geom::cases
