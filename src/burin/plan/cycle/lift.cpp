// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/lift.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "burin/base/parallel.h"
#include "burin/plan/cycle/bspline1.h"

namespace burin::cycle {
namespace {

using geom::QuinticNode;
using geom::QuinticPath;

// Samples are clear to this part of the tolerance, so that what lies between them is clear to all of it: a
// point that the ball sinks into by g is touched over a length of sqrt(8 R g).
constexpr double kShare = 0.75;
// A lift ends where less than this part of the tolerance is needed.
constexpr double kNothing = 0.002;
// The lift function gets its breaks no nearer than this part of the ball's radius.
constexpr double kFinest = 0.004;

// Places that one thread asks about at a time: few enough to share the work, enough for each to be near the
// one before. Results depend on these two, not on the number of threads.
constexpr std::size_t kChunk = 1024;
constexpr std::size_t kIntervals = 64;

using Workers = std::span<LiftWorker>;

/// body(first, last, worker) for chunks of 0 to count.
template <class Body>
void in_chunks(std::size_t count, std::size_t chunk, Workers workers, Body body) {
  parallel_for((count + chunk - 1) / chunk, static_cast<unsigned>(workers.size()),
               [&](std::size_t task, std::size_t worker) {
                 workers[worker].probe.forget();
                 body(task, task * chunk, std::min(count, (task + 1) * chunk), workers[worker]);
               });
}

/// Each of several tasks by one thread when there are enough of them, else one after the other by all.
template <class Body>
void share_out(std::size_t count, Workers workers, Body body) {
  if (count < 2 * workers.size()) {
    for (std::size_t i = 0; i < count; ++i) body(i, workers);
    return;
  }
  parallel_for(count, static_cast<unsigned>(workers.size()),
               [&](std::size_t task, std::size_t worker) { body(task, workers.subspan(worker, 1)); });
}

/// A place on the chain. `sigma`: about the length from the start of the chain.
struct Sample {
  std::size_t piece = 0;
  double t = 0, sigma = 0;
  Point3 tip;
  bool deep = false;
};

double piece_chord(const QuinticPath& path, std::size_t i) {
  // Four chords: near enough for spacing samples.
  double sum = 0;
  Point3 last = path.nodes[i].p;
  for (int k = 1; k <= 4; ++k) {
    const Point3 p = k == 4 ? path.nodes[i + 1].p : evaluate_piece(path, i, 0.25 * k).p;
    sum += distance(last, p);
    last = p;
  }
  return sum;
}

/// Linear between t and sigma on every piece.
struct Scale {
  double sigma0 = 0, t0 = 0, rate = 1;  ///< sigma = sigma0 + (t - t0) rate
  double sigma1 = 0;
};

class Lifter {
 public:
  Lifter(Chain& chain, Workers workers, double radius, double tolerance, LiftReport& report)
      : chain_(chain), workers_(workers), radius_(radius), tolerance_(tolerance), report_(report) {}

  void run() {
    spacing_ = std::min(std::sqrt(2 * radius_ * tolerance_), 0.25 * radius_);
    sample();
    if (!any_deep_) return;
    const std::vector<std::pair<double, double>> ranges = lifted_ranges();
    std::vector<Chain> lifted(ranges.size());
    std::vector<LiftPlace> highest(ranges.size());
    share_out(ranges.size(), workers_, [&](std::size_t i, Workers workers) {
      const auto [lo, hi] = ranges[i];
      lifted[i] = raised(part(lo, hi), lo > 0, hi < total_, workers, highest[i]);
    });
    Chain out;
    double from = 0;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      append(out, part(from, ranges[i].first));
      append(out, std::move(lifted[i]));
      if (highest[i].height > 0) report_.places.push_back(highest[i]);
      from = ranges[i].second;
    }
    append(out, part(from, total_));
    close_gaps(out);
    chain_ = std::move(out);
  }

 private:
  bool deeper(Obstacles::Probe& probe, Point3 tip, double depth) const {
    return !probe.clear({tip.x, tip.y, tip.z + radius_}, depth);
  }

  static double needed(Obstacles::Probe& probe, Point3 tip) {
    return std::max(0.0, probe.lowest_tip(xy(tip), tip.z) - tip.z);
  }

