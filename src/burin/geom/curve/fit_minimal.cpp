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

/// The end of an arc of the search: the next one starts here, tangentially.
struct State {
  Point2 q;
  Vec2 t;
  double k = 0;           ///< curvature of the arc that led here
  std::size_t at = 0;     ///< sample on whose normal q lies
  int parent = -1;        ///< index into the arena
  std::size_t reach = 0;  ///< last sample an arc from here can reach
};

/// Curvatures with which an arc stays in the tube up to a sample.
struct Funnel {
  double lo = 0, hi = 0;
};

constexpr std::size_t kBeam = 24;  // states of a layer that are continued
constexpr int kOffsetCells = 2;    // cells of the normal offset: -2 .. 2
constexpr int kSlopeCells = 6;     // cells of the tangent's deviation: -6 .. 6
constexpr double kSlopeStep = 3;   // times tolerance / arc length; a steady fit needs up to 10.4
constexpr double kMaxTurn = 2.6;   // rad, of the path along one arc
constexpr std::array<double, 5> kFractions{0.02, 0.25, 0.5, 0.75, 0.98};  // of the feasible curvatures
constexpr std::size_t kClosings = 8;  // closings certified before the search goes on

class Search {
 public:
  Search(const std::vector<Sample>& samples, Tube tube) : samples_(samples), tube_(tube) {}

  /// Layers of one more arc each, up to the first one with closings; true when one of these passes `accept`.
  template <class Accept>
  bool run(Accept accept) {
    const Sample& first = samples_.front();
    std::vector<State> layer{{first.p, first.t, 0, 0, -1, 0}};
    for (std::size_t count = 0; count < kMaxSegments; ++count) {
      rank(layer);
      if (layer.empty()) return false;
      const int base = static_cast<int>(arena_.size());
      arena_.insert(arena_.end(), layer.begin(), layer.end());
      const std::vector<Closing> closings = closings_of(base);
      for (const Closing& c : closings) {
        if (accept(c.state, c.biarc)) return true;
      }
      if (!closings.empty()) return false;
      layer = next_layer(base);
    }
    return false;
  }

  /// The states from the start to `last`, without the start.
  std::vector<State> chain(int last) const {
    std::vector<State> states;
    for (int i = last; arena_[static_cast<std::size_t>(i)].parent >= 0;
         i = arena_[static_cast<std::size_t>(i)].parent) {
      states.push_back(arena_[static_cast<std::size_t>(i)]);
    }
    std::reverse(states.begin(), states.end());
    return states;
  }

 private:
  /// Fills funnel_[j] for the samples after the state's; returns the last one with a feasible arc.
  std::size_t pass(const State& s) {
    const double near2 = 4 * std::max(tube_.lo * tube_.lo, tube_.hi * tube_.hi);
    const double turn = samples_[s.at].turn;
    Funnel f{-1e300, 1e300};
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
      }
      funnel_[j] = f;
    }
    return j - 1;
  }

  void rank(std::vector<State>& layer) {
    funnel_.resize(samples_.size());
    for (State& s : layer) s.reach = pass(s);
    std::stable_sort(layer.begin(), layer.end(),
                     [](const State& a, const State& b) { return a.reach > b.reach; });
    if (layer.size() > kBeam) layer.resize(kBeam);
    while (!layer.empty() && layer.back().reach <= layer.back().at) layer.pop_back();
  }

  std::vector<State> next_layer(int base) {
    constexpr std::size_t kCells = (2 * kOffsetCells + 1) * (2 * kSlopeCells + 1);
    std::array<State, kCells> cells;
    const int end = static_cast<int>(arena_.size());
    for (int i = base; i < end; ++i) {
      const State s = arena_[static_cast<std::size_t>(i)];
      const std::size_t reach = pass(s);
      const std::size_t nearest = s.at + 1 + (reach - s.at) / 4;
      for (std::size_t j = std::min(reach, samples_.size() - 2); j >= nearest && j > s.at; --j)
        expand(s, i, j, cells);
    }
    std::vector<State> layer;
    for (const State& s : cells) {
      if (s.at > 0) layer.push_back(s);
    }
    return layer;
  }

  template <std::size_t N>
  void expand(const State& s, int index, std::size_t j, std::array<State, N>& cells) {
    const Funnel f = funnel_[j];
    if (!(f.hi - f.lo < 1e300)) return;  // nothing but samples at the start itself so far
    const Sample& sample = samples_[j];
    const double tolerance = 0.5 * (tube_.hi - tube_.lo);
    for (const double fraction : kFractions) {
      const double k = f.lo + fraction * (f.hi - f.lo);
      const Arc arc = arc_towards(s.q, s.t, k, sample.p);
      const double slope = cross(sample.t, arc.tb);
      if (dot(sample.t, arc.tb) < 0.5) continue;
      const double offset = cross(sample.t, arc.b - sample.p);
      const double length = distance(arc.a, arc.b);
      const int u = static_cast<int>(std::lround(std::clamp(offset / (0.4 * tolerance), -2.0, 2.0)));
      const int v = static_cast<int>(std::lround(
          std::clamp(slope * length / (kSlopeStep * tolerance), -1.0 * kSlopeCells, 1.0 * kSlopeCells)));
      State& cell =
          cells[static_cast<std::size_t>((u + kOffsetCells) * (2 * kSlopeCells + 1) + v + kSlopeCells)];
      if (j > cell.at) cell = {arc.b, arc.tb, k, j, index, 0};
    }
  }

  struct Closing {
    double deviation;
    int state;
    Biarc biarc;
  };
  /// Biarcs from the states since `base` to the end of the path, best first.
  std::vector<Closing> closings_of(int base) const {
    std::vector<Closing> closings;
    const Sample& last = samples_.back();
    const int end = static_cast<int>(arena_.size());
    const double enough = std::min(-tube_.lo, tube_.hi);
    for (int i = base; i < end; ++i) {
      const State& s = arena_[static_cast<std::size_t>(i)];
      if (samples_.size() - 1 - s.at > 4 * (s.reach - s.at)) continue;
      Closing c{0, i, {}};
      if (!best_biarc(s.q, s.t, last.p, last.t, &samples_[s.at], &last, 0, c.biarc, c.deviation)) continue;
      if (c.deviation <= enough) closings.push_back(c);
    }
    std::stable_sort(closings.begin(), closings.end(),
                     [](const Closing& a, const Closing& b) { return a.deviation < b.deviation; });
    if (closings.size() > kClosings) closings.resize(kClosings);
    return closings;
  }

  const std::vector<Sample>& samples_;
  const Tube tube_;
  std::vector<State> arena_;
  std::vector<Funnel> funnel_;
};

