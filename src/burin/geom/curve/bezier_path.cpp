// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/bezier_path.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace burin::geom::fit {

namespace {

constexpr int kBinomialRows = 4 * kMaxDegree + 1;

constexpr std::array<std::array<double, kBinomialRows>, kBinomialRows> make_binomials() {
  std::array<std::array<double, kBinomialRows>, kBinomialRows> table{};
  for (std::size_t n = 0; n < kBinomialRows; ++n) {
    table[n][0] = 1;
    for (std::size_t k = 1; k <= n; ++k) table[n][k] = table[n - 1][k - 1] + (k < n ? table[n - 1][k] : 0);
  }
  return table;
}
constexpr auto kBinomials = make_binomials();

Vec2 mix(Vec2 a, Vec2 b, double t) {
  return a + t * (b - a);
}
double mix(double a, double b, double t) {
  return a + t * (b - a);
}

/// de Casteljau on n + 1 coefficients: lower and upper may be null.
template <class T>
void split_coefficients(const T* c, int n, double t, T* lower, T* upper) {
  std::array<T, 2 * kMaxDegree> work;
  std::copy(c, c + n + 1, work.begin());
  for (int level = 0; level <= n; ++level) {
    if (lower) lower[level] = work[0];
    if (upper) upper[n - level] = work[static_cast<std::size_t>(n - level)];
    for (int i = 0; i < n - level; ++i) {
      const auto u = static_cast<std::size_t>(i);
      work[u] = mix(work[u], work[u + 1], t);
    }
  }
}

template <class T>
T evaluate(const T* c, int n, double t) {
  std::array<T, 2 * kMaxDegree> work;
  std::copy(c, c + n + 1, work.begin());
  for (int level = n; level > 0; --level) {
    for (int i = 0; i < level; ++i) {
      const auto u = static_cast<std::size_t>(i);
      work[u] = mix(work[u], work[u + 1], t);
    }
  }
  return work[0];
}

/// Divides out zeros at both ends: b_0 = 0 means a factor t. "Zero" is rounding of the control points.
void deflate(Bezier& b, double zero) {
  int n = b.hodograph_degree;
  while (n > 0 && norm(b.d[0]) <= zero) {
    for (int i = 0; i < n; ++i)
      b.d[static_cast<std::size_t>(i)] = b.d[static_cast<std::size_t>(i) + 1] * n / (i + 1.0);
    --n;
  }
  while (n > 0 && norm(b.d[static_cast<std::size_t>(n)]) <= zero) {
    for (int i = 0; i < n; ++i)
      b.d[static_cast<std::size_t>(i)] = b.d[static_cast<std::size_t>(i)] * n / (n - i * 1.0);
    --n;
  }
  b.hodograph_degree = n;
}

/// Fills d from x and w: X' for a polynomial piece, X' w - X w' for a rational one (about the first control
/// point, which changes nothing but the rounding).
void make_hodograph(Bezier& b) {
  const int p = b.degree;
  double size = 0, magnitude = 0;
  std::array<Vec2, kMaxDegree + 1> x;
  const Vec2 origin = b.x[0] / b.w[0];
  for (int i = 0; i <= p; ++i) {
    const auto u = static_cast<std::size_t>(i);
    x[u] = b.x[u] - b.w[u] * origin;
    size = std::max(size, norm(x[u]));
    magnitude = std::max({magnitude, std::abs(b.x[u].x), std::abs(b.x[u].y)});
  }
  // Control points that differ by rounding only count as coincident.
  constexpr double kCoincident = 8 * std::numeric_limits<double>::epsilon();
  const double zero = kCoincident * (p * magnitude + size);
  if (!b.rational) {
    b.hodograph_degree = p - 1;
    for (int i = 0; i < p; ++i) {
      const auto u = static_cast<std::size_t>(i);
      b.d[u] = p * (x[u + 1] - x[u]);
    }
    deflate(b, zero);
    return;
  }
  b.hodograph_degree = 2 * p - 1;
  for (int k = 0; k < 2 * p; ++k) {
    Vec2 sum;
    for (int i = std::max(0, k - p); i <= std::min(k, p - 1); ++i) {
      const auto u = static_cast<std::size_t>(i), v = static_cast<std::size_t>(k - i);
      const double scale = binomial(p - 1, i) * binomial(p, k - i);
      sum = sum + scale * p * (b.w[v] * (x[u + 1] - x[u]) - (b.w[u + 1] - b.w[u]) * x[v]);
    }
    b.d[static_cast<std::size_t>(k)] = sum / binomial(2 * p - 1, k);
  }
  deflate(b, zero);
}

/// Pieces of an elliptic arc of at most a quarter turn each, as rational quadratics.
Path path_of_ellipse(const EllipseArc2& e) {
  Path path;
  const int count = std::max(1, static_cast<int>(std::ceil(std::abs(e.sweep) / (kPi / 2) - 1e-9)));
  const double step = e.sweep / count;
  const auto at = [&](double u) { return e.center + std::cos(u) * e.major + std::sin(u) * e.minor; };
  for (int i = 0; i < count; ++i) {
    const double u0 = e.start + i * step, u1 = e.start + (i + 1) * step, mid = 0.5 * (u0 + u1);
    const double half = std::cos(0.5 * step);
    const Point2 a = at(u0), b = at(u1);
    const Point2 shoulder = e.center + (std::cos(mid) / half) * e.major + (std::sin(mid) / half) * e.minor;
    Bezier piece;
    piece.degree = 2;
    piece.rational = true;
    piece.x[0] = {a.x, a.y};
    piece.x[1] = {half * shoulder.x, half * shoulder.y};
    piece.x[2] = {b.x, b.y};
    piece.w[0] = piece.w[2] = 1;
    piece.w[1] = half;
    path.pieces.push_back(piece);
  }
  return path;
}

Path path_of_nurbs(const Nurbs2& curve) {
  Path path;
  for (const Nurbs2& source : bezier_pieces(curve)) {
    Bezier piece;
    piece.degree = source.degree;
    const double scale = source.weights.front();
    for (std::size_t i = 0; i < source.points.size(); ++i) {
      const double w = source.weights[i] / scale;
      piece.w[i] = w;
      piece.x[i] = {w * source.points[i].x, w * source.points[i].y};
      if (w != 1) piece.rational = true;
    }
    path.pieces.push_back(piece);
  }
  return path;
}

/// Whether all control points coincide within rounding: no length, no direction.
bool is_point(const Bezier& b, double magnitude) {
  const Vec2 origin = b.x[0] / b.w[0];
  double size = 0;
  for (int i = 0; i <= b.degree; ++i) {
    const auto u = static_cast<std::size_t>(i);
    size = std::max(size, norm(b.x[u] / b.w[u] - origin));
  }
  return size <= 16 * std::numeric_limits<double>::epsilon() * magnitude;
}

void finish(Path& path) {
  for (Bezier& b : path.pieces) {
    make_hodograph(b);
    for (int i = 0; i <= b.degree; ++i) {
      const auto u = static_cast<std::size_t>(i);
      path.magnitude = std::max({path.magnitude, std::abs(b.x[u].x / b.w[u]), std::abs(b.x[u].y / b.w[u])});
    }
  }
}

}  // namespace

