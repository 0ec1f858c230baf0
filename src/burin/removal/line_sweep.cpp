// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/line_sweep.h"

#include <algorithm>

#include "burin/geom/point_tools.h"

namespace burin::removal {
namespace {

using geom::component;
using geom::Point3;
using geom::Vec3;

// Directions (sines) and ways (mm) below this are 0: over a length of 1 m the line moves by 1e-6 mm.
constexpr double kNone = 1e-9;
// A place so near (mm) to both faces of a sharp edge lies on it: far above rounding, far below a resolution.
constexpr double kOnEdge = 1e-6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMostParts = 10'000;

/// a s^2 + 2 b s + c <= 0.
struct Roots {
  double lo = 0, hi = 0;
  bool any = false;
};
Roots roots(double a, double b, double c) {
  const double d = b * b - a * c;
  if (!(d >= 0)) return {};
  const double r = std::sqrt(d);
  return {(-b - r) / a, (-b + r) / a, true};
}

}  // namespace

Motion Motion::part(const verify::Stretch& stretch, double from, double to) {
  const verify::Placed middle = stretch.at(0.5 * (from + to));
  return {middle.tip, middle.axis, (to - from) * stretch.way, (to - from) * stretch.turn, stretch.angle > 0};
}

/// A place at rho from the tip goes a curve whose second derivative is at most rho turn^2 + 2 turn way; from
/// the tangent in the middle it is an eighth of that away at the ends.
int Motion::parts(const verify::Stretch& stretch, double span, double tolerance) {
  const double turn = stretch.angle;
  if (!(turn > 0)) return 1;
  const double bend = (span * turn * turn + 2 * turn * norm(stretch.way)) / 8;
  // Normals turn, too: more than this at once and tangents no longer say where the envelope is.
  constexpr double kTurn = 0.05;
  return static_cast<int>(
      std::clamp(std::ceil(std::max(std::sqrt(bend / tolerance), turn / kTurn)), 1.0, double{kMostParts}));
}

LineSweep::LineSweep(const verify::MillBody& body, const Motion& motion, std::size_t along, double tolerance,
                     double reach)
    : body_(body),
      motion_(motion),
      along_(along),
      u_((along + 1) % 3),
      v_((along + 2) % 3),
      tolerance_(tolerance),
      tip_u_(component(motion.tip, u_)),
      tip_v_(component(motion.tip, v_)),
      tip_h_(component(motion.tip, along)) {
  straight_ = frame(motion.way);
  const double grow = 0.5 * (norm(motion.way) + norm(motion.turn) * reach) + tolerance;
  const double across = straight_.e1 * straight_.e1 + straight_.e2 * straight_.e2;
  grown_ = {(body.radius + grow) * (body.radius + grow),
            body.low - grow,
            body.high + grow,
            body.low + body.radius,
            across > kNone ? 1 / across : 0,
            std::abs(straight_.e3) > kNone ? 1 / straight_.e3 : 0,
            body.corner >= body.radius};
  if (!motion.turns) return;
  const Vec3 e{along == 0 ? 1.0 : 0.0, along == 1 ? 1.0 : 0.0, along == 2 ? 1.0 : 0.0};
  along_turn_ = cross(motion.turn, e);
}

LineSweep::Frame LineSweep::frame(Vec3 way) const {
  Frame f;
  f.axis = motion_.axis;
  f.w3 = dot(way, f.axis);
  const Vec3 across = way - f.w3 * f.axis;
  f.w1 = norm(across);
  if (f.w1 > kNone) {
    f.first = across / f.w1;
  } else {
    f.w1 = 0;
    const Vec3 any = std::abs(f.axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    f.first = unit(any - dot(any, f.axis) * f.axis);
  }
  f.second = cross(f.axis, f.first);
  f.e1 = component(f.first, along_);
  f.e2 = component(f.second, along_);
  f.e3 = component(f.axis, along_);
  if (std::abs(f.w3) < kNone) f.w3 = 0;
  f.way = std::sqrt(f.w1 * f.w1 + f.w3 * f.w3);
  return f;
}

/// The line at the height of the tip.
LineSweep::Place LineSweep::place(const Frame& f, double du, double dv) const {
  return {du * component(f.first, u_) + dv * component(f.first, v_),
          du * component(f.second, u_) + dv * component(f.second, v_),
          du * component(f.axis, u_) + dv * component(f.axis, v_)};
}

LineSweep::Bounds LineSweep::around(double u, double v) const {
  const Frame& f = straight_;
  const Place p = place(f, u - tip_u_, v - tip_v_);
  const double c = p.x * p.x + p.y * p.y - grown_.radius2, b = p.x * f.e1 + p.y * f.e2;
  double from = -kInfinity, to = kInfinity;
  if (grown_.per_e > 0) {
    const double d = b * b - (1 - f.e3 * f.e3) * c;
    if (d < 0) return {};
    const double r = std::sqrt(d);
    from = (-b - r) * grown_.per_e, to = (-b + r) * grown_.per_e;
  } else if (c > 0) {
    return {};
  }
  if (grown_.per_e3 != 0) {
    const double s = (grown_.low - p.z) * grown_.per_e3, t = (grown_.high - p.z) * grown_.per_e3;
    from = std::max(from, std::min(s, t)), to = std::min(to, std::max(s, t));
  } else if (p.z < grown_.low || p.z > grown_.high) {
    return {};
  }
  if (grown_.ball) {
    const double z = p.z - grown_.center;
    const bool low_a = z + from * f.e3 < 0, low_b = z + to * f.e3 < 0;
    if (low_a || low_b) {
      const double bs = b + z * f.e3, d = bs * bs - (c + z * z);
      if (d < 0 && low_a && low_b) return {};
      const double r = std::sqrt(std::max(d, 0.0));
      if (low_a) from = std::max(from, -bs - r);
      if (low_b) to = std::min(to, -bs + r);
    }
  }
  return {from + tip_h_, to + tip_h_};
}

Covered LineSweep::line(double u, double v) {
  du_ = u - tip_u_, dv_ = v - tip_v_;
  Covered c = motion_.turns ? turning(du_, dv_) : solve(straight_, du_, dv_);
  c.a += tip_h_, c.b += tip_h_;
  return c;
}

/// Places of the tool on the line at h go (way + turn x (place - tip)) t. Both ends are found with the way of
/// the place where they are.
Covered LineSweep::turning(double du, double dv) {
  Vec3 from_tip;
  const auto set = [](Vec3& p, std::size_t axis, double value) {
    (axis == 0 ? p.x : axis == 1 ? p.y : p.z) = value;
  };
  set(from_tip, u_, du), set(from_tip, v_, dv);
  const Vec3 way = motion_.way + cross(motion_.turn, from_tip);
  // First with the way of the place nearest to the tool's axis.
  const double up = dot(from_tip, motion_.axis), e3 = component(motion_.axis, along_);
  const double across2 = 1 - e3 * e3;
  double h = across2 > kNone ? e3 * up / across2 : 0;
  if (std::abs(e3) > kNone) {
    const double h0 = (body_.low - up) / e3, h1 = (body_.high - up) / e3;
    h = std::clamp(h, std::min(h0, h1), std::max(h0, h1));
  }
  const double span = body_.radius + std::max(std::abs(body_.low), std::abs(body_.high));
  h = std::clamp(h, -span, span);  // no place of the tool is farther
  turned_ = frame(way + h * along_turn_);
  frame_a_ = frame_b_ = &turned_;
  Covered c = solve(turned_, du, dv);
  if (c.empty()) return c;
  const double change = 0.5 * norm(along_turn_);
  // Twice: the second time the way is wrong by what the end moved in the first.
  const auto refine = [&](double& end, double& time, double Covered::*which, double Covered::*when,
                          Frame& own, const Frame*& used) {
    double at = h;
    for (int i = 0; i < 2 && change * std::abs(end - at) > 0.25 * tolerance_; ++i) {
      at = end;
      const Frame next = frame(way + at * along_turn_);
      const Covered better = solve(next, du, dv);
      if (better.empty()) return;
      own = next, used = &own, end = better.*which, time = better.*when;
    }
  };
  refine(c.a, c.time_a, &Covered::a, &Covered::time_a, turned_a_, frame_a_);
  refine(c.b, c.time_b, &Covered::b, &Covered::time_b, turned_b_, frame_b_);
  return c;
}

Covered LineSweep::solve(const Frame& f, double du, double dv) const {
  const Place p = place(f, du, dv);
  // Across the way the line stays outside: the most frequent answer.
  if (std::abs(f.e2) <= kNone && std::abs(p.y) >= body_.radius) return {};
  Covered c;
  cylinder(f, p, body_.radius, body_.low + body_.corner, body_.high, c);
  if (body_.corner > 0) {
    if (body_.corner >= body_.radius) {
      sphere(f, p, body_.radius, body_.low + body_.radius, c);
    } else {
      cylinder(f, p, body_.radius - body_.corner, body_.low, body_.high, c);
      rounded_edge(f, p, c);
    }
  }
  return c;
}

/// The set of (h, time) at which a place of the line is in the cylinder is convex: |time| <= 1/2, two planes
/// and an ellipse (or strip). Its ends in h lie on its corners, on the places where a straight side meets the
/// ellipse, or at the ends of the ellipse itself.
void LineSweep::cylinder(const Frame& f, const Place& p, double radius, double low, double high,
                         Covered& out) {
  if (!(low < high)) return;
  moment(f, p, -0.5, radius, low, high, out);
  if (f.w1 == 0 && f.w3 == 0) return;
  moment(f, p, 0.5, radius, low, high, out);
  if (f.w1 > 0 && std::abs(f.e2) > kNone) {
    for (const double side : {-radius, radius}) {
      const double h = (side - p.y) / f.e2, time = (p.x + h * f.e1) / f.w1;
      const double z = p.z + h * f.e3 - time * f.w3;
      if (std::abs(time) <= 0.5 && z >= low && z <= high) out.add(h, time);
    }
  }
  slab_edge(f, p, radius, low, out);
  slab_edge(f, p, radius, high, out);
}

void LineSweep::moment(const Frame& f, const Place& p, double time, double radius, double low, double high,
                       Covered& out) {
  const double x = p.x - time * f.w1, z = p.z - time * f.w3;
  double a = -kInfinity, b = kInfinity;
  if (std::abs(f.e3) > kNone) {
    const double s = (low - z) / f.e3, t = (high - z) / f.e3;
    a = std::min(s, t), b = std::max(s, t);
  } else if (z < low || z > high) {
    return;
  }
  const double e = f.e1 * f.e1 + f.e2 * f.e2, c = x * x + p.y * p.y - radius * radius;
  if (e > kNone * kNone) {
    const Roots r = roots(e, x * f.e1 + p.y * f.e2, c);
    if (!r.any) return;
    a = std::max(a, r.lo), b = std::min(b, r.hi);
  } else if (c > 0) {
    return;
  }
  if (a > b) return;
  out.add(a, time);
  out.add(b, time);
}

/// Where the line meets the rim at `height` while it moves.
void LineSweep::slab_edge(const Frame& f, const Place& p, double radius, double height, Covered& out) {
  if (std::abs(f.e3) >= std::abs(f.w3) && std::abs(f.e3) > kNone) {
    // h = h0 + time k
    const double h0 = (height - p.z) / f.e3, k = f.w3 / f.e3;
    const double x0 = p.x + h0 * f.e1, x1 = k * f.e1 - f.w1, y0 = p.y + h0 * f.e2, y1 = k * f.e2;
    const double a = x1 * x1 + y1 * y1;
    if (!(a > kNone * kNone)) return;
    const Roots r = roots(a, x0 * x1 + y0 * y1, x0 * x0 + y0 * y0 - radius * radius);
    if (!r.any) return;
    for (const double time : {r.lo, r.hi})
      if (std::abs(time) <= 0.5) out.add(h0 + time * k, time);
  } else if (std::abs(f.w3) > kNone) {
    // time = t0 + h k
    const double t0 = (p.z - height) / f.w3, k = f.e3 / f.w3;
    const double x0 = p.x - f.w1 * t0, x1 = f.e1 - f.w1 * k;
    const double a = x1 * x1 + f.e2 * f.e2;
    if (!(a > kNone * kNone)) return;
    const Roots r = roots(a, x0 * x1 + p.y * f.e2, x0 * x0 + p.y * p.y - radius * radius);
    if (!r.any) return;
    for (const double h : {r.lo, r.hi})
      if (std::abs(t0 + h * k) <= 0.5) out.add(h, t0 + h * k);
  }
}

/// The lower half of a sphere about the axis at `height` that moves along a segment; its upper half is the
/// cylinder's matter.
void LineSweep::sphere(const Frame& f, const Place& p, double radius, double height, Covered& out) {
  const double z = p.z - height, r2 = radius * radius;
  for (const double time : {-0.5, 0.5}) {
    const double x = p.x - time * f.w1, zt = z - time * f.w3;
    const Roots r = roots(1, x * f.e1 + p.y * f.e2 + zt * f.e3, x * x + p.y * p.y + zt * zt - r2);
    if (!r.any) continue;
    for (const double h : {r.lo, r.hi})
      if (zt + h * f.e3 <= 0) out.add(h, time);
  }
  const double way = f.way;
  if (!(way > kNone)) return;
  const double d1 = f.w1 / way, d3 = f.w3 / way;
  const double along = f.e1 * d1 + f.e3 * d3, done = p.x * d1 + z * d3, a = 1 - along * along;
  if (!(a > kNone)) return;
  const Roots r = roots(a, p.x * f.e1 + p.y * f.e2 + z * f.e3 - done * along,
                        p.x * p.x + p.y * p.y + z * z - done * done - r2);
  if (!r.any) return;
  for (const double h : {r.lo, r.hi}) {
    const double time = (done + h * along) / way;
    if (std::abs(time) <= 0.5 && z + h * f.e3 - time * f.w3 <= 0) out.add(h, time);
  }
}

/// Distance of the place of the line at h to the moving disc that the rounded edge is rolled about: least of
/// all times (which is a convex function of the time), and its slope along the line.
double LineSweep::nearest_to_disc(const Frame& f, const Place& p, double h, double& time,
                                  double& slope) const {
  const double disc = body_.radius - body_.corner;
  const double x0 = p.x + h * f.e1, y = p.y + h * f.e2, z0 = p.z + h * f.e3 - (body_.low + body_.corner);
  double gx = 0, gy = 0, gz = 0;
  const auto at = [&](double t, double& rate) {
    const double x = x0 - t * f.w1, z = z0 - t * f.w3, rho = std::sqrt(x * x + y * y), out = rho - disc;
    const double aside = std::max(out, 0.0), far = std::sqrt(aside * aside + z * z);
    gx = gy = gz = 0;
    if (far > 0) {
      if (out > 0) gx = out / far * x / rho, gy = out / far * y / rho;
      gz = z / far;
    }
    rate = -(gx * f.w1 + gz * f.w3);
    return far;
  };
  double lo = -0.5, hi = 0.5, r_lo = 0, r_hi = 0;
  time = lo;
  double d = at(lo, r_lo);
  if (r_lo < 0) {
    time = hi;
    d = at(hi, r_hi);
    // Regula falsi (Illinois) on the rate; what is left to gain is below |rate| (hi - lo).
    constexpr int kSteps = 40;
    for (int i = 0; i < kSteps && r_hi > 0; ++i) {
      const double t = std::clamp(lo + (hi - lo) * (-r_lo / (r_hi - r_lo)), lo, hi);
      double r = 0;
      time = t;
      d = at(t, r);
      if (std::abs(r) * (hi - lo) <= 0.02 * tolerance_) break;
      if (r < 0) {
        lo = t, r_lo = r, r_hi *= 0.5;
      } else {
        hi = t, r_hi = r, r_lo *= 0.5;
      }
    }
  }
  slope = gx * f.e1 + gy * f.e2 + gz * f.e3;
  return d;
}

/// Newton from outside: the distance to the moving disc is convex along the line, so no step goes too far.
void LineSweep::rounded_edge(const Frame& f, const Place& p, Covered& out) const {
  Covered outer;
  cylinder(f, p, body_.radius, body_.low, body_.high, outer);
  if (outer.empty()) return;
  const auto enter = [&](double from, double inner, double sense) {
    // What flat pieces cover already needs no search.
    double h = from, time = 0;
    constexpr int kSteps = 60;
    for (int i = 0; i < kSteps && sense * (inner - h) > 0.1 * tolerance_; ++i) {
      double slope = 0;
      const double gap = nearest_to_disc(f, p, h, time, slope) - body_.corner;
      if (gap <= 0.1 * tolerance_) {
        // Above the disc the edge is no longer round: the cylinder's matter.
        if (p.z + h * f.e3 - time * f.w3 <= body_.low + body_.corner) out.add(h, time);
        return;
      }
      if (!(sense * slope < 0)) return;  // it only gets farther
      h -= gap / slope;
    }
  };
  const double a = out.a, b = out.b;
  enter(outer.a, a, 1);
  enter(outer.b, b, -1);
}

Vec3 LineSweep::normal(const Frame& f, double h, double time) const {
  const Place p = place(f, du_, dv_);
  const double along = h - tip_h_;
  const Place at{p.x + along * f.e1 - time * f.w1, p.y + along * f.e2, p.z + along * f.e3 - time * f.w3};
  const double rho = std::sqrt(at.x * at.x + at.y * at.y);
  const Vec3 aside = rho > 0 ? (at.x / rho) * f.first + (at.y / rho) * f.second : f.first;
  const double out = rho - (body_.radius - body_.corner), down = body_.low + body_.corner - at.z;
  if (body_.corner > 0 && out > 0 && down > 0) return unit(out * aside - down * f.axis);
  const double side = std::abs(body_.radius - rho), bottom = std::abs(at.z - body_.low),
               top = std::abs(body_.high - at.z);
  if (side < kOnEdge && std::min(bottom, top) < kOnEdge && std::abs(time) < 0.5)
    return rim_normal(f, at, bottom < top ? -1 : 1);
  if (side <= std::min(bottom, top)) return aside;
  return bottom < top ? -f.axis : f.axis;
}

/// Of the surface that a sharp edge of the tool sweeps: square to the edge and to its way.
Vec3 LineSweep::rim_normal(const Frame& f, const Place& at, double up) const {
  const double rho = std::sqrt(at.x * at.x + at.y * at.y);
  const Vec3 aside = (at.x / rho) * f.first + (at.y / rho) * f.second;
  const Vec3 way = f.w1 * f.first + f.w3 * f.axis, n = unit(cross(cross(f.axis, aside), way));
  const double outwards = dot(n, aside + up * f.axis);
  if (outwards == 0) return aside;
  return outwards < 0 ? -n : n;
}

}  // namespace burin::removal
