// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/axis.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "burin/geom/vec.h"
#include "burin/plan/rotary/chain.h"

namespace burin::rotary {
namespace {

using geom::kPi;

// Which intervals are passed is decided on candidates this far apart; the angles themselves are made even
// afterwards, so the spacing is no resolution of the result.
constexpr double kGrid = 5 * kPi / 180;
// Prices of the search, in radians of turning. A retract outweighs all turning of a long path, and a jump
// over a gap that no layer shows open lies between.
constexpr double kBreak = 1e9;
constexpr double kGap = 1e4;
// A whole circle of reachable angles: no walls near.
constexpr double kFree = 100;
constexpr double kReversal = kPi / 180;
// Ends of intervals are sums of angles: equal ones may differ by rounding.
constexpr double kTouch = 1e-12;

double wrapped(double a) {
  a = std::fmod(a, 2 * kPi);
  if (a >= kPi) a -= 2 * kPi;
  if (a < -kPi) a += 2 * kPi;
  return a;
}

bool whole(const AngleInterval& i) {
  return i.hi - i.lo >= 2 * kPi;
}

/// One angle the search may take in a layer.
struct Candidate {
  double theta = 0;            ///< [-pi, pi)
  double down = 0, up = 0;     ///< room to the ends of its reachable interval
  double cost = 0;             ///< of standing here
  std::uint32_t interval = 0;  ///< of the layer's reachable set
};

/// What a layer's candidates and boxes come from.
struct Room {
  AngleInterval reachable, kept;  ///< kept: without the clearance
};

/// Whether two intervals of the circle have an angle in common.
bool overlap(const AngleInterval& a, const AngleInterval& b) {
  if (whole(a) || whole(b)) return true;
  for (const double turn : {-2 * kPi, 0.0, 2 * kPi})
    if (a.lo <= b.hi + turn && b.lo + turn <= a.hi) return true;
  return false;
}

class Search {
 public:
  Search(const std::vector<Layer>& layers, const AxisOptions& options) : layers_(layers), options_(options) {
    weigh();
  }

  AxisChain run() {
    chain_.theta.assign(layers_.size(), options_.start);
    double start = options_.start;
    std::size_t begin = 0;
    while (begin < layers_.size()) {
      if (layers_[begin].reachable.empty()) {
        note_break(begin);
        chain_.theta[begin] = start;
        ++begin;
        continue;
      }
      std::size_t end = begin + 1;
      while (end < layers_.size() && !layers_[end].reachable.empty()) ++end;
      if (begin > 0 && layers_[begin - 1].reachable.empty()) note_break(begin);
      if (options_.smooth)
        stretch(begin, end, start);
      else
        each_alone(begin, end, start);
      start = chain_.theta[end - 1];
      begin = end;
    }
    measure();
    return std::move(chain_);
  }

 private:
  void note_break(std::size_t i) {
    if (i > 0 && (chain_.breaks.empty() || chain_.breaks.back() != i)) chain_.breaks.push_back(i);
  }

  /// The length over which the axis may lag behind the first axis: that of a radian of its turning, and no
  /// more than a sixth of the path.
  void weigh() {
    double length = 0, turning = 0;
    for (std::size_t i = 1; i < layers_.size(); ++i) {
      length += std::max(0.0, layers_[i].length);
      turning += std::abs(wrapped(layers_[i].initial - layers_[i - 1].initial));
    }
    if (!(length > 0)) length = static_cast<double>(std::max<std::size_t>(layers_.size(), 1));
    lag_ = length / std::max(6.0, turning);
    shortest_ = 1e-3 * length / static_cast<double>(std::max<std::size_t>(layers_.size(), 1));
  }
  double step_length(std::size_t i) const { return std::max(layers_[i].length, shortest_); }
  /// The share of the path that stands at layer i.
  double weight(std::size_t i) const {
    const double after = i + 1 < layers_.size() ? step_length(i + 1) : 0;
    return ((i > 0 ? step_length(i) : 0) + after) / 2;
  }

  // --- candidates

  std::vector<Room> rooms(std::size_t i) const {
    std::vector<Room> out;
    const AngleSet& set = layers_[i].reachable;
    for (const AngleInterval& interval : set) {
      const AngleSet kept = narrowed({interval}, options_.clearance);
      out.push_back({interval, kept.empty() ? interval : kept.front()});
    }
    return out;
  }

  /// Distance of theta from the zone around the normal where the ball's tip cuts, 0 outside.
  double tip_cuts(const Layer& layer, double theta) const {
    if (!(options_.lean > 0) || !std::isfinite(layer.normal)) return 0;
    return std::max(0.0, options_.lean - std::abs(wrapped(theta - layer.normal)));
  }

