// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/nurbs.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace burin::geom {
namespace {

struct Homogeneous {
  double x = 0, y = 0, w = 0;
};
Homogeneous operator+(Homogeneous a, Homogeneous b) {
  return {a.x + b.x, a.y + b.y, a.w + b.w};
}
Homogeneous operator*(double s, Homogeneous a) {
  return {s * a.x, s * a.y, s * a.w};
}
Homogeneous blend(Homogeneous a, Homogeneous b, double f) {
  return (1 - f) * a + f * b;
}

std::vector<Homogeneous> homogeneous(const Nurbs2& n) {
  std::vector<Homogeneous> net(n.points.size());
  for (std::size_t i = 0; i < net.size(); ++i) {
    net[i] = {n.weights[i] * n.points[i].x, n.weights[i] * n.points[i].y, n.weights[i]};
  }
  return net;
}

void set_net(Nurbs2& n, const std::vector<Homogeneous>& net) {
  n.points.resize(net.size());
  n.weights.resize(net.size());
  for (std::size_t i = 0; i < net.size(); ++i) {
    n.points[i] = {net[i].x / net[i].w, net[i].y / net[i].w};
    n.weights[i] = net[i].w;
  }
}

double first_parameter(const Nurbs2& n) {
  return n.knots[static_cast<std::size_t>(n.degree)];
}
double last_parameter(const Nurbs2& n) {
  return n.knots[n.points.size()];
}

/// Index k with knots[k] <= u < knots[k+1], degree <= k < points.size(); the last non-empty span at the end.
std::size_t span_of(const Nurbs2& n, double u) {
  const auto p = static_cast<std::ptrdiff_t>(n.degree);
  const auto first = n.knots.begin() + p;
  const auto last = n.knots.begin() + static_cast<std::ptrdiff_t>(n.points.size());
  auto it = std::upper_bound(first, last, u);
  if (it == first) ++it;
  auto k = static_cast<std::size_t>(it - n.knots.begin() - 1);
  while (k > static_cast<std::size_t>(p) && n.knots[k] == n.knots[k + 1]) --k;
  return k;
}

/// Inserts `u` once into knots and net (Boehm). `k` is the span.
void insert_knot(int degree, std::vector<double>& knots, std::vector<Homogeneous>& net, double u,
                 std::size_t k) {
  const auto p = static_cast<std::size_t>(degree);
  std::vector<Homogeneous> out;
  out.reserve(net.size() + 1);
  for (std::size_t i = 0; i <= net.size(); ++i) {
    if (i + p <= k) {
      out.push_back(net[i]);
    } else if (i > k) {
      out.push_back(net[i - 1]);
    } else {
      const double lo = knots[i], hi = knots[i + p];
      const double f = hi > lo ? (u - lo) / (hi - lo) : 0;
      out.push_back(blend(net[i - 1], net[i], f));
    }
  }
  net = std::move(out);
  knots.insert(knots.begin() + static_cast<std::ptrdiff_t>(k) + 1, u);
}

/// Raises the multiplicity of u to the degree; u inside or at an end of the curve's interval.
void saturate(Nurbs2& n, std::vector<Homogeneous>& net, double u) {
  const auto [lo, hi] = std::equal_range(n.knots.begin(), n.knots.end(), u);
  auto multiplicity = hi - lo;
  while (multiplicity < n.degree) {
    // The span for insertion: the last knot <= u, kept inside the net.
    auto k =
        static_cast<std::size_t>(std::upper_bound(n.knots.begin(), n.knots.end(), u) - n.knots.begin()) - 1;
    k = std::clamp(k, static_cast<std::size_t>(n.degree), net.size() - 1);
    insert_knot(n.degree, n.knots, net, u, k);
    ++multiplicity;
  }
}

}  // namespace

