// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/rows.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace burin::geom::detail {
namespace {

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

int multiplicity(const std::vector<double>& knots, double value) {
  const auto [first, last] = std::equal_range(knots.begin(), knots.end(), value);
  return static_cast<int>(last - first);
}

/// What of `values` can really be inserted.
std::vector<double> insertable(const Rows& rows, std::span<const double> values) {
  std::vector<double> out;
  for (const double value : values) {
    if (!(value > rows.knots.front() && value < rows.knots.back())) continue;
    assert(out.empty() || out.back() <= value);
    const int there = multiplicity(rows.knots, value) + multiplicity(out, value);
    if (there < rows.degree) out.push_back(value);
  }
  return out;
}

/// The longest piece inside the support of the elevated control point i: the best conditioned one.
int longest_span(const std::vector<double>& knots, double lo, double hi) {
  int best = -1;
  double longest = 0;
  auto it = std::lower_bound(knots.begin(), knots.end(), lo);
  for (; it != knots.end() && it + 1 != knots.end() && *(it + 1) <= hi; ++it) {
    if (*(it + 1) - *it > longest) {
      longest = *(it + 1) - *it;
      best = static_cast<int>(it - knots.begin());
    }
  }
  return best;
}

/// The polar form of the polynomial piece on [knots[span], knots[span + 1]], which must not be empty:
/// args.size() == degree.
std::vector<HPoint> blossom(const Rows& rows, int span, std::span<const double> args) {
  const int p = rows.degree;
  assert(static_cast<int>(args.size()) == p);
  const std::size_t width = index(rows.width);
  std::vector<HPoint> d(rows.row(span - p), rows.row(span + 1));
  const auto& t = rows.knots;
  for (int r = 1; r <= p; ++r) {
    for (int j = p; j >= r; --j) {
      const int i = span - p + j;
      const double lo = t[index(i)], hi = t[index(i + p + 1 - r)];
      const double alpha = (args[index(r - 1)] - lo) / (hi - lo);
      HPoint* right = d.data() + index(j) * width;
      const HPoint* left = right - width;
      for (std::size_t k = 0; k < width; ++k) right[k] = (1 - alpha) * left[k] + alpha * right[k];
    }
  }
  return {d.end() - rows.width, d.end()};
}

}  // namespace

Rows rows_of(const NurbsCurve& curve) {
  return {curve.degree, 1, curve.knots, curve.points};
}

Rows rows_of(const NurbsSurface& surface, Direction direction) {
  if (direction == Direction::v) return {surface.degree_v, surface.count_u, surface.knots_v, surface.points};
  Rows rows{surface.degree_u, surface.count_v, surface.knots_u, {}};
  rows.points.reserve(surface.points.size());
  for (int i = 0; i < surface.count_u; ++i)
    for (int j = 0; j < surface.count_v; ++j) rows.points.push_back(surface.at(i, j));
  return rows;
}

NurbsCurve curve_of(Rows rows) {
  return {rows.degree, std::move(rows.knots), std::move(rows.points)};
}

NurbsSurface surface_of(Rows rows, Direction direction, const NurbsSurface& like) {
  NurbsSurface out;
  const int count = rows.count();
  if (direction == Direction::v) {
    out.degree_u = like.degree_u;
    out.knots_u = like.knots_u;
    out.count_u = rows.width;
    out.degree_v = rows.degree;
    out.knots_v = std::move(rows.knots);
    out.count_v = count;
    out.points = std::move(rows.points);
    return out;
  }
  out.degree_v = like.degree_v;
  out.knots_v = like.knots_v;
  out.count_v = rows.width;
  out.degree_u = rows.degree;
  out.count_u = count;
  out.points.reserve(rows.points.size());
  for (int j = 0; j < rows.width; ++j)
    for (int i = 0; i < count; ++i) out.points.push_back(rows.row(i)[j]);
  out.knots_u = std::move(rows.knots);
  return out;
}