double binomial(int n, int k) {
  return kBinomials[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)];
}

Bezier& Bezier::operator=(const Bezier& other) {
  degree = other.degree;
  hodograph_degree = other.hodograph_degree;
  rational = other.rational;
  std::copy(other.x.begin(), other.x.begin() + degree + 1, x.begin());
  std::copy(other.w.begin(), other.w.begin() + degree + 1, w.begin());
  std::copy(other.d.begin(), other.d.begin() + hodograph_degree + 1, d.begin());
  return *this;
}

void split(const Bezier& b, double t, Bezier* lower, Bezier* upper) {
  for (Bezier* half : {lower, upper}) {
    if (!half) continue;
    half->degree = b.degree;
    half->hodograph_degree = b.hodograph_degree;
    half->rational = b.rational;
    if (!b.rational) std::fill(half->w.begin(), half->w.begin() + b.degree + 1, 1.0);
  }
  split_coefficients(b.x.data(), b.degree, t, lower ? lower->x.data() : nullptr,
                     upper ? upper->x.data() : nullptr);
  split_coefficients(b.d.data(), b.hodograph_degree, t, lower ? lower->d.data() : nullptr,
                     upper ? upper->d.data() : nullptr);
  if (b.rational) {
    split_coefficients(b.w.data(), b.degree, t, lower ? lower->w.data() : nullptr,
                       upper ? upper->w.data() : nullptr);
  }
}

