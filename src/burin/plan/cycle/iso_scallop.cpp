// SPDX-License-Identifier: Apache-2.0
// I2: the next path w(t) is where the cusp against the path before is S everywhere (or the side step M).
#include <algorithm>
#include <cmath>

#include "burin/plan/cycle/passes.h"

namespace burin::cycle {
namespace {

// Use of the limits that is aimed at (height 0.996 S) and how far the spline between nodes may be off
// (height 0.3 %): never above S, and within 2 % of it with room for what a check measures differently.
constexpr double kAim = 0.998;
constexpr double kOff = 0.0015;
// Solved this closely, so that the slopes of the spline do not feel what is left.
constexpr double kSolved = 3e-6;
// Nodes are at least this part of a step apart: what is finer is no feature of the scallop.
constexpr double kFinest = 0.08;
constexpr int kSamples = 32;
constexpr int kRounds = 8;
// Rounds in which all nodes follow the direction of the spline; later ones only add nodes.
constexpr int kSettling = 2;
constexpr std::size_t kMostNodes = 4000;

enum class State {
  active,  ///< the path passes here
  capped,  ///< within reach of the border w1, which gets the last path
  done,    ///< the path before has reached the border
};

struct Node {
  double t = 0, w = 0;
  State state = State::done;
  bool end = false;  ///< the last one of a stretch
};

class Front {
 public:
  Front(const Sheet& sheet, const PassTask& task, const Before& before, const Pass* previous, bool pole_hi)
      : sheet_(sheet),
        task_(task),
        before_(before),
        previous_(previous),
        pole_hi_(pole_hi),
        least_(task.w.length() / static_cast<double>(task.max_paths)) {}

  /// The next path; no graphs when all of the border is reached.
  std::vector<Graph> advance(const std::vector<double>& places, PairFigures& figures) {
    for (const double t : places) {
      const Node n = solve(t, std::nullopt, 0);
      // Where the ball does not fit a valley the path is only led across: it is lifted there.
      const bool inside = t > places.front() && t < places.back();
      if (!(inside && n.state == State::active && in_valley(sheet_, n.t, n.w))) nodes_.push_back(n);
    }
    std::vector<Graph> graphs;
    for (int round = 0;; ++round) {
      close_ends();
      graphs = fit();
      // Now the direction of the path is known, and with it the plane that the cusp lies in.
      if (round <= kSettling && settle(graphs)) graphs = fit();
      if (round == kRounds || nodes_.size() > kMostNodes) break;
      if (!refine(graphs)) break;
    }
    figures = figures_;
    return graphs;
  }

 private:
  double use(double t, double w, std::optional<double> slope) {
    last_ = cusp(sheet_, before_, t, w, slope, false);
    double u = use_of_limits(task_, last_);
    // On a crease the ball stands on both sides (and turns between them): the one that leaves more counts.
    const std::vector<double>& creases = sheet_.t_creases();
    if (!std::binary_search(creases.begin(), creases.end(), t)) return u;
    const Cusp left = cusp(sheet_, before_, t, w, slope, false, geom::Side::left);
    if (use_of_limits(task_, left) > u) u = use_of_limits(task_, left), last_ = left;
    return u;
  }

  double start_w(double t) const { return previous_ == nullptr ? task_.w.lo : previous_->w_at(t); }
  double hi(double t) const { return task_.border_hi ? task_.border_hi->at(t).w : task_.w.hi; }

  Node solve(double t, std::optional<double> slope, double guess) {
    if (previous_ != nullptr && !previous_->covers(t)) return {t, hi(t), State::done};
    const double w0 = start_w(t), end = hi(t);
    if (!(w0 < end)) return {t, hi(t), State::done};
    double ok = 0, bad = -1;  // steps known to keep and to break the limits
    double step = guess > 0 ? guess : guess_ > 0 ? guess_ : first_step(sheet_, task_, t, w0);
    double best_step = step, best_off = 1e300, last_step = 0, last_use = 0;
    constexpr int kIterations = 40;
    for (int i = 0; i < kIterations; ++i) {
      const bool border = step >= end - w0;
      if (border) step = end - w0;
      const double u = use(t, border ? end : w0 + step, slope);
      if (border && u <= kAim + kOff) return at_border(t, w0);
      if (std::abs(u - kAim) < best_off) best_off = std::abs(u - kAim), best_step = step;
      if (best_off < kSolved) break;
      (u <= kAim ? ok : bad) = step;
      // Secant; the first time through (0, 0), as the use grows nearly linearly.
      const double rise = (u - last_use) / (step - last_step);
      double next = rise > 0 ? std::clamp(step + (kAim - u) / rise, 0.1 * step, 4 * step) : 4 * step;
      last_step = step;
      last_use = u;
      if (bad >= 0 && !(next > ok && next < bad)) next = 0.5 * (ok + bad);
      if (bad < 0 && next <= ok) next = 2 * ok;
      step = next;
      // Where the ball stops to fit the use jumps: there is nothing to be met closely.
      if (bad >= 0 && bad - ok < (last_.too_tight ? 1e-3 : 1e-9) * bad) break;
    }
    if (best_off > kOff && bad >= 0) best_step = std::max(ok, least_);
    best_step = std::max(best_step, least_);
    guess_ = best_step;
    return {t, std::min(w0 + best_step, end), State::active};
  }