  void sample() {
    double sigma = 0;
    for (std::size_t i = 0; i < chain_.size(); ++i) {
      const QuinticPath& path = chain_[i].track.tip;
      double length = 0;
      for (std::size_t k = 0; k + 1 < path.nodes.size(); ++k) length += piece_chord(path, k);
      const double t0 = path.nodes.front().t, t1 = path.nodes.back().t;
      scales_.push_back({sigma, t0, length / (t1 - t0), sigma + length});
      for (std::size_t k = 0; k + 1 < path.nodes.size(); ++k) {
        const double h = path.nodes[k + 1].t - path.nodes[k].t;
        const int n = 1 + static_cast<int>(std::min(1e6, piece_chord(path, k) / spacing_));
        const bool last = i + 1 == chain_.size() && k + 2 == path.nodes.size();
        for (int j = 0; j < n + (last ? 1 : 0); ++j) {
          const double x = static_cast<double>(j) / n;
          Sample s{i, path.nodes[k].t + x * h, 0, evaluate_piece(path, k, x).p, false};
          s.sigma = sigma + (s.t - t0) * scales_[i].rate;
          samples_.push_back(s);
        }
      }
      sigma += length;
    }
    total_ = sigma;
    check_all();
  }

  void check_all() {
    std::vector<double> gouges(samples_.size() / kChunk + 1, 0.0);
    in_chunks(samples_.size(), kChunk, workers_,
              [&](std::size_t chunk, std::size_t first, std::size_t last, LiftWorker& worker) {
                for (std::size_t i = first; i < last; ++i) check(i, worker.probe, gouges[chunk]);
              });
    any_deep_ = std::any_of(samples_.begin(), samples_.end(), [](const Sample& s) { return s.deep; });
    for (const double g : gouges) report_.gouge_max = std::max(report_.gouge_max, g);
  }

  void check(std::size_t i, Obstacles::Probe& probe, double& gouge_max) {
    Sample& s = samples_[i];
    s.deep = deeper(probe, s.tip, kShare * tolerance_);
    // How deep the rest goes is asked for now and then only.
    constexpr std::size_t kSeldom = 8;
    if (s.deep || i % kSeldom != 0) return;
    const double seen = std::max({gouge_max, report_.gouge_max, 0.01 * tolerance_});
    if (deeper(probe, s.tip, seen))
      gouge_max = probe.depth({s.tip.x, s.tip.y, s.tip.z + radius_}, kShare * tolerance_);
  }

  // From where to where lifting is needed, grown until nothing is needed, with a run-up for the smooth start.
  std::vector<std::pair<double, double>> lifted_ranges() {
    const double nothing = kNothing * tolerance_;
    Obstacles::Probe& probe = workers_.front().probe;
    probe.forget();
    std::vector<std::pair<double, double>> out;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (!samples_[i].deep) continue;
      std::size_t a = i, b = i;
      while (a > 0 && needed(probe, samples_[a].tip) > nothing) --a;
      while (b + 1 < samples_.size() && (samples_[b].deep || needed(probe, samples_[b].tip) > nothing)) ++b;
      const double lo = std::max(0.0, samples_[a].sigma - 2 * spacing_);
      const double hi = std::min(total_, samples_[b].sigma + 2 * spacing_);
      if (!out.empty() && lo <= out.back().second)
        out.back().second = std::max(out.back().second, hi);
      else
        out.emplace_back(lo, hi);
      i = b;
    }
    return out;
  }

  Chain part(double lo, double hi) const {
    Chain out;
    const auto first =
        std::partition_point(scales_.begin(), scales_.end(), [lo](const Scale& s) { return s.sigma1 <= lo; });
    for (auto i = static_cast<std::size_t>(first - scales_.begin()); i < chain_.size(); ++i) {
      const Scale& s = scales_[i];
      if (s.sigma0 >= hi) break;
      if (s.sigma1 <= lo) continue;
      ChainPiece p = chain_[i];
      if (s.sigma0 < lo || s.sigma1 > hi) {
        const double t0 = s.t0 + (std::max(lo, s.sigma0) - s.sigma0) / s.rate;
        const double t1 = s.t0 + (std::min(hi, s.sigma1) - s.sigma0) / s.rate;
        p.track.tip = cut_path(chain_[i].track.tip, t0, t1);
        p.track.uv = cut_path(chain_[i].track.uv, t0, t1);
        if (p.track.tip.empty() || p.track.tip.nodes.size() != p.track.uv.nodes.size()) continue;
      }
      out.push_back(std::move(p));
    }
    return out;
  }

