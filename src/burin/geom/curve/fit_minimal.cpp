// SPDX-License-Identifier: Apache-2.0
// Fewest arcs: a forward search over arc splines whose joints may leave the path by up to the tolerance,
// closed by a biarc that meets the end of the path exactly. docs/arc-fitting.md has the reasons and the
// measurements.
#include <algorithm>
#include <array>
#include <cmath>

#include "burin/geom/curve/fit_internal.h"

namespace burin::geom::fit {

namespace {

/// Allowed signed deviation of the path to the left of the arcs, at the samples.
struct Tube {
  double lo = 0, hi = 0;
};

/// How hard to look. `margin`: the part of the tolerance that the tube takes; samples show about 1 % less
/// than the largest deviation, and what the offset adds to it shows only when a candidate is certified.
struct Effort {
  double margin = 1;
  std::size_t beam = 8;     ///< states of a layer that are continued: those with the furthest reach
  std::size_t divisor = 2;  ///< arcs stop beyond 1 / divisor of their reach
};
/// Tried in this order. The last ones are for bends tighter than the tolerance, where going far leads astray.
constexpr std::array<Effort, 6> kEfforts{
    {{0.985, 8, 2}, {0.95, 8, 2}, {0.9, 8, 2}, {0.98, 64, 16}, {0.8, 64, 16}, {0.5, 64, 16}}};

/// The end of an arc of the search: the next one starts here, tangentially.
struct State {
  Point2 q;
  Vec2 t;
  double offset = 0;      ///< of q from the path, in tolerances
  double k = 0;           ///< curvature of the arc that led here
  std::size_t at = 0;     ///< sample on whose normal q lies
  int parent = -1;        ///< index into the arena
  std::size_t reach = 0;  ///< last sample an arc from here can reach
};

/// Curvatures with which an arc stays in the tube up to a sample.
struct Funnel {
  double lo = 0, hi = 0;
};

/// The states of a layer are kept apart by cells of normal offset and tangent deviation; each cell keeps the
/// state that came furthest. Both are in units that do not depend on the curve: the tolerance, and tolerance
/// / arc length (a steady fit has tangent deviations up to 10.4 of these).
constexpr int kOffsetCells = 4;  // -4 .. 4
constexpr double kOffsetStep = 0.2;
constexpr int kSlopeCells = 12;  // -12 .. 12
constexpr double kSlopeStep = 1.5;
constexpr std::size_t kCells = (2 * kOffsetCells + 1) * (2 * kSlopeCells + 1);

constexpr double kMaxTurn = 2.6;                                          // rad, of the path along one arc
constexpr double kMinCosine = 0.5;                                        // between arc and path at a joint
constexpr std::array<double, 5> kFractions{0.02, 0.25, 0.5, 0.75, 0.98};  // of the feasible curvatures
constexpr std::size_t kClosings = 8;  // candidates certified before the next attempt
constexpr double kNoBound = 1e300;

/// Nearest whole number in [-most, most].
int cell_index(double x, int most) {
  return static_cast<int>(std::clamp(x, -1.0 * most, 1.0 * most) + (most + 0.5)) - most;
}

class Search {
 public:
  Search(const std::vector<Sample>& samples, const Target& target, const Effort& effort)
      : samples_(samples),
        tube_{-effort.margin * target.tolerance, effort.margin * target.tolerance},
        effort_(effort),
        start_freedom_(target.start_freedom),
        end_freedom_(target.end_freedom) {}

  /// Layers of one more arc each, up to the first one with closings; true when one of these passes `accept`.
  template <class Accept>
  bool run(Accept accept) {
    std::vector<State> layer = start_layer();
    for (std::size_t count = 0; count < kMaxSegments; ++count) {
      rank(layer);
      if (layer.empty()) return false;
      const int base = static_cast<int>(arena_.size());
      arena_.insert(arena_.end(), layer.begin(), layer.end());
      const std::vector<Closing> closings = closings_of(base);
      for (const Closing& c : closings) {
        if (accept(c.state, c.arcs)) return true;
      }
      if (!closings.empty()) return false;
      layer = next_layer(base);
    }
    return false;
  }

  /// The states from the start to `last`, both included.
  std::vector<State> chain(int last) const {
    std::vector<State> states;
    for (int i = last; i >= 0; i = arena_[static_cast<std::size_t>(i)].parent) {
      states.push_back(arena_[static_cast<std::size_t>(i)]);
    }
    std::reverse(states.begin(), states.end());
    return states;
  }

