// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/crossings.h"

#include <limits>

namespace burin::removal {

using geom::component;
using geom::Point3;
using geom::Vec3;

Crossing Crossings::at(std::array<std::uint32_t, 3> node, std::size_t axis, bool leaves) const {
  for (const DexelField& f : fields_)
    if (f.axis() == axis) return on_line(f, node, leaves);
  return beside(node, axis, leaves);
}

/// The end of a span on the edge. Lines of the other directions say which nodes are material; where they
/// disagree by rounding the nearest end is taken to the edge.
Crossing Crossings::on_line(const DexelField& field, std::array<std::uint32_t, 3> at, bool leaves) const {
  const std::size_t axis = field.axis(), ua = field.u_axis(), va = field.v_axis();
  const double a = node(axis, at[axis]), b = node(axis, at[axis] + 1);
  Crossing c;
  double best = b - a, h = 0.5 * (a + b);
  PackedNormal n = 0;
  const std::uint32_t u = at[ua] - 1, v = at[va] - 1;
  for (const Span* s = field.begin(u, v); s != field.end(u, v); ++s) {
    const auto end = static_cast<double>(leaves ? s->hi : s->lo);
    const double off = std::max({a - end, end - b, 0.0});
    if (off < best) best = off, h = end, n = leaves ? s->n_hi : s->n_lo, c.known = true;
  }
  geom::set_component(c.p, axis, std::clamp(h, a, b));
  geom::set_component(c.p, ua, node(ua, at[ua]));
  geom::set_component(c.p, va, node(va, at[va]));
  Point3 way;
  geom::set_component(way, axis, leaves ? 1 : -1);
  c.n = c.known ? unpack(n) : way - Point3{};
  return c;
}

/// Without lines along the edge: where the planes at the ends of the lines beside it cross it.
Crossing Crossings::beside(std::array<std::uint32_t, 3> at, std::size_t axis, bool leaves) const {
  const DexelField& f = fields_[0];
  const double a = node(axis, at[axis]), b = node(axis, at[axis] + 1), z = node(2, at[2]);
  Crossing c;
  for (std::size_t i = 0; i < 3; ++i) geom::set_component(c.p, i, node(i, at[i]));
  double h = 0.5 * (a + b), nearest = std::numeric_limits<double>::infinity();
  Point3 way;
  geom::set_component(way, axis, leaves ? 1 : -1);
  c.n = way - Point3{};
  for (const std::uint32_t step : {0U, 1U}) {
    std::array<std::uint32_t, 3> beside = at;
    beside[axis] += step;
    // The border has no lines.
    if (beside[axis] < 1 || beside[axis] > grid_.count[axis]) continue;
    for (const Span* s = f.begin(beside[0] - 1, beside[1] - 1); s != f.end(beside[0] - 1, beside[1] - 1); ++s)
      for (const bool upper : {false, true}) {
        const double end = static_cast<double>(upper ? s->hi : s->lo);
        const Vec3 n = unpack(upper ? s->n_hi : s->n_lo);
        const double across = component(n, axis);
        if (!((across > 0) == leaves) || std::abs(z - end) >= nearest) continue;
        // Flatter planes say nothing about where an upright edge is crossed.
        constexpr double kFlat = 0.02;
        if (std::abs(across) < kFlat) continue;
        const double place = (step == 0 ? a : b) - n.z * (z - end) / across;
        if (place < a || place > b) continue;
        nearest = std::abs(z - end), h = place, c.n = n, c.known = true;
      }
  }
  geom::set_component(c.p, axis, h);
  return c;
}

}  // namespace burin::removal