Result<void> validate_nurbs(const Nurbs2& n) {
  const auto bad = [](std::string what) { return Error{ErrorCode::geometry, std::move(what), {}}; };
  if (n.degree < 1 || n.degree > kMaxDegree) {
    return bad("a spline of degree " + std::to_string(n.degree) + " (1 to " + std::to_string(kMaxDegree) +
               ")");
  }
  const auto p = static_cast<std::size_t>(n.degree);
  if (n.points.size() < p + 1) {
    return bad("a spline of degree " + std::to_string(n.degree) + " with " + std::to_string(n.points.size()) +
               " control points (at least degree + 1)");
  }
  if (n.weights.size() != n.points.size())
    return bad("a spline with another number of weights than control points");
  if (n.knots.size() != n.points.size() + p + 1) {
    return bad("a spline with " + std::to_string(n.knots.size()) +
               " knots (control points + degree + 1 = " + std::to_string(n.points.size() + p + 1) + ")");
  }
  for (const Point2& q : n.points) {
    if (!std::isfinite(q.x) || !std::isfinite(q.y))
      return bad("a spline with a control point that is not finite");
  }
  for (const double w : n.weights) {
    if (!std::isfinite(w) || w <= 0) return bad("a spline with a weight that is not positive");
  }
  for (std::size_t i = 0; i < n.knots.size(); ++i) {
    if (!std::isfinite(n.knots[i])) return bad("a spline with a knot that is not finite");
    if (i > 0 && n.knots[i] < n.knots[i - 1])
      return bad("a spline whose knots decrease (nondecreasing knots)");
  }
  if (!(last_parameter(n) > first_parameter(n))) return bad("a spline whose knots span nothing");
  return {};
}

Derivatives2 nurbs_derivatives(const Nurbs2& n, double t, int order) {
  const double u0 = first_parameter(n), u1 = last_parameter(n);
  const double u = t >= 1 ? u1 : u0 + std::max(t, 0.0) * (u1 - u0);
  const std::size_t k = span_of(n, u);
  const auto p = static_cast<std::size_t>(n.degree);
  // de Boor on the homogeneous net; the derivatives fall out of the last two levels of the triangle.
  std::array<Homogeneous, kMaxDegree + 1> d;
  for (std::size_t j = 0; j <= p; ++j) {
    const std::size_t i = k - p + j;
    d[j] = {n.weights[i] * n.points[i].x, n.weights[i] * n.points[i].y, n.weights[i]};
  }
  Homogeneous first, second;
  for (std::size_t level = 1; level <= p; ++level) {
    const std::size_t left_over = p - level;  // levels that remain after this one
    const auto knot = [&](std::size_t j) { return n.knots[j]; };
    if (order >= 2 && left_over == 1) {
      // Three points of level p-2: second differences.
      const double a = knot(k + 1) - knot(k - 1 < k ? k - 1 : k), b = knot(k + 2) - knot(k);
      const double h = knot(k + 1) - knot(k);
      const Homogeneous e0 = (a > 0 ? 1 / a : 0) * (d[p - 1] + (-1.0) * d[p - 2]);
      const Homogeneous e1 = (b > 0 ? 1 / b : 0) * (d[p] + (-1.0) * d[p - 1]);
      second = (static_cast<double>(p * (p - 1)) / h) * (e1 + (-1.0) * e0);
    }
    if (order >= 1 && left_over == 0) {
      const double h = knot(k + 1) - knot(k);
      first = (static_cast<double>(p) / h) * (d[p] + (-1.0) * d[p - 1]);
    }
    for (std::size_t j = p; j >= level; --j) {
      const double lo = knot(j + k - p), hi = knot(j + 1 + k - level);
      d[j] = blend(d[j - 1], d[j], hi > lo ? (u - lo) / (hi - lo) : 0);
    }
  }
  const Homogeneous c = d[p];
  Derivatives2 out;
  out.point = {c.x / c.w, c.y / c.w};
  const double scale = u1 - u0;
  if (order >= 1) {
    const Vec2 p0{out.point.x, out.point.y};
    out.d1 = (Vec2{first.x, first.y} - first.w * p0) / c.w;
    if (order >= 2) out.d2 = (Vec2{second.x, second.y} - 2 * first.w * out.d1 - second.w * p0) / c.w;
    out.d1 = scale * out.d1;
    out.d2 = scale * scale * out.d2;
  }
  return out;
}

