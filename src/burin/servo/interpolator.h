// SPDX-License-Identifier: Apache-2.0
// The real-time part: one call a servo period, one setpoint. Never allocates, locks, throws, or loops without
// bound.
#pragma once

#include <cstdint>

#include "burin/servo/cursor.h"
#include "burin/servo/plan.h"

namespace burin::servo {

struct Setpoint {
  double t_s = 0;
  double x = 0, y = 0, z = 0;  ///< mm
  double feed_mm_min = 0;      ///< tip speed of the feed profile at that instant
  double u = 0, v = 0;         ///< surface parameters; not a number where there are none
  std::int32_t surface = -1, pass = -1;
};

enum class Status : std::uint8_t {
  running,  ///< the first `setpoints` calls
  done,     ///< afterwards: at rest at the end; the setpoint repeats the last one
};

class Interpolator {
 public:
  /// Keeps a reference: `plan` must outlive it and not change.
  explicit Interpolator(const Plan& plan) noexcept;
  /// Fills `out` for the present period and moves on by one. The first call gives the start at t = 0.
  Status tick(Setpoint& out) noexcept;
  void restart() noexcept;
  /// Where the last setpoint lies; at a stop the start of what follows.
  const Cursor& place() const noexcept { return at_; }

 private:
  void fill(Setpoint& out, double speed) const noexcept;

  const Plan* plan_;
  std::size_t run_ = 0, profile_ = 0;
  std::int64_t tick_ = 0;
  double travelled_ = 0;  ///< chords, in this run
  Cursor at_;
};

}  // namespace burin::servo
