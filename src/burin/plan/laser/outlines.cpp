// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/outlines.h"

#include <algorithm>
#include <cmath>

namespace burin::laser::detail {
namespace {

using geom::Point2;
using geom::Segment;

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

/// Moves the ends of a run of segments onto the joints. Ends up to `most` away move with their segment;
/// further ones are bridged by a line, so that no arc is bent out of its tolerance.
void weld(std::vector<Segment>& run, Point2 from, Point2 to, double most) {
  if (run.empty()) return;
  if (geom::distance(run.front().a, from) > most) {
    run.insert(run.begin(), geom::make_line(from, run.front().a, run.front().source));
  }
  if (geom::distance(run.back().b, to) > most) {
    run.push_back(geom::make_line(run.back().b, to, run.back().source));
  }
  if (run.size() == 1) {
    run.front() = with_ends(run.front(), from, to);
    return;
  }
  run.front() = with_ends(run.front(), from, run.front().b);
  run.back() = with_ends(run.back(), run.back().a, to);
}

/// How far the fit of curve i may leave the drawn direction at its start: nothing at smooth joints, see
/// corner_freedom().
double start_freedom(const Contour& contour, std::size_t i, double tangent_rad) {
  const std::size_t n = contour.curves.size();
  if (i == 0 && !contour.closed) return 0;
  const geom::Vec2 in = tangent_at(contour.curves[(i + n - 1) % n], 1.0);
  const geom::Vec2 out = tangent_at(contour.curves[i], 0.0);
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
    if (is_free(contour.curves[i])) {
      fit.start_freedom_rad = start_freedom(contour, i, tangent_rad);
      fit.end_freedom_rad =
          i + 1 < n || contour.closed ? start_freedom(contour, (i + 1) % n, tangent_rad) : 0;
    }
    auto fitted = geom::fit_arc_spline(contour.curves[i], fit);
    if (!fitted) return at_entity(fitted.error(), drawing, contour.entity[i]);
    std::vector<Segment> run = std::move(fitted->segments);
    const bool free = is_free(contour.curves[i]);
    std::size_t next_start = 0;
    for (std::uint32_t k = 0; k < run.size(); ++k) {
      if (next_start < fitted->piece_starts.size() && k == fitted->piece_starts[next_start]) {
        pieces.push_back({contour.entity[i], free, fitted->max_deviation_mm});
        ++next_start;
      }
      run[k].source = static_cast<std::uint32_t>(pieces.size() - 1);
    }
    const Point2 from = contour.joints[i];
    const Point2 to = i + 1 < contour.joints.size() ? contour.joints[i + 1] : contour.joints.front();
    // A closed curve alone has one joint: its own start, where its end comes back to.
    weld(run, from, to, tolerance_mm);
    out.segments.insert(out.segments.end(), run.begin(), run.end());
  }
  std::erase_if(out.segments, [](const Segment& s) { return s.a == s.b; });
  return out;
}

}  // namespace burin::laser::detail
