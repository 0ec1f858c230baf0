// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace burin::cycle {
namespace {

// Slope at x[0] of the polynomial through up to four points.
double end_slope(const double* x, const double* y, std::size_t count, std::ptrdiff_t step) {
  const std::size_t n = std::min<std::size_t>(count, 4);
  double slope = 0;
  for (std::size_t i = 1; i < n; ++i) {
    // Lagrange: the derivative at x0 is sum (y_i - y_0) prod_{j != i, 0} (x0 - x_j) / prod_{j != i} (x_i -
    // x_j).
    const auto at = [&](std::size_t k) { return x[static_cast<std::ptrdiff_t>(k) * step]; };
    double f = (y[static_cast<std::ptrdiff_t>(i) * step] - y[0]) / (at(i) - at(0));
    for (std::size_t j = 1; j < n; ++j)
      if (j != i) f *= (at(0) - at(j)) / (at(i) - at(j));
    slope += f;
  }
  // Where the data turn steeply (a path that meets the border nearly square to the others) the polynomial
  // would swing: no more than thrice the slope of the end's own interval.
  const double secant = (y[step] - y[0]) / (x[step] - x[0]);
  if (n > 2)
    slope = secant >= 0 ? std::clamp(slope, -secant, 3 * secant) : std::clamp(slope, 3 * secant, -secant);
  return slope;
}

// Index of the interval that holds s.
std::size_t interval_of(const std::vector<double>& t, double s) {
  const auto it = std::upper_bound(t.begin() + 1, t.end() - 1, s);
  return static_cast<std::size_t>(it - t.begin()) - 1;
}

// The piece i of the graph minus the line a + b t, as a cubic in x = t - t_i.
std::array<double, 4> cubic_minus_line(const Graph& g, std::size_t i, double a, double b) {
  const double h = g.t[i + 1] - g.t[i];
  const double slope = (g.w[i + 1] - g.w[i]) / h - h * (2 * g.m[i] + g.m[i + 1]) / 6;
  return {g.w[i] - (a + b * g.t[i]), slope - b, g.m[i] / 2, (g.m[i + 1] - g.m[i]) / (6 * h)};
}

double value(const std::array<double, 4>& c, double x) {
  return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
}

// Roots in [x0, x1) of a cubic: bisection between its turning points, to the last bit that matters.
void roots(const std::array<double, 4>& c, double x0, double x1, double offset, std::vector<double>& out) {
  std::array<double, 4> cut{x0, x1, x1, x1};
  std::size_t n = 1;
  const double qa = 3 * c[3], qb = 2 * c[2], qc = c[1];
  const double disc = qb * qb - 4 * qa * qc;
  if (disc > 0) {
    const double q = -0.5 * (qb + std::copysign(std::sqrt(disc), qb));
    std::array<double, 2> turning{qa != 0 ? q / qa : x0, q != 0 ? qc / q : x0};
    std::sort(turning.begin(), turning.end());
    for (const double r : turning)
      if (r > cut[n - 1] && r < x1) cut[n++] = r;
  }
  cut[n++] = x1;
  for (std::size_t k = 0; k + 1 < n; ++k) {
    double lo = cut[k], hi = cut[k + 1];
    const double flo = value(c, lo), fhi = value(c, hi);
    if (flo == 0) {
      out.push_back(offset + lo);
      continue;
    }
    if (fhi == 0 || (flo < 0) == (fhi < 0)) continue;
    for (int it = 0; it < 80 && lo < hi; ++it) {
      const double mid = 0.5 * (lo + hi);
      if (mid <= lo || mid >= hi) break;
      ((value(c, mid) < 0) == (flo < 0) ? lo : hi) = mid;
    }
    out.push_back(offset + 0.5 * (lo + hi));
  }
}

}  // namespace

UvPoint Graph::at(double s) const {
  s = std::clamp(s, lo(), hi());
  const std::size_t i = interval_of(t, s);
  const std::array<double, 4> c = cubic_minus_line(*this, i, 0, 0);
  const double x = s - t[i];
  return {s, value(c, x), 1, c[1] + x * (2 * c[2] + 3 * x * c[3]), 0, 2 * c[2] + 6 * x * c[3]};
}

Graph constant(double t0, double t1, double w) {
  return {{t0, t1}, {w, w}, {0, 0}};
}

Graph spline(std::vector<double> t, std::vector<double> w) {
  const std::size_t n = t.size();
  Graph g{std::move(t), std::move(w), std::vector<double>(n, 0.0)};
  const double first = end_slope(&g.t.front(), &g.w.front(), n, 1);
  const double last = end_slope(&g.t.back(), &g.w.back(), n, -1);
  // Tridiagonal system of the complete spline (Thomas algorithm; diagonally dominant).
  std::vector<double> c(n, 0.0), d(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double hl = i > 0 ? g.t[i] - g.t[i - 1] : 0, hr = i + 1 < n ? g.t[i + 1] - g.t[i] : 0;
    const double left = i > 0 ? (g.w[i] - g.w[i - 1]) / hl : first;
    const double right = i + 1 < n ? (g.w[i + 1] - g.w[i]) / hr : last;
    const double a = hl, b = 2 * (hl + hr), rhs = 6 * (right - left);
    const double pivot = b - (i > 0 ? a * c[i - 1] : 0);
    c[i] = hr / pivot;
    d[i] = (rhs - (i > 0 ? a * d[i - 1] : 0)) / pivot;
  }
  for (std::size_t i = n; i-- > 0;) g.m[i] = d[i] - (i + 1 < n ? c[i] * g.m[i + 1] : 0);
  return g;
}

std::vector<double> crossings(const Graph& graph, double level) {
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < graph.t.size(); ++i) {
    const double h = graph.t[i + 1] - graph.t[i];
    const auto c = cubic_minus_line(graph, i, level, 0);
    // All of it on the level: nothing is crossed.
    if (c[0] == 0 && c[1] == 0 && c[2] == 0 && c[3] == 0) continue;
    roots(c, 0, h, graph.t[i], out);
  }
  std::erase_if(out, [&](double s) { return !(s > graph.lo() && s < graph.hi()); });
  return out;
}

std::vector<double> crossings(const Graph& graph, geom::Point2 a, geom::Point2 b) {
  std::vector<double> out;
  if (a.x > b.x) std::swap(a, b);
  if (b.x < graph.lo() || a.x > graph.hi()) return out;
  if (a.x == b.x) {
    const double w = graph.at(a.x).w;
    if (w >= std::min(a.y, b.y) && w <= std::max(a.y, b.y)) out.push_back(a.x);
    return out;
  }
  const double slope = (b.y - a.y) / (b.x - a.x);
  for (std::size_t i = interval_of(graph.t, a.x); i + 1 < graph.t.size() && graph.t[i] <= b.x; ++i) {
    const double x0 = std::max(a.x, graph.t[i]), x1 = std::min(b.x, graph.t[i + 1]);
    if (!(x0 <= x1)) continue;
    const auto c = cubic_minus_line(graph, i, a.y - slope * a.x, slope);
    if (c[0] == 0 && c[1] == 0 && c[2] == 0 && c[3] == 0) continue;
    roots(c, x0 - graph.t[i], x1 - graph.t[i], graph.t[i], out);
  }
  return out;
}

}  // namespace burin::cycle
