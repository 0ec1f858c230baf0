// SPDX-License-Identifier: Apache-2.0
// Drawings made by hand or at random, for tests from the drawing on.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "burin/geom/curve/arc_spline.h"
#include "burin/io/drawing/drawing.h"

namespace burin::laser::fixture {

/// Adds entities named by their order: "SHAPE 1", "SHAPE 2", ...
class Sketch {
 public:
  io::Drawing drawing;

  Sketch() { drawing.layers = {"0"}; }

  Sketch& add(std::vector<geom::Curve2> curves, bool closed, const std::string& layer = "0") {
    io::Entity e;
    e.kind = "SHAPE";
    e.id = std::to_string(drawing.entities.size() + 1);
    e.layer = layer;
    e.paths.push_back({std::move(curves), closed});
    drawing.entities.push_back(std::move(e));
    if (layer != "0" && layer != drawing.layers.back()) drawing.layers.push_back(layer);
    return *this;
  }
  Sketch& polygon(const std::vector<geom::Point2>& p, const std::string& layer = "0") {
    return add(sides(p, true), true, layer);
  }
  Sketch& chain(const std::vector<geom::Point2>& p, const std::string& layer = "0") {
    return add(sides(p, false), false, layer);
  }
  /// Every side an entity of its own.
  Sketch& pieces(const std::vector<geom::Point2>& p) {
    for (const geom::Curve2& side : sides(p, true)) add({side}, false);
    return *this;
  }
  Sketch& rectangle(double x0, double y0, double x1, double y1, const std::string& layer = "0") {
    return polygon({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, layer);
  }
  Sketch& circle(geom::Point2 c, double r, const std::string& layer = "0") {
    return add({geom::Arc2{c, r, 0, 2 * geom::kPi}}, true, layer);
  }
  Sketch& ellipse(geom::Point2 c, geom::Vec2 major, geom::Vec2 minor) {
    return add({geom::EllipseArc2{c, major, minor, 0, 2 * geom::kPi}}, true);
  }

  static std::vector<geom::Curve2> sides(const std::vector<geom::Point2>& p, bool closed) {
    std::vector<geom::Curve2> out;
    for (std::size_t i = 0; i + (closed ? 0 : 1) < p.size(); ++i)
      out.push_back(geom::Line2{p[i], p[(i + 1) % p.size()]});
    return out;
  }
};

struct Dice {
  std::mt19937_64 engine;
  explicit Dice(std::uint64_t seed) : engine(seed) {}
  double in(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(engine() >> 11) * 0x1p-53); }
  int below(int n) { return static_cast<int>(engine() % static_cast<std::uint64_t>(n)); }
};

/// A star-shaped ring of points about c: simple whatever the dice say.
inline std::vector<geom::Point2> star(Dice& dice, geom::Point2 c, double r0, double r1, int n) {
  std::vector<geom::Point2> p;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * geom::kPi * (i + dice.in(-0.3, 0.3)) / n, r = dice.in(r0, r1);
    p.push_back({c.x + r * std::cos(angle), c.y + r * std::sin(angle)});
  }
  return p;
}

/// Its sides as lines and shallow arcs, which still do not meet each other.
inline std::vector<geom::Curve2> bulged(Dice& dice, const std::vector<geom::Point2>& p) {
  std::vector<geom::Curve2> out;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const geom::Point2 a = p[i], b = p[(i + 1) % p.size()];
    if (dice.below(2) == 0) {
      out.push_back(geom::Line2{a, b});
      continue;
    }
    const geom::Segment s = geom::from_bulge(a, b, dice.in(0.02, 0.08) * (dice.below(2) == 0 ? 1 : -1));
    const double start = std::atan2(a.y - s.center.y, a.x - s.center.x);
    out.push_back(geom::Arc2{s.center, std::abs(s.radius), start, geom::sweep_of(s)});
  }
  return out;
}

/// A smooth closed spline through a ring of points.
inline geom::Curve2 smooth_ring(const std::vector<geom::Point2>& p) {
  auto curve = geom::interpolate(p, true);
  return curve ? geom::Curve2{*curve} : geom::Curve2{geom::Line2{p[0], p[1]}};
}

/// A part with holes near each other and near the edge, some too small, of lines and arcs; or of splines.
inline Sketch random_part(std::uint64_t seed, bool free_curves) {
  Dice dice(seed);
  Sketch s;
  const auto ring = [&](geom::Point2 c, double r0, double r1) {
    const auto p = star(dice, c, r0, r1, 6 + dice.below(6));
    if (free_curves) {
      s.add({smooth_ring(p)}, true);
    } else {
      s.add(bulged(dice, p), true);
    }
  };
  ring({0, 0}, 50, 60);
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      const geom::Point2 c{i * 20 + dice.in(-2, 2), j * 20 + dice.in(-2, 2)};
      switch (dice.below(4)) {
        case 0:
          s.circle(c, dice.in(0.2, 8));
          break;
        case 1:
          ring(c, 4, 8);
          ring(c, 1, 2);
          break;
        case 2:
          ring(c, 2, 8.5);
          break;
        default:
          break;
      }
    }
  }
  return s;
}

}  // namespace burin::laser::fixture