 private:
  /// The start of the path, with all directions worth trying when it is free.
  std::vector<State> start_layer() {
    const Sample& first = samples_.front();
    std::vector<State> layer{{first.p, first.t, 0, 0, 0, -1, 0}};
    if (start_freedom_ <= 0) return layer;
    funnel_.resize(samples_.size());
    const double length = distance(first.p, samples_[pass(layer.front())].p);
    const double step = kSlopeStep * 0.5 * (tube_.hi - tube_.lo) / length;
    for (int i = 1; i <= kSlopeCells && i * step <= start_freedom_; ++i) {
      for (const double angle : {i * step, -i * step}) {
        State s = layer.front();
        s.t = std::cos(angle) * first.t + std::sin(angle) * left(first.t);
        layer.push_back(s);
      }
    }
    return layer;
  }

  /// Fills funnel_[j] for the samples after the state's; returns the last one with a feasible arc.
  std::size_t pass(const State& s) {
    const double near2 = 4 * std::max(tube_.lo * tube_.lo, tube_.hi * tube_.hi);
    const double turn = samples_[s.at].turn;
    Funnel f{-kNoBound, kNoBound};
    std::size_t j = s.at + 1;
    for (; j < samples_.size(); ++j) {
      const Sample& sample = samples_[j];
      if (std::abs(sample.turn - turn) > kMaxTurn) break;
      const Vec2 p = sample.p - s.q;
      const double pp = norm2(p), pn = cross(s.t, p);
      if (pp > near2) {
        // A circle through s with curvature k leaves p at the signed distance e when k (|p|^2 - e^2) = 2 (p.n
        // - e).
        f.lo = std::max(f.lo, 2 * (pn - tube_.hi) / (pp - tube_.hi * tube_.hi));
        f.hi = std::min(f.hi, 2 * (pn - tube_.lo) / (pp - tube_.lo * tube_.lo));
        if (f.lo > f.hi) break;
        // The arcs of the funnel must run with the path, not meet a part of it that comes back.
        const double k = 0.5 * (f.lo + f.hi);
        if (!(dot(sample.t, s.t) - k * cross(sample.t, p) > 0)) break;
      }
      funnel_[j] = f;
    }
    return j - 1;
  }

  void rank(std::vector<State>& layer) {
    funnel_.resize(samples_.size());
    for (State& s : layer) s.reach = pass(s);
    // With the same reach (a tight bend stops them all) those near the path have the better prospects.
    std::stable_sort(layer.begin(), layer.end(), [](const State& a, const State& b) {
      return a.reach != b.reach ? a.reach > b.reach : a.offset < b.offset;
    });
    if (layer.size() > effort_.beam) layer.resize(effort_.beam);
    while (!layer.empty() && layer.back().reach <= layer.back().at) layer.pop_back();
  }

  /// The best way into a cell: an arc of curvature k from state `parent` to the normal at sample `at`.
  struct Cell {
    double k = 0;
    std::size_t at = 0;
    int parent = -1;
  };

  std::vector<State> next_layer(int base) {
    std::array<Cell, kCells> cells;
    const int end = static_cast<int>(arena_.size());
    for (int i = base; i < end; ++i) {
      const State s = arena_[static_cast<std::size_t>(i)];
      const std::size_t reach = pass(s);
      const std::size_t nearest = s.at + 1 + (reach - s.at) / effort_.divisor;
      for (std::size_t j = std::min(reach, samples_.size() - 2); j >= nearest; --j) expand(s, i, j, cells);
    }
    std::vector<State> layer;
    for (const Cell& c : cells) {
      if (c.at == 0) continue;
      const State& s = arena_[static_cast<std::size_t>(c.parent)];
      const Arc arc = arc_towards(s.q, s.t, c.k, samples_[c.at].p);
      const double offset = distance(arc.b, samples_[c.at].p) / tube_.hi;
      layer.push_back({arc.b, arc.tb, offset, c.k, c.at, c.parent, 0});
    }
    return layer;
  }

  /// The cells that arcs from s to the normal at sample j lead to. With m = n - k p, p from s to the sample:
  /// the arc's normal there is m / |m|, |m|^2 = 1 - 2 k F (biarc.h).
  void expand(const State& s, int index, std::size_t j, std::array<Cell, kCells>& cells) const {
    const Funnel f = funnel_[j];
    if (!(f.hi - f.lo < kNoBound)) return;  // only samples at the start itself so far
    const Sample& sample = samples_[j];
    const Vec2 p = sample.p - s.q;
    const double pp = norm2(p), pn = cross(s.t, p);
    const double along_n = dot(sample.t, left(s.t)), along_p = dot(sample.t, p);
    const double across_n = dot(sample.t, s.t), across_p = cross(sample.t, p);
    const double tolerance = 0.5 * (tube_.hi - tube_.lo);
    const double to_offset = 1 / (kOffsetStep * tolerance),
                 to_slope = std::sqrt(pp) / (kSlopeStep * tolerance);
    for (const double fraction : kFractions) {
      const double k = f.lo + fraction * (f.hi - f.lo);
      const double height = pn - 0.5 * k * pp;
      const double m = std::sqrt(std::max(0.0, 1 - 2 * k * height));
      const double cosine = (across_n - k * across_p) / m, slope = (k * along_p - along_n) / m;
      if (!(cosine >= kMinCosine)) continue;
      const double offset = -2 * height / (1 + m) * cosine;
      const int u = cell_index(offset * to_offset, kOffsetCells),
                v = cell_index(slope * to_slope, kSlopeCells);
      Cell& cell =
          cells[static_cast<std::size_t>((u + kOffsetCells) * (2 * kSlopeCells + 1) + v + kSlopeCells)];
      if (j > cell.at) cell = {k, j, index};
    }
  }

