// SPDX-License-Identifier: Apache-2.0
// Rings and the spiral on a swept section. All rings of a stretch of one twist are the same ring, turned and
// moved: the step is found once for each twist that occurs.
#include <algorithm>
#include <cmath>
#include <map>

#include "burin/plan/rotary/cusp.h"
#include "burin/plan/rotary/patterns.h"
#include "burin/plan/rotary/sweep.h"
#include "burin/plan/rotary/swept_lines.h"

namespace burin::rotary::detail {
namespace {

/// How densely a ring is looked at for cusps, in parts of the ball's radius, and at most.
constexpr double kCuspLongest = 1.0 / 12;
constexpr std::size_t kCuspNodes = 3000;

class RingPlanner {
 public:
  RingPlanner(const Sweep& sweep, const PatternOptions& options) : sweep_(sweep), options_(options) {
    const double r = options.ball_radius;
    const double longest = std::max(kCuspLongest * r, sweep.length() / double(kCuspNodes));
    nodes_ = ring_nodes(sweep, r, 2e-3 * r, longest);
    for (const RingNode& node : nodes_) {
      radius_ = std::max(radius_, norm(node.a.c - geom::Point2{}));
    }
  }

  /// Fewer rings than this are impossible: the cusp of a cylinder, with no turns counted.
  double fewest() const {
    const double gap =
        options_.side_step ? *options_.side_step : 2 * flat_step(options_.ball_radius, options_.scallop);
    return (sweep_.x_max() - sweep_.x_min()) / gap;
  }
  /// The places of the rings; empty when there are too many (`wanted` says how many).
  std::vector<double> places(double& wanted);
  double cusp(double a, double b) const {
    return ring_cusp([&](std::size_t i, double x) { return on_part(i, x); }, nodes_.size(), a, b,
                     options_.ball_radius);
  }

 private:
  Contact on_part(std::size_t i, double x) const {
    return lift(sweep_, nodes_[i], x, sweep_.swept().turn_at(x), sweep_.rate(x));
  }
  double helix_cusp(double rate, double step) const {
    return ring_cusp([&](std::size_t i, double x) { return lift(sweep_, nodes_[i], x, rate * x, rate); },
                     nodes_.size(), -0.5 * step, 0.5 * step, options_.ball_radius);
  }
  double step_at(double rate) {
    const auto found = steps_.find(rate);
    if (found != steps_.end()) return found->second;
    const double slant = std::sqrt(1 + rate * rate * radius_ * radius_);
    const double step =
        options_.side_step
            ? *options_.side_step / widest(rate)
            : step_for([&](double s) { return helix_cusp(rate, s); }, options_.scallop,
                       flat_step(options_.ball_radius, options_.scallop) / slant, 4 * options_.ball_radius);
    steps_.emplace(rate, step);
    return step;
  }
  /// mm on the surface, across rings, for 1 mm of X.
  double widest(double rate) const {
    double most = 1;
    for (const RingNode& node : nodes_) {
      const double q = rate * dot(node.a.t, node.a.c - geom::Point2{});
      most = std::max(most, std::sqrt(1 + q * q));
      // Along a corner the rings lie as far apart as its helix is long.
      if (node.f > 0) most = std::max(most, std::sqrt(1 + rate * rate * norm2(node.a.c - geom::Point2{})));
    }
    return most;
  }
  double end_of_stretch(double x) const {
    for (const Station& s : sweep_.swept().stations) {
      if (s.x > x) return s.x;
    }
    return sweep_.x_max();
  }
  double next_place(double x);

