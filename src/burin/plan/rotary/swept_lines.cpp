// SPDX-License-Identifier: Apache-2.0
// Lines at constant u. Every corner of the section takes a line on either side of it; between corners lines
// lie as far apart as the cusp allows under the twist that leaves the highest.
#include "burin/plan/rotary/swept_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/plan/rotary/cusp.h"

namespace burin::rotary::detail {
namespace {

/// A bend of the section by more than this is a corner, which has its own lines (radians): a ball of 10 mm
/// that stands on one side of a bend of 1 degree leaves 1.5 micrometres of the other.
constexpr double kCorner = 0.02;
/// Twists looked at; of more the extreme ones and evenly chosen others.
constexpr std::size_t kRates = 16;

std::vector<double> some_rates(const Sweep& sweep) {
  const std::vector<double>& all = sweep.rates();
  if (all.size() <= kRates) return all;
  std::vector<double> some;
  for (std::size_t i = 0; i < kRates; ++i) some.push_back(all[i * (all.size() - 1) / (kRates - 1)]);
  return some;
}

class LinePlanner {
 public:
  LinePlanner(const Sweep& sweep, const PatternOptions& options)
      : sweep_(sweep), options_(options), rates_(some_rates(sweep)) {}

  double cusp(double a, double b) const {
    double worst = 0;
    for (const double rate : rates_) worst = std::max(worst, cusp(a, b, rate));
    return worst;
  }
  /// Places from a corner at s0 to the next at s1, both included.
  bool places(double s0, double s1, std::vector<SectionPoint>& out, double& guess) const;

 private:
  double cusp(double a, double b, double rate) const;
  double longest_step(double s) const;
  CenterLine line(const SectionPoint& at, double rate, double reach) const {
    const double bend = rate * rate * (norm(at.c - geom::Point2{}) + options_.ball_radius);
    // Chords of the helix leave it by less than this part of the scallop.
    constexpr double kChord = 0.002;
    const double h = std::sqrt(8 * kChord * options_.scallop / (bend + 1e-9));
    const int half = int(std::clamp(std::ceil(reach / h), 8.0, 1000.0));
    std::vector<geom::Point3> points;
    for (int j = -half; j <= half; ++j) {
      const double x = reach * j / half;
      points.push_back(center_of(sweep_.lift(at, x, rate * x, rate), options_.ball_radius));
    }
    return {std::move(points), false};
  }

