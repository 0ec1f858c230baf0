// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/closest_cell.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace burin::geom::detail {
namespace {

/// Patches with more control points are bounded by planes only: the product grows with the square of them.
constexpr int kMaxForSquare = 64;

Vec3 projected(const HPoint& h) {
  return {h.x / h.w, h.y / h.w, h.z / h.w};
}

double binomial(int n, int k) {
  double b = 1;
  for (int i = 1; i <= k; ++i) b = b * (n - k + i) / i;
  return b;
}

}  // namespace

/// Half space: with unit n every point of the patch has n . X >= the least of the control points.
double Cell::lower_by_plane(Vec3 toward) const {
  const Vec3 n = unit(toward);
  double least = std::numeric_limits<double>::infinity();
  for (const HPoint& h : net) least = std::min(least, dot(n, projected(h)));
  return least;
}

/// |X|^2 = N / W with N = |w X|^2 and W = w^2 as Bernstein polynomials of twice the degree: not less than the
/// least N_k / W_k. Exact where the distance does not change (centre of a sphere, axis of a cylinder).
double Cell::lower_by_square() {
  const int nu = 2 * p + 1, nv = 2 * q + 1;
  std::vector<double> numerator(static_cast<std::size_t>(nu * nv), 0.0), weight(numerator);
  std::array<double, kMaxForSquare> bu{}, bv{};  // binomials
  for (int i = 0; i <= p; ++i) bu[static_cast<std::size_t>(i)] = binomial(p, i);
  for (int j = 0; j <= q; ++j) bv[static_cast<std::size_t>(j)] = binomial(q, j);
  double largest = 0;
  const int n = static_cast<int>(net.size());
  for (int a = 0; a < n; ++a) {
    const int ia = a % (p + 1), ja = a / (p + 1);
    const HPoint& x = net[static_cast<std::size_t>(a)];
    const Vec3 e = projected(x);
    largest = std::max(largest, dot(e, e));
    const double fa = bu[static_cast<std::size_t>(ia)] * bv[static_cast<std::size_t>(ja)];
    for (int b = a; b < n; ++b) {
      const int ib = b % (p + 1), jb = b / (p + 1);
      const HPoint& y = net[static_cast<std::size_t>(b)];
      const double f =
          (a == b ? 1 : 2) * fa * bu[static_cast<std::size_t>(ib)] * bv[static_cast<std::size_t>(jb)];
      const auto k = static_cast<std::size_t>(ia + ib + (ja + jb) * nu);
      numerator[k] += f * (x.x * y.x + x.y * y.y + x.z * y.z);
      weight[k] += f * (x.w * y.w);
    }
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < weight.size(); ++k) {
    numerator[k] /= weight[k];
    least = std::min(least, numerator[k]);
  }
  varies_u_ = varies_v_ = 0;
  for (int l = 0; l < nv; ++l) {
    for (int k = 0; k < nu; ++k) {
      const auto i = static_cast<std::size_t>(k + l * nu);
      if (k > 0) varies_u_ = std::max(varies_u_, nu * std::abs(numerator[i] - numerator[i - 1]));
      if (l > 0) {
        varies_v_ =
            std::max(varies_v_, nv * std::abs(numerator[i] - numerator[i - static_cast<std::size_t>(nu)]));
      }
    }
  }
  // Sums of up to n products, each rounded relative to the largest.
  least -= 4 * n * std::numeric_limits<double>::epsilon() * largest;
  return least > 0 ? std::sqrt(least) : 0;
}

/// Bounds of the derivatives: legs of the control net times degree.
void Cell::measure_legs() {
  varies_u_ = varies_v_ = 0;
  for (int j = 0; j <= q; ++j) {
    for (int i = 0; i <= p; ++i) {
      const Vec3 x = projected(at(i, j));
      if (i > 0) varies_u_ = std::max(varies_u_, p * norm(x - projected(at(i - 1, j))));
      if (j > 0) varies_v_ = std::max(varies_v_, q * norm(x - projected(at(i, j - 1))));
    }
  }
}

Cell::Bounds Cell::bounds() {
  Bounds b;
  b.corner = std::numeric_limits<double>::infinity();
  Vec3 sum;
  for (const int j : {0, q}) {
    for (const int i : {0, p}) {
      const Vec3 x = projected(at(i, j));
      sum = sum + x;
      if (const double d = norm(x); d < b.corner) {
        b.corner = d;
        b.corner_u = i == 0 ? u.lo : u.hi;
        b.corner_v = j == 0 ? v.lo : v.hi;
      }
    }
  }
  b.lower = std::max(0.0, lower_by_plane(sum));
  if (static_cast<int>(net.size()) <= kMaxForSquare) {
    b.lower = std::max(b.lower, lower_by_square());
  } else {
    measure_legs();
  }
  return b;
}

bool Cell::can_be_split() const {
  const auto can = [](Interval t) {
    const double m = 0.5 * (t.lo + t.hi);
    return t.lo < m && m < t.hi;
  };
  return can(u) && can(v);
}

std::pair<Cell, Cell> Cell::split() const {
  std::pair<Cell, Cell> parts{*this, *this};
  auto& [a, b] = parts;
  if (varies_u_ >= varies_v_) {
    a.u.hi = b.u.lo = 0.5 * (u.lo + u.hi);
    for (int j = 0; j <= q; ++j) {
      for (int level = 1; level <= p; ++level) {
        a.at(level - 1, j) = b.at(0, j);
        for (int i = 0; i <= p - level; ++i) b.at(i, j) = 0.5 * (b.at(i, j) + b.at(i + 1, j));
      }
      a.at(p, j) = b.at(0, j);
    }
  } else {
    a.v.hi = b.v.lo = 0.5 * (v.lo + v.hi);
    for (int i = 0; i <= p; ++i) {
      for (int level = 1; level <= q; ++level) {
        a.at(i, level - 1) = b.at(i, 0);
        for (int j = 0; j <= q - level; ++j) b.at(i, j) = 0.5 * (b.at(i, j) + b.at(i, j + 1));
      }
      a.at(i, q) = b.at(i, 0);
    }
  }
  return parts;
}

}  // namespace burin::geom::detail