Nurbs2 nurbs_part(const Nurbs2& n, double t0, double t1) {
  const double u0 = first_parameter(n), u1 = last_parameter(n);
  const double a = t0 <= 0 ? u0 : u0 + t0 * (u1 - u0);
  const double b = t1 >= 1 ? u1 : u0 + t1 * (u1 - u0);
  Nurbs2 out = n;
  std::vector<Homogeneous> net = homogeneous(n);
  saturate(out, net, a);
  saturate(out, net, b);
  // Keep what lies between: `degree` knots of a, the inner knots, `degree` knots of b, and one more at each
  // end.
  const auto p = static_cast<std::size_t>(n.degree);
  const auto end_a =
      static_cast<std::size_t>(std::upper_bound(out.knots.begin(), out.knots.end(), a) - out.knots.begin());
  const auto begin_b =
      static_cast<std::size_t>(std::lower_bound(out.knots.begin(), out.knots.end(), b) - out.knots.begin());
  std::vector<double> knots(p + 1, a);
  knots.insert(knots.end(), out.knots.begin() + static_cast<std::ptrdiff_t>(end_a),
               out.knots.begin() + static_cast<std::ptrdiff_t>(begin_b));
  knots.insert(knots.end(), p + 1, b);
  const std::size_t count = knots.size() - p - 1;
  const std::size_t start = end_a - p - 1 < end_a ? end_a - p - 1 : 0;
  out.knots = std::move(knots);
  set_net(out, std::vector<Homogeneous>(net.begin() + static_cast<std::ptrdiff_t>(start),
                                        net.begin() + static_cast<std::ptrdiff_t>(start + count)));
  return out;
}