Bezier part(const Bezier& b, double t0, double t1) {
  Bezier result = b;
  if (t1 < 1) {
    const Bezier whole = result;
    split(whole, t1, &result, nullptr);
  }
  if (t0 > 0) {
    const Bezier whole = result;
    split(whole, std::min(1.0, t0 / t1), nullptr, &result);
  }
  return result;
}

Point2 Path::point(double tau) const {
  const auto last = static_cast<double>(pieces.size() - 1);
  const double k = std::clamp(std::floor(tau), 0.0, last);
  const Bezier& b = pieces[static_cast<std::size_t>(k)];
  const Vec2 x = evaluate(b.x.data(), b.degree, tau - k);
  const double w = b.rational ? evaluate(b.w.data(), b.degree, tau - k) : 1.0;
  return {x.x / w, x.y / w};
}

PointTangent Path::at(double tau) const {
  const auto last = static_cast<double>(pieces.size() - 1);
  const double k = std::clamp(std::floor(tau), 0.0, last);
  const Bezier& b = pieces[static_cast<std::size_t>(k)];
  return {point(tau), unit(evaluate(b.d.data(), b.hodograph_degree, tau - k))};
}

double PathOfCurve::tau_of(double t) const {
  for (std::size_t k = 0; k < t_end.size(); ++k) {
    if (t > t_end[k]) continue;
    const double f = (t - t_begin[k]) / (t_end[k] - t_begin[k]);
    return static_cast<double>(k) + std::clamp(f, 0.0, 1.0);
  }
  return path.end();
}

Result<PathOfCurve> path_of(const Curve2& curve) {
  Path all;
  std::vector<double> t;
  if (const auto* ellipse = std::get_if<EllipseArc2>(&curve)) {
    all = path_of_ellipse(*ellipse);
    const std::size_t count = all.pieces.size();
    for (std::size_t k = 0; k <= count; ++k) t.push_back(static_cast<double>(k) / static_cast<double>(count));
  } else if (const auto* nurbs = std::get_if<Nurbs2>(&curve)) {
    if (nurbs->degree > kMaxDegree) {
      return Error{ErrorCode::geometry,
                   "a spline of degree " + std::to_string(nurbs->degree) +
                       " cannot be fitted (degrees 1 to " + std::to_string(kMaxDegree) + ")",
                   {}};
    }
    all = path_of_nurbs(*nurbs);
    const auto first = static_cast<std::size_t>(nurbs->degree);
    const std::size_t last = nurbs->points.size();
    const double lo = nurbs->knots[first], hi = nurbs->knots[last];
    for (std::size_t i = first; i <= last; ++i) {
      if (i == first || nurbs->knots[i] > nurbs->knots[i - 1])
        t.push_back((nurbs->knots[i] - lo) / (hi - lo));
    }
  }
  finish(all);
  PathOfCurve kept;
  kept.path.magnitude = all.magnitude;
  for (std::size_t k = 0; k < all.pieces.size() && k + 1 < t.size(); ++k) {
    if (is_point(all.pieces[k], all.magnitude)) continue;
    kept.t_begin.push_back(t[k]);
    kept.t_end.push_back(t[k + 1]);
    kept.path.pieces.push_back(all.pieces[k]);
  }
  if (kept.path.pieces.empty()) {
    return Error{
        ErrorCode::geometry, "the curve has zero length (a curve with at least two different points)", {}};
  }
  return kept;
}

Path part(const Path& path, double tau0, double tau1) {
  Path result;
  result.magnitude = path.magnitude;
  for (double k = std::floor(tau0); k < tau1; ++k) {
    const double t0 = std::max(0.0, tau0 - k), t1 = std::min(1.0, tau1 - k);
    if (!(t0 < t1)) continue;
    Bezier piece = part(path.pieces[static_cast<std::size_t>(k)], t0, t1);
    // Cut at a cusp: the derivative is zero there up to the accuracy of the parameter, and its direction is
    // noise.
    constexpr double kCusp = 1e-7;
    double largest = 0;
    for (int i = 0; i <= piece.hodograph_degree; ++i) {
      largest = std::max(largest, norm(piece.d[static_cast<std::size_t>(i)]));
    }
    if (t0 > 0 || t1 < 1) deflate(piece, kCusp * largest);
    result.pieces.push_back(piece);
  }
  return result;
}

}  // namespace burin::geom::fit
