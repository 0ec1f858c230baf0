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

Target make_target(const Path& path, double d, double tolerance) {
  Target target;
  target.path = &path;
  target.d = d;
  target.tolerance = tolerance;
  target.singular = singular_ranges(path, d, tolerance);
  return target;
}

/// `tangent_rad`: what a single arc's directions at the ends may be off; otherwise they are kept.
std::optional<FittedPiece> fit_with(FitMethod method, const Target& target, double tangent_rad) {
  if (auto single = fit_single(target, tangent_rad)) return single;
  return method == FitMethod::minimal ? fit_minimal(target) : fit_bisect(target);
}

/// The piece in parts, divided where the offset curve becomes singular: there it turns back, and only a joint
/// at just that point with just that direction keeps its regular parts in step with the arcs.
std::optional<FittedPiece> fit_divided(FitMethod method, const Target& target) {
  constexpr double kKeptDirection = 1e-9;  // rad: the joints between the parts stay G1
  const double end = target.path->end();
  std::vector<double> bounds{0};
  for (const Range& r : target.singular.ranges) {
    for (const double tau : {r.lo, r.hi}) {
      if (tau > bounds.back() && tau < end) bounds.push_back(tau);
    }
  }
  bounds.push_back(end);
  FittedPiece whole;
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
    const double lo = bounds[i], hi = bounds[i + 1];
    const Path path = part(*target.path, lo, hi);
    if (path.pieces.empty()) continue;
    bool singular = false;
    for (const Range& r : target.singular.ranges) singular = singular || (r.lo <= lo && hi <= r.hi);
    Target divided = make_target(path, singular ? 0 : target.d, target.tolerance);
    if (i == 0) divided.start_freedom = target.start_freedom;
    if (i + 2 == bounds.size()) divided.end_freedom = target.end_freedom;
    auto fitted = fit_with(method, divided, kKeptDirection);
    if (!fitted) fitted = fit_bisect(divided);
    if (!fitted) return std::nullopt;
    // Parameters of the parts are not needed any more: only arcs and the bound are.
    whole.runs.insert(whole.runs.end(), fitted->runs.begin(), fitted->runs.end());
    whole.deviation.lo = std::min(whole.deviation.lo, fitted->deviation.lo - target.singular.slack);
    whole.deviation.hi = std::max(whole.deviation.hi, fitted->deviation.hi + target.singular.slack);
  }
  return whole;
}

std::optional<FittedPiece> fit_piece(const Path& path, const FitOptions& options, double start_freedom,
                                     double end_freedom) {
  Target target = make_target(path, options.offset_mm, options.tolerance_mm);
  target.start_freedom = start_freedom;
  target.end_freedom = end_freedom;
  // Two curves that meet smoothly may each use up this part of what counts as smooth.
  constexpr double kTangentShare = 0.25;
  if (auto found = fit_with(options.method, target, kTangentShare * options.tangent_rad)) return found;
  if (!target.singular.ranges.empty()) {
    // What the ranges leave unseen comes on top.
    target.tolerance -= target.singular.slack;
    if (target.tolerance > 0) {
      if (auto found = fit_divided(options.method, target)) return found;
    }
    target.tolerance = options.tolerance_mm;
  }
  return options.method == FitMethod::bisect ? std::nullopt : fit_bisect(target);
}

double freedom_between(const Path& before, const Path& after, double tangent_rad) {
  const Vec2 a = before.at(before.end()).tangent, b = after.at(0).tangent;
  return corner_freedom(std::abs(std::atan2(cross(a, b), dot(a, b))), tangent_rad);
}

}  // namespace

double corner_freedom(double turn_rad, double tangent_rad) {
  constexpr double kMost = 0.1;
  if (!(turn_rad > tangent_rad)) return 0;
  // At a tip (a turn near pi) the two sides must not cross.
  return std::clamp(0.25 * std::min(turn_rad, kPi - turn_rad), 0.0, kMost);
}

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
  std::vector<Path> paths;
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
    Path path = part(source->path, bounds[i], bounds[i + 1]);
    if (!path.pieces.empty()) paths.push_back(std::move(path));
  }
  double freedom = options.start_freedom_rad;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Path& path = paths[i];
    const double start_freedom = freedom;
    freedom = i + 1 == paths.size() ? options.end_freedom_rad
                                    : freedom_between(path, paths[i + 1], options.tangent_rad);
    const auto piece = fit_piece(path, options, start_freedom, freedom);
    if (!piece || result.segments.size() + piece->runs.size() > kMaxSegments) {
      return geometry_error("the curve cannot be approximated within " +
                            std::to_string(options.tolerance_mm) + " mm by " + std::to_string(kMaxSegments) +
                            " arcs (a larger tolerance)");
    }
    result.piece_starts.push_back(static_cast<std::uint32_t>(result.segments.size()));
    for (const Run& run : piece->runs) result.segments.push_back(to_segment(run.arc));
    result.max_deviation_mm = std::max(result.max_deviation_mm, piece->deviation.bound());
  }
  // Ends that differ by rounding (divisions and corners seen from both sides, the curve's own ends) become
  // one.
  for (std::size_t i = 1; i < result.segments.size(); ++i) result.segments[i].a = result.segments[i - 1].b;
  result.segments.front().a = start_point(curve);
  result.segments.back().b = end_point(curve);
  return result;
}

}  // namespace burin::geom
