// SPDX-License-Identifier: Apache-2.0
// Cubic B-spline function of one variable over any knots: what lifts are made of.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace burin::cycle {

class CubicFunction {
 public:
  /// `breaks` strictly ascending, at least two. The function has breaks.size() + 2 coefficients.
  explicit CubicFunction(std::vector<double> breaks);

  std::size_t count() const { return coefficients_.size(); }
  std::vector<double>& coefficients() { return coefficients_; }
  /// Where coefficient i acts most (Greville).
  double place(std::size_t i) const;
  /// First of the four coefficients that act at x.
  std::size_t first_at(double x) const;
  std::vector<double> breaks() const { return {knots_.begin() + 3, knots_.end() - 3}; }
  /// Value and two derivatives.
  std::array<double, 3> at(double x) const;

 private:
  std::vector<double> knots_;
  std::vector<double> coefficients_;
};

}  // namespace burin::cycle
