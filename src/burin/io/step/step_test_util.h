// SPDX-License-Identifier: Apache-2.0
// For the tests of this folder: evaluation straight from the definition, and parts made with OpenCASCADE.
#pragma once

#include <TopoDS_Shape.hxx>
#include <random>
#include <string>

#include "burin/geom/surface/nurbs.h"

namespace burin::io::step::test {

/// Basis function by the recursion of Cox and de Boor, not by the library.
inline double basis(const std::vector<double>& knots, int i, int degree, double t) {
  const auto k = [&](int j) { return knots[static_cast<std::size_t>(j)]; };
  if (degree == 0) {
    const bool last = t == knots.back() && k(i) < k(i + 1) && k(i + 1) == knots.back();
    return (k(i) <= t && t < k(i + 1)) || last ? 1 : 0;
  }
  double sum = 0;
  if (k(i + degree) > k(i)) sum += (t - k(i)) / (k(i + degree) - k(i)) * basis(knots, i, degree - 1, t);
  if (k(i + degree + 1) > k(i + 1))
    sum += (k(i + degree + 1) - t) / (k(i + degree + 1) - k(i + 1)) * basis(knots, i + 1, degree - 1, t);
  return sum;
}

inline geom::Point3 evaluate(const geom::NurbsSurface& s, double u, double v) {
  geom::HPoint sum{0, 0, 0, 0};
  for (int j = 0; j < s.count_v; ++j) {
    const double b = basis(s.knots_v, j, s.degree_v, v);
    if (b == 0) continue;
    for (int i = 0; i < s.count_u; ++i) sum = sum + b * basis(s.knots_u, i, s.degree_u, u) * s.at(i, j);
  }
  return project(sum);
}

/// A wavy rational surface over uneven knots, one knot doubled.
geom::NurbsSurface random_surface(std::mt19937& random, int degree_u, int degree_v, int count_u, int count_v);

/// The shape as a file in this unit ("MM", "INCH", "M").
std::string step_text(const TopoDS_Shape& shape, const std::string& unit = "MM");
/// `as_brep`: with topology (186), else as trimmed surfaces (144).
std::string iges_text(const TopoDS_Shape& shape, bool as_brep, const std::string& unit = "MM");

}  // namespace burin::io::step::test