std::vector<HPoint> row_at(const Rows& rows, double t) {
  t = std::clamp(t, rows.knots.front(), rows.knots.back());
  const std::vector<double> args(index(rows.degree), t);
  return blossom(rows, find_span(rows.knots, rows.degree, rows.count(), t), args);
}

HPoint homogeneous_point(const NurbsCurve& curve, double t) {
  t = std::clamp(t, curve.knots.front(), curve.knots.back());
  const int p = curve.degree;
  const int span = find_span(curve.knots, p, static_cast<int>(curve.points.size()), t);
  std::vector<HPoint> d(curve.points.begin() + (span - p), curve.points.begin() + (span + 1));
  for (int r = 1; r <= p; ++r) {
    for (int j = p; j >= r; --j) {
      const int i = span - p + j;
      const double lo = curve.knots[index(i)], hi = curve.knots[index(i + p + 1 - r)];
      const double alpha = (t - lo) / (hi - lo);
      d[index(j)] = (1 - alpha) * d[index(j - 1)] + alpha * d[index(j)];
    }
  }
  return d.back();
}

// The NURBS Book, A5.4, for rows.
void insert(Rows& rows, std::span<const double> values) {
  const std::vector<double> x = insertable(rows, values);
  if (x.empty()) return;
  const int p = rows.degree, n = rows.count() - 1, r = static_cast<int>(x.size()) - 1;
  const auto& u = rows.knots;
  const int a = find_span(u, p, n + 1, x.front());
  const int b = find_span(u, p, n + 1, x.back()) + 1;

  Rows out{p, rows.width, std::vector<double>(u.size() + x.size()), {}};
  out.points.resize(rows.points.size() + x.size() * index(rows.width));
  const auto copy = [&](int to, const HPoint* from) { std::copy(from, from + rows.width, out.row(to)); };
  for (int j = 0; j <= a - p; ++j) copy(j, rows.row(j));
  for (int j = b - 1; j <= n; ++j) copy(j + r + 1, rows.row(j));
  for (int j = 0; j <= a; ++j) out.knots[index(j)] = u[index(j)];
  for (int j = b + p; j <= n + p + 1; ++j) out.knots[index(j + r + 1)] = u[index(j)];

  int i = b + p - 1, k = b + p + r;
  for (int j = r; j >= 0; --j) {
    while (x[index(j)] <= u[index(i)] && i > a) {
      copy(k - p - 1, rows.row(i - p - 1));
      out.knots[index(k)] = u[index(i)];
      --k;
      --i;
    }
    copy(k - p - 1, out.row(k - p));
    for (int l = 1; l <= p; ++l) {
      const int at = k - p + l;
      const double up = out.knots[index(k + l)] - x[index(j)];
      if (up == 0) {
        copy(at - 1, out.row(at));
        continue;
      }
      const double alpha = up / (out.knots[index(k + l)] - u[index(i - p + l)]);
      HPoint* left = out.row(at - 1);
      const HPoint* right = out.row(at);
      for (int c = 0; c < rows.width; ++c) left[c] = alpha * left[c] + (1 - alpha) * right[c];
    }
    out.knots[index(k)] = x[index(j)];
    --k;
  }
  rows = std::move(out);
}

// With F the polar form of degree p + 1 of a polynomial whose polar form of degree p is f:
// F(t_1 .. t_p+1) = mean over j of f(all but t_j). The new control points are F at p + 1 consecutive new
// knots.
void elevate_once(Rows& rows) {
  const int p = rows.degree;
  std::vector<double> knots;
  for (std::size_t i = 0; i < rows.knots.size(); ++i) {
    knots.push_back(rows.knots[i]);
    if (i + 1 == rows.knots.size() || rows.knots[i + 1] != rows.knots[i]) knots.push_back(rows.knots[i]);
  }
  const int count = static_cast<int>(knots.size()) - p - 2;
  Rows out{p + 1, rows.width, knots, {}};
  out.points.reserve(index(count) * index(rows.width));
  std::vector<double> args(index(p));
  for (int i = 0; i < count; ++i) {
    const int span = longest_span(rows.knots, knots[index(i)], knots[index(i + p + 2)]);
    std::vector<HPoint> sum(index(rows.width), HPoint{0, 0, 0, 0});
    double share = 0;
    for (int omit = 1; omit <= p + 1; ++omit) {
      // Equal knots give the same set: count it once with its multiplicity.
      share += 1;
      if (omit <= p && knots[index(i + omit + 1)] == knots[index(i + omit)]) continue;
      for (int j = 1, k = 0; j <= p + 1; ++j)
        if (j != omit) args[index(k++)] = knots[index(i + j)];
      const std::vector<HPoint> f = blossom(rows, span, args);
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] = sum[c] + (share / (p + 1)) * f[c];
      share = 0;
    }
    out.points.insert(out.points.end(), sum.begin(), sum.end());
  }
  // The ends are control points of both: keep them to the bit.
  std::copy(rows.row(0), rows.row(1), out.row(0));
  std::copy(rows.row(rows.count() - 1), rows.row(rows.count() - 1) + rows.width, out.row(count - 1));
  rows = std::move(out);
}

