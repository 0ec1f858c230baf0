// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/nurbs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "burin/base/text.h"

namespace burin::geom {
namespace {

// Magnitudes beyond which products of third derivatives could overflow. Far outside anything that is made.
constexpr double kMaxCoordinate = 1e30;  // of w X, w Y, w Z, and of knots
constexpr double kMinWeight = 1e-15, kMaxWeight = 1e15;
constexpr double kMinSpan = 1e-30;  // of knots that differ: the third power of its inverse is finite

Error bad(std::string message) {
  return {ErrorCode::geometry, std::move(message), {}};
}

Result<void> check_degree(int degree, const std::string& of) {
  if (degree >= 1 && degree <= kMaxSurfaceDegree) return {};
  return bad("degree " + std::to_string(degree) + of + " (1 to " + std::to_string(kMaxSurfaceDegree) +
             " are accepted)");
}

Result<void> check_count(int count, int degree, const std::string& of) {
  if (count > degree && count <= kMaxControlPoints) return {};
  return bad(std::to_string(count) + " control points" + of + " (degree " + std::to_string(degree) +
             " needs at least " + std::to_string(degree + 1) + ", at most " +
             std::to_string(kMaxControlPoints) + " are accepted)");
}

std::string knot_text(const std::vector<double>& knots, std::size_t i) {
  return "knot " + std::to_string(i + 1) + ", " + format_shortest(knots[i]) + ",";
}

Result<void> check_order(const std::vector<double>& knots, const std::string& of) {
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!(std::abs(knots[i]) <= kMaxCoordinate)) {
      return bad(knot_text(knots, i) + of + " is not a usable number (finite, magnitude up to 1e30)");
    }
    if (i == 0) continue;
    if (knots[i] < knots[i - 1]) {
      return bad(knot_text(knots, i) + of + " is less than the one before, " + format_shortest(knots[i - 1]) +
                 " (knots must not decrease)");
    }
    if (knots[i] > knots[i - 1] && knots[i] - knots[i - 1] < kMinSpan) {
      return bad(knot_text(knots, i) + of + " is too close to the one before (equal, or 1e-30 apart)");
    }
  }
  return {};
}

/// Clamped, inner multiplicity at most degree.
Result<void> check_multiplicity(const std::vector<double>& knots, int degree, const std::string& of) {
  const auto p = static_cast<std::size_t>(degree);
  const std::size_t n = knots.size();
  if (!(knots.front() < knots.back())) {
    return bad("all knots" + of + " are equal (the last must be greater than the first)");
  }
  if (knots[p] != knots.front() || knots[n - 1 - p] != knots.back()) {
    return bad("the knots" + of + " are not clamped (the first and the last " + std::to_string(degree + 1) +
               " must be equal)");
  }
  for (std::size_t i = 1; i + p < n - 1; ++i) {
    if (knots[i] == knots[i + p]) {
      return bad(knot_text(knots, i) + of + " stands there more than " + std::to_string(degree) +
                 " times (inside the domain at most as often as the degree, at its ends once more)");
    }
  }
  return {};
}

Result<void> check_knots(const std::vector<double>& knots, int degree, int count, const std::string& of) {
  const auto expected = static_cast<std::size_t>(count) + static_cast<std::size_t>(degree) + 1;
  if (knots.size() != expected) {
    return bad(std::to_string(knots.size()) + " knots" + of + " (" + std::to_string(count) +
               " control points of degree " + std::to_string(degree) + " need " + std::to_string(expected) +
               ")");
  }
  if (auto r = check_order(knots, of); !r) return r;
  return check_multiplicity(knots, degree, of);
}

