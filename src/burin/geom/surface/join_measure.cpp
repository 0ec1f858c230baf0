// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/join_measure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "burin/geom/surface/basis.h"
#include "burin/geom/surface/closest.h"
#include "burin/geom/surface/evaluate.h"

namespace burin::geom::detail {
namespace {

constexpr double kTangentAngle = 1e-6, kCurvatureRatio = 1e-4;  // promised in join.h
constexpr int kSamples = 9;                                     // per span and direction, promised in join.h
/// In very large nets fewer: each span is small.
constexpr std::size_t kManySpans = 40000;
constexpr int kFewSamples = 3;
/// Samples of a joint's line per span.
constexpr int kLineSamples = 5;
/// Curvature radii beyond this many sizes of the surface are flat.
constexpr double kFlat = 1e6;
/// Of a surface that is a point, mm: so that nothing is divided by 0.
constexpr double kLeastSize = 1e-9;
/// Tangents this much shorter than the others are degenerate: no statement about the plane there.
constexpr double kDegenerate = 1e-7;
constexpr int kNewtonSteps = 12;
/// Steps of the search for the maximum between the samples.
constexpr int kHalvings = 10;

double widest_step(const std::vector<double>& at) {
  double widest = 0;
  for (std::size_t i = 1; i < at.size(); ++i) widest = std::max(widest, at[i] - at[i - 1]);
  return widest;
}

std::vector<double> samples_in(const std::vector<double>& knots, Interval t, int per_span) {
  const std::vector<double> at = spans_in(knots, t);
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < at.size(); ++i)
    for (int k = i == 0 ? 0 : 1; k < per_span; ++k)
      out.push_back(at[i] + (at[i + 1] - at[i]) * k / (per_span - 1));
  return out;
}

/// Normal curvature square to the line, in the tangent plane.
double curvature_across(const SurfaceDerivatives& d, Vec3 along) {
  const Vec3 n = normal(d), want = cross(n, along);
  // want = a du + b dv
  const double e = dot(d.du, d.du), f = dot(d.du, d.dv), g = dot(d.dv, d.dv);
  const double p = dot(want, d.du), q = dot(want, d.dv), det = e * g - f * f;
  return normal_curvature(d, (p * g - q * f) / det, (q * e - p * f) / det);
}

/// Distance of p to the surface, by Newton from `start`: never more than from there.
double local_distance(const NurbsSurface& surface, Point3 p, Point2 start) {
  const Interval u = surface.domain(Direction::u), v = surface.domain(Direction::v);
  double best = distance(point(surface, start.x, start.y), p);
  Point2 at{std::clamp(start.x, u.lo, u.hi), std::clamp(start.y, v.lo, v.hi)};
  for (int step = 0; step < kNewtonSteps; ++step) {
    const SurfaceDerivatives d = derivatives(surface, at.x, at.y);
    const Vec3 off = d.p - p;
    best = std::min(best, norm(off));
    const double gu = dot(off, d.du), gv = dot(off, d.dv);
    double a = dot(d.du, d.du) + dot(off, d.duu), b = dot(d.du, d.dv) + dot(off, d.duv),
           c = dot(d.dv, d.dv) + dot(off, d.dvv);
    if (!(a > 0 && a * c - b * b > 0)) {
      a = dot(d.du, d.du);
      b = dot(d.du, d.dv);
      c = dot(d.dv, d.dv);
    }
    // A parameter at its end and pushed outwards stays there.
    const bool fix_u = (at.x == u.lo && gu > 0) || (at.x == u.hi && gu < 0);
    const bool fix_v = (at.y == v.lo && gv > 0) || (at.y == v.hi && gv < 0);
    const double det = a * c - b * b;
    double du = 0, dv = 0;
    if (!fix_u && !fix_v && det > 0) {
      du = -(gu * c - gv * b) / det;
      dv = -(gv * a - gu * b) / det;
    } else {
      if (!fix_u && a > 0) du = -gu / a;
      if (!fix_v && c > 0 && fix_u) dv = -gv / c;
    }
    const Point2 next{std::clamp(at.x + du, u.lo, u.hi), std::clamp(at.y + dv, v.lo, v.hi)};
    if (!(next.x != at.x || next.y != at.y)) break;
    at = next;
  }
  return best;
}

/// The largest of `distance_at` over 9 x 9 places in every span of the surface, and uphill from there.
/// `distance_at` may stop early with a value that is not above `most`.
double largest_over(const NurbsSurface& surface, const Region& region,
                    const std::function<double(Point2 at, double most)>& distance_at, double negligible_mm) {
  const std::size_t spans =
      spans_in(surface.knots_u, region.u).size() * spans_in(surface.knots_v, region.v).size();
  const int per_span = spans <= kManySpans ? kSamples : kFewSamples;
  const std::vector<double> us = samples_in(surface.knots_u, region.u, per_span);
  const std::vector<double> vs = samples_in(surface.knots_v, region.v, per_span);
  double most = 0;
  Point2 worst{us.front(), vs.front()};
  const auto look = [&](Point2 at) {
    const double apart = distance_at(at, most);
    if (!(apart > most)) return;
    most = apart;
    worst = at;
  };
  for (const double v : vs)
    for (const double u : us) look({u, v});
  if (most <= negligible_mm) return most;
  // Uphill from the worst sample.
  Vec2 step{widest_step(us), widest_step(vs)};
  for (int halving = 0; halving < kHalvings; ++halving) {
    step = 0.5 * step;
    const Point2 from = worst;
    for (const Vec2 way : {Vec2{1, 0}, Vec2{-1, 0}, Vec2{0, 1}, Vec2{0, -1}}) {
      look({std::clamp(from.x + way.x * step.x, region.u.lo, region.u.hi),
            std::clamp(from.y + way.y * step.y, region.v.lo, region.v.hi)});
    }
  }
  return most;
}

}  // namespace

