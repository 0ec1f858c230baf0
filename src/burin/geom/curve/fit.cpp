// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/fit.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "burin/geom/curve/fit_internal.h"

namespace burin::geom {

namespace {

using namespace fit;

Error geometry_error(std::string message) {
  return {ErrorCode::geometry, std::move(message), {}};
}

FitResult unchanged_line(const Line2& line) {
  return {{make_line(line.a, line.b)}, 0, {0}};
}

FitResult unchanged_arc(const Arc2& arc) {
  const Curve2 curve = arc;
  const bool left_turn = arc.sweep > 0;
  const Point2 a = point_at(curve, 0), b = point_at(curve, 1);
  FitResult result{{}, 0, {0}};
  // Segments sweep less than a full turn: beyond three quarters two of them are safer and read as well.
  if (std::abs(arc.sweep) > 1.5 * kPi) {
    const Point2 m = point_at(curve, 0.5);
    const bool full = std::abs(arc.sweep) >= 2 * kPi * (1 - 1e-15);
    result.segments = {make_arc(a, m, arc.center, left_turn),
                       make_arc(m, full ? a : b, arc.center, left_turn)};
  } else {
    result.segments = {make_arc(a, b, arc.center, left_turn)};
  }
  return result;
}

/// Path parameters at which smooth pieces begin and end.
std::vector<double> piece_bounds(const Curve2& curve, const PathOfCurve& source, double tangent_rad) {
  std::vector<double> bounds{0};
  for (const double t : corner_parameters(curve, tangent_rad)) bounds.push_back(source.tau_of(t));
  const auto& pieces = source.path.pieces;
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
    const Vec2 before = pieces[k].d[static_cast<std::size_t>(pieces[k].hodograph_degree)];
    const Vec2 after = pieces[k + 1].d[0];
    if (std::abs(std::atan2(cross(before, after), dot(before, after))) > tangent_rad) {
      bounds.push_back(static_cast<double>(k + 1));
    }
  }
  bounds.push_back(source.path.end());
  std::sort(bounds.begin(), bounds.end());
  // A corner found twice (as a knot and as a joint) differs by rounding at most.
  constexpr double kSameParameter = 1e-9;
  const auto same = [](double a, double b) { return b - a <= kSameParameter; };
  bounds.erase(std::unique(bounds.begin(), bounds.end(), same), bounds.end());
  bounds.back() = source.path.end();
  return bounds;
}

std::optional<FittedPiece> fit_piece(const Path& path, const FitOptions& options) {
  Target target;
  target.path = &path;
  target.d = options.offset_mm;
  target.tolerance = options.tolerance_mm;
  target.singular = singular_ranges(path, target.d, target.tolerance);
  // Two pieces that meet smoothly may each use up this part of what counts as smooth.
  constexpr double kTangentShare = 0.25;
  if (auto single = fit_single(target, kTangentShare * options.tangent_rad)) return single;
  if (options.method == FitMethod::minimal) {
    if (auto found = fit_minimal(target)) return found;
  }
  return fit_bisect(target);
}

}  // namespace

Result<FitResult> fit_arc_spline(const Curve2& curve, const FitOptions& options) {
  if (auto valid = validate(curve); !valid.ok()) return valid.error();
  if (!(options.tolerance_mm > 0) || !std::isfinite(options.tolerance_mm)) {
    return geometry_error("the tolerance " + std::to_string(options.tolerance_mm) +
                          " mm cannot be kept (a positive number)");
  }
  if (!std::isfinite(options.offset_mm))
    return geometry_error("the offset is not a number (a finite number of mm)");
  if (const auto* line = std::get_if<Line2>(&curve)) {
    if (line->a == line->b) return geometry_error("the line has zero length (two different points)");
    return unchanged_line(*line);
  }
  if (const auto* arc = std::get_if<Arc2>(&curve)) {
    if (arc->sweep == 0) return geometry_error("the arc has zero length (a sweep other than 0)");
    return unchanged_arc(*arc);
  }
  auto source = path_of(curve);
  if (!source.ok()) return source.error();

  FitResult result;
  const std::vector<double> bounds = piece_bounds(curve, *source, options.tangent_rad);
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
    const Path path = part(source->path, bounds[i], bounds[i + 1]);
    if (path.pieces.empty()) continue;
    const auto piece = fit_piece(path, options);
    if (!piece || result.segments.size() + piece->runs.size() > kMaxSegments) {
      return geometry_error("the curve cannot be approximated within " +
                            std::to_string(options.tolerance_mm) + " mm by " + std::to_string(kMaxSegments) +
                            " arcs (a larger tolerance)");
    }
    result.piece_starts.push_back(static_cast<std::uint32_t>(result.segments.size()));
    for (const Run& run : piece->runs) result.segments.push_back(to_segment(run.arc));
    result.max_deviation_mm = std::max(result.max_deviation_mm, piece->deviation.bound());
  }
  return result;
}

}  // namespace burin::geom