  static void append(Chain& to, Chain&& more) { std::move(more.begin(), more.end(), std::back_inserter(to)); }

  // Pieces that were cut at the same place by two polynomials, or at the end of a piece found by a division,
  // meet in the same point to the last bits, the more of them the farther the part is from its zero.
  static void close_gaps(Chain& chain) {
    for (std::size_t i = 1; i < chain.size(); ++i)
      chain[i].track.tip.nodes.front().p = chain[i - 1].track.tip.nodes.back().p;
  }

  // Which way the tool goes, compared with its contact on the surface.
  static bool runs_back(const Chain& c, std::size_t piece, double t, LiftWorker& worker) {
    const ChainPiece& p = c[piece];
    if (p.sheet == nullptr) return false;
    const geom::QuinticDerivatives tip = evaluate(p.track.tip, t);
    if (p.track.swing) {
      // In a concave crease the ball goes back while it turns.
      for (std::size_t k = piece; k-- > 0;)
        if (!c[k].track.swing) return dot(tip.d1, c[k].track.tip.nodes.back().d1) < 0;
      return false;
    }
    const geom::QuinticDerivatives uv = evaluate(p.track.uv, t);
    const bool u = p.sheet->along() == geom::Direction::u;
    const Contact at = worker.own(*p.sheet).contact(u ? uv.p.x : uv.p.y, u ? uv.p.y : uv.p.x);
    const Vec3 along = (u ? uv.d1.x : uv.d1.y) * at.st + (u ? uv.d1.y : uv.d1.x) * at.sw;
    return dot(tip.d1, along) < 0;
  }

  Chain raised(Chain c, bool smooth_start, bool smooth_end, Workers workers, LiftPlace& highest) const {
    c = without_returns(std::move(c), workers);
    std::vector<Scale> scales;
    double total = 0;
    for (const ChainPiece& p : c) {
      const QuinticPath& path = p.track.tip;
      double length = 0;
      for (std::size_t k = 0; k + 1 < path.nodes.size(); ++k) length += piece_chord(path, k);
      const double t0 = path.nodes.front().t, t1 = path.nodes.back().t;
      scales.push_back({total, t0, length / (t1 - t0), total + length});
      total += length;
    }
    if (c.empty() || !(total > 0)) return c;
    const CubicFunction f = lift_function(c, scales, total, smooth_start, smooth_end, workers);
    const std::vector<double> breaks = f.breaks();
    for (std::size_t i = 0; i < c.size(); ++i) apply(c[i], scales[i], f, breaks, highest);
    return c;
  }

  static Point3 tip_on(const Chain& c, const std::vector<Scale>& scales, double sigma) {
    const auto it = std::lower_bound(scales.begin(), scales.end(), sigma,
                                     [](const Scale& s, double x) { return s.sigma1 < x; });
    const std::size_t i = std::min(static_cast<std::size_t>(it - scales.begin()), c.size() - 1);
    const Scale& s = scales[i];
    return evaluate(c[i].track.tip, s.rate > 0 ? s.t0 + (sigma - s.sigma0) / s.rate : s.t0).p;
  }

  // Breaks where the needed height bends; between them it is nearly straight, as seen at three places.
  void place_breaks(Obstacles::Probe& probe, const Chain& c, const std::vector<Scale>& scales, double a,
                    double na, double b, double nb, std::vector<std::pair<double, double>>& out) const {
    const double mid = 0.5 * (a + b);
    const double need = needed(probe, tip_on(c, scales, mid));
    const double allowed = 0.1 * tolerance_;
    bool bends = std::abs(need - 0.5 * (na + nb)) > allowed;
    for (const double x : {0.25, 0.75}) {
      if (bends) break;
      bends = needed(probe, tip_on(c, scales, a + x * (b - a))) - (na + x * (nb - na)) > allowed;
    }
    if (bends && b - a > kFinest * radius_) {
      place_breaks(probe, c, scales, a, na, mid, need, out);
      place_breaks(probe, c, scales, mid, need, b, nb, out);
      return;
    }
    out.emplace_back(mid, need);
    out.emplace_back(b, nb);
  }