  void add(std::vector<Candidate>& out, const Layer& layer, const Room& room, std::uint32_t index,
           double theta, double share) const {
    Candidate c;
    c.theta = wrapped(theta);
    c.interval = index;
    c.down = whole(room.reachable) ? kFree : theta - room.reachable.lo;
    c.up = whole(room.reachable) ? kFree : room.reachable.hi - theta;
    const double away = wrapped(theta - layer.initial);
    c.cost = share / lag_ * (0.5 * away * away);
    // Half a radian of turning is worth a stretch of `lag_` in which the tip does not cut with its centre.
    if (options_.lean > 0) c.cost += share / lag_ * (0.5 * tip_cuts(layer, theta) / options_.lean);
    out.push_back(c);
  }

  void candidates(std::size_t i, std::vector<Candidate>& out) const {
    out.clear();
    const Layer& layer = layers_[i];
    const double share = weight(i);
    std::uint32_t index = 0;
    for (const Room& room : rooms(i)) {
      const double lo = room.kept.lo, hi = room.kept.hi;
      const auto inside = [&](double theta) {
        const double t = lo + (wrapped(theta - lo) + (wrapped(theta - lo) < 0 ? 2 * kPi : 0));
        if (t > lo && t < hi) add(out, layer, room, index, t, share);
      };
      if (!whole(room.kept)) {
        add(out, layer, room, index, lo, share);
        if (hi > lo) add(out, layer, room, index, hi, share);
        if (hi - lo < 2 * kGrid) add(out, layer, room, index, (lo + hi) / 2, share);
      }
      // The grid hangs on the path's first angle: a part that is turned gives the same chain, turned.
      const double first = grid_ + kGrid * std::ceil((lo - grid_) / kGrid);
      for (double t = first; t < hi && out.size() < 4096; t += kGrid)
        if (t > lo || whole(room.kept)) add(out, layer, room, index, t, share);
      if (options_.lean > 0 && std::isfinite(layer.normal)) {
        inside(layer.normal + options_.lean);
        inside(layer.normal - options_.lean);
      }
      ++index;
    }
    std::sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) {
      return a.theta != b.theta ? a.theta < b.theta : a.interval < b.interval;
    });
  }

  // --- search

  /// Which intervals of two neighbouring layers go on into the other one.
  void continuations(std::size_t i) {
    const AngleSet &a = layers_[i - 1].reachable, &b = layers_[i].reachable;
    goes_on_.assign(a.size(), 0);
    comes_from_.assign(b.size(), 0);
    for (std::size_t j = 0; j < a.size(); ++j)
      for (std::size_t k = 0; k < b.size(); ++k)
        if (overlap(a[j], b[k])) goes_on_[j] = comes_from_[k] = 1;
  }

  /// The price of the step from a to b, `turn` (wrapped) between them; infinite when it is not to be made.
  double price(const Candidate& a, const Candidate& b, double turn) const {
    const double room = turn >= 0 ? a.up + b.down : a.down + b.up;
    const double size = std::abs(turn);
    if (size <= room + kTouch) return size;
    // A gap is taken only where one interval ends and the other begins: layers too far apart, not a wall.
    if (goes_on_[a.interval] || comes_from_[b.interval]) return std::numeric_limits<double>::infinity();
    return kGap + size;
  }

  /// Best way to b over the candidates of the layer before, which are sorted by angle.
  void relax(const std::vector<Candidate>& before, const std::vector<double>& cost, std::size_t best,
             const Candidate& b, double& out, std::int32_t& parent) const {
    out = cost[best] + kBreak + 1e-3 * std::abs(wrapped(b.theta - before[best].theta));
    parent = static_cast<std::int32_t>(best);
    const auto size = before.size();
    const auto look = [&](double from, double to) {
      auto it = std::lower_bound(before.begin(), before.end(), from,
                                 [](const Candidate& c, double value) { return c.theta < value; });
      for (; it != before.end() && it->theta <= to; ++it) {
        const auto j = static_cast<std::size_t>(it - before.begin());
        if (cost[j] >= out) continue;
        const double turn = wrapped(b.theta - it->theta);
        if (std::abs(turn) > options_.max_step) continue;
        const double c = cost[j] + price(*it, b, turn);
        if (c < out) {
          out = c;
          parent = static_cast<std::int32_t>(j);
        }
      }
    };
    if (size == 0) return;
    const double reach = std::min(options_.max_step, kPi);
    look(std::max(-kPi, b.theta - reach), std::min(kPi, b.theta + reach));
    if (b.theta - reach < -kPi) look(b.theta - reach + 2 * kPi, kPi);
    if (b.theta + reach > kPi) look(-kPi, b.theta + reach - 2 * kPi);
  }

