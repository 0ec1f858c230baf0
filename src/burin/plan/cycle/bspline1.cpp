// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/bspline1.h"

#include <algorithm>

namespace burin::cycle {

CubicFunction::CubicFunction(std::vector<double> breaks) {
  knots_.assign(3, breaks.front());
  knots_.insert(knots_.end(), breaks.begin(), breaks.end());
  knots_.insert(knots_.end(), 3, breaks.back());
  coefficients_.assign(breaks.size() + 2, 0.0);
}

double CubicFunction::place(std::size_t i) const {
  return (knots_[i + 1] + knots_[i + 2] + knots_[i + 3]) / 3;
}

std::size_t CubicFunction::first_at(double x) const {
  const auto it = std::upper_bound(knots_.begin() + 4, knots_.end() - 4, x);
  return static_cast<std::size_t>(it - knots_.begin()) - 4;
}

std::array<double, 3> CubicFunction::at(double x) const {
  x = std::clamp(x, knots_.front(), knots_.back());
  const std::size_t f = first_at(x), k = f + 3;  // knots_[k] <= x <= knots_[k + 1]
  // De Boor's triangle for the function and those of its derivatives (The NURBS Book, A3.1 and eq. 3.8).
  const auto deboor = [&](std::array<double, 4> c, int degree) {
    for (int r = 1; r <= degree; ++r)
      for (int j = degree; j >= r; --j) {
        const std::size_t i = k - static_cast<std::size_t>(degree - j);
        const double lo = knots_[i], hi = knots_[i + static_cast<std::size_t>(degree - r + 1)];
        const double a = (x - lo) / (hi - lo);
        c[static_cast<std::size_t>(j)] =
            (1 - a) * c[static_cast<std::size_t>(j - 1)] + a * c[static_cast<std::size_t>(j)];
      }
    return c[static_cast<std::size_t>(degree)];
  };
  std::array<double, 4> c{};
  for (std::size_t j = 0; j < 4; ++j) c[j] = coefficients_[f + j];
  std::array<double, 4> d{}, dd{};
  for (std::size_t j = 0; j < 3; ++j) d[j] = 3 * (c[j + 1] - c[j]) / (knots_[f + j + 4] - knots_[f + j + 1]);
  for (std::size_t j = 0; j < 2; ++j) dd[j] = 2 * (d[j + 1] - d[j]) / (knots_[f + j + 4] - knots_[f + j + 2]);
  return {deboor(c, 3), deboor(d, 2), deboor(dd, 1)};
}

}  // namespace burin::cycle
