// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/tile_cutter.h"

#include <optional>

namespace burin::removal {

using geom::component;

namespace {

// Remains thinner than this share of the step are rounding.
constexpr double kSliver = 1e-4;

/// The lines of a row that may come near a tool: projected along the lines, it lies in a strip about its axis.
struct Strip {
  double tip_u = 0, tip_v = 0, n_u = 0, n_v = 0, half = 0;
  bool any = false;

  Strip(const Cut& cut, std::size_t u_axis, std::size_t v_axis, double tolerance)
      : tip_u(component(cut.motion.tip, u_axis)), tip_v(component(cut.motion.tip, v_axis)) {
    const double a_u = component(cut.motion.axis, u_axis), a_v = component(cut.motion.axis, v_axis);
    const double length = std::hypot(a_u, a_v);
    // Nearly along the lines the box says as much.
    constexpr double kShort = 1e-3;
    if (length < kShort) return;
    n_u = -a_v / length, n_v = a_u / length;
    const double span = std::max(std::abs(cut.body.low), std::abs(cut.body.high));
    half = cut.body.radius +
           0.5 * std::abs(n_u * component(cut.motion.way, u_axis) + n_v * component(cut.motion.way, v_axis)) +
           tolerance + (cut.motion.turns ? 0.5 * norm(cut.motion.turn) * (span + cut.body.radius) : 0);
    constexpr double kFlat = 1e-6;  // a strip along the row: all or nothing of it
    any = std::abs(n_u) > kFlat;
  }
  void clip(double v, double& lo, double& hi) const {
    if (!any) return;
    const double middle = tip_u - n_v * (v - tip_v) / n_u, far = half / std::abs(n_u);
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
  box_.lo[u_axis_] = static_cast<float>(u_.from * step_u_), box_.hi[u_axis_] = static_cast<float>(u_.to * step_u_);
  box_.lo[v_axis_] = static_cast<float>(v_.from * step_v_), box_.hi[v_axis_] = static_cast<float>(v_.to * step_v_);
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
  const double from = std::ceil(static_cast<double>(lo) / step - 0.5), to = std::floor(static_cast<double>(hi) / step - 0.5) + 1;
  return {static_cast<std::uint32_t>(std::clamp<double>(from, most.from, most.to)),
          static_cast<std::uint32_t>(std::clamp<double>(to, most.from, most.to))};
}

void TileCutter::cut(const Cut& cut) {
  const Range rows = lines(cut.box.lo[v_axis_], cut.box.hi[v_axis_], v_axis_, v_);
  const Strip strip(cut, u_axis_, v_axis_, limits_.tolerance);
  std::optional<LineSweep> sweep, deep;
  const float lo = cut.box.lo[axis_], hi = cut.box.hi[axis_];
  bool any = false;
  for (std::uint32_t v = rows.from; v < rows.to; ++v) {
    double from = static_cast<double>(cut.box.lo[u_axis_]), to = static_cast<double>(cut.box.hi[u_axis_]);
    strip.clip((v + 0.5) * step_v_, from, to);
    const Range row = lines(static_cast<float>(from), static_cast<float>(to), u_axis_, u_);
    for (std::uint32_t u = row.from; u < row.to; ++u) {
      const std::uint32_t l = DexelField::in_tile(u, v);
      const Span* s = tile_.begin(l);
      const Span* end = tile_.end(l);
      while (s != end && s->hi <= lo) ++s;
      if (s == end || s->lo >= hi) continue;
      if (!sweep) {
        sweep.emplace(cut.body, cut.motion, axis_, limits_.tolerance);
        verify::MillBody inner = cut.body;
        if (cut.contact && shrink(inner, limits_.contact))
          deep.emplace(inner, cut.motion, axis_, limits_.tolerance);
      }
      line(cut, u, v, *sweep, deep ? &*deep : nullptr);
      any = true;
    }
  }
  if (any) tile_.count_parts(per_mm_);
}

void TileCutter::line(const Cut& cut, std::uint32_t u, std::uint32_t v, LineSweep& sweep, LineSweep* deep) {
  const double pu = (u + 0.5) * step_u_, pv = (v + 0.5) * step_v_;
  const Covered c = sweep.line(pu, pv);
  const auto a = static_cast<float>(c.a), b = static_cast<float>(c.b);
  if (c.empty() || !(a < b)) return;
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
  tile_.cut(
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
  const double step = g.step[axis_];
  const auto from = static_cast<std::uint32_t>(std::max(0.0, std::ceil(static_cast<double>(lo) / step - 0.5)));
  for (std::uint32_t k = from; k < g.count[2] && (k + 0.5) * step < static_cast<double>(hi); ++k)
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