/// The runs of a found chain: joints at samples, the closing joint where the path crosses its normal.
bool make_runs(const Path& path, const std::vector<Sample>& samples, const std::vector<State>& chain,
               const Biarc& closing, std::vector<Run>& runs) {
  runs.clear();
  Point2 a = samples.front().p;
  Vec2 ta = samples.front().t;
  double tau = 0;
  for (const State& s : chain) {
    const double next = samples[s.at].tau;
    runs.push_back({{a, ta, s.k, s.q, s.t}, tau, next});
    a = s.q;
    ta = s.t;
    tau = next;
  }
  const Point2 joint = closing[0].b;
  const Vec2 tangent = closing[0].tb;
  std::size_t j = chain.empty() ? 0 : chain.back().at;
  while (j + 1 < samples.size() && dot(samples[j].p - joint, tangent) < 0) ++j;
  const double hand_over = parameter_on_normal(path, 0, joint, tangent, samples[j].tau, tau, path.end());
  if (hand_over < tau) return false;
  runs.push_back({closing[0], tau, hand_over});
  runs.push_back({closing[1], hand_over, path.end()});
  return true;
}

}  // namespace

std::optional<FittedPiece> fit_single(const Target& target, double tangent_rad) {
  const Path& path = *target.path;
  const PointTangent a = path.at(0), b = path.at(path.end());
  const Vec2 chord = b.point - a.point;
  if (chord == Vec2{}) return std::nullopt;
  const double at_start = std::atan2(cross(a.tangent, chord), dot(a.tangent, chord));
  const double at_end = std::atan2(cross(chord, b.tangent), dot(chord, b.tangent));
  // The arc turns by alpha on each side of its chord; the mean shares the misfit between both ends.
  const double misfit = 0.5 * (at_start - at_end);
  if (std::abs(misfit) > tangent_rad) return std::nullopt;
  double alpha = 0.5 * (at_start + at_end);
  if (std::abs(alpha) > 0.5 * kMaxTurn) return std::nullopt;
  if (std::abs(alpha) <= tangent_rad) alpha = 0;  // tried as a line first
  for (const double turn : {alpha, 0.5 * (at_start + at_end)}) {
    const Vec2 along = unit(chord);
    const double c = std::cos(turn), s = std::sin(turn);
    const Arc arc{a.point, c * along - s * left(along), 2 * s / norm(chord), b.point,
                  c * along + s * left(along)};
    FittedPiece piece{{{arc, 0, path.end()}}, {}};
    const double worst = std::max(std::abs(at_start - turn), std::abs(at_end - turn));
    if (worst > tangent_rad) continue;
    piece.deviation = certify(target, piece.runs);
    if (piece.deviation.bound() <= target.tolerance) return piece;
  }
  return std::nullopt;
}

std::optional<FittedPiece> fit_minimal(const Target& target) {
  const Path& path = *target.path;
  const std::vector<Sample> samples = sample_path(path, target.tolerance);
  if (samples.empty()) return std::nullopt;
  // Between samples the deviation grows by about 1 %; what the offset adds shows when a candidate is
  // certified.
  for (const double margin : {0.985, 0.95, 0.9, 0.8, 0.65, 0.5}) {
    Search search(samples, {-margin * target.tolerance, margin * target.tolerance});
    FittedPiece piece;
    const auto accept = [&](int state, const Biarc& closing) {
      if (!make_runs(path, samples, search.chain(state), closing, piece.runs)) return false;
      piece.deviation = certify(target, piece.runs);
      return piece.deviation.bound() <= target.tolerance;
    };
    if (search.run(accept)) return piece;
  }
  return std::nullopt;
}

}  // namespace burin::geom::fit
