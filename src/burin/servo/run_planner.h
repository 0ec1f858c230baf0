// SPDX-License-Identifier: Apache-2.0
// One run, from rest to rest: its feed profile, found by planning, running the tick through, and planning
// again where a limit was passed. Part of the planner.
#pragma once

#include <vector>

#include "burin/servo/cells.h"
#include "burin/servo/cursor.h"
#include "burin/servo/profile.h"
#include "burin/servo/track.h"

namespace burin::servo {

class RunPlanner {
 public:
  RunPlanner(const Track& track, const TrackRun& run, const Limits& limits);

  /// Error when the run is too long for kMaxSetpoints or its limits are below the rounding of coordinates.
  Result<void> plan();
  /// The whole run slower by `factor` > 1 in time; the way out that always works.
  Result<void> slow_down(double factor);

  const std::vector<ProfilePiece>& profile() const { return profile_; }
  std::int64_t ticks() const { return ticks_; }
  double length() const { return total_; }  ///< of the chords
  bool slowed_down() const { return stretch_ > 1; }

 private:
  struct Passage {
    double left_over = 0;  ///< path left at the last tick, mm; negative: the end came too early
    double worst = 0;      ///< largest ratio to a limit in the setpoints
  };

  std::vector<LimitSpan> spans(double tau, double reserve) const;
  void choose();
  Result<void> make();
  void count_ticks();
  double shortest_step() const;
  void lengthen(double step);
  Result<Passage> settle();
  Passage walk(bool measure_chords);
  double chord_ratio(const Cursor& before, const Cursor& now) const;
  double deviation(const double (&a)[3], const double (&b)[3], std::size_t piece, double x) const;
  double key(const Cursor& at) const;
  void mark(double key0, double key1, double ratio);
  bool acceptable(const Passage& passage, double missed, bool both_ways) const;
  void lower();

  const Track& track_;
  TrackRun run_;
  Limits limits_, aim_;
  std::vector<Cell> cells_;
  std::vector<ProfilePiece> profile_;
  std::int64_t ticks_ = 0;
  double total_ = 0, tau_ = 0, reserve_ = 0, stretch_ = 1;
  double rounding_ = 0;  ///< of a coordinate of the run, mm
};

/// That no feed, however slow, keeps the limits.
Error limits_too_low();

}  // namespace burin::servo
