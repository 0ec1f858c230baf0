// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/bernstein.h"

#include <algorithm>
#include <cstring>

#include "burin/geom/surface/basis.h"
#include "burin/geom/surface/rational.h"

namespace burin::geom::detail {
namespace {

/// All Bernstein polynomials of degree p over [a, b] at t and their derivatives up to `order`.
void bernstein_basis(int p, double a, double b, double t, int order, Basis& out) {
  const double h = b - a, f = (t - a) / h, g = (b - t) / h;
  // Degree n from n - 1 in place; those of degree p - k, differenced k times, are the k-th derivatives.
  std::array<double, kMaxSurfaceDegree + 1> n{};
  n[0] = 1;
  for (int degree = 0; degree <= p; ++degree) {
    if (degree > 0) {
      for (int i = degree; i > 0; --i) n[i] = f * n[i - 1] + g * n[i];
      n[0] = g * n[0];
    }
    const int k = p - degree;
    if (k <= order) std::copy_n(n.begin(), p + 1, out.value[k].begin());
  }
  double factor = 1;
  for (int k = 1; k <= order; ++k) {
    auto& d = out.value[k];
    if (k > p) {
      std::fill_n(d.begin(), p + 1, 0.0);
      continue;
    }
    factor *= (p - k + 1) / h;
    for (int pass = 0; pass < k; ++pass) {
      for (int i = p; i > 0; --i) d[i] = d[i - 1] - d[i];
      d[0] = -d[0];
    }
    for (int i = 0; i <= p; ++i) d[i] *= factor;
  }
}

struct Sums {
  double a[4][4][4] = {};  // [derivatives in u][in v][coordinate]
};

void sum(const Piece& s, double u, double v, int order, Sums& out) {
  Basis nu, nv;
  bernstein_basis(s.p, s.u0, s.u1, u, order, nu);
  bernstein_basis(s.q, s.v0, s.v1, v, order, nv);
  for (int j = 0; j <= s.q; ++j) {
    const double* const row = s.c + 4 * j * (s.p + 1);
    for (int k = 0; k <= order; ++k) {
      double part[4] = {};
      for (int i = 0; i <= s.p; ++i) {
        for (int c = 0; c < 4; ++c) part[c] += nu.value[k][i] * row[4 * i + c];
      }
      for (int l = 0; k + l <= order; ++l) {
        for (int c = 0; c < 4; ++c) out.a[k][l][c] += nv.value[l][j] * part[c];
      }
    }
  }
}

HPoint at(const Sums& s, int k, int l) {
  return {s.a[k][l][0], s.a[k][l][1], s.a[k][l][2], s.a[k][l][3]};
}

HSurface named(const Sums& s) {
  return {at(s, 0, 0), at(s, 1, 0), at(s, 0, 1), at(s, 2, 0), at(s, 1, 1),
          at(s, 0, 2), at(s, 3, 0), at(s, 2, 1), at(s, 1, 2), at(s, 0, 3)};
}

}  // namespace

void bernstein(const Piece& piece, double u, double v, int order, double* out) {
  Sums s;
  sum(piece, u, v, order, s);
  if (order == 0) {
    const Point3 p = project(at(s, 0, 0));
    std::memcpy(out, &p, sizeof p);
  } else if (order == 2) {
    SurfaceDerivatives d;
    rational2(named(s), d);
    std::memcpy(out, &d, sizeof d);
  } else {
    SurfaceDerivatives3 d;
    rational3(named(s), d);
    std::memcpy(out, &d, sizeof d);
  }
}

}  // namespace burin::geom::detail
