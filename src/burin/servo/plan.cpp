// SPDX-License-Identifier: Apache-2.0
#include "burin/servo/plan.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <string>
#include <utility>

#include "burin/base/text.h"
#include "burin/servo/interpolator.h"
#include "burin/servo/run_planner.h"
#include "burin/servo/track.h"

namespace burin::servo {
namespace {

Result<void> check(const Limits& l) {
  const struct {
    const char* name;
    double value;
  } all[] = {{"period", l.period_s}, {"chord error", l.chord_error_mm},       {"acceleration", l.accel_mm_s2},
             {"jerk", l.jerk_mm_s3}, {"axis velocity", l.axis_velocity_mm_s}, {"rapid feed", l.rapid_mm_min}};
  for (const auto& limit : all) {
    constexpr double kLeast = 1e-9, kMost = 1e12;
    if (!(limit.value >= kLeast && limit.value <= kMost))
      return Error{ErrorCode::usage,
                   std::string("a ") + limit.name + " of " + format_shortest(limit.value) +
                       " is not possible (above 0, from 1e-9 to 1e12)",
                   {}};
  }
  return {};
}

/// Profiles of the runs, one after the other. Pieces are in place already.
Result<void> assemble(Plan& plan, const Track& track, const std::vector<RunPlanner>& planners) {
  plan.runs.clear();
  plan.profile.clear();
  std::int64_t tick = 0;
  for (std::size_t i = 0; i < planners.size(); ++i) {
    Plan::Run run;
    run.first_piece = track.runs[i].first;
    run.end_piece = track.runs[i].end;
    run.first_profile = plan.profile.size();
    plan.profile.insert(plan.profile.end(), planners[i].profile().begin(), planners[i].profile().end());
    run.end_profile = plan.profile.size();
    run.first_tick = tick;
    run.end_tick = tick += planners[i].ticks();
    run.length = planners[i].length();
    plan.runs.push_back(run);
    if (tick > kMaxSetpoints)
      return Error{ErrorCode::range,
                   "the motion takes more than " + std::to_string(kMaxSetpoints) +
                       " periods (a higher feed, or a longer period)",
                   {}};
  }
  plan.setpoints = static_cast<std::size_t>(tick) + 1;
  plan.duration_s = static_cast<double>(tick) * plan.limits.period_s;
  return {};
}

/// The tick over the whole plan. Runs (index and ratio) whose setpoints pass a limit: only where two runs
/// meet, as each was looked at alone before.
std::vector<std::pair<std::size_t, double>> offenders(const Plan& plan, double rounding) {
  std::vector<std::pair<std::size_t, double>> found;
  const double t = plan.limits.period_s;
  const double accel = plan.limits.accel_mm_s2 * t * t + 4 * rounding;
  const double jerk = plan.limits.jerk_mm_s3 * t * t * t + 8 * rounding;
  Interpolator interpolator(plan);
  Setpoint now;
  interpolator.tick(now);
  double old[3][3];
  for (auto& o : old) o[0] = now.x, o[1] = now.y, o[2] = now.z;
  std::size_t run = 0;
  for (std::size_t i = 1; i < plan.setpoints; ++i) {
    interpolator.tick(now);
    const double p[3] = {now.x, now.y, now.z};
    double ratio = 0;
    for (int k = 0; k < 3; ++k) {
      const double second = p[k] - 2 * old[0][k] + old[1][k];
      const double third = p[k] - 3 * (old[0][k] - old[1][k]) - old[2][k];
      ratio = std::max({ratio, std::abs(second) / accel, std::abs(third) / jerk});
      old[2][k] = old[1][k];
      old[1][k] = old[0][k];
      old[0][k] = p[k];
    }
    while (run + 1 < plan.runs.size() && plan.runs[run].end_tick < static_cast<std::int64_t>(i)) ++run;
    if (ratio > 1) {
      if (found.empty() || found.back().first != run) found.push_back({run, ratio});
      found.back().second = std::max(found.back().second, ratio);
    }
  }
  return found;
}

double rounding_of(const Track& track) {
  double largest = 0;
  for (const Piece& p : track.pieces)
    for (int k = 0; k < 3; ++k) largest = std::max({largest, std::abs(p.c[k][0]), std::abs(p.end[k])});
  return largest * std::numeric_limits<double>::epsilon();
}

/// Nothing to move: one setpoint, at the start.
Plan standstill(const Track& track, const Limits& limits, bool any) {
  Plan plan;
  plan.limits = limits;
  if (!any) return plan;
  Piece piece{};
  piece.c[0][0] = piece.end[0] = track.start.x;
  piece.c[1][0] = piece.end[1] = track.start.y;
  piece.c[2][0] = piece.end[2] = track.start.z;
  piece.surface = piece.pass = -1;
  piece.rest_after = true;
  plan.pieces.push_back(piece);
  plan.setpoints = 1;
  return plan;
}

Result<Plan> make_plan(const std::vector<Stretch>& stretches, const Limits& limits,
                       Diagnostics& diagnostics) {
  if (auto fine = check(limits); !fine) return fine.error();
  auto made = make_track(stretches, limits);
  if (!made) return made.error();
  Track& track = *made;
  if (track.runs.empty()) return standstill(track, limits, !stretches.empty());
  std::vector<RunPlanner> planners;
  planners.reserve(track.runs.size());
  for (const TrackRun& run : track.runs) {
    planners.emplace_back(track, run, limits);
    if (auto fine = planners.back().plan(); !fine) return fine.error();
  }
  Plan plan;
  plan.limits = limits;
  plan.pieces = track.pieces;
  const double rounding = rounding_of(track);
  constexpr int kRounds = 40;  // each slows the runs that meet; few are ever needed
  for (int round = 0;; ++round) {
    if (auto fine = assemble(plan, track, planners); !fine) return fine.error();
    const auto bad = offenders(plan, rounding);
    if (bad.empty()) break;
    if (round == kRounds) return limits_too_low();
    for (const auto& [run, ratio] : bad) {
      const double factor = std::clamp(std::cbrt(ratio) * 1.001, 1.001, 2.0);
      if (auto fine = planners[run].slow_down(factor); !fine) return fine.error();
      if (run > 0)
        if (auto fine = planners[run - 1].slow_down(factor); !fine) return fine.error();
    }
  }
  std::size_t slowed = 0;
  for (const RunPlanner& p : planners) slowed += p.slowed_down() ? 1 : 0;
  if (slowed > 0)
    diagnostics.info("servo_slowed",
                     std::to_string(slowed) +
                         " runs between stops were slowed as a whole to keep the limits in the setpoints");
  return plan;
}

}  // namespace

Result<Plan> plan(const std::vector<Stretch>& stretches, const Limits& limits, Diagnostics& diagnostics) {
  try {
    return make_plan(stretches, limits, diagnostics);
  } catch (const std::exception&) {  // only memory can run out
    return Error{ErrorCode::range, "the motion is too long for the memory (a shorter program)", {}};
  }
}

}  // namespace burin::servo