  // Within one step of the border. A border that is a point is covered from half a step away.
  Node at_border(double t, double w0) {
    if (!pole_hi_) return {t, hi(t), State::capped};
    const double h = height_at(sheet_, t, hi(t), sheet_.contact(t, w0).c);
    if (previous_ != nullptr && h <= task_.scallop) return {t, hi(t), State::capped};
    return {t, 0.5 * (w0 + hi(t)), State::active};
  }

  // Between an active and a capped neighbour lies the place where the path meets the border.
  void close_ends() {
    std::vector<Node> out;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (i > 0) {
        const Node a = nodes_[i - 1], b = nodes_[i];
        const bool edge = (a.state == State::active) != (b.state == State::active);
        const bool found = (a.state == State::active ? a : b).end;
        if (edge && !found) {
          Node e = a.state == State::active ? meeting(a, b.t) : meeting(b, a.t);
          e.end = true;
          if (e.t > a.t && e.t < b.t && e.state == State::active) out.push_back(e);
        }
      }
      out.push_back(nodes_[i]);
    }
    nodes_ = std::move(out);
  }

  Node meeting(const Node& active, double capped_t) {
    double in = active.t, out = capped_t;
    constexpr int kHalvings = 40;
    for (int i = 0; i < kHalvings; ++i) {
      const double mid = 0.5 * (in + out);
      if (!(std::min(in, out) < mid && mid < std::max(in, out))) break;
      const bool covered = previous_ == nullptr || previous_->covers(mid);
      const bool inside = covered && start_w(mid) < hi(mid) && use(mid, hi(mid), std::nullopt) > kAim + kOff;
      (inside ? in : out) = mid;
      if (std::abs(out - in) < 1e-7 * task_.t.length()) break;
    }
    // The path reaches the border there, or turns back before it (then it just ends).
    return solve(in, std::nullopt, 0);
  }

  std::vector<Graph> fit() const {
    std::vector<Graph> graphs;
    std::vector<double> t, w;
    const auto flush = [&] {
      if (t.size() >= 2) graphs.push_back(spline(t, w));
      t.clear();
      w.clear();
    };
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& n = nodes_[i];
      if (n.state != State::active) {
        flush();
        continue;
      }
      t.push_back(n.t);
      w.push_back(n.w);
    }
    flush();
    return graphs;
  }

  // Solves nodes again whose use of the limits is another one with the slope of the spline.
  bool settle(const std::vector<Graph>& graphs) {
    bool changed = false;
    std::size_t i = 0;
    for (const Graph& g : graphs)
      for (const double t : g.t) {
        while (i < nodes_.size() && nodes_[i].t < t) ++i;
        if (i == nodes_.size()) return changed;
        Node& n = nodes_[i];
        if (n.t != t || n.end || n.state != State::active) continue;
        const double slope = g.at(t).w1;
        const double u = use(t, n.w, slope);
        const bool half_of_pole = pole_hi_ && u < kAim;
        if (std::abs(u - kAim) < 0.25 * kOff || half_of_pole) continue;
        const Node again = solve(t, slope, n.w - start_w(t));
        if (again.state != State::active) continue;
        n.w = again.w;
        changed = true;
      }
    return changed;
  }

  // Nodes between those where the spline leaves the wanted use of the limits.
  bool refine(const std::vector<Graph>& graphs) {
    figures_ = {};
    figures_.scallop_min = kNoOverlap;
    std::vector<UvPoint> wanted;
    for (const Graph& g : graphs)
      for (std::size_t i = 0; i + 1 < g.t.size(); ++i) {
        const double t = 0.5 * (g.t[i] + g.t[i + 1]);
        const UvPoint p = g.at(t);
        if (in_valley(sheet_, t, p.w)) {
          for (const double from : {g.t[i], g.t[i + 1]}) edge_of_valley(g, from, t, wanted);
          continue;
        }
        const double u = use(t, std::min(p.w, hi(t)), p.w1);
        if (last_.too_tight) continue;  // lifted: more nodes would follow what is not cut
        const Contact c = sheet_.contact(t, std::min(p.w, hi(t)));
        const double apart = (g.t[i + 1] - g.t[i]) * norm(c.st + p.w1 * c.sw);
        // Where paths bend over a crease the spline may swing over less than what counts.
        if (!(apart > kFinest * last_.side_step)) continue;
        if (t >= task_.inner_t.lo && t <= task_.inner_t.hi) note();
        const bool half_of_pole = pole_hi_ && u < kAim;
        if (std::abs(u - kAim) > kOff && !half_of_pole) wanted.push_back(p);
      }
    if (wanted.empty()) return false;
    std::vector<Node> more;
    for (const UvPoint& p : wanted) more.push_back(solve(p.t, p.w1, p.w - start_w(p.t)));
    std::vector<Node> all;
    std::merge(nodes_.begin(), nodes_.end(), more.begin(), more.end(), std::back_inserter(all),
               [](const Node& a, const Node& b) { return a.t < b.t; });
    nodes_ = std::move(all);
    return true;
  }

