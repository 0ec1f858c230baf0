// SPDX-License-Identifier: Apache-2.0
// docs/strip.md. One side at a time, mirrored so that it lies towards +x: the profile (x, z) across the feed,
// x along t, z along n, y along f. The edge circle (the ring of the corner's centres for a bull nose) from c:
//   x = rho (-s ca (1 - cos w) + cb sin w)      s = +-sin(beta), sa, ca, cb: sines and cosines of the angles
//   y = rho (-cb ca (1 - cos w) - s sin w)      rho = R - r
//   z = rho sa (1 - cos w)
// While the tool moves on along the feed it turns with the surface: what passes over x is as high over it as
// the edge point is over the surface under it, z - (2 k_ft x y + k_ff y^2) / 2 over the circle of curvature
// k_tt. With k_ft = k_ff = 0 this is the silhouette seen along f.
#include "burin/plan/orient/strip.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burin::orient {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// 1 / tan(w / 2) that stands for w = 0: its square is finite, its inverse below any rounding.
constexpr double kAtContact = 1e100;
/// Last step of an angle that is looked for (the error is its square, or itself where halving finds it).
constexpr double kAngleShare = 1e-9;
constexpr int kMaxSteps = 60;

double square(double x) {
  return x * x;
}

/// The circle of curvature k through the contact point, and the level `h` above it.
struct Circle {
  double k = 0, h = 0;
  /// level(x, z) grows with the height over the circle; it is top() at height h.
  double level(double x, double z) const { return z - 0.5 * k * (x * x + z * z); }
  /// Beyond the centre of a concave circle there is no height.
  double top() const { return k * h < 1 ? h * (1 - 0.5 * k * h) : 0.5 / k; }
  /// Length on the circle up to the foot of a place.
  double foot(double x, double z) const {
    const double a = k * x, b = 1 - k * z;
    if (b > 0 && std::abs(a) < 1e-8 * b) return x / b;  // atan(a / b) = a / b to rounding
    return std::atan2(a, b) / k;
  }
};

struct Side {
  double s = 0, cb = 0, sa = 0, ca = 0;
  double ring = 0, corner = 0, reach = 0;  ///< R - r, r, height of the body over the ring
  double k_ft = 0, k_ff = 0;               ///< of the surface at the ring's height, mirrored
  Circle circle;
};

struct Place {
  double x = 0, y = 0, z = 0;
};

/// The place of the edge by 1 / tan(w / 2).
Place edge_at(const Side& a, double inverse) {
  const double d = 2 * a.ring / (1 + inverse * inverse), e = d * inverse;
  return {-a.s * a.ca * d + a.cb * e, -a.cb * a.ca * d - a.s * e, a.sa * d};
}
double lowered(const Side& a, const Place& p) {
  return p.z - p.y * (a.k_ft * p.x + 0.5 * a.k_ff * p.y);
}

/// Where the silhouette runs along the side of the body, as 1 / tan(w / 2).
double side_begins(const Side& a) {
  const double k = a.cb * a.ca, both = std::hypot(a.s, k);
  if (a.s < 0) return k / (both - a.s);
  return k > 0 ? std::min((both + a.s) / k, kAtContact) : kAtContact;
}
/// The widest place of the ellipse, seen along the normals of the circle: 0 when there is none.
double widest(const Side& a) {
  const double p = a.s * a.ca, c = a.cb * (1 - 2 * a.circle.k * a.ring * a.sa);
  const double d = p * p + a.cb * c;
  if (!(d >= 0)) return 0;
  if (p < 0) return std::max(0.0, c / (std::sqrt(d) - p));
  return a.cb > 0 ? std::min((p + std::sqrt(d)) / a.cb, kAtContact) : kAtContact;
}

