// SPDX-License-Identifier: Apache-2.0
#include "burin/servo/measure.h"

#include <algorithm>
#include <cmath>

namespace burin::servo {
namespace {

using Position = std::array<double, 3>;

Position position(const Setpoint& s) {
  return {s.x, s.y, s.z};
}

/// Distance of m from the segment a b.
double distance(const Position& m, const Position& a, const Position& b) {
  double ab2 = 0, dot = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    ab2 += (b[k] - a[k]) * (b[k] - a[k]);
    dot += (b[k] - a[k]) * (m[k] - a[k]);
  }
  const double share = ab2 > 0 ? std::clamp(dot / ab2, 0.0, 1.0) : 0;
  double d2 = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double d = m[k] - a[k] - share * (b[k] - a[k]);
    d2 += d * d;
  }
  return std::sqrt(d2);
}

/// Largest distance of the path between two places from the segment a b.
double deviation(const Plan& plan, const Cursor& from, const Cursor& to, const Position& a,
                 const Position& b) {
  constexpr int kSamples = 8;  // of each piece; the largest deviation of an arc is at the middle one
  double worst = 0;
  for (std::size_t i = from.piece; i <= to.piece && i < plan.pieces.size(); ++i) {
    const double x0 = i == from.piece ? from.x : 0, x1 = i == to.piece ? to.x : 1;
    for (int k = 0; k <= kSamples; ++k) {
      const double x = x0 + (x1 - x0) * k / kSamples;
      const auto& c = plan.pieces[i].c;
      worst = std::max(worst, distance({horner(c[0], x), horner(c[1], x), horner(c[2], x)}, a, b));
    }
  }
  return worst;
}

void measure_differences(const std::vector<Setpoint>& setpoints, double period, Quality& q) {
  // At rest before the first and after the last.
  const auto at = [&setpoints](std::ptrdiff_t i) {
    const auto last = static_cast<std::ptrdiff_t>(setpoints.size()) - 1;
    return position(setpoints[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, last))]);
  };
  for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(setpoints.size()) + 2; ++i) {
    const Position a = at(i - 3), b = at(i - 2), c = at(i - 1), d = at(i);
    for (std::size_t k = 0; k < 3; ++k) {
      const double second = (d[k] - c[k]) - (c[k] - b[k]);
      const double third = second - ((c[k] - b[k]) - (b[k] - a[k]));
      q.accel_max_mm_s2 = std::max(q.accel_max_mm_s2, std::abs(second) / (period * period));
      q.jerk_max_mm_s3 = std::max(q.jerk_max_mm_s3, std::abs(third) / (period * period * period));
    }
  }
}

/// The steady speed planned from setpoint i - 1 to i; 0 where it is not steady.
class SteadySpeed {
 public:
  explicit SteadySpeed(const Plan& plan) : plan_(plan) {}
  double into(std::int64_t tick) {
    while (run_ < plan_.runs.size() && plan_.runs[run_].end_tick < tick) ++run_, piece_ = 0;
    if (run_ >= plan_.runs.size()) return 0;
    const Plan::Run& run = plan_.runs[run_];
    if (tick == run.end_tick) return 0;
    piece_ = std::max(piece_, run.first_profile);
    const double t = plan_.limits.period_s * static_cast<double>(tick - run.first_tick);
    look_up(plan_.profile.data(), run.end_profile, piece_, t - plan_.limits.period_s);
    const std::size_t before = piece_;
    look_up(plan_.profile.data(), run.end_profile, piece_, t);
    const ProfilePiece& p = plan_.profile[piece_];
    return before == piece_ && p.a == 0 && p.j == 0 ? p.v : 0;
  }

 private:
  const Plan& plan_;
  std::size_t run_ = 0, piece_ = 0;
};

}  // namespace

std::vector<Setpoint> run(const Plan& plan) {
  std::vector<Setpoint> out(plan.setpoints);
  Interpolator interpolator(plan);
  for (Setpoint& s : out) interpolator.tick(s);
  return out;
}

Quality measure(const Plan& plan, const std::vector<Setpoint>& setpoints) {
  Quality q;
  q.setpoints = setpoints.size();
  if (setpoints.empty()) return q;
  const double period = plan.limits.period_s;
  measure_differences(setpoints, period, q);
  Interpolator interpolator(plan);
  SteadySpeed steady(plan);
  Setpoint unused;
  interpolator.tick(unused);
  Cursor before = interpolator.place();
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 1; i < std::min(setpoints.size(), plan.setpoints); ++i) {
    interpolator.tick(unused);
    const Position a = position(setpoints[i - 1]), b = position(setpoints[i]);
    q.chord_error_max_mm =
        std::max(q.chord_error_max_mm, deviation(plan, before, interpolator.place(), a, b));
    before = interpolator.place();
    const double planned = steady.into(static_cast<std::int64_t>(i));
    if (!(planned > 0)) continue;
    const double chord = std::sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]) +
                                   (b[2] - a[2]) * (b[2] - a[2]));
    const double fluctuation = std::abs(chord / period - planned) / planned;
    q.feed_fluctuation_max = std::max(q.feed_fluctuation_max, fluctuation);
    squares += fluctuation * fluctuation;
    ++count;
  }
  if (count > 0) q.feed_fluctuation_rms = std::sqrt(squares / static_cast<double>(count));
  return q;
}

}  // namespace burin::servo
