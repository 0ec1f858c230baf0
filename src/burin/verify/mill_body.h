// SPDX-License-Identifier: Apache-2.0
// One convex piece of a tool as a function of the place: positive inside (the distance to its surface),
// negative outside. Internal to verify. mm.
//
// It is the least of a few concave functions: the distances to bottom, side and top, and to the rounded
// corner where that is the nearest. The gradient of each, and every mean of them, gives an upper bound
// everywhere:
//   f(q) <= f_i(p) + g_i . (q - p),   |g_i| <= 1,
// which is what the check of motions prunes with. (Outside f is not the distance where two of the surfaces
// matter; its sign is right everywhere.)
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "burin/geom/vec.h"
#include "burin/verify/mill_check.h"

namespace burin::verify {

/// Cylinder about the tool axis from height `low` to `high` above the tip, its lower edge rounded by `corner`
/// (0: sharp; the radius: a ball).
struct MillBody {
  double radius = 0, low = 0, high = 0, corner = 0;

  /// No place of it is farther from the tip.
  double span() const { return std::hypot(radius, std::max(std::abs(low), std::abs(high))); }
  /// No place is deeper in it.
  double inside() const { return std::min(radius, 0.5 * (high - low)); }
  /// How far the piece reaches along the unit vector `m`, seen from the tip. No place is deeper in the piece
  /// than below the plane there: f(q) <= reach(m) - m . (q - tip) wherever f > 0.
  double reach(geom::Vec3 axis, geom::Vec3 m) const {
    const double up = dot(m, axis), aside = std::sqrt(std::max(0.0, 1 - up * up));
    return up < 0 ? (radius - corner) * aside + corner + up * (low + corner) : radius * aside + up * high;
  }
};

/// The cutter, then its cylinders.
inline std::vector<MillBody> bodies_of(const CheckedMill& tool) {
  std::vector<MillBody> out{{tool.radius, 0, tool.length, tool.corner_radius}};
  for (const ToolCylinder& c : tool.cylinders) out.push_back({c.radius, c.from, c.to, 0});
  return out;
}

/// One of the functions at a place.
struct BodySide {
  double f = 0;
  geom::Vec3 gradient;
};
/// All of them for a tool that stands at `tip` with its axis along the unit vector `axis`; the first two are
/// bottom and side.
struct BodyAt {
  std::array<BodySide, 4> sides;
  std::size_t count = 3, least = 0;
  double f = 0;  ///< of the least one
};
inline BodyAt body_at(const MillBody& body, geom::Point3 tip, geom::Vec3 axis, geom::Point3 p) {
  const geom::Vec3 d = p - tip;
  const double height = dot(d, axis);
  const geom::Vec3 aside = d - height * axis;
  const double distance = norm(aside);
  // On the axis itself no direction is outwards: 0 is among the gradients there.
  const geom::Vec3 outwards = distance > 0 ? aside / distance : geom::Vec3{};
  BodyAt at;
  at.sides[0] = {height - body.low, axis};
  at.sides[1] = {body.radius - distance, -outwards};
  at.sides[2] = {body.high - height, -axis};
  // From the centre of the corner, outwards and down.
  const double out = distance - (body.radius - body.corner), down = body.low + body.corner - height;
  if (out > 0 && down > 0) {
    const double far = std::sqrt(out * out + down * down);
    at.sides[3] = {body.corner - far, (down / far) * axis - (out / far) * outwards};
    at.count = 4;
  }
  for (std::size_t i = 1; i < at.count; ++i)
    if (at.sides[i].f < at.sides[at.least].f) at.least = i;
  at.f = at.sides[at.least].f;
  return at;
}

}  // namespace burin::verify