/// The largest positive root of h x^4 - a2 x^2 - a3 x - a4, h > 0; 0 when there is none. As a function of x >
/// 0 it is first concave (not when a2 <= 0), then convex.
double largest_root(double h, double a2, double a3, double a4) {
  const auto f = [&](double x) { return ((h * x * x - a2) * x - a3) * x - a4; };
  const auto slope = [&](double x) { return (4 * h * x * x - 2 * a2) * x - a3; };
  const double turn = a2 > 0 ? std::sqrt(a2 / (6 * h)) : 0;
  const auto newton = [&](double x, double least) {
    for (int i = 0; i < kMaxSteps; ++i) {
      const double d = slope(x);
      if (!(d > 0)) return 0.0;
      const double to = x - f(x) / d;
      if (!(to >= least)) return 0.0;
      if (std::abs(to - x) <= kAngleShare * to) return to;
      x = to;
    }
    return x;
  };
  // A start to the right of the root: the biquadratic's root plus what a3 can add (h x^3 = |a3| at most).
  const double disc = a2 * a2 + 4 * h * std::max(a4, 0.0);
  double start = std::sqrt(std::max(0.0, (a2 + std::sqrt(disc)) / (2 * h)));
  if (f(start) < 0 || slope(start) <= 0) start += std::cbrt(std::max(a3, 0.0) / h);
  if (f(start) < 0) start = 1 + std::max({std::abs(a2), std::abs(a3), std::abs(a4)}) / h;  // Cauchy
  if (start > 0) {
    if (const double x = newton(std::max(start, turn), turn); x > 0) return x;
  }
  // All of the convex part is positive: the concave part rises through 0 or has no root.
  if (turn > 0 && f(turn) > 0 && a4 > 0) {
    double lo = 0, hi = turn;
    for (int i = 0; i < kMaxSteps; ++i) {
      const double x = 0.5 * (lo + hi);
      (f(x) < 0 ? lo : hi) = x;
    }
    return lo > 0 ? lo : 0;
  }
  return 0;
}

/// Where the edge of a flat end reaches the top level, as 1 / tan(w / 2); 0 when it does not.
double edge_reaches_top(const Side& a) {
  const double x1 = a.cb, x2 = -a.s * a.ca, y1 = -a.s, y2 = -a.cb * a.ca, z2 = a.sa;
  const double k = a.circle.k, top = a.circle.top(), g = 2 * a.ring;
  const double a2 = g * (z2 - a.ring * (k * x1 * x1 + 2 * a.k_ft * x1 * y1 + a.k_ff * y1 * y1)) - 2 * top;
  const double a3 = -2 * g * a.ring * (k * x1 * x2 + a.k_ft * (x1 * y2 + x2 * y1) + a.k_ff * y1 * y2);
  const double a4 =
      g * (z2 - a.ring * (k * (x2 * x2 + z2 * z2) + 2 * a.k_ft * x2 * y2 + a.k_ff * y2 * y2)) - top;
  return largest_root(top, a2, a3, a4);
}

/// From a place below the top level on along the side of the body.
double along_side(const Side& a, double x, double z) {
  const Circle& c = a.circle;
  const double wx = a.sa * a.s, wz = a.ca;
  // Towards the wide side only.
  if (c.k * (x * wz - z * wx) + wx <= 0) return c.foot(x, z);
  const double p = -0.5 * c.k * (wx * wx + wz * wz), q = wz - c.k * (x * wx + z * wz);
  const double r = c.level(x, z) - c.top(), disc = q * q - 4 * p * r;
  double way = a.reach;
  if (disc >= 0 && q > 0) way = std::min(way, -2 * r / (q + std::sqrt(disc)));
  if (disc >= 0 && q <= 0 && p > 0) way = std::min(way, (std::sqrt(disc) - q) / (2 * p));
  way = std::max(way, 0.0);
  return c.foot(x + way * wx, z + way * wz);
}

/// On a surface that falls away along the feed the flat bottom itself comes lower than its edge: the envelope
/// of the bottom's plane, while the place where it touches lies on the disc. `x`: where the edge ends.
double under_bottom(const Side& a, const Place& edge) {
  if (!(a.k_ff < 0) || !(a.ca > 0)) return 0;
  const double t = a.sa / a.ca, fall = t * a.cb;
  const auto touch = [&](double x) { return -(fall + a.k_ft * x) / a.k_ff; };
  if (touch(edge.x) >= edge.y) return 0;
  const double p = 0.5 * (a.k_ft * a.k_ft / a.k_ff - a.circle.k), q = fall * a.k_ft / a.k_ff - t * a.s;
  const double r = 0.5 * fall * fall / a.k_ff - a.circle.top(), disc = q * q - 4 * p * r;
  if (disc < 0) return 0;
  const double x = q > 0 ? -2 * r / (q + std::sqrt(disc)) : p > 0 ? (std::sqrt(disc) - q) / (2 * p) : 0;
  if (!(x > edge.x)) return 0;
  // The chord of the disc at x.
  const double xi = x / a.ring, m = -2 * a.s * a.ca - xi, d = a.cb * a.cb + m * xi;
  if (!(d > 0)) return 0;
  const Place front = edge_at(a, (a.cb + std::sqrt(d)) / xi);
  const double y = touch(x);
  if (!(y < front.y) || y < front.y - 2 * a.ring) return 0;
  const double k = a.circle.k, sine = k * x / (1 - k * a.circle.h);
  if (std::abs(sine) > 1) return 0;
  return std::abs(sine) < 1e-8 ? x : std::asin(sine) / k;
}