  void stretch(std::size_t begin, std::size_t end, double start) {
    grid_ = wrapped(layers_[begin].initial);
    if (!std::isfinite(grid_)) grid_ = 0;
    std::vector<std::int32_t> parents;
    std::vector<std::size_t> first_of;
    std::vector<double> angles;
    std::vector<Candidate> now, before;
    std::vector<double> cost, cost_before;
    for (std::size_t i = begin; i < end; ++i) {
      candidates(i, now);
      first_of.push_back(angles.size());
      cost.assign(now.size(), 0);
      std::size_t best = 0;
      if (i > begin) {
        continuations(i);
        best = static_cast<std::size_t>(std::min_element(cost_before.begin(), cost_before.end()) -
                                        cost_before.begin());
      }
      for (std::size_t k = 0; k < now.size(); ++k) {
        std::int32_t parent = -1;
        if (i > begin)
          relax(before, cost_before, best, now[k], cost[k], parent);
        else
          cost[k] = std::abs(wrapped(now[k].theta - start));
        cost[k] += now[k].cost;
        parents.push_back(parent);
        angles.push_back(now[k].theta);
      }
      // Prices are counted from the cheapest, so that small ones do not drown after many breaks.
      const double least = cost.empty() ? 0 : *std::min_element(cost.begin(), cost.end());
      for (double& c : cost) c -= least;
      std::swap(now, before);
      std::swap(cost, cost_before);
    }
    trace(begin, end, start, parents, first_of, angles, cost_before);
    even_out(begin, end, start);
  }

  void trace(std::size_t begin, std::size_t end, double start, const std::vector<std::int32_t>& parents,
             const std::vector<std::size_t>& first_of, const std::vector<double>& angles,
             const std::vector<double>& last) {
    auto k = static_cast<std::size_t>(std::min_element(last.begin(), last.end()) - last.begin());
    for (std::size_t i = end; i-- > begin;) {
      const std::size_t at = first_of[i - begin] + k;
      chain_.theta[i] = angles[at];
      if (i > begin) k = static_cast<std::size_t>(parents[at]);
    }
    double previous = start;
    for (std::size_t i = begin; i < end; ++i) {
      chain_.theta[i] = previous + wrapped(chain_.theta[i] - previous);
      previous = chain_.theta[i];
      if (i > begin && !joined(i)) note_break(i);
    }
  }

