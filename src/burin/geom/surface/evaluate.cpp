// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/evaluate.h"

#include "burin/geom/surface/basis.h"
#include "burin/geom/surface/rational.h"

namespace burin::geom {
namespace {

using detail::Basis;
using detail::HSurface;

/// Homogeneous derivatives up to `order` of a curve.
std::array<HPoint, 4> homogeneous_curve(const NurbsCurve& c, double t, Side side, int order) {
  const int count = static_cast<int>(c.points.size());
  t = detail::clamped(c.knots, t);
  const int span = detail::span_at(c.knots, c.degree, count, t, side);
  Basis n;
  detail::basis_derivatives(c.knots, c.degree, span, t, order, n);
  std::array<HPoint, 4> a;
  for (int k = 0; k <= order; ++k) {
    HPoint sum{0, 0, 0, 0};
    for (int i = 0; i <= c.degree; ++i) {
      sum = sum + n.value[k][i] * c.points[static_cast<std::size_t>(span - c.degree + i)];
    }
    a[static_cast<std::size_t>(k)] = sum;
  }
  return a;
}

/// a[k][l]: d^(k+l) / du^k dv^l of the homogeneous surface, k + l <= order.
struct Net {
  HPoint a[4][4];
};
void homogeneous_surface(const NurbsSurface& s, double u, double v, Side side_u, Side side_v, int order,
                         Net& out) {
  u = detail::clamped(s.knots_u, u);
  v = detail::clamped(s.knots_v, v);
  const int i0 = detail::span_at(s.knots_u, s.degree_u, s.count_u, u, side_u);
  const int j0 = detail::span_at(s.knots_v, s.degree_v, s.count_v, v, side_v);
  Basis nu, nv;
  detail::basis_derivatives(s.knots_u, s.degree_u, i0, u, order, nu);
  detail::basis_derivatives(s.knots_v, s.degree_v, j0, v, order, nv);
  for (int k = 0; k <= order; ++k) {
    for (int l = 0; k + l <= order; ++l) out.a[k][l] = {0, 0, 0, 0};
  }
  for (int j = 0; j <= s.degree_v; ++j) {
    const HPoint* const row = &s.at(i0 - s.degree_u, j0 - s.degree_v + j);
    for (int k = 0; k <= order; ++k) {
      HPoint sum{0, 0, 0, 0};
      for (int i = 0; i <= s.degree_u; ++i) sum = sum + nu.value[k][i] * row[i];
      for (int l = 0; k + l <= order; ++l) out.a[k][l] = out.a[k][l] + nv.value[l][j] * sum;
    }
  }
}

HSurface named(const Net& n, int order) {
  HSurface h;
  h.p = n.a[0][0];
  h.u = n.a[1][0], h.v = n.a[0][1];
  h.uu = n.a[2][0], h.uv = n.a[1][1], h.vv = n.a[0][2];
  if (order == 3) h.uuu = n.a[3][0], h.uuv = n.a[2][1], h.uvv = n.a[1][2], h.vvv = n.a[0][3];
  return h;
}

}  // namespace

Point3 point(const NurbsCurve& curve, double t) {
  return project(homogeneous_curve(curve, t, Side::right, 0)[0]);
}

CurveDerivatives derivatives(const NurbsCurve& curve, double t, Side side) {
  const auto a = homogeneous_curve(curve, t, side, 3);
  const double r = 1 / a[0].w;
  CurveDerivatives d;
  d.p = {a[0].x * r, a[0].y * r, a[0].z * r};
  const Vec3 s{d.p.x, d.p.y, d.p.z};
  d.d1 = r * (detail::numerator(a[1]) - a[1].w * s);
  d.d2 = r * (detail::numerator(a[2]) - (2 * a[1].w) * d.d1 - a[2].w * s);
  d.d3 = r * (detail::numerator(a[3]) - (3 * a[1].w) * d.d2 - (3 * a[2].w) * d.d1 - a[3].w * s);
  return d;
}

Point3 point(const NurbsSurface& surface, double u, double v) {
  Net n;
  homogeneous_surface(surface, u, v, Side::right, Side::right, 0, n);
  return project(n.a[0][0]);
}

SurfaceDerivatives derivatives(const NurbsSurface& surface, double u, double v, Side side_u, Side side_v) {
  Net n;
  homogeneous_surface(surface, u, v, side_u, side_v, 2, n);
  SurfaceDerivatives d;
  detail::rational2(named(n, 2), d);
  return d;
}

SurfaceDerivatives3 derivatives3(const NurbsSurface& surface, double u, double v, Side side_u, Side side_v) {
  Net n;
  homogeneous_surface(surface, u, v, side_u, side_v, 3, n);
  SurfaceDerivatives3 d;
  detail::rational3(named(n, 3), d);
  return d;
}

}  // namespace burin::geom