std::vector<Nurbs2> bezier_pieces(const Nurbs2& n) {
  const double u0 = first_parameter(n), u1 = last_parameter(n);
  Nurbs2 whole = n;
  std::vector<Homogeneous> net = homogeneous(n);
  saturate(whole, net, u0);
  saturate(whole, net, u1);
  std::vector<double> breaks{u0};
  for (const double u : n.knots) {
    if (u > breaks.back() && u < u1) {
      breaks.push_back(u);
    }
  }
  for (std::size_t i = 1; i < breaks.size(); ++i) saturate(whole, net, breaks[i]);
  breaks.push_back(u1);
  const auto p = static_cast<std::size_t>(n.degree);
  std::vector<Nurbs2> pieces;
  pieces.reserve(breaks.size() - 1);
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    // Control points of the span that ends at breaks[i + 1]: its last knot of breaks[i] has index k.
    const auto k = static_cast<std::size_t>(
        std::upper_bound(whole.knots.begin(), whole.knots.end(), breaks[i]) - whole.knots.begin() - 1);
    Nurbs2 piece;
    piece.degree = n.degree;
    piece.knots.assign(p + 1, 0.0);
    piece.knots.insert(piece.knots.end(), p + 1, 1.0);
    const auto from = net.begin() + static_cast<std::ptrdiff_t>(k - p);
    set_net(piece, std::vector<Homogeneous>(from, from + static_cast<std::ptrdiff_t>(p + 1)));
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

std::vector<double> nurbs_corners(const Nurbs2& n, double tangent_rad) {
  // Inside a Bezier piece the tangent is continuous but for cusps, where the hodograph passes through zero;
  // between pieces it jumps only where a knot has full multiplicity or control points coincide. Comparing the
  // limits of the tangents at every knot covers the second kind; cusps inside a piece are found from the
  // hodograph.
  std::vector<double> corners;
  const std::vector<Nurbs2> pieces = bezier_pieces(n);
  const double u0 = first_parameter(n), u1 = last_parameter(n);
  std::vector<double> breaks{u0};
  for (const double u : n.knots) {
    if (u > breaks.back() && u < u1) breaks.push_back(u);
  }
  breaks.push_back(u1);
  const auto turn = [](Vec2 a, Vec2 b) { return std::abs(std::atan2(cross(a, b), dot(a, b))); };
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double scale = breaks[i + 1] - breaks[i];
    if (i > 0 && turn(tangent_at(pieces[i - 1], 1.0), tangent_at(pieces[i], 0.0)) > tangent_rad) {
      corners.push_back((breaks[i] - u0) / (u1 - u0));
    }
    // A cusp: speed falls to (nearly) nothing between samples and the direction turns round.
    constexpr int kSteps = 32;
    const Box2 box = bounds(Curve2{pieces[i]});
    const double size = box.width() + box.height();
    const auto speed = [&](double t) { return norm(nurbs_derivatives(pieces[i], t, 1).d1); };
    for (int s = 1; s < kSteps; ++s) {
      double lo = (s - 1) / double(kSteps), hi = (s + 1) / double(kSteps);
      const double middle = speed(s / double(kSteps));
      if (middle > speed(lo) || middle > speed(hi) || middle > 0.1 * size) continue;
      for (int step = 0; step < 60; ++step) {  // golden-section-like search for the slowest point
        const double a = lo + 0.382 * (hi - lo), b = lo + 0.618 * (hi - lo);
        (speed(a) < speed(b) ? hi : lo) = speed(a) < speed(b) ? b : a;
      }
      const double t = 0.5 * (lo + hi);
      constexpr double kStopped = 1e-7;  // of the piece's size: slower is a cusp, not a tight bend
      if (speed(t) > kStopped * size) continue;
      const Vec2 before = unit(nurbs_derivatives(pieces[i], std::max(0.0, t - 1e-4), 1).d1);
      const Vec2 after = unit(nurbs_derivatives(pieces[i], std::min(1.0, t + 1e-4), 1).d1);
      if (turn(before, after) > std::max(tangent_rad, 0.1))
        corners.push_back((breaks[i] + t * scale - u0) / (u1 - u0));
    }
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::erase_if(corners, [](double t) { return t <= 0 || t >= 1; });
  return corners;
}

namespace {

/// Solves the tridiagonal (cyclic when `corner_lo`/`corner_hi` are not 0: Sherman-Morrison) system for second
/// derivatives.
std::vector<Vec2> solve_tridiagonal(std::vector<double> lo, std::vector<double> diag, std::vector<double> hi,
                                    std::vector<Vec2> rhs) {
  const std::size_t n = diag.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double f = lo[i] / diag[i - 1];
    diag[i] -= f * hi[i - 1];
    rhs[i] = rhs[i] - f * rhs[i - 1];
  }
  rhs[n - 1] = rhs[n - 1] / diag[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) rhs[i] = (rhs[i] - hi[i] * rhs[i + 1]) / diag[i];
  return rhs;
}

std::vector<Vec2> solve_cyclic(const std::vector<double>& lo, std::vector<double> diag,
                               const std::vector<double>& hi, const std::vector<Vec2>& rhs) {
  const std::size_t n = diag.size();
  const double alpha = hi[n - 1], beta = lo[0], gamma = -diag[0];
  diag[0] -= gamma;
  diag[n - 1] -= alpha * beta / gamma;
  const std::vector<Vec2> x = solve_tridiagonal(lo, diag, hi, rhs);
  std::vector<Vec2> u(n);
  u[0] = {gamma, gamma};
  u[n - 1] = {alpha, alpha};
  const std::vector<Vec2> z = solve_tridiagonal(lo, diag, hi, u);
  const Vec2 top = x[0] + (beta / gamma) * x[n - 1];
  const double bottom = 1 + z[0].x + beta / gamma * z[n - 1].x;
  std::vector<Vec2> out(n);
  for (std::size_t i = 0; i < n; ++i)
    out[i] = {x[i].x - top.x / bottom * z[i].x, x[i].y - top.y / bottom * z[i].x};
  return out;
}

/// The C1 data (points and tangents with respect to chord length) as a cubic NURBS with double inner knots.
Nurbs2 hermite_to_nurbs(const std::vector<Point2>& q, const std::vector<Vec2>& d,
                        const std::vector<double>& s) {
  Nurbs2 n;
  n.degree = 3;
  const std::size_t m = q.size();
  n.knots.assign(4, s.front());
  n.points.push_back(q.front());
  for (std::size_t i = 0; i + 1 < m; ++i) {
    const double h = s[i + 1] - s[i];
    n.points.push_back(q[i] + (h / 3) * d[i]);
    n.points.push_back(q[i + 1] - (h / 3) * d[i + 1]);
    if (i + 2 < m) n.knots.insert(n.knots.end(), 2, s[i + 1]);
  }
  n.points.push_back(q.back());
  n.knots.insert(n.knots.end(), 4, s.back());
  n.weights.assign(n.points.size(), 1.0);
  return n;
}

}  // namespace