  const Sweep& sweep_;
  const PatternOptions& options_;
  std::vector<RingNode> nodes_;
  double radius_ = 0;
  std::map<double, double> steps_;  ///< by twist
};

double RingPlanner::next_place(double x) {
  const double step = step_at(sweep_.rate(x));
  const double end = end_of_stretch(x);
  if (x + step <= end) return x + step;
  // Across a station: the least step of the stretches that it may touch is a good guess.
  double guess = step;
  for (double at = end; at < x + guess && at < sweep_.x_max(); at = end_of_stretch(at)) {
    guess = std::min(guess, step_at(sweep_.rate(at)));
  }
  if (options_.side_step) return x + guess;
  const double longest = sweep_.x_max() - x;
  return x + step_for([&](double s) { return cusp(x, x + s); }, options_.scallop, std::min(guess, longest),
                      longest);
}

std::vector<double> RingPlanner::places(double& wanted) {
  const double x0 = sweep_.x_min(), x1 = sweep_.x_max(), length = x1 - x0;
  wanted = fewest();
  if (wanted > double(options_.max_paths)) return {};
  if (sweep_.swept().uniform()) {
    const double step = step_at((sweep_.swept().turn_at(x1) - sweep_.swept().turn_at(x0)) / length);
    wanted = step > 0 ? std::max(1.0, std::ceil(length / step * (1 - 1e-12))) + 1
                      : std::numeric_limits<double>::infinity();
    if (!(wanted <= double(options_.max_paths))) return {};
    std::vector<double> xs;
    const std::size_t n = std::size_t(wanted) - 1;
    for (std::size_t i = 0; i <= n; ++i) xs.push_back(i == n ? x1 : x0 + length * (double(i) / double(n)));
    return xs;
  }
  std::vector<double> xs{x0};
  while (xs.back() < x1) {
    const double next = next_place(xs.back());
    const bool stuck = !(next > xs.back());
    if (stuck || xs.size() >= options_.max_paths) {
      wanted =
          stuck ? std::numeric_limits<double>::infinity() : double(xs.size()) * length / (xs.back() - x0);
      return {};
    }
    // A last gap of next to nothing is rounding.
    xs.push_back(next > x1 - 1e-9 * length ? x1 : next);
  }
  wanted = double(xs.size());
  return xs;
}

void append(std::vector<Contact>& points, const Contact& c) {
  if (!points.empty() && points.back().p == c.p && points.back().n == c.n) return;
  points.push_back(c);
}

Contact ring_contact(const Sweep& sweep, const RingNode& node, double x) {
  // On a station the twist jumps: the mean of both sides.
  const double rate = 0.5 * (sweep.rate(x, false) + sweep.rate(x, true));
  return lift(sweep, node, x, sweep.swept().turn_at(x), rate);
}

}  // namespace

ContactPath ring_path(const Sweep& sweep, const std::vector<RingNode>& nodes, double x) {
  ContactPath path;
  path.closed = true;
  path.points.reserve(nodes.size());
  for (const RingNode& node : nodes) path.points.push_back(ring_contact(sweep, node, x));
  return path;
}

namespace {

ContactPath spiral_path(const Sweep& sweep, const std::vector<RingNode>& nodes,
                        const std::vector<double>& xs) {
  ContactPath path;
  const std::size_t turns = xs.size() - 1;
  path.points.reserve(nodes.size() * (turns + 2) + 1);
  for (const RingNode& node : nodes) append(path.points, ring_contact(sweep, node, xs.front()));
  for (std::size_t turn = 0; turn < turns; ++turn) {
    for (const RingNode& node : nodes) {
      const double u = node.a.s / sweep.length();
      append(path.points, ring_contact(sweep, node, xs[turn] + u * (xs[turn + 1] - xs[turn])));
    }
  }
  for (const RingNode& node : nodes) append(path.points, ring_contact(sweep, node, xs.back()));
  append(path.points, ring_contact(sweep, nodes.front(), xs.back()));
  return path;
}

/// Places at equal steps, none larger than the least given one.
std::vector<double> evened(const std::vector<double>& xs) {
  double least = xs.back() - xs.front();
  // The last gap is what remains.
  for (std::size_t i = 1; i + 1 < xs.size(); ++i) least = std::min(least, xs[i] - xs[i - 1]);
  const double length = xs.back() - xs.front();
  const std::size_t n = std::size_t(std::max(1.0, std::ceil(length / least * (1 - 1e-12))));
  std::vector<double> even;
  for (std::size_t i = 0; i <= n; ++i)
    even.push_back(i == n ? xs.back() : xs.front() + length * (double(i) / double(n)));
  return even;
}

void measure(const RingPlanner& planner, const Sweep& sweep, const std::vector<double>& xs,
             PatternResult& result) {
  result.side_step_min = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < xs.size(); ++i) {
    result.side_step_min = std::min(result.side_step_min, xs[i] - xs[i - 1]);
    result.side_step_max = std::max(result.side_step_max, xs[i] - xs[i - 1]);
    // Equal gaps of one twist leave equal cusps.
    if (i == 1 || !sweep.swept().uniform()) {
      result.scallop_max = std::max(result.scallop_max, planner.cusp(xs[i - 1], xs[i]));
    }
  }
}

}  // namespace

Result<PatternResult> swept_paths(const SweptSection& swept, const PatternOptions& options) {
  const Sweep sweep(swept);
  if (options.pattern == Pattern::lines) return swept_lines(sweep, options);
  // So far apart that nothing else bounds the spacing of points.
  const double longest = std::numeric_limits<double>::infinity();
  RingPlanner planner(sweep, options);
  const std::size_t a_ring =
      count_ring_nodes(sweep, options.ball_radius, options.density_mm, longest, options.max_points);
  double wanted = 0;
  std::vector<double> xs = planner.places(wanted);
  if (xs.empty() || double(xs.size() + 2) * double(a_ring) > double(options.max_points)) {
    return too_many(options, wanted, double(a_ring));
  }
  if (options.pattern == Pattern::spiral) {
    xs = evened(xs);
    if (double(xs.size() + 2) * double(a_ring) > double(options.max_points)) {
      return too_many(options, double(xs.size()), double(a_ring));
    }
  }
  const std::vector<RingNode> nodes = ring_nodes(sweep, options.ball_radius, options.density_mm, longest);
  PatternResult result;
  measure(planner, sweep, xs, result);
  if (options.pattern == Pattern::spiral) {
    result.paths.push_back(spiral_path(sweep, nodes, xs));
  } else {
    for (const double x : xs) result.paths.push_back(ring_path(sweep, nodes, x));
  }
  return result;
}

}  // namespace burin::rotary::detail
