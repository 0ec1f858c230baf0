// SPDX-License-Identifier: Apache-2.0
#include "burin/servo/run_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "burin/base/text.h"

namespace burin::servo {
namespace {

/// What is aimed at, of the limits: the rest is for chords that are shorter than their arcs.
constexpr double kAim = 0.999;
constexpr int kRounds = 12;      ///< of lowering where a limit was passed, then the whole run is slowed
constexpr int kSlowRounds = 80;  ///< of that
constexpr int kMissRounds = 8;   ///< of it while only the end is missed
constexpr int kSettle = 12;      ///< rounds to meet the end
/// An arc between two setpoints this much longer than its chord is more than a bend of 2 rad.
constexpr double kSkip = 1.4;
/// The end missed by less than the first share of the shortest step is taken at once; by more only when
/// slowing at the bends that were jumped over (kSkipRounds of it) did not help, and only when the path was
/// not used up long before the profile.
constexpr double kMissed = 1e-3, kEarly = 0.1;
constexpr int kSkipRounds = 6;
/// Turn of a chord, rad, that the first guess of the chords' length reckons with: the largest curvature of a
/// cell says nothing about the whole of it where it is the tip of a cusp.
constexpr double kMostTurn = 1;
/// Share of the acceleration and jerk that stays for changes of feed where the path is curved; both others
/// are tried.
constexpr double kReserve = 0.3;
constexpr double kOtherReserves[] = {0.15, 0.5};
constexpr double kTauFactors[] = {1, 0.62, 0.38, 0.24};

}  // namespace

RunPlanner::RunPlanner(const Track& track, const TrackRun& run, const Limits& limits)
    : track_(track), run_(run), limits_(limits), aim_(limits) {
  aim_.accel_mm_s2 *= kAim;
  aim_.jerk_mm_s3 *= kAim;
  double largest = 0;
  for (std::size_t i = run.first; i < run.end; ++i)
    for (int k = 0; k < 3; ++k)
      largest = std::max({largest, std::abs(track.pieces[i].c[k][0]), std::abs(track.pieces[i].end[k])});
  rounding_ = largest * std::numeric_limits<double>::epsilon();
}

std::vector<LimitSpan> RunPlanner::spans(double tau, double reserve) const {
  std::vector<LimitSpan> out;
  out.reserve(cells_.size());
  for (const Cell& cell : cells_) {
    const CellLimit limit = cell_limit(cell, aim_, tau, reserve);
    out.push_back({cell.s0, cell.s1, limit.v, limit.a});
  }
  return out;
}

/// The smoothing time that is fastest: sqrt(V / J) is optimal for a change of feed by V, (S / 2J)^(1/3) for
/// rest to rest over S; a path of many small changes is faster with less.
void RunPlanner::choose() {
  double steepest = 1e-3, fastest = 0;
  bool curved = false, jumps = false;
  const double guess = 3 * aim_.period_s;
  for (const Cell& c : cells_) {
    steepest = std::max({steepest, c.d1[0], c.d1[1], c.d1[2]});
    fastest = std::max(fastest, cell_limit(c, aim_, guess, kReserve).v);
    curved = curved || c.curvature > 0 || cells_.size() > 1;
    jumps = jumps || c.length == 0;
  }
  const double jerk = aim_.jerk_mm_s3 / steepest;
  const double best = std::min(
      {std::sqrt(fastest / jerk), std::cbrt(total_ / (2 * jerk)), aim_.accel_mm_s2 / aim_.jerk_mm_s3});
  tau_ = best;
  reserve_ = kReserve;
  if (!curved) return;
  const double least = jumps ? std::min(best, guess) : 0;
  double shortest = std::numeric_limits<double>::infinity();
  const auto attempt = [&](double tau, double reserve) {
    const std::vector<RawKnot> raw = raw_profile(spans(tau, reserve), total_, tau);
    const double time = raw.empty() ? 0 : raw.back().t + tau;
    if (!(time < shortest)) return;
    shortest = time;
    tau_ = tau;
    reserve_ = reserve;
  };
  for (const double factor : kTauFactors) attempt(std::max(best * factor, least), kReserve);
  const double tau = tau_;
  for (const double reserve : kOtherReserves) attempt(tau, reserve);
}

Result<void> RunPlanner::make() {
  const std::vector<RawKnot> raw = raw_profile(spans(tau_, reserve_), total_, tau_);
  profile_ = smooth_profile(raw, total_, tau_);
  if (stretch_ > 1) {
    const double f = 1 / stretch_;
    for (ProfilePiece& p : profile_) {
      p.time *= stretch_;
      p.v *= f;
      p.a *= f * f;
      p.j *= f * f * f;
    }
  }
  const double periods = profile_.back().time / limits_.period_s;
  if (!(periods <= static_cast<double>(kMaxSetpoints)))
    return Error{ErrorCode::range,
                 "the motion takes " + format_fixed(profile_.back().time, 0) + " s (at most " +
                     std::to_string(kMaxSetpoints) + " periods: a higher feed, or a longer period)",
                 {}};
  count_ticks();
  return {};
}

void RunPlanner::count_ticks() {
  const double periods = profile_.back().time / limits_.period_s;
  ticks_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(periods * (1 - 1e-12))));
}