double flat_side(const Side& a) {
  const double reached = edge_reaches_top(a), side = side_begins(a), wide = widest(a);
  const double end = std::max({reached, side, wide});
  const Place p = edge_at(a, end);
  const double z = lowered(a, p);
  const double width = end > reached && side >= wide ? along_side(a, p.x, z) : a.circle.foot(p.x, z);
  return std::max(width, under_bottom(a, p));
}

/// A place of the bull nose's silhouette and how it goes on.
struct Outline {
  double x = 0, z = 0;    ///< place
  double tx = 0, tz = 0;  ///< unit tangent
  double speed = 0;       ///< length of the derivative by the angle
};
Outline outline(const Side& a, double angle) {
  const double si = std::sin(angle), co = std::cos(angle), m = 2 * square(std::sin(0.5 * angle));
  // In units of the ring's radius.
  const double x = -a.s * a.ca * m + a.cb * si, y = -a.cb * a.ca * m - a.s * si;
  const double x1 = -a.s * a.ca * si + a.cb * co, y1 = -a.cb * a.ca * si - a.s * co;
  const double x2 = -a.s * a.ca * co - a.cb * si, y2 = -a.cb * a.ca * co + a.s * si;
  const double ft = a.ring * a.k_ft, ff = a.ring * a.k_ff;
  const double z = a.sa * m - y * (ft * x + 0.5 * ff * y);
  const double z1 = a.sa * si - ft * (x1 * y + x * y1) - ff * y * y1;
  const double z2 = a.sa * co - ft * (x2 * y + 2 * x1 * y1 + x * y2) - ff * (y1 * y1 + y * y2);
  const double length = std::hypot(x1, z1);
  Outline o;
  o.tx = length > 0 ? x1 / length : 1;
  o.tz = length > 0 ? z1 / length : 0;
  const double turn = length > 0 ? (x1 * z2 - z1 * x2) / square(length) : 0;
  o.x = a.ring * x + a.corner * o.tz;
  o.z = a.corner + a.ring * z - a.corner * o.tx;
  o.speed = a.ring * length + a.corner * turn;
  return o;
}

/// A first guess of the angle at which the outline reaches the top level: near the contact point the level
/// grows with the square of the angle. Where the tool cuts in beside the contact point it does not; then a
/// small angle to begin with.
double first_guess(const Side& a) {
  constexpr double kSmall = 1e-2;
  const double bend = a.sa - a.ring * (a.k_ff * a.s * a.s - 2 * a.k_ft * a.s * a.cb);
  if (!(a.cb > 0) || !(a.ring > 0)) return kSmall;
  // Curvature of the ring's profile, of the bull nose's, and what the surface leaves of it.
  const double ring = bend / (a.ring * square(a.cb));
  const double nose = ring / (1 + a.corner * ring);
  const double rest = nose - a.circle.k;
  if (!(ring > 0) || !(rest > 0)) return kSmall;
  return std::sqrt(2 * a.circle.h / rest) * nose / ring / (a.ring * a.cb);
}

/// The first angle in [0, hi] at which the outline reaches the top level, hi when it does not.
double outline_reaches_top(const Side& a, double hi) {
  constexpr double kStride = 1.3;  // of the steps until the level is passed
  const double top = a.circle.top(), root = std::sqrt(top);
  const auto level = [&](const Outline& o) { return a.circle.level(o.x, o.z); };
  double lo = 0, angle = std::min(first_guess(a), hi);
  Outline o = outline(a, angle);
  while (level(o) < top) {
    if (angle >= hi) return hi;
    lo = angle;
    angle = std::min(kStride * angle, hi);
    o = outline(a, angle);
  }
  hi = angle;
  for (int i = 0; i < kMaxSteps; ++i) {
    const double at = level(o);
    (at < top ? lo : hi) = angle;
    const double slope = (o.tz - a.circle.k * (o.x * o.tx + o.z * o.tz)) * o.speed;
    double to = at > 0 ? angle - (std::sqrt(at) - root) * 2 * std::sqrt(at) / slope : lo;
    if (std::abs(to - angle) <= kAngleShare * angle) return to;
    if (!(to > lo && to < hi)) to = 0.5 * (lo + hi);
    if (hi - lo <= kAngleShare * hi) return hi;
    angle = to;
    o = outline(a, angle);
  }
  return hi;
}