Result<Nurbs2> interpolate(const std::vector<Point2>& fit_points, bool closed, Vec2 start_tangent,
                           Vec2 end_tangent) {
  Box2 extent;
  for (const Point2& p : fit_points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
      return Error{ErrorCode::geometry, "a spline with a fit point that is not finite", {}};
    }
    extent.add(p);
  }
  // Points apart by rounding only (a closed spline that repeats its first point, computed again) are one.
  constexpr double kSameFitPoint = 1e-12;  // of the size of the coordinates
  const double same =
      kSameFitPoint * (extent.width() + extent.height() + std::abs(extent.lo.x) + std::abs(extent.lo.y));
  std::vector<Point2> q;
  for (const Point2& p : fit_points) {
    if (q.empty() || distance(q.back(), p) > same) q.push_back(p);
  }
  if (closed && q.size() > 1) {
    if (distance(q.front(), q.back()) <= same) q.pop_back();
    if (q.size() > 1) q.push_back(q.front());
  }
  if (q.size() < 2) return Error{ErrorCode::geometry, "a spline with fewer than 2 different fit points", {}};
  const std::size_t m = q.size();
  std::vector<double> s(m, 0.0), h(m - 1);
  for (std::size_t i = 0; i + 1 < m; ++i) {
    h[i] = distance(q[i], q[i + 1]);
    if (!(h[i] > 0))
      return Error{ErrorCode::geometry, "a spline with fit points too close to tell apart", {}};
    s[i + 1] = s[i] + h[i];
    if (!(s[i + 1] > s[i]))
      return Error{ErrorCode::geometry, "a spline with fit points too close to tell apart", {}};
  }
  if (closed && m == 3) closed = false;  // there and back again: no periodic spline through two points
  // C2 conditions for the tangents d_i: h_i d_{i-1} + 2 (h_{i-1} + h_i) d_i + h_{i-1} d_{i+1} = 3 (...)
  const std::size_t n = closed ? m - 1 : m;
  std::vector<double> lo(n, 0.0), diag(n, 0.0), hi(n, 0.0);
  std::vector<Vec2> rhs(n);
  for (std::size_t i = closed ? 0 : 1; i + (closed ? 0 : 1) < n; ++i) {
    const std::size_t before = i == 0 ? n - 1 : i - 1;
    const double ha = h[before], hb = h[i];
    const Vec2 slope_a = (q[i] - q[before]) / ha, slope_b = (q[i + 1] - q[i]) / hb;
    lo[i] = hb;
    diag[i] = 2 * (ha + hb);
    hi[i] = ha;
    rhs[i] = 3 * (hb * slope_a + ha * slope_b);
  }
  if (!closed) {
    const auto end_row = [&](std::size_t row, Vec2 tangent, Vec2 slope, double& neighbour) {
      if (norm(tangent) > 0) {
        diag[row] = 1;
        rhs[row] = unit(tangent);
      } else {  // natural end: no curvature
        diag[row] = 2;
        neighbour = 1;
        rhs[row] = 3 * slope;
      }
    };
    end_row(0, start_tangent, (q[1] - q[0]) / h[0], hi[0]);
    end_row(n - 1, end_tangent, (q[m - 1] - q[m - 2]) / h[m - 2], lo[n - 1]);
  }
  std::vector<Vec2> d = closed ? solve_cyclic(lo, diag, hi, rhs) : solve_tridiagonal(lo, diag, hi, rhs);
  if (closed) d.push_back(d.front());
  Nurbs2 out = hermite_to_nurbs(q, d, s);
  if (auto check = validate_nurbs(out); !check) return check.error();
  return out;
}

}  // namespace burin::geom
