// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/tool_angles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burin::orient {

using geom::Vec2;
using geom::Vec3;

namespace {

double square(double x) {
  return x * x;
}
/// A flat mill has no corner, whatever its data say.
double corner(const model::Mill& mill) {
  return mill.kind == model::MillKind::flat ? 0 : mill.corner_radius;
}

}  // namespace

Angles AngleRange::widest() const {
  return {alpha_lo, std::clamp(0.0, beta_lo, beta_hi)};
}

cl::Pose pose(const CcPoint& at, const Angles& angles, const model::Mill& mill) {
  const double r = corner(mill), flat = mill.radius - r;
  const double beta = angles.alpha > kNoTilt ? angles.beta : 0;
  const double sa = std::sin(angles.alpha), ca = std::cos(angles.alpha);
  const Vec3 d = std::cos(beta) * at.f + std::sin(beta) * at.t();
  const Vec3 u = geom::unit(ca * at.n + sa * d);
  return {at.c + r * at.n + flat * (sa * at.n - ca * d) - r * u, u};
}

Angles angles_of(const CcPoint& at, const Vec3& axis) {
  const double along = dot(axis, at.f), across = dot(axis, at.t());
  const double alpha = std::atan2(std::hypot(along, across), dot(axis, at.n));
  return {alpha, alpha > kNoTilt ? std::atan2(across, along) : 0};
}

double effective_radius(const Angles& angles, const model::Mill& mill) {
  const double r = corner(mill), sa = std::sin(angles.alpha);
  const double c2 = square(std::cos(angles.beta)), s2 = square(std::sin(angles.beta));
  const double wide = mill.radius - r;
  if (angles.alpha <= kNoTilt) return std::numeric_limits<double>::infinity();
  return c2 * (wide / sa + r) + r * s2;
}

Vec2 radius_gradient(const Angles& angles, const model::Mill& mill) {
  const double wide = mill.radius - corner(mill);
  const double sa = std::sin(angles.alpha), cb = std::cos(angles.beta);
  return {-square(cb) * wide * std::cos(angles.alpha) / square(sa),
          -2 * cb * std::sin(angles.beta) * wide / sa};
}

std::optional<double> contour_tilt(double rho, double beta, const model::Mill& mill) {
  // rho = cos^2 (R - r) / sin(alpha) + r
  const double r = corner(mill), above = rho - r;
  if (!(above > 0)) return std::nullopt;
  const double sa = square(std::cos(beta)) * (mill.radius - r) / above;
  if (sa > 1) return std::nullopt;
  return std::asin(sa);
}

double least_local_tilt(const CcPoint& at, double beta, const model::Mill& mill) {
  const double cb = std::cos(beta), sb = std::sin(beta), r = corner(mill);
  // e = t cos(beta) - f sin(beta)
  const double kappa = cb * cb * at.k_tt - 2 * cb * sb * at.k_ft + sb * sb * at.k_ff;
  if (kappa <= 0) return 0;
  if (r * kappa >= 1) return geom::kPi / 2;
  const double sa = (mill.radius - r) * kappa / (1 - r * kappa);
  return sa >= 1 ? geom::kPi / 2 : std::asin(sa);
}

}  // namespace burin::orient
