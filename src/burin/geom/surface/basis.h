// SPDX-License-Identifier: Apache-2.0
// B-spline basis functions and the rational quotient rule. Internal to geom/surface.
#pragma once

#include <array>
#include <vector>

#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/nurbs.h"

namespace burin::geom::detail {

inline constexpr int kMaxOrder = 3;  ///< highest derivative that is asked for

/// t in the domain; not-a-number stays.
inline double clamped(const std::vector<double>& knots, double t) {
  return t < knots.front() ? knots.front() : t > knots.back() ? knots.back() : t;
}

/// find_span for Side::right; for Side::left the span that ends at t when t is an inner knot.
int span_at(const std::vector<double>& knots, int degree, int count, double t, Side side);

/// Ends of the spans within t: t.lo, the knots between, t.hi.
std::vector<double> spans_in(const std::vector<double>& knots, Interval t);

/// value[k][j]: k-th derivative of N_{span - degree + j} at t, k = 0..order. The NURBS Book, A2.3.
struct Basis {
  std::array<std::array<double, kMaxSurfaceDegree + 1>, kMaxOrder + 1> value;
};
void basis_derivatives(const std::vector<double>& knots, int degree, int span, double t, int order,
                       Basis& out);

}  // namespace burin::geom::detail