double bull_side(const Side& a) {
  const double side = 2 * std::atan2(1.0, side_begins(a));
  double end = outline_reaches_top(a, side);
  const auto widens = [&](const Outline& o) { return a.circle.k * (o.x * o.tz - o.z * o.tx) + o.tx > 0; };
  Outline o = outline(a, end);
  if (widens(o)) return end == side ? along_side(a, o.x, o.z) : a.circle.foot(o.x, o.z);
  double lo = 0, hi = end;
  while (hi - lo > kAngleShare * hi) {
    const double mid = 0.5 * (lo + hi);
    (widens(outline(a, mid)) ? lo : hi) = mid;
  }
  o = outline(a, hi);
  return a.circle.foot(o.x, o.z);
}

/// A bull nose without tilt stands on its flat bottom: half its width, then round the corner.
double resting_side(const Side& a) {
  if (a.corner == 0) return flat_side(a);
  // The corner's circle, centre (ring, corner): as the ball's, seen from the middle of the flat.
  double lo = 0, hi = geom::kPi / 2;
  const auto place = [&](double angle) {
    return Outline{a.ring + a.corner * std::sin(angle), a.corner * (1 - std::cos(angle)), std::cos(angle),
                   std::sin(angle), 0};
  };
  const auto within = [&](double angle) {
    const Outline o = place(angle);
    return a.circle.level(o.x, o.z) <= a.circle.top() && a.circle.k * (o.x * o.tz - o.z * o.tx) + o.tx >= 0;
  };
  if (!within(0)) {
    // The flat is left before its end: z = 0 at the top level.
    const double x = std::sqrt(-2 * a.circle.top() / a.circle.k);
    return a.circle.foot(std::min(x, a.ring), 0);
  }
  while (hi - lo > kAngleShare * hi) {
    const double mid = 0.5 * (lo + hi);
    (within(mid) ? lo : hi) = mid;
  }
  const Outline o = place(lo);
  return a.circle.foot(o.x, o.z);
}

/// Finite, not negative; not more than half round a circle.
double bounded(double width, double k) {
  if (!(width > 0)) return 0;
  return k == 0 ? width : std::min(width, geom::kPi / std::abs(k));
}

double one_side(const Side& a, bool rests) {
  const double width = rests ? resting_side(a) : a.corner > 0 ? bull_side(a) : flat_side(a);
  return bounded(std::isfinite(width) ? width : 0, a.circle.k);
}

}  // namespace

Strip strip_at(const CcPoint& at, const Angles& angles, const model::Mill& mill, double scallop_mm) {
  if (!(scallop_mm > 0)) return {};
  const double r = mill.kind == model::MillKind::flat ? 0 : mill.corner_radius;
  const bool rests = angles.alpha <= kNoTilt;
  const double beta = rests ? 0 : angles.beta;
  const double sb = std::sin(beta);
  Side a;
  a.s = sb;
  a.cb = std::max(0.0, std::cos(beta));
  a.sa = rests ? 0 : std::sin(angles.alpha);
  a.ca = std::max(0.0, std::cos(angles.alpha));
  a.ring = mill.radius - r, a.corner = r, a.reach = std::max(0.0, mill.length - r);
  a.circle = {at.k_tt, scallop_mm};
  // The surface at the height of the ring, to which the edge's way along the feed is compared.
  const double ff = at.k_ff * r < 1 ? at.k_ff / (1 - at.k_ff * r) : kInfinity;
  const double ft_share = (1 - at.k_ff * r) * (1 - at.k_tt * r);
  a.k_ff = std::isfinite(ff) ? ff : 0;
  a.k_ft = ft_share > 0 ? at.k_ft / ft_share : 0;
  Strip strip;
  strip.left = one_side(a, rests);
  a.s = -a.s, a.k_ft = -a.k_ft;
  strip.right = one_side(a, rests);
  return strip;
}

Strip ball_strip(const CcPoint& at, double ball_radius, double scallop_mm) {
  const double k = at.k_tt, r = ball_radius;
  if (!(k * r < 1) || !(scallop_mm > 0) || !(r > 0)) return {};
  const Circle circle{k, scallop_mm};
  // level = z (1 - k r) on the ball's circle; its widest place is where a normal of the surface touches it
  // (for a concave surface the shank begins before that).
  const double widest = r * (k < 0 ? 1 / (1 - k * r) : 1.0);
  const double z = std::min(circle.top() / (1 - k * r), widest);
  const double x = std::sqrt(std::max(0.0, z * (2 * r - z)));
  const double width = bounded(circle.foot(x, z), k);
  return {width, width};
}

double StripGoal::value(const CcPoint& at, const Angles& angles) const {
  const Strip strip = strip_at(at, angles, *mill_, scallop_mm_);
  return count_ == StripCount::whole ? strip.width() : 2 * std::min(strip.left, strip.right);
}

}  // namespace burin::orient
