// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/outlines.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace burin::laser::detail {
namespace {

using geom::Point2;
using geom::Segment;
using geom::Vec2;

/// The segment with its ends moved; an arc keeps its sweep when the ends move by more than rounding.
Segment with_ends(const Segment& s, Point2 a, Point2 b) {
  if (s.a == a && s.b == b) return s;
  if (s.is_line()) return geom::make_line(a, b, s.source);
  const double slack = 0.25 * geom::kArcConsistency * (std::abs(s.radius) + 1);
  if (geom::distance(s.a, a) <= slack && geom::distance(s.b, b) <= slack) {
    Segment moved = s;
    moved.a = a;
    moved.b = b;
    return moved;
  }
  return geom::from_bulge(a, b, geom::bulge_of(s), s.source);
}

/// Ends further away than this from their joint are off by more than the rounding of the curve's evaluation.
constexpr double kRounding_mm = 1e-9;
/// Curves whose ends are at least this part of their size apart keep their shape when an end is moved a
/// little.
constexpr double kStretched = 0.7;

/// The curve turned and scaled so that it runs from joint to joint, when that moves no point of it by much
/// more than the ends: then smooth pieces stay smooth. Ends up to `most` away are moved, others are left for
/// a bridge.
geom::Curve2 eased(const geom::Curve2& curve, Point2 from, Point2 to, double most) {
  const Point2 a = start_point(curve), b = end_point(curve);
  const double gap = std::max(distance(a, from), distance(b, to));
  const geom::Box2 box = bounds(curve);
  const Vec2 old = b - a, wanted = to - from;
  if (gap <= kRounding_mm || gap > most || norm(old) < kStretched * std::hypot(box.width(), box.height()))
    return curve;
  const double re = dot(wanted, old) / norm2(old), im = cross(old, wanted) / norm2(old);
  const Vec2 moved_a{re * a.x - im * a.y, im * a.x + re * a.y};
  return transformed({re, im, -im, re, from.x - moved_a.x, from.y - moved_a.y}, curve);
}

/// Whether an arc of this run may be bent so that its end comes to the joint: a flat one only.
bool bends_gently(const Segment& s) {
  return s.is_line() || std::abs(sweep_of(s)) < geom::kPi / 2;
}

/// Makes a run of segments start and end in the joints. Small gaps are taken by moving the end of a drawn
/// line or flat arc; others are bridged by a line, so that nothing is bent out of its tolerance. Returns
/// whether a bridge stands before and after.
std::pair<bool, bool> weld(std::vector<Segment>& run, Point2 from, Point2 to, double most, bool free) {
  if (run.empty()) return {false, false};
  const auto bridges = [&](const Segment& s, double gap) {
    return gap > (free || !bends_gently(s) ? kRounding_mm : most);
  };
  const bool before = bridges(run.front(), distance(run.front().a, from));
  const bool after = bridges(run.back(), distance(run.back().b, to));
  const Point2 a = before ? run.front().a : from, b = after ? run.back().b : to;
  if (run.size() == 1) {
    run.front() = with_ends(run.front(), a, b);
  } else {
    run.front() = with_ends(run.front(), a, run.front().b);
    run.back() = with_ends(run.back(), run.back().a, b);
  }
  if (before) run.insert(run.begin(), geom::make_line(from, a));
  if (after) run.push_back(geom::make_line(b, to));
  return {before, after};
}

/// How far the fit of curve i may leave the drawn direction at its start: nothing at smooth joints, see
/// corner_freedom().
double start_freedom(const Contour& contour, std::size_t i, double tangent_rad) {
  const std::size_t n = contour.curves.size();
  if (i == 0 && !contour.closed) return 0;
  const Vec2 in = tangent_at(contour.curves[(i + n - 1) % n], 1.0);
  const Vec2 out = tangent_at(contour.curves[i], 0.0);
  return geom::corner_freedom(std::abs(std::atan2(cross(in, out), dot(in, out))), tangent_rad);
}

bool is_free(const geom::Curve2& curve) {
  return std::holds_alternative<geom::Nurbs2>(curve) || std::holds_alternative<geom::EllipseArc2>(curve);
}

Error at_entity(Error error, const io::Drawing& drawing, std::uint32_t entity) {
  if (entity < drawing.entities.size()) error.where.entity = drawing.entities[entity].name();
  return error;
}

}  // namespace

bool has_free_curves(const Contour& contour) {
  return std::any_of(contour.curves.begin(), contour.curves.end(), is_free);
}

Result<geom::ArcSpline> outline_of(const Contour& contour, const io::Drawing& drawing, double offset_mm,
                                   double tolerance_mm, const LaserOptions& options,
                                   std::vector<Piece>& pieces) {
  geom::ArcSpline out;
  out.closed = contour.closed;
  const std::size_t n = contour.curves.size();
  const double tangent_rad = options.tolerance.tangent_rad;
  for (std::size_t i = 0; i < n; ++i) {
    geom::FitOptions fit;
    fit.method = options.fit;
    fit.tolerance_mm = tolerance_mm;
    fit.offset_mm = offset_mm;
    fit.tangent_rad = tangent_rad;
    const bool free = is_free(contour.curves[i]);
    if (free) {
      fit.start_freedom_rad = start_freedom(contour, i, tangent_rad);
      fit.end_freedom_rad =
          i + 1 < n || contour.closed ? start_freedom(contour, (i + 1) % n, tangent_rad) : 0;
    }
    // A closed curve alone has one joint: its own start, where its end comes back to.
    const Point2 from = contour.joints[i];
    const Point2 to = i + 1 < contour.joints.size() ? contour.joints[i + 1] : contour.joints.front();
    auto fitted = geom::fit_arc_spline(
        free ? eased(contour.curves[i], from, to, tolerance_mm) : contour.curves[i], fit);
    if (!fitted) return at_entity(fitted.error(), drawing, contour.entity[i]);
    std::vector<Segment> run = std::move(fitted->segments);
    std::size_t next_start = 0;
    for (std::uint32_t k = 0; k < run.size(); ++k) {
      if (next_start < fitted->piece_starts.size() && k == fitted->piece_starts[next_start]) {
        pieces.push_back({contour.entity[i], free, fitted->max_deviation_mm});
        ++next_start;
      }
      run[k].source = static_cast<std::uint32_t>(pieces.size() - 1);
    }
    const auto [before, after] = weld(run, from, to, tolerance_mm, free);
    for (const bool at_start : {true, false}) {
      if (!(at_start ? before : after)) continue;
      pieces.push_back({contour.entity[i], false, 0});
      (at_start ? run.front() : run.back()).source = static_cast<std::uint32_t>(pieces.size() - 1);
    }
    out.segments.insert(out.segments.end(), run.begin(), run.end());
  }
  std::erase_if(out.segments, [](const Segment& s) { return s.a == s.b; });
  return out;
}

}  // namespace burin::laser::detail