  // The last place before a valley that the path crosses: `out` does not lie in it, `in` does.
  void edge_of_valley(const Graph& g, double out, double in, std::vector<UvPoint>& wanted) {
    if (in_valley(sheet_, out, g.at(out).w)) return;
    const double from = out;
    constexpr int kHalvings = 20;
    for (int i = 0; i < kHalvings; ++i) {
      const double mid = 0.5 * (in + out);
      (in_valley(sheet_, mid, g.at(mid).w) ? in : out) = mid;
    }
    const UvPoint p = g.at(out);
    use(out, std::min(p.w, hi(out)), p.w1);
    const Contact c = sheet_.contact(out, std::min(p.w, hi(out)));
    if (std::abs(out - from) * norm(c.st + p.w1 * c.sw) > kFinest * last_.side_step) wanted.push_back(p);
  }

  void note() {
    if (last_.too_tight) return;
    figures_.scallop_min = std::min(figures_.scallop_min, last_.height);
    figures_.scallop_max = std::max(figures_.scallop_max, last_.height);
    figures_.side_step_max = std::max(figures_.side_step_max, last_.side_step);
    if (task_.side_step && last_.side_step > 0.9 * *task_.side_step) figures_.side_step_binds = true;
  }

  const Sheet& sheet_;
  const PassTask& task_;
  const Before& before_;
  const Pass* previous_;
  bool pole_hi_;
  double least_;
  double guess_ = 0;
  Cusp last_;
  std::vector<Node> nodes_;
  PairFigures figures_;
};

PairFigures between(const Sheet& sheet, geom::Interval inner, const Pass& a, const Pass& b, bool last) {
  PairFigures f;
  f.scallop_min = kNoOverlap;
  f.last = last;
  const Before before(a, sheet.radius());
  for (const Graph& g : b.graphs)
    for (const double t : samples_along(sheet, inner, 24)) {
      if (!a.covers(t)) continue;
      const UvPoint p = g.at(t);
      if (in_valley(sheet, t, p.w)) continue;
      const Cusp c = cusp(sheet, before, t, p.w, p.w1, false);
      if (c.too_tight) continue;
      f.scallop_min = std::min(f.scallop_min, c.height);
      f.scallop_max = std::max(f.scallop_max, c.height);
      f.side_step_max = std::max(f.side_step_max, c.side_step);
    }
  return f;
}

Pass border_pass(const Sheet& sheet, const PassTask& task, const std::optional<Graph>& graph, double w) {
  Pass p;
  if (graph) {
    p.graphs.push_back(*graph);
    p.track = build_track(sheet, *graph, task.path_mm);
  } else {
    p = constant_pass(sheet, task, w);
  }
  p.valley = graph.has_value();
  p.fitting = between_valleys(sheet, p);
  return p;
}

}  // namespace

Result<Passes> iso_scallop(const Sheet& sheet, const PassTask& task) {
  Passes r;
  const std::vector<double> places = samples_along(sheet, task.t, kSamples);
  const bool pole_lo = collapsed(sheet, task.t, task.w.lo), pole_hi = collapsed(sheet, task.t, task.w.hi);
  std::size_t nodes = 0;
  if (!pole_lo) r.passes.push_back(border_pass(sheet, task, task.border_lo, task.w.lo));
  const double guess = first_step(sheet, task, 0.5 * (task.t.lo + task.t.hi), task.w.lo);
  if (task.w.length() / guess > 16.0 * static_cast<double>(task.max_paths)) return too_many_paths(task);
  for (;;) {
    const Pass* previous = r.passes.empty() ? nullptr : &r.passes.back();
    const Before before =
        previous == nullptr ? Before(task.t.lo, task.w.lo) : Before(*previous, sheet.radius());
    PairFigures figures;
    Pass next;
    next.graphs = Front(sheet, task, before, previous, pole_hi).advance(places, figures);
    if (next.graphs.empty()) break;
    if (r.passes.size() >= task.max_paths) return too_many_paths(task);
    for (const Graph& g : next.graphs) {
      Track part = build_track(sheet, g, task.path_mm);
      next.track.insert(next.track.end(), part.begin(), part.end());
    }
    next.fitting = between_valleys(sheet, next);
    nodes += node_count(next.track);
    if (nodes > kMaxNodes) return too_many_nodes();
    if (previous != nullptr) r.pairs.push_back(figures);
    r.passes.push_back(std::move(next));
    if (too_long(task, r, r.passes.back())) return r;
  }
  if (!pole_hi) {
    Pass border = border_pass(sheet, task, task.border_hi, task.w.hi);
    if (!r.passes.empty()) r.pairs.push_back(between(sheet, task.inner_t, r.passes.back(), border, true));
    r.passes.push_back(std::move(border));
  }
  return r;
}

}  // namespace burin::cycle
