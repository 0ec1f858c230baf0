// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/sheet.h"

#include <algorithm>
#include <cmath>

namespace burin::cycle {
namespace {

using geom::Direction;
using geom::Side;

// |St x Sw| below this, relative to the typical |St| |Sw|: the direction of the normal has lost half of its
// digits.
constexpr double kDegenerate = 1e-8;
// Where a normal is not defined it is taken this far inside, relative to the domain: the nearest first. Its
// second derivatives lose digits with the square of this (1e-16 / 1e-10), and are 1e-5 of a domain off.
constexpr double kPulls[] = {1e-5, 1e-3, 1e-2};
// |n.k| below this counts as vertical.
constexpr double kVertical = 1e-6;

geom::SurfaceDerivatives swapped(const geom::SurfaceDerivatives& d) {
  geom::SurfaceDerivatives r;
  r.p = d.p;
  r.du = d.dv;
  r.dv = d.du;
  r.duu = d.dvv;
  r.duv = d.duv;
  r.dvv = d.duu;
  return r;
}

// Derivatives of the unit normal n = N / m, N = St x Sw:  n_i = (N_i - m_i n) / m,
// n_ij = (N_ij - m_ij n - m_i n_j - m_j n_i) / m,  m_i = n.N_i,  m_ij = n_j.N_i + n.N_ij.
struct NormalDerivatives {
  Vec3 t, w, tt, tw, ww;
};

NormalDerivatives unit_normal_derivatives(const geom::SurfaceDerivatives3& d) {
  const Vec3 big = cross(d.du, d.dv);
  const double m = norm(big);
  const Vec3 n = big / m;
  const Vec3 nt = cross(d.duu, d.dv) + cross(d.du, d.duv);
  const Vec3 nw = cross(d.duv, d.dv) + cross(d.du, d.dvv);
  const Vec3 ntt = cross(d.duuu, d.dv) + 2.0 * cross(d.duu, d.duv) + cross(d.du, d.duuv);
  const Vec3 ntw = cross(d.duuv, d.dv) + cross(d.duu, d.dvv) + cross(d.du, d.duvv);
  const Vec3 nww = cross(d.duvv, d.dv) + 2.0 * cross(d.duv, d.dvv) + cross(d.du, d.dvvv);
  const double mt = dot(n, nt), mw = dot(n, nw);
  NormalDerivatives r;
  r.t = (nt - mt * n) / m;
  r.w = (nw - mw * n) / m;
  r.tt = (ntt - (dot(r.t, nt) + dot(n, ntt)) * n - 2.0 * mt * r.t) / m;
  r.tw = (ntw - (dot(r.w, nt) + dot(n, ntw)) * n - mt * r.w - mw * r.t) / m;
  r.ww = (nww - (dot(r.w, nw) + dot(n, nww)) * n - 2.0 * mw * r.w) / m;
  return r;
}

// First derivatives of the unit normal n, which may be turned against St x Sw.
void normal_slopes(const geom::SurfaceDerivatives& d, Vec3 n, Vec3& nt, Vec3& nw) {
  const Vec3 big = cross(d.du, d.dv);
  const double k = std::copysign(1 / norm(big), dot(big, n));
  const Vec3 bt = cross(d.duu, d.dv) + cross(d.du, d.duv);
  const Vec3 bw = cross(d.duv, d.dv) + cross(d.du, d.dvv);
  nt = k * (bt - dot(bt, n) * n);
  nw = k * (bw - dot(bw, n) * n);
}

double typical_length(const geom::NurbsSurface& s, Direction d) {
  // Mean length of the control polygon's legs over the parameter range: the size that |St| is compared with.
  double sum = 0;
  const int nu = s.count_u, nv = s.count_v;
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      if (d == Direction::u && i + 1 < nu) sum += distance(project(s.at(i, j)), project(s.at(i + 1, j)));
      if (d == Direction::v && j + 1 < nv) sum += distance(project(s.at(i, j)), project(s.at(i, j + 1)));
    }
  const double lines = d == Direction::u ? nv : nu;
  return sum / lines / s.domain(d).length();
}

}  // namespace

