// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/extend.h"

#include <algorithm>
#include <cmath>

#include "burin/geom/surface/evaluate.h"

namespace burin::cycle {
namespace {

using geom::Direction;
using geom::HPoint;
using geom::Interval;
using geom::NurbsSurface;
using geom::Vec3;

/// The polar form of the polynomial of span k at `args` (one for each degree): de Boor's algorithm with a
/// parameter of its own in every round. `row`: the control points k - degree .. k.
HPoint blossom(const std::vector<double>& knots, int degree, int k, std::vector<HPoint> row,
               const std::vector<double>& args) {
  const auto knot = [&](int i) { return knots[static_cast<std::size_t>(i)]; };
  for (int r = 1; r <= degree; ++r) {
    const double u = args[static_cast<std::size_t>(r - 1)];
    for (int i = degree; i >= r; --i) {
      const int j = k - degree + i;
      const double a = (u - knot(j)) / (knot(j + degree + 1 - r) - knot(j));
      HPoint& p = row[static_cast<std::size_t>(i)];
      p = (1 - a) * row[static_cast<std::size_t>(i - 1)] + a * p;
    }
  }
  return row.back();
}

/// One row of control points with the end of the domain (the first or the last knot) moved to `end`.
std::vector<HPoint> moved_end(const std::vector<double>& knots, int degree, const std::vector<HPoint>& points,
                              bool first, double end) {
  const int n = static_cast<int>(points.size());
  // All others have their knots outside the span whose polynomial goes on.
  const int k = first ? degree : n - 1;
  const std::vector<HPoint> row(points.begin() + (k - degree), points.begin() + (k + 1));
  std::vector<HPoint> out = points;
  for (int i = 0; i < degree; ++i) {
    std::vector<double> args(static_cast<std::size_t>(degree), end);
    for (int r = 0; r < i; ++r)
      args[static_cast<std::size_t>(r)] = knots[static_cast<std::size_t>(first ? degree + 1 + r : n - 1 - r)];
    out[static_cast<std::size_t>(first ? i : n - 1 - i)] = blossom(knots, degree, k, row, args);
  }
  return out;
}

void move_end(NurbsSurface& s, Direction direction, bool first, double end) {
  const bool u = direction == Direction::u;
  std::vector<double>& knots = u ? s.knots_u : s.knots_v;
  const int degree = s.degree(direction), count = s.count(direction), rows = s.count(other(direction));
  std::vector<HPoint> row(static_cast<std::size_t>(count));
  for (int j = 0; j < rows; ++j) {
    const auto at = [&](int i) -> HPoint& { return u ? s.at(i, j) : s.at(j, i); };
    for (int i = 0; i < count; ++i) row[static_cast<std::size_t>(i)] = at(i);
    const std::vector<HPoint> moved = moved_end(knots, degree, row, first, end);
    for (int i = 0; i < count; ++i) at(i) = moved[static_cast<std::size_t>(i)];
  }
  const auto from = first ? knots.begin() : knots.end() - (degree + 1);
  std::fill(from, from + degree + 1, end);
}

geom::SurfaceDerivatives at(const NurbsSurface& s, Direction direction, double t, double w) {
  geom::SurfaceDerivatives d = direction == Direction::u ? derivatives(s, t, w) : derivatives(s, w, t);
  if (direction == Direction::v) std::swap(d.du, d.dv);
  return d;
}

// Where an edge is looked at: every knot span of it thrice.
std::vector<double> places(const NurbsSurface& s, Direction along_edge) {
  const std::vector<double>& knots = s.knots(along_edge);
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
    if (knots[i] < knots[i + 1])
      for (int k = 0; k < 3; ++k) out.push_back(knots[i] + (knots[i + 1] - knots[i]) * k / 3);
  out.push_back(knots.back());
  return out;
}

/// How far the parameter must go beyond `edge` for `distance` square to it; 0 where the edge is a pole.
double room(const NurbsSurface& s, Direction direction, double edge, double distance) {
  double slowest = 1e300;
  for (const double w : places(s, other(direction))) {
    const geom::SurfaceDerivatives d = at(s, direction, edge, w);
    const double across = norm(cross(d.du, d.dv)), size = norm(d.dv);
    constexpr double kPole = 1e-6;  // mm over the whole width of the edge
    if (!(size * s.domain(other(direction)).length() > kPole)) return 0;
    slowest = std::min(slowest, across / size);
  }
  return slowest > 0 ? distance / slowest : 0;
}

/// The continuation to `end` bends and stretches so little that it is still the surface's.
bool sound(const NurbsSurface& s, Direction direction, double edge, double end) {
  for (const double w : places(s, other(direction)))
    for (const double x : {0.5, 1.0}) {
      const geom::SurfaceDerivatives a = at(s, direction, edge, w),
                                     b = at(s, direction, edge + x * (end - edge), w);
      constexpr double kTurned = 0.9, kSlower = 0.4, kFaster = 2.5;
      const Vec3 na = geom::normal(a), nb = geom::normal(b);
      if (!(dot(na, nb) > kTurned * norm(na) && norm(na) > 0)) return false;
      const double st = norm(b.du) / norm(a.du), sw = norm(b.dv) / norm(a.dv);
      if (!(std::min(st, sw) > kSlower && std::max(st, sw) < kFaster)) return false;
    }
  return true;
}

}  // namespace

std::optional<NurbsSurface> extended(const NurbsSurface& surface, Direction direction, Interval to) {
  const Interval domain = surface.domain(direction);
  NurbsSurface s = surface;
  if (to.lo < domain.lo) move_end(s, direction, true, to.lo);
  if (to.hi > domain.hi) move_end(s, direction, false, to.hi);
  if (!geom::validate(s).ok()) return std::nullopt;
  return s;
}

NurbsSurface continued(const NurbsSurface& surface, Direction direction, double distance) {
  NurbsSurface out = surface;
  const Interval domain = surface.domain(direction);
  for (const double edge : {domain.lo, domain.hi}) {
    const double sign = edge == domain.lo ? -1 : 1;
    // Never by more than a part of the surface itself.
    double far = std::min(room(surface, direction, edge, distance), 0.25 * domain.length());
    constexpr int kTries = 3;
    for (int i = 0; i < kTries && far > 0; ++i, far *= 0.5) {
      const double end = edge + sign * far;
      Interval to = out.domain(direction);
      (sign < 0 ? to.lo : to.hi) = end;
      std::optional<NurbsSurface> s = extended(out, direction, to);
      if (!s || !sound(*s, direction, edge, end)) continue;
      out = std::move(*s);
      break;
    }
  }
  return out;
}

}  // namespace burin::cycle