  const Sweep& sweep_;
  const PatternOptions& options_;
  std::vector<double> rates_;
};

double LinePlanner::cusp(double a, double b, double rate) const {
  const double gap = b - a;
  // A helix at the angle t to X: the nearest place on it lies gap sin t cos t further along X, at most half;
  // normals of the two lean along X by different amounts, by up to the turn over the gap.
  const double reach = gap * (1 + 2 * options_.ball_radius * std::abs(rate)) + 1e-6;
  const CenterLine line_a = line(sweep_.at_length(a, true), rate, reach),
                   line_b = line(sweep_.at_length(b, false), rate, reach);
  const auto height = [&](double f) {
    std::size_t hint_a = line_a.segments() / 2, hint_b = line_b.segments() / 2;
    const Contact q = sweep_.lift(sweep_.at_length(a + gap * f), 0, 0, rate);
    return std::min(line_a.entry(q.p, q.n, options_.ball_radius, hint_a),
                    line_b.entry(q.p, q.n, options_.ball_radius, hint_b));
  };
  // The peak stands where the two balls leave the same: a narrow tip, looked for more and more closely.
  constexpr int kProbes = 16, kCloser = 4;
  double worst = 0, peak = 0.5, reach_of_peak = 0.5;
  for (int round = 0; round < kCloser && worst < std::numeric_limits<double>::infinity(); ++round) {
    const double lo = std::max(0.0, peak - reach_of_peak), hi = std::min(1.0, peak + reach_of_peak);
    for (int k = 1; k < kProbes; ++k) {
      const double f = lo + (hi - lo) * k / kProbes, h = height(f);
      if (h <= worst) continue;
      worst = h;
      peak = f;
    }
    reach_of_peak = (hi - lo) / kProbes;
  }
  return worst;
}

/// Twice the step on a flat surface, by the angle at which lines cross the section. A ball that gouges would
/// seem to reach much further; what it is moved to does not.
double LinePlanner::longest_step(double s) const {
  const SectionPoint at = sweep_.at_length(s);
  const geom::Vec2 c = at.c - geom::Point2{};
  double least = std::numeric_limits<double>::infinity();
  for (const double rate : rates_) {
    const double q = rate * dot(at.t, c);
    least = std::min(least, std::sqrt((1 + rate * rate * norm2(c)) / (1 + q * q)));
  }
  return 2 * least * flat_step(options_.ball_radius, options_.scallop);
}

bool LinePlanner::places(double s0, double s1, std::vector<SectionPoint>& out, double& guess) const {
  out.push_back(sweep_.at_length(s0, true));
  for (double s = s0; s < s1;) {
    const double rest = s1 - s, most = std::min(rest, longest_step(s));
    const double step = options_.side_step ? std::min(*options_.side_step, rest)
                                           : step_for([&](double d) { return cusp(s, s + d); },
                                                      options_.scallop, std::min(guess, most), most);
    if (!(step > 0) || out.size() > options_.max_paths) return false;
    guess = step;
    s = step >= rest * (1 - 1e-9) ? s1 : s + step;
    out.push_back(sweep_.at_length(s, false));
  }
  return true;
}

/// Lengths at which the section has corners; without any, only its start.
std::vector<double> corners_of(const Sweep& sweep, bool& at_start) {
  std::vector<double> corners;
  at_start = false;
  for (std::size_t i = 0; i < sweep.pieces(); ++i) {
    const std::size_t before = (i + sweep.pieces() - 1) % sweep.pieces();
    const geom::Vec2 a = sweep.at(before, 1).t, b = sweep.at(i, 0).t;
    if (std::abs(std::atan2(cross(a, b), dot(a, b))) < kCorner) continue;
    corners.push_back(sweep.piece_start(i));
    at_start = at_start || i == 0;
  }
  return corners;
}

/// Steps of a line over a stretch of one twist: from the bend of its centre path.
std::size_t steps_along(const Sweep& sweep, const SectionPoint& at, double from, double to,
                        const PatternOptions& options) {
  const double rate = sweep.rate(0.5 * (from + to));
  const geom::Point3 c = center_of(sweep.lift(at, 0, 0, rate), options.ball_radius);
  // The centre runs on a helix of this radius.
  const double bend = rate * rate * std::hypot(c.y, c.z);
  const double n = std::ceil((to - from) * std::sqrt(bend / (8 * options.density_mm)));
  return n < 1e9 ? std::max<std::size_t>(1, std::size_t(n)) : std::size_t(1e9);
}

ContactPath line_path(const Sweep& sweep, const SectionPoint& at, const PatternOptions& options) {
  ContactPath path;
  const std::vector<Station>& st = sweep.swept().stations;
  for (std::size_t i = 1; i < st.size(); ++i) {
    const double rate = (st[i].turn - st[i - 1].turn) / (st[i].x - st[i - 1].x);
    const std::size_t n = steps_along(sweep, at, st[i - 1].x, st[i].x, options);
    for (std::size_t k = 0; k <= n; ++k) {
      const double f = double(k) / double(n);
      const double x = k == n ? st[i].x : st[i - 1].x + f * (st[i].x - st[i - 1].x);
      const Contact c = sweep.lift(at, x, rate);
      if (k > 0 || i == 1) {
        path.points.push_back(c);
        continue;
      }
      // A bend at a station: round a convex one the ball turns, in a concave one it has two contacts.
      const Contact last = path.points.back();
      if (angle_between(last.n, c.n) == 0) continue;
      const geom::Vec3 along =
          path.points.size() > 1 ? last.p - path.points[path.points.size() - 2].p : geom::Vec3{1, 0, 0};
      if (dot(c.n - last.n, along) > 0) {
        append_fan(path.points, c, options.ball_radius, options.density_mm);
      } else {
        path.points.push_back(c);
      }
    }
  }
  return path;
}

double points_on(const Sweep& sweep, const SectionPoint& at, const PatternOptions& options) {
  double n = 1;
  const std::vector<Station>& st = sweep.swept().stations;
  const double fan = std::ceil(geom::kPi / std::sqrt(8 * options.density_mm / options.ball_radius));
  for (std::size_t i = 1; i < st.size(); ++i)
    n += double(steps_along(sweep, at, st[i - 1].x, st[i].x, options));
  return n + fan * double(st.size() - 2);
}

}  // namespace

Result<PatternResult> swept_lines(const Sweep& sweep, const PatternOptions& options) {
  const LinePlanner planner(sweep, options);
  const double flat = flat_step(options.ball_radius, options.scallop);
  // Where the section is not hollow no cusp lets lines lie further apart than on a flat surface (twice, for
  // what a twist may change).
  double convex = 0;
  for (std::size_t i = 0; i < sweep.pieces(); ++i) {
    if (sweep.at(i, 0).curvature >= 0) convex += sweep.piece_length(i);
  }
  const double fewest = options.side_step ? sweep.length() / *options.side_step : convex / (2 * flat);
  if (fewest > double(options.max_paths)) return too_many(options, 2 * fewest, 2);
  bool at_start = false;
  std::vector<double> corners = corners_of(sweep, at_start);
  std::vector<SectionPoint> places;
  double guess = options.side_step ? *options.side_step : flat;
  PatternResult result;
  std::vector<double> ends = corners;
  if (!at_start) ends.insert(ends.begin(), 0.0);
  ends.push_back(sweep.length());
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const std::size_t first = places.size();
    if (!planner.places(ends[i], ends[i + 1], places, guess)) {
      const double done = places.back().s - 0;
      return too_many(options, done > 0 ? double(places.size()) * sweep.length() / done : 1e18, 2);
    }
    for (std::size_t k = first + 1; k < places.size(); ++k) {
      const double gap = places[k].s - places[k - 1].s;
      result.side_step_min = result.side_step_min > 0 ? std::min(result.side_step_min, gap) : gap;
      result.side_step_max = std::max(result.side_step_max, gap);
      result.scallop_max = std::max(result.scallop_max, planner.cusp(places[k - 1].s, places[k].s));
    }
  }
  if (!at_start) places.pop_back();  // the first one again
  double points = 0;
  for (const SectionPoint& p : places) points += points_on(sweep, p, options);
  const bool twisted = sweep.rates().front() != 0 || sweep.rates().back() != 0;
  const double longest = std::numeric_limits<double>::infinity();
  if (twisted) {
    points += 2.0 * double(count_ring_nodes(sweep, options.ball_radius, options.density_mm, longest,
                                            options.max_points));
  }
  if (places.size() + 2 > options.max_paths || points > double(options.max_points)) {
    return too_many(options, double(places.size()), points / double(places.size()));
  }
  // Where lines meet the end of the part at a slant, the ball of one is past it before it is next to its
  // neighbour's: a ring takes what they leave.
  std::vector<RingNode> nodes;
  if (twisted) nodes = ring_nodes(sweep, options.ball_radius, options.density_mm, longest);
  if (twisted) result.paths.push_back(ring_path(sweep, nodes, sweep.x_min()));
  for (std::size_t i = 0; i < places.size(); ++i) {
    ContactPath path = line_path(sweep, places[i], options);
    if (i % 2 == 1) std::reverse(path.points.begin(), path.points.end());
    result.paths.push_back(std::move(path));
  }
  if (twisted) result.paths.push_back(ring_path(sweep, nodes, sweep.x_max()));
  return result;
}

}  // namespace burin::rotary::detail
