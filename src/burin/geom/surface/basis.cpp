// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/basis.h"

#include <algorithm>

namespace burin::geom::detail {

int span_at(const std::vector<double>& knots, int degree, int count, double t, Side side) {
  const int span = find_span(knots, degree, count, t);
  if (side == Side::right || t != knots[static_cast<std::size_t>(span)] || t == knots.front()) return span;
  const auto first = knots.begin() + degree + 1;
  const auto last = knots.begin() + count;
  return static_cast<int>(std::lower_bound(first, last, t) - knots.begin()) - 1;
}

std::vector<double> spans_in(const std::vector<double>& knots, Interval t) {
  std::vector<double> at{t.lo};
  for (const double knot : knots)
    if (knot > at.back() && knot < t.hi) at.push_back(knot);
  at.push_back(t.hi);
  return at;
}

void basis_derivatives(const std::vector<double>& knots, int degree, int span, double t, int order,
                       Basis& out) {
  constexpr int kSize = kMaxSurfaceDegree + 1;
  const int p = degree;
  const double* const knot = knots.data() + span;
  double left[kSize], right[kSize];
  double ndu[kSize][kSize];  // upper triangle: basis functions, lower: knot differences
  ndu[0][0] = 1;
  for (int j = 1; j <= p; ++j) {
    left[j] = t - knot[1 - j];
    right[j] = knot[j] - t;
    double saved = 0;
    for (int r = 0; r < j; ++r) {
      ndu[j][r] = right[r + 1] + left[j - r];
      const double term = ndu[r][j - 1] / ndu[j][r];
      ndu[r][j] = saved + right[r + 1] * term;
      saved = left[j - r] * term;
    }
    ndu[j][j] = saved;
  }
  for (int j = 0; j <= p; ++j) out.value[0][j] = ndu[j][p];
  for (int k = p + 1; k <= order; ++k) std::fill_n(out.value[k].begin(), p + 1, 0.0);

  const int most = std::min(order, p);
  for (int r = 0; r <= p; ++r) {
    double a[2][kSize];
    int s1 = 0, s2 = 1;
    a[0][0] = 1;
    for (int k = 1; k <= most; ++k) {
      double d = 0;
      const int rk = r - k, pk = p - k;
      if (r >= k) {
        a[s2][0] = a[s1][0] / ndu[pk + 1][rk];
        d = a[s2][0] * ndu[rk][pk];
      }
      const int j1 = rk >= -1 ? 1 : -rk;
      const int j2 = r - 1 <= pk ? k - 1 : p - r;
      for (int j = j1; j <= j2; ++j) {
        a[s2][j] = (a[s1][j] - a[s1][j - 1]) / ndu[pk + 1][rk + j];
        d += a[s2][j] * ndu[rk + j][pk];
      }
      if (r <= pk) {
        a[s2][k] = -a[s1][k - 1] / ndu[pk + 1][r];
        d += a[s2][k] * ndu[r][pk];
      }
      out.value[k][r] = d;
      std::swap(s1, s2);
    }
  }
  double factor = p;
  for (int k = 1; k <= most; ++k) {
    for (int j = 0; j <= p; ++j) out.value[k][j] *= factor;
    factor *= p - k;
  }
}

}  // namespace burin::geom::detail
