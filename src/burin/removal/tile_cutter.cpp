// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/tile_cutter.h"

#include <optional>

namespace burin::removal {

using geom::component;

namespace {

// Remains thinner than this share of the step are rounding.
constexpr double kSliver = 1e-4;

/// Projected along the lines, the sweep of a tool lies in a strip: about its axis, and about its way.
struct Strip {
  double at_u = 0, at_v = 0, n_u = 0, n_v = 0, half = 0;
  bool any = false;

  /// Along `direction`; axis and way as (u, v).
  Strip(geom::Vec2 direction, geom::Point2 center, geom::Vec2 axis, geom::Vec2 way, double grow)
      : at_u(center.x), at_v(center.y) {
    const double length = norm(direction);
    // Shorter ones say no more than the box; a strip along a row takes all of it or nothing.
    constexpr double kShort = 1e-3, kFlat = 1e-6;
    if (length < kShort) return;
    const geom::Vec2 n = left(direction) / length;
    n_u = n.x, n_v = n.y;
    half = 0.5 * (std::abs(dot(n, axis)) + std::abs(dot(n, way))) + grow;
    any = std::abs(n_u) > kFlat;
  }
  void clip(double v, double& lo, double& hi) const {
    if (!any) return;
    const double middle = at_u - n_v * (v - at_v) / n_u, far = half / std::abs(n_u);
    lo = std::max(lo, middle - far), hi = std::min(hi, middle + far);
  }
};

/// Smaller all around, so that what it takes is taken by more than `by`.
bool shrink(verify::MillBody& body, double by) {
  body.radius -= by, body.low += by, body.high -= by;
  body.corner = std::max(0.0, body.corner - by);
  return body.radius > 0 && body.low + body.corner < body.high;
}

}  // namespace

TileCutter::TileCutter(DexelField& field, std::size_t tile, const CutLimits& limits, NodeTimes times)
    : field_(field),
      tile_(field.tile(tile)),
      limits_(limits),
      times_(times),
      u_axis_(field.u_axis()),
      v_axis_(field.v_axis()),
      axis_(field.axis()),
      step_u_(field.grid().step[u_axis_]),
      step_v_(field.grid().step[v_axis_]),
      per_mm_(field.parts_per_mm()),
      sliver_(static_cast<float>(kSliver * field.grid().step[axis_])) {
  const auto range = [](std::size_t t, std::uint32_t count) {
    const auto from = static_cast<std::uint32_t>(t) * Tile::kSide;
    return Range{from, std::min(from + Tile::kSide, count)};
  };
  u_ = range(tile % field.tiles_u(), field.grid().count[u_axis_]);
  v_ = range(tile / field.tiles_u(), field.grid().count[v_axis_]);
  box_.lo[u_axis_] = static_cast<float>(u_.from * step_u_),
  box_.hi[u_axis_] = static_cast<float>(u_.to * step_u_);
  box_.lo[v_axis_] = static_cast<float>(v_.from * step_v_),
  box_.hi[v_axis_] = static_cast<float>(v_.to * step_v_);
}

void TileCutter::run(const std::vector<Cut>& cuts, const CutTree& tree, std::vector<ContactPart>& contacts) {
  if (tile_.empty()) return;
  contacts_ = &contacts;
  tree.walk([this](const CutBox& box) { return wanted(box); }, [&](std::size_t i) { cut(cuts[i]); });
  for (Open& open : open_) flush(open);
}

bool TileCutter::wanted(const CutBox& box) const {
  return box.lo[u_axis_] <= box_.hi[u_axis_] && box_.lo[u_axis_] <= box.hi[u_axis_] &&
         box.lo[v_axis_] <= box_.hi[v_axis_] && box_.lo[v_axis_] <= box.hi[v_axis_] &&
         tile_.holds(Tile::parts(box.lo[axis_], box.hi[axis_], per_mm_));
}

TileCutter::Range TileCutter::lines(float lo, float hi, std::size_t axis, const Range& most) const {
  const double step = field_.grid().step[axis];
  const double from = std::ceil(static_cast<double>(lo) / step - 0.5),
               to = std::floor(static_cast<double>(hi) / step - 0.5) + 1;
  return {static_cast<std::uint32_t>(std::clamp<double>(from, most.from, most.to)),
          static_cast<std::uint32_t>(std::clamp<double>(to, most.from, most.to))};
}

void TileCutter::cut(const Cut& cut) {
  const Range rows = lines(cut.box.lo[v_axis_], cut.box.hi[v_axis_], v_axis_, v_);
  const auto uv = [&](auto p) { return geom::Vec2{component(p, u_axis_), component(p, v_axis_)}; };
  const geom::Vec2 axis = (cut.body.high - cut.body.low) * uv(cut.motion.axis), way = uv(cut.motion.way);
  const geom::Point2 center =
      geom::Point2{} + uv(cut.motion.tip + 0.5 * (cut.body.low + cut.body.high) * cut.motion.axis);
  const double grow =
      cut.body.radius + limits_.tolerance + (cut.motion.turns ? 0.5 * norm(cut.motion.turn) * cut.reach : 0);
  const Strip beside_axis(axis, center, axis, way, grow), beside_way(way, center, axis, way, grow);
  std::optional<LineSweep> sweep, deep;
  const float lo = cut.box.lo[axis_], hi = cut.box.hi[axis_];
  bool any = false;
  for (std::uint32_t v = rows.from; v < rows.to; ++v) {
    double from = static_cast<double>(cut.box.lo[u_axis_]), to = static_cast<double>(cut.box.hi[u_axis_]);
    beside_axis.clip((v + 0.5) * step_v_, from, to);
    beside_way.clip((v + 0.5) * step_v_, from, to);
    const Range row = lines(static_cast<float>(from), static_cast<float>(to), u_axis_, u_);
    for (std::uint32_t u = row.from; u < row.to; ++u) {
      const std::uint32_t l = DexelField::in_tile(u, v);
      const Span* s = tile_.begin(l);
      const Span* end = tile_.end(l);
      while (s != end && s->hi <= lo) ++s;
      if (s == end || s->lo >= hi) continue;
      if (!sweep) {
        sweep.emplace(cut.body, cut.motion, axis_, limits_.tolerance, cut.reach);
        verify::MillBody inner = cut.body;
        if (cut.contact && shrink(inner, limits_.contact))
          deep.emplace(inner, cut.motion, axis_, limits_.tolerance, cut.reach);
      }
      const LineSweep::Bounds around = sweep->around((u + 0.5) * step_u_, (v + 0.5) * step_v_);
      const auto a = static_cast<float>(around.a), b = static_cast<float>(around.b);
      while (s != end && s->hi <= a) ++s;
      if (s == end || s->lo >= b || !(a < b)) continue;
      any |= line(cut, u, v, *sweep, deep ? &*deep : nullptr);
    }
  }
  if (any) tile_.count_parts(per_mm_);
}

bool TileCutter::line(const Cut& cut, std::uint32_t u, std::uint32_t v, LineSweep& sweep, LineSweep* deep) {
  const double pu = (u + 0.5) * step_u_, pv = (v + 0.5) * step_v_;
  const Covered c = sweep.line(pu, pv);
  const auto a = static_cast<float>(c.a), b = static_cast<float>(c.b);
  if (c.empty() || !(a < b)) return false;
  const std::uint32_t l = DexelField::in_tile(u, v);
  Open* open = nullptr;
  if (cut.contact) {
    open = &open_[static_cast<std::size_t>(cut.kind)];
    if (open->used && open->part.move != cut.move) flush(*open);
    if (deep && !(open->used && open->part.deep)) {
      const Covered inner = deep->line(pu, pv);
      const auto from = static_cast<float>(inner.a), to = static_cast<float>(inner.b);
      if (!inner.empty())
        for (const Span* s = tile_.begin(l); s != tile_.end(l); ++s)
          if (std::min(s->hi, to) - std::max(s->lo, from) > sliver_) {
            open->part.move = cut.move, open->part.deep = true, open->used = true;
          }
    }
  }
  return tile_.cut(
      l, a, b, sliver_,
      [&](float lo, float hi) {
        if (times_.cut_at) mark(u, v, lo, hi, cut.move);
        if (!open) return;
        open->part.move = cut.move, open->part.kind = cut.kind, open->used = true;
        note(*open, l, u, v, lo, hi);
      },
      [&] { return pack(-sweep.normal_a(c)); }, [&] { return pack(-sweep.normal_b(c)); });
}

void TileCutter::note(Open& open, std::uint32_t line, std::uint32_t u, std::uint32_t v, float lo, float hi) {
  float& taken = open.taken[line];
  if (taken == 0) open.lines.push_back(line);
  taken += hi - lo;
  open.part.volume += static_cast<double>(hi - lo) * step_u_ * step_v_;
  if (taken > open.part.depth) {
    open.part.depth = taken;
    open.part.at[u_axis_] = static_cast<float>((u + 0.5) * step_u_);
    open.part.at[v_axis_] = static_cast<float>((v + 0.5) * step_v_);
    open.part.at[axis_] = 0.5F * (lo + hi);
  }
}

void TileCutter::mark(std::uint32_t u, std::uint32_t v, float lo, float hi, std::uint32_t move) {
  const Grid& g = field_.grid();
  const auto [from, to] = g.nodes_in(axis_, lo, hi);
  for (std::uint32_t k = from; k < to; ++k)
    times_.cut_at[(static_cast<std::size_t>(k) * g.count[1] + v) * g.count[0] + u] = move + 1;
}

void TileCutter::flush(Open& open) {
  if (!open.used) return;
  if (open.part.deep && open.part.volume > 0) {
    open.part.axis = static_cast<std::uint8_t>(axis_);
    contacts_->push_back(open.part);
  }
  for (const std::uint32_t l : open.lines) open.taken[l] = 0;
  open.lines.clear();
  open.part = {};
  open.used = false;
}

}  // namespace burin::removal