void reverse(Rows& rows) {
  const double sum = rows.knots.front() + rows.knots.back();
  const double lo = rows.knots.front(), hi = rows.knots.back();
  std::reverse(rows.knots.begin(), rows.knots.end());
  for (double& knot : rows.knots) knot = knot == hi ? lo : knot == lo ? hi : sum - knot;
  const int count = rows.count();
  for (int i = 0, j = count - 1; i < j; ++i, --j)
    std::swap_ranges(rows.row(i), rows.row(i) + rows.width, rows.row(j));
}

void map_domain(Rows& rows, Interval to) {
  const double lo = rows.knots.front(), hi = rows.knots.back();
  if (to.lo == lo && to.hi == hi) return;
  const double scale = to.length() / (hi - lo);
  for (double& knot : rows.knots)
    knot = knot == lo ? to.lo : knot == hi ? to.hi : std::clamp(to.lo + (knot - lo) * scale, to.lo, to.hi);
}

// q(s_1 .. s_p) = product of c(s_r) * f(t(s_1) .. t(s_p)) with c(s) = 1 + (alpha - 1) s' is affine in every
// argument, so it is the polar form of the new piece; the control points are its values at the new knots.
void bend(Rows& rows, double alpha) {
  if (alpha == 1) return;
  const double lo = rows.knots.front(), hi = rows.knots.back(), length = hi - lo;
  std::vector<double> factor(rows.knots.size());
  for (std::size_t i = 0; i < rows.knots.size(); ++i) {
    const double t = (rows.knots[i] - lo) / length;
    const double s = t / (alpha - (alpha - 1) * t);
    factor[i] = 1 + (alpha - 1) * s;
    if (rows.knots[i] != lo && rows.knots[i] != hi) rows.knots[i] = lo + length * s;
  }
  for (int i = 0; i < rows.count(); ++i) {
    double product = 1;
    for (int r = 1; r <= rows.degree; ++r) product *= factor[index(i + r)];
    for (HPoint* h = rows.row(i); h != rows.row(i + 1); ++h) *h = product * *h;
  }
}

Rows part(Rows rows, Interval part) {
  const int p = rows.degree;
  std::vector<double> values;
  values.insert(values.end(), index(p), part.lo);
  values.insert(values.end(), index(p), part.hi);
  insert(rows, values);
  // Control points first .. last belong to the part: the clamped ends interpolate.
  const auto& t = rows.knots;
  int first = 0;
  if (part.lo > t.front())
    first = static_cast<int>(std::lower_bound(t.begin(), t.end(), part.lo) - t.begin()) - 1;
  int last = rows.count() - 1;
  if (part.hi < t.back())
    last = static_cast<int>(std::lower_bound(t.begin(), t.end(), part.hi) - t.begin()) - 1;
  Rows out{p, rows.width, {}, {rows.row(first), rows.row(last + 1)}};
  out.knots.push_back(part.lo);
  out.knots.insert(out.knots.end(), t.begin() + first + 1, t.begin() + last + p + 1);
  out.knots.push_back(part.hi);
  return out;
}

}  // namespace burin::geom::detail
