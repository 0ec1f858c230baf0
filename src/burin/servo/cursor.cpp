// SPDX-License-Identifier: Apache-2.0
#include "burin/servo/cursor.h"

#include <algorithm>
#include <cmath>

namespace burin::servo {
namespace {

/// Newton needs one or two corrections; where the speed of the parameter vanishes it halves instead. 48
/// halvings reach the last bits of x.
constexpr int kMaxCorrections = 48;
/// Chord error left, relative to the chord, and the rounding of the position relative to the coordinates.
constexpr double kChordRelative = 1e-12;
constexpr double kRounding = 2.3e-16;
/// Pieces looked at one by one before and after the search by arc length.
constexpr int kNeighbours = 4;

double distance(const double (&a)[3], const double (&b)[3]) noexcept {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z);
}

double slope(const double (&c)[6], double x) noexcept {
  return (((5 * c[5] * x + 4 * c[4]) * x + 3 * c[3]) * x + 2 * c[2]) * x + c[1];
}
double bend(const double (&c)[6], double x) noexcept {
  return ((20 * c[5] * x + 12 * c[4]) * x + 6 * c[3]) * x + 2 * c[2];
}

/// Taylor: x after `chord` more, from `lo`.
double predict(const Piece& piece, double lo, double chord) noexcept {
  double speed2 = 0, along = 0;
  for (int k = 0; k < 3; ++k) {
    const double d1 = slope(piece.c[k], lo), d2 = bend(piece.c[k], lo);
    speed2 += d1 * d1;
    along += d1 * d2;
  }
  const double h = chord / std::sqrt(speed2);
  const double x = lo + h - along * h * h / (2 * speed2);
  return x > lo ? std::min(x, 1.0) : 0.5 * (lo + 1);  // not a number: the middle
}

/// x in [lo, 1] where the piece is `chord` away from at.p; sets the place, returns the distance.
double solve(const Piece& piece, double lo, Cursor& at, double chord, double covered) noexcept {
  const double from[3] = {at.p[0], at.p[1], at.p[2]};
  const double tolerance =
      kChordRelative * chord + kRounding * (std::abs(from[0]) + std::abs(from[1]) + std::abs(from[2]));
  double hi = 1, x = predict(piece, lo, chord - covered), reached = 0;
  for (int i = 0;; ++i) {
    double r2 = 0, along = 0;
    for (int k = 0; k < 3; ++k) {
      at.p[k] = horner(piece.c[k], x);
      const double r = at.p[k] - from[k];
      r2 += r * r;
      along += r * slope(piece.c[k], x);
    }
    reached = std::sqrt(r2);
    const double miss = reached - chord;
    if (!(std::abs(miss) > tolerance) || i == kMaxCorrections) break;
    (miss < 0 ? lo : hi) = x;
    double next = x - miss * reached / along;
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    if (next == x) break;
    x = next;
  }
  at.x = x;
  return reached;
}

/// The first piece after `i` whose end is at least `chord` away from p; `end` when there is none. `reach`:
/// distance of the end of piece i.
std::size_t find_piece(const Piece* pieces, std::size_t end, std::size_t i, const double (&p)[3],
                       double chord, double reach) noexcept {
  std::size_t j = i + 1;
  for (int step = 0; j < end && step < kNeighbours; ++step, ++j)
    if (distance(pieces[j].end, p) >= chord) return j;
  if (j >= end) return end;
  // Pieces much shorter than a chord: about where the arc length says, then by doubling steps and halving.
  const double target = pieces[i].start + pieces[i].length + (chord - reach);
  const Piece* found = std::upper_bound(pieces + j, pieces + end, target,
                                        [](double s, const Piece& piece) { return s < piece.start; });
  const std::size_t guess = std::max(static_cast<std::size_t>(found - pieces) - 1, j);
  const auto within = [&](std::size_t k) { return distance(pieces[k].end, p) < chord; };
  std::size_t lo = j - 1, hi = guess;  // lo is within the chord; look for the first after it that is not
  if (within(guess)) {
    lo = guess;
    for (std::size_t step = 1;; step *= 2) {
      hi = std::min(lo + step, end);
      if (hi == end || !within(hi)) break;
      lo = hi;
    }
  } else {
    for (std::size_t step = 1; hi - lo > step; step *= 2) {
      if (within(hi - step)) {
        lo = hi - step;
        break;
      }
      hi -= step;
    }
  }
  while (hi - lo > 1) {
    const std::size_t mid = lo + (hi - lo) / 2;
    (within(mid) ? lo : hi) = mid;
  }
  return hi;
}

}  // namespace

Cursor start_of(const Piece& piece, std::size_t index) noexcept {
  return {index, 0, {piece.c[0][0], piece.c[1][0], piece.c[2][0]}};
}

double advance(const Piece* pieces, std::size_t end, Cursor& at, double chord) noexcept {
  if (!(chord > 0) || at.piece >= end) return 0;
  const double reach = distance(pieces[at.piece].end, at.p);
  if (!(reach < chord)) return solve(pieces[at.piece], at.x, at, chord, 0);
  const std::size_t j = find_piece(pieces, end, at.piece, at.p, chord, reach);
  if (j >= end) {
    const Piece& last = pieces[end - 1];
    const double covered = distance(last.end, at.p);
    at = {end - 1, 1, {last.end[0], last.end[1], last.end[2]}};
    return covered;
  }
  at.piece = j;
  const double begin[3] = {pieces[j].c[0][0], pieces[j].c[1][0], pieces[j].c[2][0]};
  return solve(pieces[j], 0, at, chord, std::min(distance(begin, at.p), chord));
}

ProfileValue look_up(const ProfilePiece* profile, std::size_t end, std::size_t& at, double t) noexcept {
  if (at >= end) return {};
  for (int step = 0; step < kNeighbours && at + 1 < end && profile[at + 1].time <= t; ++step) ++at;
  if (at + 1 < end && profile[at + 1].time <= t) {
    const ProfilePiece* after = std::upper_bound(profile + at + 1, profile + end, t,
                                                 [](double s, const ProfilePiece& p) { return s < p.time; });
    at = static_cast<std::size_t>(after - profile) - 1;
  }
  const ProfilePiece& p = profile[at];
  const double d = t - p.time;
  return {p.s + d * (p.v + d * (p.a / 2 + d * (p.j / 6))), p.v + d * (p.a + d * (p.j / 2))};
}

}  // namespace burin::servo
