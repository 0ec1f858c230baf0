// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/scene_turn.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burin::orient::detail {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kTurn = 2 * geom::kPi;
/// Tilts this near count as equal (rad): rounding of arcs, far below the 1e-9 that is promised.
constexpr double kSame = 1e-12;

/// The first angle from `now` on that is `when` up to whole turns.
double next(double when, double now) {
  const double turns = std::ceil((now - kSame - when) / kTurn);
  return std::max(when + kTurn * turns, now);
}

/// A circle in a meridian strip: x = rho sin(theta) - arm, h = rho cos(theta) + corner, y fixed.
struct Circle {
  double rho, y, arm, corner;
  Local at(double theta) const { return {rho * std::sin(theta) - arm, y, rho * std::cos(theta) + corner}; }
};

/// When the circle, inside now, first leaves the cylinder: each face in closed form.
double leaves_cylinder(const Circle& c, double radius, double from, double to, double now) {
  const double s = std::sqrt(std::max(radius * radius - c.y * c.y, 0.0));
  double first = kNever;
  const auto at = [&](double when) { first = std::min(first, next(when, now)); };
  // sin rises beyond k at asin(k), falls below at pi - asin(k); cos falls below at acos(k), rises at
  // -acos(k).
  if (const double k = (c.arm + s) / c.rho; std::abs(k) <= 1) at(std::asin(k));
  if (const double k = (c.arm - s) / c.rho; std::abs(k) <= 1) at(geom::kPi - std::asin(k));
  if (const double k = (from - c.corner) / c.rho; std::abs(k) <= 1) at(std::acos(k));
  if (const double k = (to - c.corner) / c.rho; std::abs(k) <= 1) at(-std::acos(k));
  return first;
}

/// How far the circle, beside the rim of a grown cylinder now, surely stays inside: the distance F from a
/// convex body bends by at most 1 / distance, so F(theta + x) <= F + F' x + M x^2 / 2.
double safe_step(const Circle& c, const Piece& p, const Local& q, double theta, double f) {
  const double r = std::hypot(q.x, q.y), out = std::max(r - p.radius, 0.0);
  const double up = q.h < p.from ? q.h - p.from : q.h > p.to ? q.h - p.to : 0.0;
  const double distance = std::hypot(out, up), plain = -f / c.rho;
  if (!(distance > 0)) return plain;
  const double dx = c.rho * std::cos(theta), dh = -c.rho * std::sin(theta);
  const double slope = ((out > 0 ? out * q.x / r * dx : 0) + up * dh) / distance;
  const double bend = 2 * c.rho * c.rho / distance + c.rho;
  const double root = std::sqrt(std::max(slope * slope - 2 * bend * f, 0.0));
  // Without cancellation where F' > 0.
  const double quadratic = slope > 0 ? -2 * f / (slope + root) : (root - slope) / bend;
  return std::max(plain, std::min(quadratic, 0.5 * distance / c.rho));
}

/// The last theta in [now, end] up to which the circle stays in the piece.
double stays(const Circle& c, const Piece& p, double now, double end) {
  constexpr int kSteps = 200;
  if (c.rho <= 0) return end;
  if (p.grow <= 0) return std::min(leaves_cylinder(c, p.radius, p.from, p.to, now), end);
  double theta = now;
  for (int i = 0; i < kSteps && theta < end; ++i) {
    const Local q = c.at(theta);
    const double f = excess(q, p);
    if (f >= 0) break;
    double ahead = theta;
    if (q.h >= p.from && q.h <= p.to) ahead = leaves_cylinder(c, p.radius + p.grow, p.from, p.to, theta);
    if (q.x * q.x + q.y * q.y < p.radius * p.radius)
      ahead = std::max(ahead, leaves_cylinder(c, p.radius, p.from - p.grow, p.to + p.grow, theta));
    ahead = std::max(ahead, theta + safe_step(c, p, q, theta, f));
    if (ahead - theta < kSame) return std::min(ahead, end);
    theta = ahead;
  }
  return std::min(theta, end);
}

}  // namespace

Turn::Turn(const CcPoint& at, double beta, const model::Mill& mill) : n_(at.n) {
  const double r = mill.kind == model::MillKind::flat ? 0 : mill.corner_radius;
  corner_ = r;
  arm_ = mill.radius - r;
  pivot_ = at.c + r * at.n;
  d_ = std::cos(beta) * at.f + std::sin(beta) * at.t();
  e_ = cross(n_, d_);
}