  // (place, need), ascending: the places of the grid and what is put between them.
  std::vector<std::pair<double, double>> needs_on(const std::vector<double>& grid, const Chain& c,
                                                  const std::vector<Scale>& scales, Workers workers) const {
    const std::size_t intervals = grid.size() - 1;
    std::vector<std::vector<std::pair<double, double>>> parts((intervals + kIntervals - 1) / kIntervals);
    in_chunks(intervals, kIntervals, workers,
              [&](std::size_t chunk, std::size_t first, std::size_t last, LiftWorker& worker) {
                auto& at = parts[chunk];
                const auto need = [&](double x) { return needed(worker.probe, tip_on(c, scales, x)); };
                at.emplace_back(grid[first], need(grid[first]));
                for (std::size_t i = first + 1; i <= last; ++i) {
                  const auto [a, na] = at.back();
                  place_breaks(worker.probe, c, scales, a, na, grid[i], need(grid[i]), at);
                }
              });
    std::vector<std::pair<double, double>> all;
    for (const auto& part : parts) {
      if (!all.empty()) all.pop_back();  // the next part begins with it
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }

  CubicFunction lift_function(const Chain& c, const std::vector<Scale>& scales, double total,
                              bool smooth_start, bool smooth_end, Workers workers) const {
    // (place, need), ascending. The run-up is cut finely: three intervals at a held end stay at 0.
    const double run_up = std::min(2 * spacing_, 0.25 * total);
    std::vector<double> grid{0};
    const int coarse = std::max(4, static_cast<int>(std::ceil(total / (2 * spacing_))));
    if (smooth_start) grid.insert(grid.end(), {0.5 * run_up, run_up});
    for (int i = 1; i < coarse; ++i) {
      const double x = total * i / coarse;
      const double last = smooth_end ? total - run_up : total;
      if (x > grid.back() + 0.25 * spacing_ && x < last - 0.25 * spacing_) grid.push_back(x);
    }
    if (smooth_end) grid.insert(grid.end(), {total - run_up, total - 0.5 * run_up});
    grid.push_back(total);
    // Pieces meet at corners, where the needed height has one as well.
    for (const Scale& p : scales)
      if (p.sigma1 > grid.front() && p.sigma1 < total) grid.push_back(p.sigma1);
    std::sort(grid.begin(), grid.end());
    std::vector<double> apart{grid.front()};
    for (const double x : grid)
      if (x - apart.back() > 1e-3 * spacing_ && (x == total || total - x > 1e-3 * spacing_))
        apart.push_back(x);
    grid = std::move(apart);
    if (grid.back() != total) grid.push_back(total);
    const std::vector<std::pair<double, double>> at = needs_on(grid, c, scales, workers);
    std::vector<double> breaks;
    for (const auto& p : at) breaks.push_back(p.first);
    CubicFunction f(breaks);
    const auto need_at = [&](double x) {
      const auto it = std::lower_bound(at.begin(), at.end(), x,
                                       [](const auto& p, double value) { return p.first < value; });
      if (it == at.begin()) return at.front().second;
      if (it == at.end()) return at.back().second;
      const auto& hi = *it;
      const auto& lo = *std::prev(it);
      return lo.second + (hi.second - lo.second) * (x - lo.first) / (hi.first - lo.first);
    };
    std::vector<double>& b = f.coefficients();
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = need_at(f.place(i));
    settle_ends(b, smooth_start, smooth_end);
    // Never below what is needed: the coefficients that act at a place are raised by what is missing there.
    // They sum to one, so that one pass is enough except at the ends that are held down.
    std::vector<double> more(b.size(), 0.0);
    for (const auto& [x, need] : at) {
      const double missing = need - f.at(x)[0];
      if (!(missing > 0)) continue;
      const std::size_t first = f.first_at(x);
      for (std::size_t k = first; k < first + 4; ++k) more[k] = std::max(more[k], missing);
    }
    for (std::size_t i = 0; i < b.size(); ++i) b[i] += more[i];
    settle_ends(b, smooth_start, smooth_end);
    return f;
  }

  // Value and two derivatives vanish where the lifted part meets the path on the surface.
  static void settle_ends(std::vector<double>& b, bool start, bool end) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (start) b[k] = 0;
      if (end) b[b.size() - 1 - k] = 0;
    }
  }

  void apply(ChainPiece& p, const Scale& s, const CubicFunction& f, const std::vector<double>& breaks,
             LiftPlace& place) const {
    std::vector<double> ts;
    for (const QuinticNode& n : p.track.tip.nodes) ts.push_back(n.t);
    const double t1 = p.track.tip.nodes.back().t;
    if (s.rate > 0)
      for (auto x = std::upper_bound(breaks.begin(), breaks.end(), s.sigma0);
           x != breaks.end() && *x < s.sigma1; ++x)
        ts.push_back(s.t0 + (*x - s.sigma0) / s.rate);
    std::sort(ts.begin(), ts.end());
    const double same = 1e-9 * (t1 - s.t0);
    QuinticPath tip, uv;
    for (std::size_t i = 0; i < ts.size(); ++i) {
      const bool last = i + 1 == ts.size();
      if (!tip.nodes.empty() && ts[i] - tip.nodes.back().t <= same) {
        if (!last || tip.nodes.size() < 2) continue;
        tip.nodes.pop_back();
        uv.nodes.pop_back();
      }
      const double sigma = s.sigma0 + (ts[i] - s.t0) * s.rate;
      const std::array<double, 3> l = f.at(sigma);
      const geom::QuinticDerivatives d = evaluate(p.track.tip, ts[i]), e = evaluate(p.track.uv, ts[i]);
      tip.nodes.push_back({ts[i],
                           {d.p.x, d.p.y, d.p.z + l[0]},
                           {d.d1.x, d.d1.y, d.d1.z + l[1] * s.rate},
                           {d.d2.x, d.d2.y, d.d2.z + l[2] * s.rate * s.rate}});
      uv.nodes.push_back({ts[i], e.p, e.d1, e.d2});
      p.lift_max = std::max(p.lift_max, l[0]);
      if (l[0] > place.height) {
        place.height = l[0];
        place.at = tip.nodes.back().p;
        place.surface = p.surface;
        place.pass = p.pass;
      }
    }
    if (tip.nodes.size() < 2) return;
    p.track.tip = std::move(tip);
    p.track.uv = std::move(uv);
  }

  /// Where the tool may run backwards.
  struct Place {
    std::size_t piece;
    double t;
    Point3 tip;
    Vec3 forward;
    bool back;
  };
  // Leaves out the parts of the chain where the tool would run backwards, with as much before and after as
  // brings both ends together.
  static void look_back(const Chain& c, double fine, std::size_t piece, LiftWorker& worker,
                        std::vector<Place>& places);
  Chain without_returns(Chain c, Workers workers) const;

  Chain& chain_;
  Workers workers_;
  double radius_, tolerance_;
  LiftReport& report_;
  double spacing_ = 0.1;
  double total_ = 0;
  bool any_deep_ = false;
  std::vector<Scale> scales_;
  std::vector<Sample> samples_;
};

