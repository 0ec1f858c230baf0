// SPDX-License-Identifier: Apache-2.0
// Bounds of the depth of places in a moving piece of a tool, from one evaluation. Internal to verify. mm.
// docs/verify-mill.md
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "burin/verify/mill_body.h"
#include "burin/verify/mill_motion.h"

namespace burin::verify {

/// A part of the time of a stretch.
struct Span {
  double middle = 0, half = 0;
  Placed at;  ///< in the middle

  static Span whole(const Stretch& stretch) { return {0.5, 0.5, stretch.middle}; }
  std::array<Span, 2> halves(const Stretch& stretch) const {
    std::array<Span, 2> out;
    for (std::size_t i = 0; i < 2; ++i) {
      const double t = middle + (i == 0 ? -0.5 : 0.5) * half;
      out[i] = {t, 0.5 * half, stretch.at(t)};
    }
    return out;
  }
};

/// A unit normal and how far an extent goes from its centre along it.
struct Plane {
  geom::Vec3 normal;
  double most = 0, least = 0;
};

// Extents: the places a bound is for. `directions(g)`: what three directions that span the extent add to a
// function of gradient g, most(those): what they add together at most. `radius`: of a ball about the centre
// that holds the extent.

struct BoxExtent {
  geom::Point3 center;
  double radius = 0;
  Plane plane;
  std::array<geom::Vec3, 3> half;  ///< edges, from the centre

  std::array<double, 3> directions(geom::Vec3 g) const {
    return {dot(g, half[0]), dot(g, half[1]), dot(g, half[2])};
  }
  static double most(const std::array<double, 3>& d) {
    return std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]);
  }
};

struct TriangleExtent {
  geom::Point3 center;
  double radius = 0;
  Plane plane;
  std::array<geom::Vec3, 3> corner;  ///< from the centre

  TriangleExtent(const std::array<geom::Point3, 3>& c, geom::Vec3 normal)
      : center(lerp(lerp(c[0], c[1], 0.5), c[2], 1.0 / 3)), plane{normal, 0, 0} {
    for (std::size_t i = 0; i < 3; ++i) {
      corner[i] = c[i] - center;
      radius = std::max(radius, norm(corner[i]));
    }
  }
  std::array<double, 3> directions(geom::Vec3 g) const {
    return {dot(g, corner[0]), dot(g, corner[1]), dot(g, corner[2])};
  }
  static double most(const std::array<double, 3>& d) { return std::max({d[0], d[1], d[2]}); }
};

struct Upper {
  double value = 0;  ///< no place is deeper
  double f = 0;      ///< in the middle
  // Of the side that is the least there; what it may grow by is the reason to divide.
  geom::Vec3 gradient;
  double space = 0, time = 0;
  double along_time = 0;
};

/// All places within the extent over the span: the least of the bounds that the sides of the body give, and
/// of a mean of bottom and side, whose edge is where flat ends cut deepest. Nothing more is tried once it is
/// down at `enough`.
template <class Extent>
Upper upper_bound(const MillBody& body, const Stretch& stretch, const Span& span, const Extent& extent,
                  double enough) {
  using geom::Vec3;
  const BodyAt b = body_at(body, span.at.tip, span.at.axis, extent.center);
  // How a place of the part moves as seen from the tool, to the first order and what is left of it.
  const Vec3 from_tip = extent.center - span.at.tip, turn = stretch.turn;
  const Vec3 motion = -(stretch.way + cross(turn, from_tip));
  const double way_rate = norm(stretch.way), turn_rate = stretch.angle;
  const double far = norm(from_tip) + extent.radius + way_rate * span.half;
  const double bend = 0.5 * turn_rate * (turn_rate * far + 2 * way_rate) * span.half * span.half;
  Upper upper;
  upper.f = b.f;
  upper.value = std::numeric_limits<double>::infinity();
  const auto consider = [&](double f, Vec3 gradient, double space, bool least) {
    const double along = dot(gradient, motion);
    double time = span.half * std::abs(along) + bend;
    // (gradient x turn) . (place - centre): of how differently the places move.
    if (turn_rate > 0)
      time += span.half * std::max(Extent::most(extent.directions(cross(gradient, turn))),
                                   Extent::most(extent.directions(cross(turn, gradient))));
    upper.value = std::min(upper.value, f + space + time);
    if (least) upper.space = space, upper.time = time, upper.gradient = gradient, upper.along_time = along;
  };
  for (std::size_t i = 0; i < b.count; ++i) {
    consider(b.sides[i].f, b.sides[i].gradient, Extent::most(extent.directions(b.sides[i].gradient)),
             i == b.least);
    if (upper.value <= enough) return upper;
  }
  const double side = dot(extent.plane.normal, upper.gradient) < 0 ? -1 : 1;
  const Vec3 n = side * extent.plane.normal;
  consider(body.reach(span.at.axis, -n) + dot(n, from_tip), n,
           side > 0 ? extent.plane.most : -extent.plane.least, false);
  if (upper.value <= enough) return upper;
  // The mean of bottom and side that changes least over extent and span.
  const auto one = extent.directions(b.sides[0].gradient), two = extent.directions(b.sides[1].gradient);
  const double time_one = span.half * dot(b.sides[0].gradient, motion);
  const double time_two = span.half * dot(b.sides[1].gradient, motion);
  double over = time_two * (time_two - time_one), under = (time_two - time_one) * (time_two - time_one);
  for (std::size_t i = 0; i < 3; ++i) {
    over += two[i] * (two[i] - one[i]);
    under += (two[i] - one[i]) * (two[i] - one[i]);
  }
  if (under > 0 && over > 0 && over < under) {
    const double share = over / under;
    const Vec3 gradient = share * b.sides[0].gradient + (1 - share) * b.sides[1].gradient;
    consider(share * b.sides[0].f + (1 - share) * b.sides[1].f, gradient,
             Extent::most(extent.directions(gradient)), false);
  }
  return upper;
}

}  // namespace burin::verify
