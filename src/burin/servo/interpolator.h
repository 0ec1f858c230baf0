// SPDX-License-Identifier: Apache-2.0
// The real-time part: one call a servo period, one setpoint. Never allocates, locks, throws, or loops without
// bound.
#pragma once

#include <cstdint>

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
  running,
  done,  ///< at rest at the end; the setpoint repeats the last position
};

class Interpolator {
 public:
  /// Keeps a reference: `plan` must outlive it and not change.
  explicit Interpolator(const Plan& plan) noexcept;
  /// Fills `out` for the present period and moves on by one. The first call gives the start at t = 0.
  Status tick(Setpoint& out) noexcept;
  void restart() noexcept;

 private:
  const Plan* plan_;
  std::size_t run_ = 0, piece_ = 0, profile_ = 0;
  std::int64_t tick_ = 0;
  double x_ = 0;  ///< place in the piece
  double s_ = 0;  ///< chords travelled in this run
  double px_ = 0, py_ = 0, pz_ = 0;
};

}  // namespace burin::servo
