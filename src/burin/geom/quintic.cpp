// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/quintic.h"

#include <algorithm>
#include <cmath>

#include "burin/geom/gauss.h"

namespace burin::geom {
namespace {

/// Error of quintic Hermite interpolation: h^6 |f(6)| / (6! 4^3) = r h^6 / 46080 for an arc of radius r,
/// below 8.5e-9 r at this step.
constexpr double kArcStep = 0.27;
/// More turns than any part has; keeps the number of nodes bounded.
constexpr double kMaxSweep = 1e6;

struct Coefficients3 {
  std::array<double, 6> x, y, z;
  double h = 1;
};

Coefficients3 coefficients(const QuinticNode& a, const QuinticNode& b) {
  const double h = b.t - a.t;
  return {quintic_coefficients(h, a.p.x, a.d1.x, a.d2.x, b.p.x, b.d1.x, b.d2.x),
          quintic_coefficients(h, a.p.y, a.d1.y, a.d2.y, b.p.y, b.d1.y, b.d2.y),
          quintic_coefficients(h, a.p.z, a.d1.z, a.d2.z, b.p.z, b.d1.z, b.d2.z), h};
}

/// Value and derivatives with respect to x.
std::array<double, 4> horner(const std::array<double, 6>& c, double x) {
  return {((((c[5] * x + c[4]) * x + c[3]) * x + c[2]) * x + c[1]) * x + c[0],
          (((5 * c[5] * x + 4 * c[4]) * x + 3 * c[3]) * x + 2 * c[2]) * x + c[1],
          ((20 * c[5] * x + 12 * c[4]) * x + 6 * c[3]) * x + 2 * c[2],
          (60 * c[5] * x + 24 * c[4]) * x + 6 * c[3]};
}

QuinticDerivatives evaluate(const Coefficients3& c, double x) {
  const auto fx = horner(c.x, x), fy = horner(c.y, x), fz = horner(c.z, x);
  const double g = 1 / c.h;
  return {{fx[0], fy[0], fz[0]},
          g * Vec3{fx[1], fy[1], fz[1]},
          (g * g) * Vec3{fx[2], fy[2], fz[2]},
          (g * g * g) * Vec3{fx[3], fy[3], fz[3]}};
}

/// |d/dx| of the piece.
double speed(const Coefficients3& c, double x) {
  const auto slope = [x](const std::array<double, 6>& k) {
    return (((5 * k[5] * x + 4 * k[4]) * x + 3 * k[3]) * x + 2 * k[2]) * x + k[1];
  };
  return norm(Vec3{slope(c.x), slope(c.y), slope(c.z)});
}

double gauss(const Coefficients3& c, double lo, double hi) {
  return gauss10([&c](double x) { return speed(c, x); }, lo, hi);
}

/// Halved until two halves agree with the whole: a speed that nearly vanishes inside (a cusp) needs it.
double adaptive(const Coefficients3& c, double lo, double hi, double whole, int depth) {
  constexpr double kRelative = 1e-11;
  const double mid = 0.5 * (lo + hi);
  const double a = gauss(c, lo, mid), b = gauss(c, mid, hi);
  if (depth == 0 || !(std::abs(a + b - whole) > kRelative * (a + b))) return a + b;
  return adaptive(c, lo, mid, a, depth - 1) + adaptive(c, mid, hi, b, depth - 1);
}

}  // namespace

std::array<double, 6> quintic_coefficients(double h, double p0, double d0, double dd0, double p1, double d1,
                                           double dd1) {
  const double rise = p1 - p0, a = h * d0, b = h * d1, aa = h * h * dd0, bb = h * h * dd1;
  return {p0,
          a,
          0.5 * aa,
          10 * rise - 6 * a - 4 * b - 1.5 * aa + 0.5 * bb,
          -15 * rise + 8 * a + 7 * b + 1.5 * aa - bb,
          6 * rise - 3 * (a + b) - 0.5 * (aa - bb)};
}

QuinticDerivatives evaluate_piece(const QuinticPath& path, std::size_t i, double x) {
  return evaluate(coefficients(path.nodes[i], path.nodes[i + 1]), x);
}

QuinticDerivatives evaluate(const QuinticPath& path, double t) {
  if (path.empty()) {
    if (path.nodes.empty()) return {};
    return {path.nodes[0].p, path.nodes[0].d1, path.nodes[0].d2, {}};
  }
  const auto& nodes = path.nodes;
  const auto after = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, t,
                                      [](double value, const QuinticNode& n) { return value < n.t; });
  const std::size_t i = static_cast<std::size_t>(after - nodes.begin()) - 1;
  const double x = (t - nodes[i].t) / (nodes[i + 1].t - nodes[i].t);
  return evaluate_piece(path, i, std::clamp(x, 0.0, 1.0));
}

QuinticPath straight(Point3 a, Point3 b) {
  const double l = distance(a, b);
  if (!(l > 0)) return {{{0, a, {}, {}}, {1, b, {}, {}}}};
  const Vec3 direction = (b - a) / l;
  return {{{0, a, direction, {}}, {l, b, direction, {}}}};
}

QuinticPath arc(Point3 start, Point3 center, Vec3 normal, double sweep, double rise) {
  if (!(sweep > 0 && sweep <= kMaxSweep)) return {};
  const Vec3 arm = start - center;
  const double height = dot(arm, normal);
  const Vec3 e1 = arm - height * normal, e2 = cross(normal, e1);
  const int pieces = static_cast<int>(std::ceil(sweep / kArcStep));
  QuinticPath path;
  path.nodes.reserve(static_cast<std::size_t>(pieces) + 1);
  for (int i = 0; i <= pieces; ++i) {
    const double t = i == pieces ? sweep : sweep * i / pieces;
    const double c = std::cos(t), s = std::sin(t);
    const Vec3 up = (height + rise * (t / sweep)) * normal;
    path.nodes.push_back({t, i == 0 ? start : center + (c * e1 + s * e2 + up),
                          c * e2 - s * e1 + (rise / sweep) * normal, -c * e1 - s * e2});
  }
  return path;
}

double piece_length(const QuinticPath& path, std::size_t i) {
  constexpr int kDepth = 20;  // a cusp halves twenty times; what is left is 1e-6 of the piece
  const Coefficients3 c = coefficients(path.nodes[i], path.nodes[i + 1]);
  return adaptive(c, 0, 1, gauss(c, 0, 1), kDepth);
}

double length(const QuinticPath& path) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < path.nodes.size(); ++i) sum += piece_length(path, i);
  return sum;
}

QuinticPath reversed(const QuinticPath& path) {
  QuinticPath back;
  back.nodes.reserve(path.nodes.size());
  for (auto n = path.nodes.rbegin(); n != path.nodes.rend(); ++n)
    back.nodes.push_back({-n->t, n->p, -n->d1, n->d2});
  return back;
}

}  // namespace burin::geom