Continuity continuity_along(const NurbsSurface& surface, Direction direction, double at) {
  const Direction along = other(direction);
  Continuity found = Continuity::g2;
  const double flat = 1 / (kFlat * std::max(bounds(surface).diagonal(), kLeastSize));
  SurfaceEvaluator evaluator(surface);
  for (const double t : samples_in(surface.knots(along), surface.domain(along), kLineSamples)) {
    // Between the samples at knots only: there the pieces on both sides of the knot would mix.
    const bool u = direction == Direction::u;
    const auto side = [&](Side s) {
      return u ? evaluator.derivatives(at, t, s, Side::right) : evaluator.derivatives(t, at, Side::right, s);
    };
    const SurfaceDerivatives left = side(Side::left), right = side(Side::right);
    const Vec3 line = u ? right.dv : right.du;
    const Vec3 cross_left = u ? left.du : left.dv, cross_right = u ? right.du : right.dv;
    const double longest = std::max({norm(line), norm(cross_left), norm(cross_right)});
    if (!(std::min({norm(line), norm(cross_left), norm(cross_right)}) > kDegenerate * longest)) continue;
    const Vec3 n1 = normal(left), n2 = normal(right);
    if (norm(n1) == 0 || norm(n2) == 0) continue;
    if (!(std::atan2(norm(cross(n1, n2)), dot(n1, n2)) <= kTangentAngle)) return Continuity::g0;
    const double k1 = curvature_across(left, unit(line)), k2 = curvature_across(right, unit(line));
    if (!(std::abs(k1 - k2) <= kCurvatureRatio * std::max({std::abs(k1), std::abs(k2), flat})))
      found = Continuity::g1;
  }
  return found;
}

double distance_by_samples(const NurbsSurface& joined, const Region& region, const NurbsSurface& source,
                           const Member& map, double negligible_mm) {
  SurfaceEvaluator on_joined(joined), on_source(source);
  const auto apart = [&](Point2 at, double most) {
    const Point2 there = patch_parameters(map, at);
    const Point3 p = on_joined.point(at.x, at.y), q = on_source.point(there.x, there.y);
    const double bound = distance(p, q);
    if (bound <= negligible_mm || bound <= most) return bound;
    return std::max(local_distance(source, p, there), local_distance(joined, q, at));
  };
  return largest_over(joined, region, apart, negligible_mm);
}

double distance_to_parts(const NurbsSurface& whole, const std::vector<NurbsSurface>& parts,
                         const std::vector<Member>& maps, double negligible_mm) {
  // Newton may end at a place that is near but not nearest: what would raise the maximum is proven.
  const ClosestPointFinder on_whole(whole);
  std::vector<ClosestPointFinder> on_parts;
  for (const NurbsSurface& part : parts) on_parts.emplace_back(part);
  double largest = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto to_whole = [&](Point2 at, double most) {
      const Point3 p = point(parts[i], at.x, at.y);
      const double local = local_distance(whole, p, patch_parameters(maps[i], at));
      return local <= std::max(most, negligible_mm) ? local : on_whole.find(p, negligible_mm).distance;
    };
    largest = std::max(largest, largest_over(parts[i], {maps[i].u, maps[i].v}, to_whole, negligible_mm));
  }
  const auto to_nearest_part = [&](Point2 at, double most) {
    const Point3 p = point(whole, at.x, at.y);
    double local = std::numeric_limits<double>::infinity(), proven = local;
    for (std::size_t i = 0; i < parts.size(); ++i)
      local = std::min(local, local_distance(parts[i], p, joined_parameters(maps[i], at)));
    if (local <= std::max(most, negligible_mm)) return local;
    for (const ClosestPointFinder& finder : on_parts)
      proven = std::min(proven, finder.find(p, negligible_mm).distance);
    return proven;
  };
  const Region all{whole.domain(Direction::u), whole.domain(Direction::v)};
  return std::max(largest, largest_over(whole, all, to_nearest_part, negligible_mm));
}

}  // namespace burin::geom::detail