  /// One or two arcs from a state to the end of the path.
  struct Closing {
    double deviation = 0;
    int state = 0;
    std::vector<Arc> arcs;
  };

  /// Ways to finish from the states since `base`, fewest arcs first, then the smallest deviation.
  std::vector<Closing> closings_of(int base) {
    std::vector<Closing> closings;
    const int end = static_cast<int>(arena_.size());
    for (int i = base; i < end; ++i) close_by_arc(i, closings);
    if (closings.empty()) {
      for (int i = base; i < end; ++i) close_by_biarc(i, closings);
    }
    std::stable_sort(closings.begin(), closings.end(),
                     [](const Closing& a, const Closing& b) { return a.deviation < b.deviation; });
    if (closings.size() > kClosings) closings.resize(kClosings);
    return closings;
  }

  /// A single arc, where the direction at the end is free enough.
  void close_by_arc(int index, std::vector<Closing>& closings) {
    const State s = arena_[static_cast<std::size_t>(index)];
    const Sample& last = samples_.back();
    if (end_freedom_ <= 0 || s.reach + 1 != samples_.size()) return;
    pass(s);
    const double k = curvature_through(s.q, s.t, last.p);
    if (!(funnel_.back().lo <= k && k <= funnel_.back().hi)) return;
    Arc arc = arc_towards(s.q, s.t, k, last.p);
    arc.b = last.p;
    const double misfit = std::abs(cross(last.t, arc.tb));
    if (misfit > std::sin(end_freedom_) || dot(last.t, arc.tb) <= 0) return;
    closings.push_back({misfit, index, {arc}});
  }

  void close_by_biarc(int index, std::vector<Closing>& closings) const {
    const State& s = arena_[static_cast<std::size_t>(index)];
    const Sample& last = samples_.back();
    if (samples_.size() - 1 - s.at > 4 * (s.reach - s.at)) return;  // more than two arcs away
    Biarc biarc;
    double deviation = 0;
    if (!best_biarc(s.q, s.t, last.p, last.t, &samples_[s.at], &last, 0, biarc, deviation)) return;
    if (deviation <= std::min(-tube_.lo, tube_.hi))
      closings.push_back({deviation, index, {biarc[0], biarc[1]}});
  }

  const std::vector<Sample>& samples_;
  const Tube tube_;
  const Effort effort_;
  const double start_freedom_, end_freedom_;
  std::vector<State> arena_;
  std::vector<Funnel> funnel_;
};

/// The runs of a found chain: joints at samples; the joint of a closing biarc where the path crosses its
/// normal.
bool make_runs(const Path& path, const std::vector<Sample>& samples, const std::vector<State>& chain,
               const std::vector<Arc>& closing, std::vector<Run>& runs) {
  runs.clear();
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const State& from = chain[i - 1];
    const State& to = chain[i];
    runs.push_back({{from.q, from.t, to.k, to.q, to.t}, samples[from.at].tau, samples[to.at].tau});
  }
  double tau = samples[chain.back().at].tau;
  if (closing.size() == 2) {
    const Point2 joint = closing[0].b;
    const Vec2 tangent = closing[0].tb;
    std::size_t j = chain.back().at;
    while (j + 1 < samples.size() && dot(samples[j].p - joint, tangent) < 0) ++j;
    const double hand_over = parameter_on_normal(path, 0, joint, tangent, samples[j].tau, tau, path.end());
    if (hand_over < tau) return false;
    runs.push_back({closing[0], tau, hand_over});
    tau = hand_over;
  }
  runs.push_back({closing.back(), tau, path.end()});
  return true;
}

}  // namespace

std::optional<FittedPiece> fit_minimal(const Target& target) {
  const Path& path = *target.path;
  const std::vector<Sample> samples = sample_path(path, target.tolerance);
  if (samples.empty()) return std::nullopt;
  for (const Effort& effort : kEfforts) {
    Search search(samples, target, effort);
    FittedPiece piece;
    const auto accept = [&](int state, const std::vector<Arc>& closing) {
      if (!make_runs(path, samples, search.chain(state), closing, piece.runs)) return false;
      piece.deviation = certify(target, piece.runs);
      return piece.deviation.bound() <= target.tolerance;
    };
    if (search.run(accept)) return piece;
  }
  return std::nullopt;
}

}  // namespace burin::geom::fit