Sheet::Sheet(const geom::NurbsSurface& surface, Direction along, double sign, double radius, double stock,
             std::optional<geom::Interval> inner)
    : along_(along),
      sign_(along == Direction::u ? sign : -sign),
      radius_(radius),
      stock_(stock),
      t_(surface.domain(along)),
      w_(surface.domain(other(along))),
      inner_(inner.value_or(t_)),
      size_t_(typical_length(surface, along)),
      size_w_(typical_length(surface, other(along))),
      t_knots_(geom::inner_knots(surface.knots(along), surface.degree(along))),
      w_knots_(geom::inner_knots(surface.knots(other(along)), surface.degree(other(along)))),
      evaluator_(surface) {
  for (const geom::Knot& k : w_knots_)
    if (k.multiplicity >= surface.degree(other(along)) && creased(k.value, false))
      w_creases_.push_back(k.value);
  for (const geom::Knot& k : t_knots_)
    if (k.multiplicity >= surface.degree(along) && creased(k.value, true)) t_creases_.push_back(k.value);
  // The edges are places where paths are cut.
  if (inner_.lo > t_.lo) t_knots_.insert(t_knots_.begin(), {inner_.lo, 0});
  if (inner_.hi < t_.hi) t_knots_.push_back({inner_.hi, 0});
}

// Pieces that were joined where they are tangent have full knots there, but no crease.
bool Sheet::creased(double value, bool in_t) const {
  // Below this the centre jumps by less than what a path is off by anyway.
  constexpr double kSmooth = 3e-4;
  constexpr int kSamples = 32;
  const geom::Interval across = in_t ? w_ : t_;
  for (int i = 0; i <= kSamples; ++i) {
    const double x = across.lo + across.length() * i / kSamples;
    const double t = in_t ? value : x, w = in_t ? x : value;
    const Contact l = contact(t, w, in_t ? Side::left : Side::right, in_t ? Side::right : Side::left);
    if (distance(l.c, contact(t, w).c) > kSmooth * radius_) return true;
  }
  return false;
}

geom::SurfaceDerivatives Sheet::at(double t, double w, Side side_t, Side side_w) const {
  if (along_ == Direction::u) return evaluator_.derivatives(t, w, side_t, side_w);
  return swapped(evaluator_.derivatives(w, t, side_w, side_t));
}

bool Sheet::normal_of(const geom::SurfaceDerivatives& d, Vec3& n) const {
  const Vec3 big = cross(d.du, d.dv);
  const double m = norm(big);
  if (!(m > kDegenerate * size_t_ * size_w_)) return false;
  n = (sign_ / m) * big;
  return true;
}

geom::Point2 Sheet::pulled_inside(double t, double w, double fraction) const {
  const double mt = 0.5 * (t_.lo + t_.hi), mw = 0.5 * (w_.lo + w_.hi);
  // Not exactly towards the middle, so that an inner degenerate line is left as well.
  return {t + fraction * t_.length() * (t <= mt ? 1.0 : -1.0),
          w + fraction * w_.length() * (w <= mw ? 1.0 : -1.0)};
}

Point3 Sheet::point(double t, double w) const {
  return along_ == Direction::u ? evaluator_.point(t, w) : evaluator_.point(w, t);
}

Contact Sheet::contact(double t, double w, Side side_t, Side side_w) const {
  const geom::SurfaceDerivatives d = at(t, w, side_t, side_w);
  Contact r;
  r.s = d.p;
  r.st = d.du;
  r.sw = d.dv;
  r.degenerate = !normal_of(d, r.n);
  if (r.degenerate) {
    r.n = {0, 0, 1};
    for (const double pull : kPulls) {
      const geom::Point2 p = pulled_inside(t, w, pull);
      const geom::SurfaceDerivatives inside = at(p.x, p.y, side_t, side_w);
      if (!normal_of(inside, r.n)) continue;
      Vec3 nt, nw;
      normal_slopes(inside, r.n, nt, nw);
      r.n = unit(r.n + (t - p.x) * nt + (w - p.y) * nw);
      break;
    }
  }
  r.c = r.s + (radius_ + stock_) * r.n;
  r.ct = r.st;
  r.cw = r.sw;
  if (!r.degenerate) {
    Vec3 nt, nw;
    normal_slopes(d, r.n, nt, nw);
    r.ct = r.st + (radius_ + stock_) * nt;
    r.cw = r.sw + (radius_ + stock_) * nw;
  }
  return r;
}

