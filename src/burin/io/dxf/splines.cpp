// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "burin/io/dxf/curves.h"

namespace burin::io::dxf {
namespace {

using geom::Nurbs2;
using geom::Point2;
using geom::Vec2;

Error bad(std::string what) {
  return {ErrorCode::geometry, std::move(what), {}};
}

// Knots of a clamped curve with even spans, for files that leave them out.
std::vector<double> even_knots(std::size_t points, std::size_t degree) {
  std::vector<double> knots(degree + 1, 0.0);
  for (std::size_t i = 1; i + degree < points; ++i) knots.push_back(static_cast<double>(i));
  knots.resize(points + degree + 1, static_cast<double>(points - degree));
  return knots;
}

// Decreasing steps of the size of lost decimals are levelled; the curve does not change by more than those
// decimals.
bool level_knots(std::vector<double>& knots, bool& changed) {
  constexpr double kLostDecimals = 1e-9;  // of the knot range
  const auto [low, high] = std::minmax_element(knots.begin(), knots.end());
  const double allowed = kLostDecimals * (*high - *low);
  for (std::size_t i = 1; i < knots.size(); ++i) {
    if (knots[i] >= knots[i - 1]) continue;
    if (knots[i - 1] - knots[i] > allowed) return false;
    knots[i] = knots[i - 1];
    changed = true;
  }
  return true;
}

Result<void> take_knots(const SplineShape& spline, Nurbs2& n, std::vector<Finding>& findings) {
  const auto p = static_cast<std::size_t>(n.degree);
  const std::size_t wanted = n.points.size() + p + 1;
  n.knots = spline.knots;
  const auto repaired = [&](const std::string& how) {
    findings.push_back({Severity::info, "spline_repaired", how});
  };
  if (n.knots.empty()) {
    n.knots = even_knots(n.points.size(), p);
    repaired("has no knots: even ones are assumed");
  } else if (n.knots.size() + 2 == wanted) {
    // Some systems leave out the first and the last knot, which no point of the curve depends on.
    n.knots.insert(n.knots.begin(), n.knots.front());
    n.knots.push_back(n.knots.back());
    repaired("lacks the outermost two knots: they are repeated");
  } else if (n.knots.size() != wanted) {
    return bad("it has " + std::to_string(n.knots.size()) + " knots for " + std::to_string(n.points.size()) +
               " control points of degree " + std::to_string(n.degree) + " (" + std::to_string(wanted) +
               " knots are expected)");
  }
  bool levelled = false;
  if (!level_knots(n.knots, levelled)) return bad("its knots decrease (nondecreasing knots are expected)");
  if (levelled) repaired("has knots that decrease by rounding: they are levelled");
  return {};
}

}  // namespace

Result<Nurbs2> spline_curve(const SplineShape& spline, std::vector<Finding>& findings) {
  if (spline.points.empty()) {
    std::vector<Point2> fit;
    fit.reserve(spline.fit_points.size());
    for (const auto& p : spline.fit_points) fit.push_back(xy(p));
    const Vec2 start{spline.start_tangent.x, spline.start_tangent.y};
    const Vec2 end{spline.end_tangent.x, spline.end_tangent.y};
    return geom::interpolate(fit, spline.closed(), start, end);
  }
  Nurbs2 n;
  n.degree = spline.degree;
  if (n.degree < 1 || static_cast<std::size_t>(n.degree) >= spline.points.size()) {
    return bad("its degree is " + std::to_string(n.degree) + " with " + std::to_string(spline.points.size()) +
               " control points (at least 1, and less than the number of points)");
  }
  for (const auto& p : spline.points) n.points.push_back(xy(p));
  n.weights = spline.weights;
  if (std::any_of(n.weights.begin(), n.weights.end(), [](double w) { return !(w > 0); })) {
    return bad("it has a weight of 0 or less (positive weights are expected)");
  }
  if (auto taken = take_knots(spline, n, findings); !taken) return taken.error();
  if (auto valid = geom::validate(n); !valid) return valid.error();
  return n;
}

std::vector<Nurbs2> split_at_breaks(const Nurbs2& n) {
  const auto p = static_cast<std::size_t>(n.degree);
  const double first = n.knots[p], last = n.knots[n.points.size()];
  std::vector<Nurbs2> pieces;
  std::size_t from = 0;                   // first point of the piece, and index of its first knot
  const auto cut = [&](std::size_t to) {  // points [from, to), knots [from, to + p]
    const auto at = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
    Nurbs2& piece = pieces.emplace_back();
    piece.degree = n.degree;
    piece.knots.assign(n.knots.begin() + at(from), n.knots.begin() + at(to + p + 1));
    piece.points.assign(n.points.begin() + at(from), n.points.begin() + at(to));
    piece.weights.assign(n.weights.begin() + at(from), n.weights.begin() + at(to));
  };
  for (std::size_t i = p + 1; i + p < n.knots.size(); ++i) {
    const double knot = n.knots[i];
    if (knot <= first || knot >= last || knot != n.knots[i + p]) continue;
    cut(i);
    std::size_t end = i + p;  // of the run of equal knots
    while (n.knots[end + 1] == knot) ++end;
    from = end - p;
    i = end;
  }
  cut(n.points.size());
  return pieces;
}

}  // namespace burin::io::dxf
