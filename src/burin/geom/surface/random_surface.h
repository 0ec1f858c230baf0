// SPDX-License-Identifier: Apache-2.0
// For tests only: seeded random surfaces, and evaluation straight from the definition (Cox-de Boor recursion
// and sums over all control points), independent of the library's own.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "burin/geom/surface/nurbs.h"

namespace burin::geom::test {

using Random = std::mt19937_64;

inline double uniform(Random& random, double lo, double hi) {
  return lo + (hi - lo) * (static_cast<double>(random() >> 11) * 0x1p-53);
}
inline int integer(Random& random, int lo, int hi) {
  return lo + static_cast<int>(random() % static_cast<std::uint64_t>(hi - lo + 1));
}

inline double basis(const std::vector<double>& t, int i, int p, double x) {
  const auto k = static_cast<std::size_t>(i);
  if (p == 0) {
    if (t[k] <= x && x < t[k + 1]) return 1;
    return x == t.back() && t[k] < t[k + 1] && t[k + 1] == t.back() ? 1 : 0;
  }
  const auto q = static_cast<std::size_t>(p);
  double sum = 0;
  if (t[k + q] > t[k]) sum += (x - t[k]) / (t[k + q] - t[k]) * basis(t, i, p - 1, x);
  if (t[k + q + 1] > t[k + 1])
    sum += (t[k + q + 1] - x) / (t[k + q + 1] - t[k + 1]) * basis(t, i + 1, p - 1, x);
  return sum;
}

inline Point3 by_definition(const NurbsSurface& s, double u, double v) {
  HPoint sum{0, 0, 0, 0};
  std::vector<double> nu, nv;
  for (int i = 0; i < s.count_u; ++i) nu.push_back(basis(s.knots_u, i, s.degree_u, u));
  for (int j = 0; j < s.count_v; ++j) nv.push_back(basis(s.knots_v, j, s.degree_v, v));
  for (int j = 0; j < s.count_v; ++j)
    for (int i = 0; i < s.count_u; ++i)
      sum = sum + nu[static_cast<std::size_t>(i)] * nv[static_cast<std::size_t>(j)] * s.at(i, j);
  return project(sum);
}

/// Inner knots with random multiplicities up to the degree.
inline std::vector<double> random_knots(Random& random, int count, int degree, double lo, double hi) {
  std::vector<double> inner;
  const int wanted = count - degree - 1;
  while (static_cast<int>(inner.size()) < wanted) {
    const double value = uniform(random, lo + 0.01 * (hi - lo), hi - 0.01 * (hi - lo));
    int times = std::min(
        {integer(random, 1, degree), integer(random, 1, degree), wanted - static_cast<int>(inner.size())});
    while (times-- > 0) inner.push_back(value);
  }
  std::sort(inner.begin(), inner.end());
  std::vector<double> knots(static_cast<std::size_t>(degree + 1), lo);
  knots.insert(knots.end(), inner.begin(), inner.end());
  knots.insert(knots.end(), static_cast<std::size_t>(degree + 1), hi);
  return knots;
}

/// About 100 x 100 x 20 mm over a plane, random degrees, knots, domains and weights.
inline NurbsSurface random_surface(Random& random, int max_degree = 4, int max_more = 4) {
  NurbsSurface s;
  s.degree_u = integer(random, 1, max_degree);
  s.degree_v = integer(random, 1, max_degree);
  s.count_u = s.degree_u + 1 + integer(random, 0, max_more);
  s.count_v = s.degree_v + 1 + integer(random, 0, max_more);
  const double u0 = uniform(random, -2, 2), v0 = uniform(random, -2, 2);
  s.knots_u = random_knots(random, s.count_u, s.degree_u, u0, u0 + uniform(random, 0.5, 3));
  s.knots_v = random_knots(random, s.count_v, s.degree_v, v0, v0 + uniform(random, 0.5, 3));
  for (int j = 0; j < s.count_v; ++j) {
    for (int i = 0; i < s.count_u; ++i) {
      const Point3 p{100.0 * i / (s.count_u - 1) + uniform(random, -5, 5),
                     100.0 * j / (s.count_v - 1) + uniform(random, -5, 5), uniform(random, -10, 10)};
      s.points.push_back(homogeneous(p, uniform(random, 0.5, 2)));
    }
  }
  return s;
}

inline double at_fraction(Interval t, double f) {
  return t.lo + f * (t.hi - t.lo);
}

}  // namespace burin::geom::test