Result<void> check_points(const std::vector<HPoint>& points, int count_u) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const HPoint& h = points[i];
    const auto where = [&] {
      if (count_u == 0) return "control point " + std::to_string(i + 1);
      const auto n = static_cast<std::size_t>(count_u);
      return "control point " + std::to_string(i % n + 1) + " in u, " + std::to_string(i / n + 1) + " in v";
    };
    if (!(h.w > 0)) return bad(where() + ": weight " + format_shortest(h.w) + " (weights must be positive)");
    if (!(h.w >= kMinWeight && h.w <= kMaxWeight)) {
      return bad(where() + ": weight " + format_shortest(h.w) + " (1e-15 to 1e15 are accepted)");
    }
    for (const double c : {h.x, h.y, h.z}) {
      if (!(std::abs(c) <= kMaxCoordinate)) {
        return bad(where() + ": a coordinate is not a usable number (finite, magnitude up to 1e30)");
      }
    }
  }
  return {};
}

Box3 bounds_of(const std::vector<HPoint>& points) {
  Box3 box;
  for (const HPoint& h : points) box.add(project(h));
  return box;
}

}  // namespace

Result<void> validate(const NurbsCurve& curve) {
  if (auto r = check_degree(curve.degree, ""); !r) return r;
  if (curve.points.size() > static_cast<std::size_t>(kMaxControlPoints)) {
    return bad(std::to_string(curve.points.size()) + " control points (at most " +
               std::to_string(kMaxControlPoints) + " are accepted)");
  }
  const int count = static_cast<int>(curve.points.size());
  if (auto r = check_count(count, curve.degree, ""); !r) return r;
  if (auto r = check_knots(curve.knots, curve.degree, count, ""); !r) return r;
  return check_points(curve.points, 0);
}

Result<void> validate(const NurbsSurface& s) {
  for (const Direction d : {Direction::u, Direction::v}) {
    const std::string of = d == Direction::u ? " in u" : " in v";
    if (auto r = check_degree(s.degree(d), of); !r) return r;
    if (auto r = check_count(s.count(d), s.degree(d), of); !r) return r;
  }
  const std::int64_t total = std::int64_t{s.count_u} * s.count_v;
  if (total > kMaxControlPoints) {
    return bad(std::to_string(total) + " control points (at most " + std::to_string(kMaxControlPoints) +
               " are accepted)");
  }
  if (s.points.size() != static_cast<std::size_t>(total)) {
    return bad(std::to_string(s.points.size()) + " control points (" + std::to_string(s.count_u) +
               " in u by " + std::to_string(s.count_v) + " in v need " + std::to_string(total) + ")");
  }
  if (auto r = check_knots(s.knots_u, s.degree_u, s.count_u, " in u"); !r) return r;
  if (auto r = check_knots(s.knots_v, s.degree_v, s.count_v, " in v"); !r) return r;
  return check_points(s.points, s.count_u);
}

std::vector<double> clamped_uniform_knots(int count, int degree) {
  const int spans = count - degree;
  std::vector<double> knots(static_cast<std::size_t>(count + degree + 1), 0.0);
  for (int i = 0; i < static_cast<int>(knots.size()); ++i) {
    const int k = std::clamp(i - degree, 0, spans);
    knots[static_cast<std::size_t>(i)] = k / double(spans);
  }
  return knots;
}

std::vector<Knot> inner_knots(const std::vector<double>& knots, int degree) {
  std::vector<Knot> inner;
  const auto p = static_cast<std::size_t>(degree);
  for (std::size_t i = p + 1; i + p + 1 < knots.size(); ++i) {
    if (inner.empty() || inner.back().value != knots[i]) inner.push_back({knots[i], 0});
    ++inner.back().multiplicity;
  }
  return inner;
}

int find_span(const std::vector<double>& knots, int degree, int count, double t) {
  // knots[degree] and knots[count] are the ends of the domain. A t that is not a number ends in the last
  // span.
  const auto first = knots.begin() + degree + 1;
  const auto last = knots.begin() + count;
  return static_cast<int>(std::upper_bound(first, last, t) - knots.begin()) - 1;
}

Box3 bounds(const NurbsCurve& curve) {
  return bounds_of(curve.points);
}
Box3 bounds(const NurbsSurface& surface) {
  return bounds_of(surface.points);
}

}  // namespace burin::geom
