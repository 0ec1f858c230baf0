// SPDX-License-Identifier: Apache-2.0
// Gauss-Legendre quadrature of a function of one number over [lo, hi]. n points are exact for polynomials of
// degree 2 n - 1.
#pragma once

namespace burin::geom {

template <class F>
double gauss5(const F& f, double lo, double hi) {
  constexpr double node[2] = {0.53846931010568309, 0.90617984593866399};
  constexpr double weight[3] = {0.56888888888888889, 0.47862867049936647, 0.23692688505618909};
  const double mid = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
  double sum = weight[0] * f(mid);
  for (int i = 0; i < 2; ++i) sum += weight[i + 1] * (f(mid - half * node[i]) + f(mid + half * node[i]));
  return half * sum;
}

template <class F>
double gauss10(const F& f, double lo, double hi) {
  constexpr double node[5] = {0.14887433898163122, 0.43339539412924719, 0.67940956829902441,
                              0.86506336668898451, 0.97390652851717172};
  constexpr double weight[5] = {0.29552422471475287, 0.26926671930999636, 0.21908636251598204,
                                0.14945134915058059, 0.06667134430868814};
  const double mid = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
  double sum = 0;
  for (int i = 0; i < 5; ++i) sum += weight[i] * (f(mid - half * node[i]) + f(mid + half * node[i]));
  return half * sum;
}

}  // namespace burin::geom
