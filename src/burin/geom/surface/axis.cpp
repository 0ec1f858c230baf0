// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace burin::geom::detail {
namespace {

/// Larger tables of matrices are not kept; the matrices are then made when a piece is entered.
constexpr std::size_t kMaxTable = std::size_t{1} << 17;  // doubles, 1 MB
constexpr int kBucketsAPiece = 16, kMaxBuckets = 1 << 13;

std::size_t squared(int degree) {
  const auto n = static_cast<std::size_t>(degree) + 1;
  return n * n;
}

double binomial(int n, int k) {
  double b = 1;
  for (int i = 1; i <= k; ++i) b = b * (n - k + i) / i;
  return b;
}

/// Coefficients of x^k in the Bernstein polynomial r over [-1, 1]: C(p, r) ((1-x)/2)^(p-r) ((1+x)/2)^r.
/// Exact for the small degrees it is used for.
std::array<double, kMaxPowerDegree + 1> bernstein_powers(int p, int r) {
  std::array<double, kMaxPowerDegree + 1> c{};
  c[0] = std::ldexp(binomial(p, r), -p);
  for (int f = 0; f < p; ++f) {
    const double sign = f < r ? 1 : -1;
    for (int k = f + 1; k > 0; --k)
      c[static_cast<std::size_t>(k)] += sign * c[static_cast<std::size_t>(k) - 1];
  }
  return c;
}

}  // namespace

Axis::Axis(const std::vector<double>& knots, int degree) : degree_(degree), knots_(knots) {
  const auto p = static_cast<std::size_t>(degree);
  for (std::size_t k = p; k + p + 1 < knots.size(); ++k) {
    if (!(knots[k] < knots[k + 1])) continue;
    breaks_.push_back(knots[k]);
    first_.push_back(static_cast<int>(k - p));
  }
  breaks_.push_back(knots.back());
  above_end_ = std::nextafter(knots.back(), std::numeric_limits<double>::infinity());
  make_lookup();
  const std::size_t size = squared(degree), all = size * first_.size();
  if (all > kMaxTable) return;
  bezier_.resize(all);
  for (int i = 0; i < pieces(); ++i) make_bezier(i, bezier_.data() + static_cast<std::size_t>(i) * size);
  if (degree > kMaxPowerDegree) return;
  power_.resize(all);
  for (int i = 0; i < pieces(); ++i) make_power(i, power_.data() + static_cast<std::size_t>(i) * size);
}

int Axis::bucket(double t) const {
  const double at = (t - breaks_.front()) * scale_;
  const auto most = static_cast<double>(last_.size() - 1);
  return static_cast<int>(at < 0 ? 0 : at < most ? at : most);
}

void Axis::make_lookup() {
  // bucket() does not decrease with t, rounding included: so piece i of a t in bucket k starts in bucket k or
  // before it, and the next piece starts in bucket k or after it.
  const int buckets =
      static_cast<int>(std::min<std::int64_t>(kBucketsAPiece * std::int64_t{pieces()}, kMaxBuckets));
  last_.assign(static_cast<std::size_t>(buckets), 0);
  scale_ = buckets / (breaks_.back() - breaks_.front());
  for (int i = 0; i < pieces(); ++i) last_[static_cast<std::size_t>(bucket(lo(i)))] = i;
  for (std::size_t k = 1; k < last_.size(); ++k) last_[k] = std::max(last_[k], last_[k - 1]);
}

int Axis::piece(double t) const {
  if (!(t > breaks_.front())) return 0;
  const auto k = static_cast<std::size_t>(bucket(t));
  const int first = k == 0 ? 0 : last_[k - 1], last = last_[k];
  // Hardly ever more than one piece begins in a bucket: no branch for that, places come in any order.
  const int next = first + static_cast<int>(lo(std::min(first + 1, last)) <= t && first < last);
  if (next == last || !(lo(next + 1) <= t)) return next;
  const auto from = breaks_.begin() + next + 1, to = breaks_.begin() + last + 1;
  return static_cast<int>(std::upper_bound(from, to, t) - breaks_.begin()) - 1;
}

void Axis::make_bezier(int piece, double* out) const {
  // Bezier point r is the blossom at p - r times lo and r times hi; all combinations are convex.
  const int p = degree_, n = p + 1;
  const double* const knot = knots_.data() + first_point(piece);  // knot[i + p] .. acts on point i
  std::vector<double> d(squared(p));
  const auto at = [n](int row, int column) { return static_cast<std::size_t>(row * n + column); };
  for (int r = 0; r <= p; ++r) {
    std::fill(d.begin(), d.end(), 0.0);
    for (int i = 0; i <= p; ++i) d[at(i, i)] = 1;
    for (int level = 1; level <= p; ++level) {
      const double t = level <= r ? hi(piece) : lo(piece);
      for (int i = p; i >= level; --i) {
        const double a = knot[i], b = knot[i + p + 1 - level];
        const double f = (t - a) / (b - a), g = (b - t) / (b - a);
        for (int c = 0; c <= p; ++c) d[at(i, c)] = g * d[at(i - 1, c)] + f * d[at(i, c)];
      }
    }
    std::copy_n(d.begin() + p * n, n, out + r * n);
  }
}

void Axis::make_power(int piece, double* out) const {
  const int p = degree_, n = p + 1;
  std::array<double, (kMaxPowerDegree + 1) * (kMaxPowerDegree + 1)> e;
  make_bezier(piece, e.data());
  std::fill_n(out, n * n, 0.0);
  for (int r = 0; r <= p; ++r) {
    const auto c = bernstein_powers(p, r);
    for (int k = 0; k <= p; ++k) {
      for (int i = 0; i <= p; ++i) {
        out[k * n + i] += c[static_cast<std::size_t>(k)] * e[static_cast<std::size_t>(r * n + i)];
      }
    }
  }
  const double to_unit = 2 / (hi(piece) - lo(piece));
  double scale = 1;
  for (int k = 0; k <= p; ++k, scale *= to_unit) {
    for (int i = 0; i <= p; ++i) out[k * n + i] *= scale;
  }
}

const double* Axis::bezier(int piece, std::vector<double>& space) const {
  const std::size_t size = squared(degree_);
  if (!bezier_.empty()) return bezier_.data() + static_cast<std::size_t>(piece) * size;
  space.resize(size);
  make_bezier(piece, space.data());
  return space.data();
}

const double* Axis::power(int piece, std::vector<double>& space) const {
  const std::size_t size = squared(degree_);
  if (!power_.empty()) return power_.data() + static_cast<std::size_t>(piece) * size;
  space.resize(size);
  make_power(piece, space.data());
  return space.data();
}

}  // namespace burin::geom::detail
