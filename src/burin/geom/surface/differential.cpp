// SPDX-License-Identifier: Apache-2.0
// Normals and curvatures.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "burin/geom/surface/basis.h"
#include "burin/geom/surface/evaluate.h"

namespace burin::geom {
namespace {

/// Sine of the angle of the partial derivatives below which they count as parallel (evaluate.h).
constexpr double kParallel = 1e-12;
/// Rounding of a partial derivative, relative to the size of the coordinates over the length of the span (for
/// which |Suv| / |Su| stands): a derivative below it has no direction.
constexpr double kRounding = 1e-14;
/// Uneven weights spoil digits, but seldom all at once: beyond this quotient no more is allowed for.
constexpr double kMaxSpread = 1e6;
/// Room for the higher derivatives, which are rounded more.
constexpr double kRoom = 1e3;
/// Steps inwards from a place without a normal, in widths of the domain.
constexpr double kStepsInside[] = {1e-6, 1e-4, 1e-2};

/// Partial derivatives in lengths (times the width of the piece, so that u and v are alike).
struct Lengths {
  Vec3 u, v, uu, uv, vv, uuu, uuv, uvv, vvv;
  double rounding = 0;  // of u and v
};

Lengths lengths(const NurbsSurface& s, double u, double v, Side side_u, Side side_v) {
  const int i = detail::span_at(s.knots_u, s.degree_u, s.count_u, u, side_u);
  const int j = detail::span_at(s.knots_v, s.degree_v, s.count_v, v, side_v);
  const auto width = [](const std::vector<double>& knots, int span) {
    return knots[static_cast<std::size_t>(span) + 1] - knots[static_cast<std::size_t>(span)];
  };
  const double a = width(s.knots_u, i), b = width(s.knots_v, j);
  const SurfaceDerivatives3 d = derivatives3(s, u, v, side_u, side_v);
  double reach = 0, heaviest = 0, lightest = std::numeric_limits<double>::infinity();
  for (int y = j - s.degree_v; y <= j; ++y) {
    for (int x = i - s.degree_u; x <= i; ++x) {
      const HPoint& h = s.at(x, y);
      reach = std::max(reach, norm(project(h) - Point3{}));
      heaviest = std::max(heaviest, h.w);
      lightest = std::min(lightest, h.w);
    }
  }
  const int degree = std::max(s.degree_u, s.degree_v);
  return {a * d.du,           b * d.dv,
          a * a * d.duu,      a * b * d.duv,
          b * b * d.dvv,      a * a * a * d.duuu,
          a * a * b * d.duuv, a * b * b * d.duvv,
          b * b * b * d.dvvv, kRounding * degree * reach * std::min(heaviest / lightest, kMaxSpread)};
}

/// Su x Sv, k times differentiated in direction (a, b): the first one that does not vanish is the limit.
/// Nothing when up to k = 2 all do.
Vec3 limit(const Lengths& d, double a, double b) {
  const Vec3 u1 = a * d.uu + b * d.uv, v1 = a * d.uv + b * d.vv;
  const Vec3 u2 = a * a * d.uuu + (2 * a * b) * d.uuv + b * b * d.uvv;
  const Vec3 v2 = a * a * d.uuv + (2 * a * b) * d.uvv + b * b * d.vvv;
  const double size = std::max({norm(d.u), norm(d.v), norm(u1), norm(v1), norm(u2), norm(v2)});
  // What rounding of any factor can bring.
  const double least = kRoom * d.rounding * size;
  const Vec3 n1 = cross(u1, d.v) + cross(d.u, v1);
  if (norm(n1) > least) return unit(n1);
  const Vec3 n2 = cross(u2, d.v) + 2 * cross(u1, v1) + cross(d.u, v2);
  return norm(n2) > least ? unit(n2) : Vec3{};
}

/// 1 where the domain goes on upwards from t, -1 in its upper half.
double inwards(double t, const std::vector<double>& knots) {
  return t < 0.5 * knots.front() + 0.5 * knots.back() ? 1.0 : -1.0;
}

/// Where the normal vector and its derivatives vanish: a look from a small step inside.
Vec3 from_inside(const NurbsSurface& s, double u, double v, double a, double b) {
  const double width_u = s.domain(Direction::u).length(), width_v = s.domain(Direction::v).length();
  for (const double step : kStepsInside) {
    for (const auto& [x, y] : {Vec2{a, b}, Vec2{a, 0}, Vec2{0, b}}) {
      const Lengths d = lengths(s, u + x * step * width_u, v + y * step * width_v, Side::right, Side::right);
      const Vec3 n = cross(d.u, d.v);
      if (norm(n) > d.rounding * (norm(d.u) + norm(d.v))) return unit(n);
    }
  }
  return {};
}

}  // namespace

Vec3 normal(const SurfaceDerivatives& d) {
  if (norm(d.du) * norm(d.dv) <= kRounding * norm(d.p - Point3{}) * norm(d.duv)) return {};
  const Vec3 a = unit(d.du), b = unit(d.dv);
  const Vec3 n = cross(a, b);
  return norm(n) > kParallel ? unit(n) : Vec3{};
}

Vec3 normal(const NurbsSurface& s, double u, double v) {
  u = detail::clamped(s.knots_u, u);
  v = detail::clamped(s.knots_v, v);
  if (std::isnan(u) || std::isnan(v)) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan};
  }
  Lengths d = lengths(s, u, v, Side::right, Side::right);
  const auto vanish = [&] { return std::pair{norm(d.u) <= d.rounding, norm(d.v) <= d.rounding}; };
  auto [no_u, no_v] = vanish();
  if (!no_u && !no_v) {
    const Vec3 n = cross(unit(d.u), unit(d.v));
    if (norm(n) > std::max(kParallel, d.rounding / norm(d.u) + d.rounding / norm(d.v))) return unit(n);
  }
  const double a = inwards(u, s.knots_u), b = inwards(v, s.knots_v);
  d = lengths(s, u, v, a > 0 ? Side::right : Side::left, b > 0 ? Side::right : Side::left);
  std::tie(no_u, no_v) = vanish();
  if (no_u) d.u = {};
  if (no_v) d.v = {};
  // A collapsed edge has a normal at each of its parameters (think of a cone): straight away from it.
  Vec3 n;
  if (no_u && !no_v) n = limit(d, 0, b);
  if (no_v && !no_u) n = limit(d, a, 0);
  if (n == Vec3{}) n = limit(d, a, b);
  return n == Vec3{} ? from_inside(s, u, v, a, b) : n;
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
  if (!std::isfinite(mean) || !std::isfinite(radius)) return {};
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
