// SPDX-License-Identifier: Apache-2.0
// The two steps of a tick, shared with the planner (which counts the chords of a run beforehand) and with the
// measurement: where the profile is at a time, and the next point of the path at a given chord. Every loop is
// bounded, whatever the numbers are.
#pragma once

#include <cstddef>

#include "burin/servo/plan.h"

namespace burin::servo {

/// A place on the path: piece, parameter, and the position there.
struct Cursor {
  std::size_t piece = 0;
  double x = 0;
  double p[3] = {0, 0, 0};
};

/// At the start of a piece.
Cursor start_of(const Piece& piece, std::size_t index) noexcept;
/// To the next point whose distance from the present one is `chord`, in pieces below `end`: second-order
/// Taylor step, then Newton between brackets until the chord agrees within 1e-12 of itself (or the rounding
/// of the position). Stops at the end of piece `end` - 1. Returns the distance covered.
double advance(const Piece* pieces, std::size_t end, Cursor& at, double chord) noexcept;

struct ProfileValue {
  double s = 0, v = 0;
};
/// The profile pieces [at, end) at time t; `at` moves on to the piece that holds t.
ProfileValue look_up(const ProfilePiece* profile, std::size_t end, std::size_t& at, double t) noexcept;

/// Value of one coordinate's polynomial.
inline double horner(const double (&c)[6], double x) noexcept {
  return ((((c[5] * x + c[4]) * x + c[3]) * x + c[2]) * x + c[1]) * x + c[0];
}

}  // namespace burin::servo