void Lifter::look_back(const Chain& c, double fine, std::size_t piece, LiftWorker& worker,
                       std::vector<Place>& places) {
  const QuinticPath& path = c[piece].track.tip;
  for (std::size_t k = 0; k + 1 < path.nodes.size(); ++k) {
    const int n = 1 + static_cast<int>(std::min(1e5, piece_chord(path, k) / fine));
    const double h = path.nodes[k + 1].t - path.nodes[k].t;
    for (int j = 0; j < n; ++j) {
      const double x = (j + 0.5) / n, t = path.nodes[k].t + h * x;
      const geom::QuinticDerivatives d = evaluate_piece(path, k, x);
      places.push_back({piece, t, d.p, d.d1, runs_back(c, piece, t, worker)});
    }
  }
}

Chain Lifter::without_returns(Chain c, Workers workers) const {
  std::vector<std::vector<Place>> seen(c.size());
  const double fine = 0.25 * spacing_;
  in_chunks(c.size(), 1, workers, [&](std::size_t piece, std::size_t, std::size_t, LiftWorker& worker) {
    look_back(c, fine, piece, worker, seen[piece]);
  });
  std::vector<Place> places;
  for (const std::vector<Place>& p : seen) places.insert(places.end(), p.begin(), p.end());
  if (std::none_of(places.begin(), places.end(), [](const Place& p) { return p.back; })) return c;
  // Index ranges (a, b) of places that are joined by a straight line.
  std::vector<std::pair<std::size_t, std::size_t>> bridges;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!places[i].back) continue;
    // Inside one pass (or link): what follows is another path.
    const auto same = [&](std::size_t k) {
      const ChainPiece &p = c[places[k].piece], &q = c[places[i].piece];
      return p.kind == q.kind && p.surface == q.surface && p.pass == q.pass;
    };
    std::size_t a = i > 0 && same(i - 1) ? i - 1 : i, b = i;
    while (b + 1 < places.size() && places[b].back && same(b + 1)) ++b;
    const auto turned_back = [&] {
      const Vec3 d = places[b].tip - places[a].tip;
      return d.x * places[a].forward.x + d.y * places[a].forward.y < 0;
    };
    while (turned_back()) {
      const bool before = a > 0 && same(a - 1), after = b + 1 < places.size() && same(b + 1);
      if (!before && !after) break;
      if (before) --a;
      if (after && turned_back()) ++b;
    }
    if (!bridges.empty() && a <= bridges.back().second)
      bridges.back().second = b;
    else
      bridges.emplace_back(a, b);
    i = b;
  }
  Chain out;
  std::size_t piece = 0;
  double t = c[0].track.tip.nodes.front().t;
  const auto copy_until = [&](std::size_t to_piece, double to_t) {
    for (; piece <= to_piece && piece < c.size();
         ++piece, t = piece < c.size() ? c[piece].track.tip.nodes.front().t : 0) {
      const double end = piece == to_piece ? to_t : c[piece].track.tip.nodes.back().t;
      ChainPiece p = c[piece];
      p.track.tip = cut_path(c[piece].track.tip, t, end);
      p.track.uv = cut_path(c[piece].track.uv, t, end);
      if (!p.track.tip.empty() && p.track.tip.nodes.size() == p.track.uv.nodes.size())
        out.push_back(std::move(p));
      if (piece == to_piece) return;
    }
  };
  for (const auto& [a, b] : bridges) {
    const Place &pa = places[a], &pb = places[b];
    copy_until(pa.piece, pa.t);
    ChainPiece bridge = c[pa.piece];
    bridge.track = {};
    bridge.track.tip = geom::straight(pa.tip, pb.tip);
    const double length = bridge.track.tip.nodes.back().t;
    const Point3 ua = evaluate(c[pa.piece].track.uv, pa.t).p, ub = evaluate(c[pb.piece].track.uv, pb.t).p;
    const Vec3 rate = (ub - ua) / length;
    bridge.track.uv = {{{0, ua, rate, {}}, {length, ub, rate, {}}}};
    bridge.sheet = nullptr;
    if (distance(pa.tip, pb.tip) > 0) out.push_back(std::move(bridge));
    piece = pb.piece;
    t = pb.t;
  }
  copy_until(c.size() - 1, c.back().track.tip.nodes.back().t);
  return out;
}

}  // namespace

void lift(Chain& chain, Workers workers, double radius, double tolerance, LiftReport& report) {
  if (chain.empty()) return;
  Lifter(chain, workers, radius, tolerance, report).run();
}

void lift(std::vector<Chain>& chains, const Obstacles& obstacles, unsigned threads, double radius,
          double tolerance, LiftReport& report) {
  std::vector<LiftWorker> workers(std::max(1U, threads), LiftWorker(obstacles));
  std::vector<LiftReport> reports(chains.size());
  share_out(chains.size(), workers,
            [&](std::size_t i, Workers own) { lift(chains[i], own, radius, tolerance, reports[i]); });
  for (const LiftReport& r : reports) {
    report.places.insert(report.places.end(), r.places.begin(), r.places.end());
    report.gouge_max = std::max(report.gouge_max, r.gouge_max);
  }
}

}  // namespace burin::cycle