CentreDerivatives Sheet::derivatives(double t, double w, Side side_t, Side side_w) const {
  const auto at3 = [&](double a, double b) {
    if (along_ == Direction::u) return evaluator_.derivatives3(a, b, side_t, side_w);
    const geom::SurfaceDerivatives3 d = evaluator_.derivatives3(b, a, side_w, side_t);
    geom::SurfaceDerivatives3 r;
    static_cast<geom::SurfaceDerivatives&>(r) = swapped(d);
    r.duuu = d.dvvv;
    r.duuv = d.duvv;
    r.duvv = d.duuv;
    r.dvvv = d.duuu;
    return r;
  };
  const geom::SurfaceDerivatives3 d = at3(t, w);
  CentreDerivatives r;
  r.at.s = d.p;
  r.at.st = d.du;
  r.at.sw = d.dv;
  r.at.n = {0, 0, 1};
  r.at.degenerate = !normal_of(d, r.at.n);
  NormalDerivatives nd;
  if (!r.at.degenerate) {
    nd = unit_normal_derivatives(d);
  } else {
    for (const double pull : kPulls) {
      const geom::Point2 p = pulled_inside(t, w, pull);
      const geom::SurfaceDerivatives3 inside = at3(p.x, p.y);
      if (!normal_of(inside, r.at.n)) continue;
      nd = unit_normal_derivatives(inside);
      // Back to the place itself by Taylor.
      const double dt = t - p.x, dw = w - p.y;
      const Vec3 first = dt * nd.t + dw * nd.w;
      const Vec3 second = (0.5 * dt * dt) * nd.tt + (dt * dw) * nd.tw + (0.5 * dw * dw) * nd.ww;
      r.at.n = unit(r.at.n + sign_ * (first + second));
      nd.t = nd.t + dt * nd.tt + dw * nd.tw;
      nd.w = nd.w + dt * nd.tw + dw * nd.ww;
      break;
    }
  }
  const double reach = radius_ + stock_;
  r.at.c = r.at.s + reach * r.at.n;
  const double k = reach * sign_;
  r.at.ct = d.du + k * nd.t;
  r.at.cw = d.dv + k * nd.w;
  r.ctt = d.duu + k * nd.tt;
  r.ctw = d.duv + k * nd.tw;
  r.cww = d.dvv + k * nd.ww;
  return r;
}

Contact Sheet::nearest(Point3 x, double& t, double& w, double step) const {
  constexpr int kIterations = 8;
  Contact c = contact(t, w);
  Contact best = c;
  double best_t = t, best_w = w, best_distance = distance(x, c.s);
  for (int i = 0; i < kIterations; ++i) {
    const Vec3 e = x - c.s;
    // Normal equations of min |e - st a - sw b|, with a little damping against parallel tangents.
    const double damp = 1e-12;
    const double tt = dot(c.st, c.st) + damp * size_t_ * size_t_;
    const double ww = dot(c.sw, c.sw) + damp * size_w_ * size_w_;
    const double tw = dot(c.st, c.sw);
    const double rt = dot(e, c.st), rw = dot(e, c.sw);
    const double det = tt * ww - tw * tw;
    if (!(det > 0)) break;
    double a = (rt * ww - rw * tw) / det, b = (rw * tt - rt * tw) / det;
    // At the border one parameter is held and the other one solved for alone.
    if (t + a < t_.lo || t + a > t_.hi) {
      a = std::clamp(t + a, t_.lo, t_.hi) - t;
      b = (rw - a * tw) / ww;
    }
    if (w + b < w_.lo || w + b > w_.hi) {
      b = std::clamp(w + b, w_.lo, w_.hi) - w;
      a = std::clamp(t + (rt - b * tw) / tt, t_.lo, t_.hi) - t;
    }
    const double moved = norm(a * c.st + b * c.sw);
    if (!(moved > step)) break;
    t += a;
    w += b;
    c = contact(t, w);
    const double away = distance(x, c.s);
    if (away < best_distance) {
      best_distance = away;
      best = c;
      best_t = t;
      best_w = w;
    }
  }
  t = best_t;
  w = best_w;
  return best;
}

Point3 Sheet::uv(double t, double w) const {
  t = std::clamp(t, inner_.lo, inner_.hi);
  return along_ == Direction::u ? Point3{t, w, 0} : Point3{w, t, 0};
}

Vec3 Sheet::uv_vector(double t, double w) const {
  return along_ == Direction::u ? Vec3{t, w, 0} : Vec3{w, t, 0};
}

double side_that_looks_up(const geom::NurbsSurface& surface) {
  const geom::Interval u = surface.domain(Direction::u), v = surface.domain(Direction::v);
  const Vec3 middle = geom::normal(surface, u.lo + 0.5 * u.length(), v.lo + 0.5 * v.length());
  if (std::abs(middle.z) > kVertical) return middle.z > 0 ? 1 : -1;
  constexpr int kGrid = 8;
  double sum = 0;
  for (int j = 0; j <= kGrid; ++j)
    for (int i = 0; i <= kGrid; ++i) {
      const Vec3 n = geom::normal(surface, u.lo + u.length() * i / kGrid, v.lo + v.length() * j / kGrid);
      if (std::abs(n.z) > kVertical) sum += n.z;
    }
  if (std::abs(sum) <= kVertical) return 0;
  return sum > 0 ? 1 : -1;
}

}  // namespace burin::cycle
