// SPDX-License-Identifier: Apache-2.0
// One arc or line for a whole smooth piece.
#include <algorithm>
#include <cmath>

#include "burin/geom/curve/fit_internal.h"

namespace burin::geom::fit {

namespace {

/// The arc over the chord a-b that turns by 2 `half_turn`.
Arc arc_over(Point2 a, Point2 b, double half_turn) {
  const Vec2 chord = b - a, along = unit(chord);
  const double c = std::cos(half_turn), s = std::sin(half_turn);
  return {a, c * along - s * left(along), 2 * s / norm(chord), b, c * along + s * left(along)};
}

}  // namespace

std::optional<FittedPiece> fit_single(const Target& target, double tangent_rad) {
  const Path& path = *target.path;
  const PointTangent a = path.at(0), b = path.at(path.end());
  const Vec2 chord = b.point - a.point;
  if (chord == Vec2{}) return std::nullopt;
  const double at_start = std::atan2(cross(a.tangent, chord), dot(a.tangent, chord));
  const double at_end = std::atan2(cross(chord, b.tangent), dot(chord, b.tangent));
  // Half turns for which both ends keep their directions closely enough.
  const double start_free = std::max(tangent_rad, target.start_freedom);
  const double end_free = std::max(tangent_rad, target.end_freedom);
  constexpr double kMaxHalfTurn = 1.3;
  const double lo = std::max({at_start - start_free, at_end - end_free, -kMaxHalfTurn});
  const double hi = std::min({at_start + start_free, at_end + end_free, kMaxHalfTurn});
  if (lo > hi) return std::nullopt;

  constexpr int kProbes = 32;
  std::array<Point2, kProbes> probes;
  for (int i = 0; i < kProbes; ++i) {
    probes[static_cast<std::size_t>(i)] = path.point(path.end() * (i + 1) / (kProbes + 1));
  }
  const auto deviation = [&](double half_turn) {
    const Arc arc = arc_over(a.point, b.point, half_turn);
    double worst = 0;
    for (const Point2 p : probes) worst = std::max(worst, std::abs(signed_distance(arc.a, arc.ta, arc.k, p)));
    return worst;
  };
  // A line where one will do; else the best half turn: the deviation has one minimum.
  double best = 0;
  if (!(lo <= 0 && 0 <= hi && deviation(0) <= 0.9 * target.tolerance)) {
    double x0 = lo, x1 = hi;
    for (int i = 0; i < 24; ++i) {
      const double m0 = x0 + 0.38 * (x1 - x0), m1 = x0 + 0.62 * (x1 - x0);
      (deviation(m0) <= deviation(m1) ? x1 : x0) = deviation(m0) <= deviation(m1) ? m1 : m0;
    }
    best = 0.5 * (x0 + x1);
    // What an exact arc has, to the last digit.
    const double mean = std::clamp(0.5 * (at_start + at_end), lo, hi);
    if (deviation(mean) <= deviation(best)) best = mean;
  }
  if (deviation(best) > target.tolerance) return std::nullopt;
  FittedPiece piece{{{arc_over(a.point, b.point, best), 0, path.end()}}, {}};
  piece.deviation = certify(target, piece.runs);
  if (!(piece.deviation.bound() <= target.tolerance)) return std::nullopt;
  return piece;
}

}  // namespace burin::geom::fit
