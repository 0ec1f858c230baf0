// SPDX-License-Identifier: Apache-2.0
// Tilt and yaw of a face mill at a contact point, and the effective radius they give. Park & Lee 2001, eq. 1
// and 2; the radius in closed form (spec: docs/orient.md). mm, radians, part frame.
//   u = n cos(alpha) + sin(alpha) d,  d = f cos(beta) + t sin(beta),  t = n x f
//   p = c + r n + (R - r) (n sin(alpha) - d cos(alpha)) - r u        (alpha = 0: d = f)
//   rho = cos(beta)^2 (R - r + r sin(alpha)) / sin(alpha) + r sin(beta)^2
// At a fixed yaw the tool turns rigidly with alpha about the line through c + r n along e = n x d = t
// cos(beta)
// - f sin(beta), by the right hand.
#pragma once

#include <optional>

#include "burin/cl/program.h"
#include "burin/geom/vec.h"
#include "burin/model/tool.h"

namespace burin::orient {

/// Contact point: place, unit normal towards the tool, unit feed direction in the tangent plane; and the
/// second fundamental form of the design there in (f, t), 1/mm, positive where the surface rises towards n
/// (zero when it is not known: contacts from a file).
struct CcPoint {
  geom::Point3 c;
  geom::Vec3 n, f;
  double k_ff = 0, k_ft = 0, k_tt = 0;
  geom::Vec3 t() const { return cross(n, f); }
};

struct Angles {
  double alpha = 0;  ///< tilt, 0 to pi/2
  double beta = 0;   ///< yaw, -pi/2 to pi/2
  bool operator==(const Angles&) const = default;
};
/// Closed intervals of both.
struct AngleRange {
  double alpha_lo = 0, alpha_hi = 0, beta_lo = 0, beta_hi = 0;
  bool contains(const Angles& a) const {
    return alpha_lo <= a.alpha && a.alpha <= alpha_hi && beta_lo <= a.beta && a.beta <= beta_hi;
  }
  /// The corner of the largest effective radius.
  Angles widest() const;
};

/// Below this tilt the bottom counts as lying in the tangent plane (yaw then means nothing).
inline constexpr double kNoTilt = 1e-12;

cl::Pose pose(const CcPoint& at, const Angles& angles, const model::Mill& mill);
/// Tilt and yaw of a tool axis at a contact point; yaw in (-pi, pi], 0 where there is no tilt.
Angles angles_of(const CcPoint& at, const geom::Vec3& axis);

/// Infinite at alpha = 0.
double effective_radius(const Angles& angles, const model::Mill& mill);
/// (d rho / d alpha, d rho / d beta), alpha > 0.
geom::Vec2 radius_gradient(const Angles& angles, const model::Mill& mill);
/// The tilt at which the contour of `rho` passes the yaw; nothing when it does not (rho too small for a
/// bull's corner or not positive). At most pi / 2.
std::optional<double> contour_tilt(double rho, double beta, const model::Mill& mill);

/// The least tilt at which the edge does not cut in beside the contact point, from the surface's curvature
/// kappa along e: sin(alpha) >= (R - r) kappa / (1 - r kappa). Necessary, not sufficient; 0 where the surface
/// does not rise, pi / 2 where no tilt is enough.
double least_local_tilt(const CcPoint& at, double beta, const model::Mill& mill);

}  // namespace burin::orient