/// Shortest step that the profile plans: that of a steady part, or the slowest step at which no path can pass
/// a limit.
double RunPlanner::shortest_step() const {
  double v = safe_speed(limits_);
  for (const ProfilePiece& p : profile_)
    if (p.a == 0 && p.j == 0 && p.v > 0) v = std::min(v, p.v);
  return v * limits_.period_s;
}

double RunPlanner::key(const Cursor& at) const {
  const Piece& piece = track_.pieces[at.piece];
  return piece.start + at.x * piece.length;
}

double RunPlanner::deviation(const double (&a)[3], const double (&b)[3], std::size_t piece, double x) const {
  double ab[3], am[3], ab2 = 0, dot = 0;
  for (int k = 0; k < 3; ++k) {
    ab[k] = b[k] - a[k];
    am[k] = horner(track_.pieces[piece].c[k], x) - a[k];
    ab2 += ab[k] * ab[k];
    dot += ab[k] * am[k];
  }
  const double share = ab2 > 0 ? std::clamp(dot / ab2, 0.0, 1.0) : 0;
  double d2 = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = am[k] - share * ab[k];
    d2 += d * d;
  }
  return std::sqrt(d2);
}

/// Largest distance of the path from the chord between two setpoints, relative to the limit: at the middle of
/// each part and at up to kNodes nodes, and where that is near the limit at many more.
double RunPlanner::chord_ratio(const Cursor& before, const Cursor& now) const {
  constexpr std::size_t kNodes = 8;
  double worst = 0;
  if (before.piece == now.piece) {
    worst = deviation(before.p, now.p, now.piece, 0.5 * (before.x + now.x));
  } else {
    const std::size_t between = now.piece - before.piece, step = std::max<std::size_t>(1, between / kNodes);
    for (std::size_t i = before.piece; i < now.piece; i += step)
      worst = std::max(worst, deviation(before.p, now.p, i, 1));
    worst = std::max({worst, deviation(before.p, now.p, before.piece, 0.5 * (before.x + 1)),
                      deviation(before.p, now.p, now.piece, 0.5 * now.x)});
  }
  constexpr double kNear = 0.7;
  constexpr int kSamples = 8;
  if (worst > kNear * limits_.chord_error_mm) {
    for (std::size_t i = before.piece; i <= now.piece; ++i) {
      const double x0 = i == before.piece ? before.x : 0, x1 = i == now.piece ? now.x : 1;
      for (int k = 1; k <= kSamples; ++k)
        worst = std::max(worst, deviation(before.p, now.p, i, x0 + (x1 - x0) * k / kSamples));
    }
  }
  return worst / (limits_.chord_error_mm + rounding_);
}

void RunPlanner::mark(double key0, double key1, double ratio) {
  auto cell = std::lower_bound(cells_.begin(), cells_.end(), key0,
                               [](const Cell& c, double k) { return c.key1 < k; });
  for (; cell != cells_.end() && cell->key0 <= key1; ++cell) cell->hit = std::max(cell->hit, ratio);
}