Place Turn::place(const geom::Point3& q) const {
  const geom::Vec3 v = q - pivot_;
  return {dot(v, n_), dot(v, d_), dot(v, e_)};
}
geom::Point3 Turn::point(const Place& p) const {
  return pivot_ + p.n * n_ + p.d * d_ + p.e * e_;
}
Turn::Tilt::Tilt(double alpha) : s(std::sin(alpha)), c(std::cos(alpha)) {}
Local Turn::at(const Place& p, const Tilt& tilt) const {
  return {p.n * tilt.s - p.d * tilt.c - arm_, p.e, p.n * tilt.c + p.d * tilt.s + corner_};
}
Place Turn::back(const Local& q, const Tilt& tilt) const {
  const double x = q.x + arm_, h = q.h - corner_;
  return {x * tilt.s + h * tilt.c, h * tilt.s - x * tilt.c, q.y};
}
cl::Pose Turn::pose(const Tilt& tilt) const {
  const geom::Vec3 u = tilt.c * n_ + tilt.s * d_;
  return {pivot_ + arm_ * across(tilt) - corner_ * u, u};
}

double Turn::until(const Place& p, const Piece& piece, double alpha, double to) const {
  if (!(alpha < to) || excess(at(p, Tilt(alpha)), piece) >= 0) return alpha;
  // n = rho cos(phi), d = rho sin(phi): sin(a) n - cos(a) d = rho sin(a - phi).
  const double rho = std::hypot(p.n, p.d), phi = std::atan2(p.d, p.n);
  const double end = stays({rho, p.e, arm_, corner_}, piece, alpha - phi, to - phi) + phi;
  return end > to - kSame ? to : std::max(end, alpha);
}

double Turn::since(const Place& p, const Piece& piece, double alpha, double from) const {
  if (!(alpha > from) || excess(at(p, Tilt(alpha)), piece) >= 0) return alpha;
  // Mirrored: a -> -a turns x = rho sin(a - phi) - arm into -(rho sin(-a + phi) + arm).
  const double rho = std::hypot(p.n, p.d), phi = std::atan2(p.d, p.n);
  const double start = phi - stays({rho, p.e, -arm_, corner_}, piece, phi - alpha, phi - from);
  return start < from + kSame ? from : std::min(start, alpha);
}

Turn::Left Turn::at_least(const std::array<Place, 3>& t, const Piece& piece, double alpha, double to) const {
  const Tilt tilt(alpha);
  const Deepest d = deepest({at(t[0], tilt), at(t[1], tilt), at(t[2], tilt)}, piece);
  Left left{alpha, t[0]};
  if (d.value >= 0) return left;
  left.last = back(d.at, tilt);
  left.alpha = until(left.last, piece, alpha, to);
  for (const Place& p : t) {
    const double end = until(p, piece, alpha, to);
    if (end > left.alpha) left = {end, p};
  }
  return left;
}

Turn::Left Turn::until(const std::array<Place, 3>& t, const Piece& piece, double alpha, double to,
                       double coarse) const {
  constexpr int kSteps = 64;
  Left left = at_least(t, piece, alpha, to);
  const auto offer = [&](const Place& p, double a) {
    const double end = until(p, piece, a, to);
    if (end > left.alpha) left = {end, p};
  };
  // Where the line through the last two values says that it ends, a little before: taken up to there when a
  // place found there has blocked all the way.
  constexpr std::array<double, 3> kShort{2e-3, 0.05, 0.3};
  constexpr double kNear = 5e-11;
  double before = alpha, before_value = 0, now = alpha, free_at = kNever;
  for (int i = 0; i < kSteps && now <= to; ++i) {
    const Tilt tilt(now);
    const Deepest d = deepest({at(t[0], tilt), at(t[1], tilt), at(t[2], tilt)}, piece);
    if (d.value >= 0) break;
    if (i > 0) offer(back(d.at, tilt), now);
    double known = now, known_value = d.value;
    if (i > 0 && d.value > before_value && left.alpha < to) {
      const double end = std::min(now + d.value * (now - before) / (before_value - d.value), free_at);
      for (const double share : kShort) {
        const double guess = std::min(end - share * (end - left.alpha), to);
        if (!(guess > left.alpha + kNear)) break;
        const Tilt there(guess);
        const Deepest ahead = deepest({at(t[0], there), at(t[1], there), at(t[2], there)}, piece);
        if (ahead.value >= 0) {
          free_at = guess;
        } else if (const Place p = back(ahead.at, there); since(p, piece, guess, left.alpha) <= left.alpha) {
          offer(p, guess);
          known = guess;
          known_value = ahead.value;
          break;
        }
      }
    }
    before = known;
    before_value = known_value;
    const double gained = left.alpha - now;
    if (left.alpha >= to || gained <= std::max(kNear, coarse * (left.alpha - alpha)) ||
        free_at - left.alpha < kNear)
      break;
    now = left.alpha + kSame;
  }
  return left;
}

}  // namespace burin::orient::detail
