// SPDX-License-Identifier: Apache-2.0
// Normals and curvatures.
#include <cmath>

#include "burin/geom/surface/basis.h"
#include "burin/geom/surface/evaluate.h"

namespace burin::geom {
namespace {

/// Sine of the angle of the partial derivatives below which they count as parallel (evaluate.h).
constexpr double kParallel = 1e-12;

/// Rounding of a partial derivative, relative to the size of the coordinates over the length of the span (for
/// which |Suv| / |Su| stands): a derivative below it has no direction.
constexpr double kRounding = 1e-14;

double dir(double t, const std::vector<double>& knots) {
  return t < 0.5 * (knots.front() + knots.back()) ? 1.0 : -1.0;
}

}  // namespace

Vec3 normal(const SurfaceDerivatives& d) {
  if (norm(d.du) * norm(d.dv) <= kRounding * norm(d.p - Point3{}) * norm(d.duv)) return {};
  const Vec3 a = unit(d.du), b = unit(d.dv);
  const Vec3 n = cross(a, b);
  return norm(n) > kParallel ? unit(n) : Vec3{};
}

Vec3 normal(const NurbsSurface& s, double u, double v) {
  const SurfaceDerivatives d = derivatives(s, u, v);
  const Vec3 n = normal(d);
  if (n != Vec3{} || std::isnan(u) || std::isnan(v)) return n;
  // Step inside, ever less: the first step that has an area.
  u = detail::clamped(s.knots_u, u);
  v = detail::clamped(s.knots_v, v);
  const double hu = dir(u, s.knots_u) * s.domain(Direction::u).length();
  const double hv = dir(v, s.knots_v) * s.domain(Direction::v).length();
  for (const double step : {1e-7, 1e-5, 1e-3}) {
    for (const auto& [a, b] : {Vec2{0, 1}, Vec2{1, 0}, Vec2{1, 1}}) {
      const Vec3 m = normal(derivatives(s, u + a * step * hu, v + b * step * hv));
      if (m != Vec3{}) return m;
    }
  }
  return {};
}

Curvature curvature(const SurfaceDerivatives& d) {
  const Vec3 n = normal(d);
  if (n == Vec3{}) return {};
  // Orthonormal tangents e1 along Su, e2 = n x e1; Su = a e1, Sv = b e1 + c e2.
  const Vec3 e1 = unit(d.du), e2 = cross(n, e1);
  const double a = norm(d.du), b = dot(d.dv, e1), c = dot(d.dv, e2);
  // d/de1 = d/du / a, d/de2 = (d/dv - b / a d/du) / c: the second fundamental form in the frame.
  const double l = dot(d.duu, n), m = dot(d.duv, n), k = dot(d.dvv, n);
  const double f = b / a;
  const double h11 = l / a / a;
  const double h12 = (m - f * l) / a / c;
  const double h22 = (k - 2 * f * m + f * f * l) / c / c;
  const double mean = 0.5 * (h11 + h22), half = 0.5 * (h11 - h22);
  const double radius = std::hypot(half, h12);
  Curvature r;
  r.k_min = mean - radius;
  r.k_max = mean + radius;
  const double angle = 0.5 * std::atan2(h12, half);
  r.direction_max = std::cos(angle) * e1 + std::sin(angle) * e2;
  r.direction_min = cross(n, r.direction_max);
  return r;
}

double normal_curvature(const SurfaceDerivatives& d, double du, double dv) {
  const Vec3 n = normal(d);
  const Vec3 t = du * d.du + dv * d.dv;
  const double length2 = dot(t, t);
  if (n == Vec3{} || !(length2 > 0)) return 0;
  return dot(du * du * d.duu + (2 * du * dv) * d.duv + dv * dv * d.dvv, n) / length2;
}

}  // namespace burin::geom