/// The tick over the whole run: what is left at its end, limits in the setpoints, and (measure_chords) the
/// chords travelled up to each cell.
RunPlanner::Passage RunPlanner::walk(bool measure_chords) {
  Passage found;
  const Piece* pieces = track_.pieces.data();
  const Piece& last = pieces[run_.end - 1];
  const double t = limits_.period_s;
  const double accel = 1 / (limits_.accel_mm_s2 * t * t + 4 * rounding_);
  const double jerk = 1 / (limits_.jerk_mm_s3 * t * t * t + 8 * rounding_);
  constexpr double kSpeedRounding = 1e-6;  // of the profile, when it is fitted to the chords
  const double speed = 1 / (limits_.axis_velocity_mm_s * t * (1 + kSpeedRounding) + 2 * rounding_);
  Cursor at = start_of(pieces[run_.first], run_.first);
  const Cursor goal{run_.end - 1, 1, {last.end[0], last.end[1], last.end[2]}};
  Cursor old[3] = {at, at, at};
  double travelled = 0, keys[4] = {0, 0, 0, 0};
  std::size_t hint = 0, cell = 0;
  for (Cell& c : cells_) c.hit = 0;
  for (std::int64_t tick = 1; tick <= ticks_ + 2; ++tick) {
    if (tick <= ticks_) {
      const double s = tick == ticks_
                           ? total_
                           : look_up(profile_.data(), profile_.size(), hint, static_cast<double>(tick) * t).s;
      const double covered = advance(pieces, run_.end, at, s - travelled);
      const bool ended = at.piece + 1 == run_.end && at.x >= 1;
      if (ended) found.left_over -= s - travelled - covered;
      if (tick == ticks_) {
        if (!ended) found.left_over += run_.length - key(at);
        at = goal;
      }
      const double next = key(at);
      // A bend smaller than the chord is jumped over: slower there, or the chords do not add up steadily.
      if (next - keys[0] > kSkip * covered + rounding_) mark(keys[0], next, kSkip);
      if (measure_chords) {
        const double end = tick == ticks_ ? total_ + found.left_over : s;
        for (; cell < cells_.size() && cells_[cell].key1 <= next; ++cell) {
          const double share =
              next > keys[0] ? std::clamp((cells_[cell].key1 - keys[0]) / (next - keys[0]), 0.0, 1.0) : 1;
          cells_[cell].s1 = travelled + share * (end - travelled);
        }
      }
      travelled = s;
    }
    double ratio = chord_ratio(old[0], at);
    for (int k = 0; k < 3; ++k) {
      const double first = at.p[k] - old[0].p[k];
      const double second = at.p[k] - 2 * old[0].p[k] + old[1].p[k];
      const double third = at.p[k] - 3 * (old[0].p[k] - old[1].p[k]) - old[2].p[k];
      ratio = std::max({ratio, std::abs(first) * speed, std::abs(second) * accel, std::abs(third) * jerk});
    }
    found.worst = std::max(found.worst, ratio);
    keys[3] = keys[2];
    keys[2] = keys[1];
    keys[1] = keys[0];
    keys[0] = key(at);
    if (ratio > 1) mark(keys[3], keys[0], ratio);
    old[2] = old[1];
    old[1] = old[0];
    old[0] = at;
  }
  return found;
}

/// The profile longer by `step` mm (shorter: negative). The last steady part takes it, so that every setpoint
/// before stays; where that is too short, the whole profile: slower, or for more length in more time, so that
/// speed, acceleration and jerk never grow.
void RunPlanner::lengthen(double step) {
  constexpr double kMostTaken = 0.5;  // of a steady part
  const double scale = (total_ + step) / total_;
  total_ += step;
  for (std::size_t i = profile_.size() - 1; i-- > 0;) {
    const ProfilePiece& steady = profile_[i];
    if (steady.a != 0 || steady.j != 0 || !(steady.v > 0)) continue;
    if (-step > kMostTaken * (profile_[i + 1].s - steady.s)) continue;
    const double wait = step / steady.v;
    for (std::size_t k = i + 1; k < profile_.size(); ++k) {
      profile_[k].time += wait;
      profile_[k].s += step;
    }
    profile_.back().s = total_;
    return count_ticks();
  }
  const double time = std::max(scale, 1.0), speed = std::min(scale, 1.0);
  for (ProfilePiece& p : profile_) {
    p.s *= scale;
    p.time *= time;
    p.v *= speed;
    p.a *= speed / time;
    p.j *= speed / (time * time);
  }
  profile_.back().s = total_;
  count_ticks();
}

