// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/scallop.h"

#include <algorithm>
#include <cmath>

namespace burin::cycle {
namespace {

// Point of the circle |X - b| = R in the plane through b across `axis` with |X - a| = R, on the side `down`.
bool cusp_point(Point3 b, Vec3 axis, Point3 a, double radius, Vec3 down, Point3& x) {
  const Vec3 to = a - b;
  const double e = dot(to, axis);
  const Vec3 flat = to - e * axis;
  const double d = norm(flat);
  // Nearly the same centre: the cusp is right below it.
  constexpr double kSameCentre = 1e-12;
  Vec3 side = d > kSameCentre * radius ? flat / d : Vec3{};
  const double along = d > kSameCentre * radius ? (e * e + d * d) / (2 * d) : 0;
  if (!(along < radius)) return false;
  Vec3 g = down - dot(down, axis) * axis;
  g = unit(g - dot(g, side) * side);
  x = b + along * side + std::sqrt(radius * radius - along * along) * g;
  return true;
}

// The nearest of the creases between two parameters may be nearer than what Gauss-Newton found.
bool try_creases(const Sheet& sheet, Point3 x, double wa, double wb, double t, Contact& best) {
  bool nearer = false;
  for (const double crease : sheet.w_creases()) {
    if (!(crease > std::min(wa, wb) && crease < std::max(wa, wb))) continue;
    double tc = t;
    for (int i = 0; i < 6; ++i) {
      const Contact c = sheet.contact(tc, crease);
      if (distance(x, c.s) < distance(x, best.s)) {
        const Vec3 n = best.n;
        best = c;
        best.n = unit(n + c.n);
        nearer = true;
      }
      const double tt = dot(c.st, c.st);
      if (!(tt > 0)) break;
      tc = std::clamp(tc + dot(x - c.s, c.st) / tt, sheet.t_range().lo, sheet.t_range().hi);
    }
  }
  return nearer;
}

/// The cusp seen from the surface.
struct Foot {
  double height = 0;
  bool outside = false;  ///< the cusp stands beyond the end of the paths
};

Foot foot_of(const Sheet& sheet, Point3 x, double ta, double wa, double tb, double wb, double step) {
  double t = 0.5 * (ta + tb), w = 0.5 * (wa + wb);
  // A thousandth of the step off the foot changes the height by a millionth of the cusp.
  Contact c = sheet.nearest(x, t, w, 1e-3 * step);
  const bool crease = !sheet.w_creases().empty() && try_creases(sheet, x, wa, wb, t, c);
  const Vec3 e = x - c.s;
  const double along = dot(e, c.n);
  Foot f;
  // On a crease the distance counts; at a border the cusp may stand a little outside, which is no height.
  f.height = (crease ? std::copysign(norm(e), along) : along) - sheet.stock();
  const bool at_end = t <= sheet.t_range().lo || t >= sheet.t_range().hi;
  f.outside = at_end && std::abs(dot(e, unit(c.st))) > 3e-3 * step;
  return f;
}

// What a ball leaves at a surface point.
double left_by(const Sheet& sheet, const Contact& at, Point3 centre) {
  const Vec3 q = centre - at.s;
  const double b = dot(q, at.n);
  const double off2 = std::max(0.0, dot(q, q) - b * b);
  const double r2 = sheet.radius() * sheet.radius();
  if (!(off2 < r2)) return kNoOverlap;
  return b - std::sqrt(r2 - off2) - sheet.stock();
}

// The cusp on the edge t = const where the paths end: the place that both leave equally high. The new path is
// the half-line from (or through) its centre along `axis`.
double edge_cusp(const Sheet& sheet, const Before& before, double t_edge, double wa, double wb,
                 const Contact& b, Vec3 axis, bool ends_here) {
  const double reach = sheet.radius() + sheet.stock();
  const double inward = t_edge <= sheet.t_range().lo ? 1 : -1;
  const auto both = [&](double w, double& ha, double& hb) {
    const Contact q = sheet.contact(t_edge, w);
    const Point3 over = q.s + reach * q.n;
    ha = left_by(sheet, q, before.centres(t_edge).find(over).c);
    double s = dot(over - b.c, axis);
    if (ends_here && s * inward < 0) s = 0;
    hb = left_by(sheet, q, b.c + s * axis);
  };
  double lo = wa, hi = wb, h = kNoOverlap;
  constexpr int kHalvings = 12;  // the heights are linear there: 1/4096 of the step is 1e-3 of the cusp
  for (int i = 0; i < kHalvings; ++i) {
    const double w = 0.5 * (lo + hi);
    double ha = 0, hb = 0;
    both(w, ha, hb);
    h = std::min(h, std::max(ha, hb));
    (ha < hb ? lo : hi) = w;
  }
  return h;
}

// The centre's surface runs backwards: (1 + r k1)(1 + r k2) of the principal curvatures, or both, below 0.
bool fold(const Contact& c) {
  if (c.degenerate) return false;
  const double turned = dot(cross(c.ct, c.cw), cross(c.st, c.sw));
  const double trace = dot(c.ct, c.st) * dot(c.sw, c.sw) + dot(c.cw, c.sw) * dot(c.st, c.st);
  return turned < 0 || trace < 0;
}

// A crease across the paths within two steps of the new path's place at t, or between it and the old one's.
bool near_crease(const Sheet& sheet, double t, double s, double speed, double step) {
  constexpr double kSteps = 2;
  return std::any_of(sheet.t_creases().begin(), sheet.t_creases().end(), [&](double crease) {
    return (t - crease) * (s - crease) <= 0 || std::abs(t - crease) * speed < kSteps * step;
  });
}

double on_surface(const Sheet& sheet, Point3 sa, double ta, double wa, Point3 sb, double tb, double wb) {
  const Point3 mid = sheet.point(0.5 * (ta + tb), 0.5 * (wa + wb));
  const double one = distance(sa, sb), two = distance(sa, mid) + distance(mid, sb);
  // Chords: the error falls with the square of their length.
  return two + (two - one) / 3;
}

}  // namespace

bool Pass::covers(double t) const {
  return std::any_of(graphs.begin(), graphs.end(),
                     [t](const Graph& g) { return t >= g.lo() && t <= g.hi(); });
}

double Pass::w_at(double t) const {
  const Graph* nearest = nullptr;
  double away = 0;
  for (const Graph& g : graphs) {
    const double d = std::max({g.lo() - t, t - g.hi(), 0.0});
    if (nearest == nullptr || d < away) nearest = &g, away = d;
  }
  return nearest == nullptr ? 0.0 : nearest->at(t).w;
}

double height_over(const Sheet& sheet, const Contact& at, Point3 centre) {
  return left_by(sheet, at, centre);
}

double height_at(const Sheet& sheet, double t, double w, Point3 centre) {
  return left_by(sheet, sheet.contact(t, w), centre);
}

Cusp cusp(const Sheet& sheet, const Before& before, double t, double w, std::optional<double> slope,
          bool ends, geom::Side side) {
  const Contact b = sheet.contact(t, w, side);
  Cusp r;
  if (before.pole) {
    r.s = t;
    r.height = height_at(sheet, before.pole_t, before.pole_w, b.c);
    const Point3 pole = sheet.point(before.pole_t, before.pole_w);
    r.side_step = on_surface(sheet, pole, t, before.pole_w, b.s, t, w);
    return r;
  }
  NearestCentre::Place a = before.centres(t).find(b.c);
  double wa = before.path->w_at(a.s);
  const Contact at_a = sheet.contact(a.s, wa);
  // On a crease the ball of the path before may stand on either side of it, or between.
  const Vec3 down = -(unit(a.c - at_a.s) + b.n);
  r.s = a.s;
  r.side_step = on_surface(sheet, at_a.s, a.s, wa, b.s, t, w);
  // Contacts and centres of a ball that fits move the same way; at (1 - R / rho) of the way, 0 where the ball
  // just fits.
  constexpr double kFits = 0.02;
  r.too_tight =
      fold(at_a) || fold(b) || dot(b.c - a.c, b.s - at_a.s) < kFits * dot(b.s - at_a.s, b.s - at_a.s);
  // Neighbours are nearly parallel; a direction that is not (a spline that still swings while I2 looks for
  // its path) says nothing about the cusp.
  constexpr double kParallel = 0.94;
  const Vec3 old = unit(a.tangent), own = slope ? unit(b.ct + *slope * b.cw) : old;
  Vec3 axis = norm(old) > 0 && std::abs(dot(old, own)) < kParallel ? old : own;
  const Vec3 apart = a.c - b.c;
  // Beyond its end the path before is the sphere about it: what stands between two spheres lies in the plane
  // that holds both centres, whatever the direction of the new path. At creases that the paths cross both
  // paths have bends, whose directions say nothing of the path as a whole; there too.
  const bool bends = !ends && near_crease(sheet, t, a.s, norm(b.st), distance(b.c, a.c));
  if (const Vec3 around = cross(apart, down); (a.at_end || bends) && norm(around) > 0)
    axis = dot(around, axis) < 0 ? -unit(around) : unit(around);
  const double radius = sheet.radius();
  const geom::Interval ts = sheet.t_range();
  const bool at_edge = ends && (t <= ts.lo || t >= ts.hi);
  Point3 x;
  if (!cusp_point(b.c, axis, a.c, radius, down, x)) {
    // The two centres face each other at a slant: the plane between them instead of the one across the path.
    const Vec3 square = unit(axis - (dot(axis, apart) / dot(apart, apart)) * apart);
    if (!cusp_point(b.c, square, a.c, radius, down, x)) {
      r.height = kNoOverlap;
      return r;
    }
  }
  // The nearest centre of the old path to the cusp itself; the paths are nearly parallel, so that this
  // settles at once. Where the surface is bent more sharply than the ball another part of the old path may
  // be nearer: that is no neighbour.
  constexpr int kRounds = 3;
  const double step = distance(b.c, a.c);
  for (int i = 0; i < kRounds; ++i) {
    const NearestCentre::Place next = before.centres(t).find(x);
    if (distance(next.c, b.c) > 2 * step) break;
    const double moved = distance(next.c, a.c);
    if (!(moved > 1e-4 * step)) break;
    Point3 y;
    if (!cusp_point(b.c, axis, next.c, radius, down, y)) break;
    a = next;
    x = y;
  }
  wa = before.path->w_at(a.s);
  r.s = a.s;
  const Foot foot = foot_of(sheet, x, a.s, wa, t, w, std::max(step, r.side_step));
  r.height = foot.height;
  if (foot.outside || at_edge) {
    // Where the cusp leaves the surface its last place is on the edge.
    const double t_edge = at_edge ? t : (t > 0.5 * (ts.lo + ts.hi) ? ts.hi : ts.lo);
    const Vec3 forward = dot(axis, b.ct) >= 0 ? axis : -axis;
    const double edge = edge_cusp(sheet, before, t_edge, before.path->w_at(t_edge), w, b, forward, at_edge);
    r.height = foot.outside ? edge : std::max(edge, r.height);
  }
  return r;
}

}  // namespace burin::cycle