  /// Whether the step to layer i, as it stands in theta, is one the search would not call a break.
  bool joined(std::size_t i) {
    const double turn = chain_.theta[i] - chain_.theta[i - 1];
    if (std::abs(turn) > options_.max_step) return false;
    Candidate a, b;
    place(i - 1, a);
    place(i, b);
    continuations(i);
    return std::isfinite(price(a, b, turn));
  }
  /// The interval that theta[i] lies in, and its room.
  void place(std::size_t i, Candidate& c) const {
    const AngleSet& set = layers_[i].reachable;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < set.size(); ++k) {
      const AngleInterval box = near(set[k], chain_.theta[i]);
      const double outside = std::max({box.lo - chain_.theta[i], chain_.theta[i] - box.hi, 0.0});
      if (outside >= best) continue;
      best = outside;
      c.interval = static_cast<std::uint32_t>(k);
      c.down = whole(set[k]) ? kFree : chain_.theta[i] - box.lo;
      c.up = whole(set[k]) ? kFree : box.hi - chain_.theta[i];
    }
  }

  // --- even steps

  /// The interval by whole turns so that theta lies in it, or its middle is nearest to it.
  static AngleInterval near(const AngleInterval& interval, double theta) {
    if (whole(interval)) return {theta - kPi, theta + kPi};
    const double middle = (interval.lo + interval.hi) / 2;
    const double turns = std::round((theta - middle) / (2 * kPi)) * 2 * kPi;
    return {interval.lo + turns, interval.hi + turns};
  }

  /// Where theta[i] may move without entering another interval or the zone around the normal.
  AngleInterval box(std::size_t i) const {
    const Layer& layer = layers_[i];
    const double theta = chain_.theta[i];
    Candidate c;
    place(i, c);
    if (whole(layer.reachable[c.interval])) return without_tip(layer, theta, {theta - kFree, theta + kFree});
    const Room room = rooms(i)[c.interval];
    AngleInterval out = near(room.kept, theta);
    out.lo = std::min(out.lo, theta);
    out.hi = std::max(out.hi, theta);
    return without_tip(layer, theta, out);
  }
  AngleInterval without_tip(const Layer& layer, double theta, AngleInterval out) const {
    if (!(options_.lean > 0) || !std::isfinite(layer.normal)) return out;
    const double from = wrapped(theta - layer.normal), normal = theta - from;
    // Candidates stand exactly at the zone's ends.
    if (from >= options_.lean * (1 - 1e-9)) {
      out.lo = std::max(out.lo, std::min(theta, normal + options_.lean));
      out.hi = std::min(out.hi, normal + 2 * kPi - options_.lean);
    } else if (from <= -options_.lean * (1 - 1e-9)) {
      out.hi = std::min(out.hi, std::max(theta, normal - options_.lean));
      out.lo = std::max(out.lo, normal - 2 * kPi + options_.lean);
    }
    return out;
  }

  void even_out(std::size_t begin, std::size_t end, double start) {
    std::size_t from = begin;
    while (from < end) {
      std::size_t to = from + 1;
      while (to < end && !std::binary_search(chain_.breaks.begin(), chain_.breaks.end(), to)) ++to;
      even_out_chain(from, to, from == begin ? start : chain_.theta[from]);
      from = to;
    }
  }

  void even_out_chain(std::size_t from, std::size_t to, double start) {
    const std::size_t n = to - from;
    ChainProblem problem;
    for (auto* v : {&problem.stiff, &problem.pull, &problem.goal, &problem.lo, &problem.hi}) v->resize(n);
    std::vector<double> x(n);
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = from + k;
      const AngleInterval b = box(i);
      problem.lo[k] = b.lo;
      problem.hi[k] = b.hi;
      x[k] = chain_.theta[i];
      problem.stiff[k] = lag_ / step_length(i);
      problem.pull[k] = weight(i) / lag_;
      problem.goal[k] = std::isfinite(layers_[i].initial) ? x[k] + wrapped(layers_[i].initial - x[k]) : x[k];
    }
    // The first one hangs on where the axis stood before, as over a step of `lag_`.
    const double pull = problem.pull[0] + 1;
    problem.goal[0] = (problem.pull[0] * problem.goal[0] + start) / pull;
    problem.pull[0] = pull;
    soften(problem, x);
    std::copy(x.begin(), x.end(), chain_.theta.begin() + static_cast<std::ptrdiff_t>(from));
  }

  /// Even steps may exceed the largest one where a short piece has to turn far: those are made dearer. The
  /// way of the search, whose steps are allowed, stays where that does not help.
  void soften(ChainProblem& problem, std::vector<double>& x) const {
    const std::vector<double> searched = x;
    for (int round = 0; round < 8; ++round) {
      x = searched;
      solve_chain(problem, x);
      bool good = true;
      for (std::size_t k = 1; k < x.size(); ++k) {
        const double over = std::abs(x[k] - x[k - 1]) / options_.max_step;
        if (over <= 1) continue;
        good = false;
        problem.stiff[k] *= 2 * over * over;
      }
      if (good) return;
    }
    x = searched;
  }

  void each_alone(std::size_t begin, std::size_t end, double start) {
    double previous = start;
    for (std::size_t i = begin; i < end; ++i) {
      AngleSet kept;
      for (const Room& room : rooms(i)) kept.push_back(room.kept);
      const double initial = std::isfinite(layers_[i].initial) ? layers_[i].initial : previous;
      const double theta = nearest(kept, initial);
      chain_.theta[i] = previous + wrapped(theta - previous);
      previous = chain_.theta[i];
      if (i > begin && !joined(i)) note_break(i);
    }
  }

  // --- figures

  void measure() {
    std::size_t next = 0;
    double low = 0, high = 0;
    int direction = 0;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      const bool broken = next < chain_.breaks.size() && chain_.breaks[next] == i;
      if (broken) ++next;
      const double t = chain_.theta[i];
      if (i == 0 || broken || layers_[i].reachable.empty()) {
        low = high = t;
        direction = 0;
        continue;
      }
      const double step = std::abs(t - chain_.theta[i - 1]);
      chain_.turn_total += step;
      chain_.step_max = std::max(chain_.step_max, step);
      if (direction >= 0 && t < high - kReversal) {
        if (direction > 0) ++chain_.reversals;
        direction = -1;
        low = t;
      } else if (direction <= 0 && t > low + kReversal) {
        if (direction < 0) ++chain_.reversals;
        direction = 1;
        high = t;
      }
      low = direction < 0 || direction == 0 ? std::min(low, t) : low;
      high = direction > 0 || direction == 0 ? std::max(high, t) : high;
    }
  }

  const std::vector<Layer>& layers_;
  const AxisOptions& options_;
  AxisChain chain_;
  double lag_ = 1, shortest_ = 0, grid_ = 0;
  std::vector<char> goes_on_, comes_from_;
};

}  // namespace

AxisChain choose_axes(const std::vector<Layer>& layers, const AxisOptions& options) {
  return Search(layers, options).run();
}

}  // namespace burin::rotary