/// Fits the profile's length to the chords, so that the last tick meets the end.
Result<RunPlanner::Passage> RunPlanner::settle() {
  const double t = limits_.period_s;
  // What the last step adds must not show in the jerk, and the end is met to 1e-8 mm.
  const double target = std::max(std::min(1e-4 * limits_.jerk_mm_s3 * t * t * t, 1e-9), 4 * rounding_);
  // Above this, relative, the chords up to each cell are measured again and the run is planned again. Where
  // bends are smaller than a chord that may go to and fro, as every profile jumps over others of them: after
  // kMeasure rounds only the profile's length is changed.
  constexpr double kRemap = 1e-7;
  constexpr int kMeasure = kSettle / 3;
  Passage passage;
  double total_before = 0, left_before = 0;
  for (int i = 0; i < kSettle; ++i) {
    const bool last = i + 1 == kSettle;
    passage = walk(!last);
    const double left = passage.left_over;
    if (std::abs(left) <= target || last) break;
    if (i < kMeasure && std::abs(left) > kRemap * total_) {
      for (std::size_t c = 1; c < cells_.size(); ++c) cells_[c].s0 = cells_[c - 1].s1;
      cells_.back().s1 = total_ = total_ + left;
      if (auto made = make(); !made) return made.error();
      total_before = 0;
    } else {
      // Secant: where the curvature changes within a chord, the end moves by more or less than the length.
      constexpr double kFlattest = -0.2;
      const double slope = total_before > 0 ? (left - left_before) / (total_ - total_before) : -1;
      total_before = total_;
      left_before = left;
      lengthen(slope < kFlattest ? -left / slope : left);
    }
  }
  return passage;
}

bool RunPlanner::acceptable(const Passage& passage, double missed, bool both_ways) const {
  const double room = missed * shortest_step() + 4 * rounding_;
  return passage.worst <= 1 && passage.left_over >= -room && (!both_ways || passage.left_over <= room);
}

void RunPlanner::lower() {
  for (Cell& c : cells_) {
    if (!(c.hit > 1)) continue;
    c.slow *= std::max(0.5, 0.98 * std::pow(c.hit, -0.4));
    c.soft *= std::max(0.5, 0.97 / c.hit);
  }
}

Result<void> RunPlanner::plan() {
  cells_ = make_cells(track_, run_, aim_);
  double s = 0;
  for (Cell& c : cells_) {
    const double chord = cell_limit(c, aim_, 3 * aim_.period_s, kReserve).v * aim_.period_s;
    const double turn = std::min(chord * c.curvature, kMostTurn);
    c.s0 = s;
    c.s1 = s += c.length / (1 + turn * turn / 24);
  }
  total_ = s;
  choose();
  for (int round = 0; round < kRounds; ++round) {
    if (auto made = make(); !made) return made;
    const auto passage = settle();
    if (!passage) return passage.error();
    if (acceptable(*passage, round < kSkipRounds ? kMissed : kEarly, round < kSkipRounds)) return {};
    lower();
  }
  return slow_down(1.02);
}

Error limits_too_low() {
  return Error{ErrorCode::geometry,
               "the limits cannot be kept: at this period they are below the rounding of the coordinates (a "
               "longer period, or higher limits)",
               {}};
}

Result<void> RunPlanner::slow_down(double factor) {
  for (int round = 0; round < kSlowRounds; ++round) {
    stretch_ *= factor;
    if (auto made = make(); !made) return made;
    const auto passage = settle();
    if (!passage) return passage.error();
    // Slower is no better where only the end is missed: the tool waits there for the rest of the profile, or
    // the last step is longer, and the setpoints keep the limits either way.
    if (acceptable(*passage, kEarly, false) || (round >= kMissRounds && passage->worst <= 1)) return {};
    factor = std::clamp(std::sqrt(passage->worst), 1.02, 1.5);
  }
  return limits_too_low();
}

}  // namespace burin::servo
