// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/curve.h"

#include <algorithm>
#include <cmath>

#include "burin/geom/curve/nurbs.h"
#include "burin/geom/gauss.h"
#include "burin/geom/point_tools.h"

namespace burin::geom {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

bool finite(double v) {
  return std::isfinite(v);
}

Error bad(const char* what) {
  return {ErrorCode::geometry, what, {}};
}

Point2 on_ellipse(const EllipseArc2& e, double u) {
  return e.center + std::cos(u) * e.major + std::sin(u) * e.minor;
}

/// Whether the map keeps circles round: columns perpendicular and of equal length.
bool keeps_circles(const Affine2& m) {
  const double u = std::hypot(m.a, m.b), v = std::hypot(m.c, m.d);
  const double scale = std::max(u, v);
  // The bound is the rounding of products of sines and cosines in chains of transforms, not a geometric
  // tolerance.
  constexpr double kRound = 1e-12;
  return std::abs(u - v) <= kRound * scale && std::abs(m.a * m.c + m.b * m.d) <= kRound * scale * scale;
}

/// Range of c + A cos(u) + B sin(u) over the arc, one coordinate.
void add_extremes(Box2& box, const EllipseArc2& e) {
  const auto inside = [&](double u) {
    // u may lie whole turns away from the arc's parameter interval.
    const double turns = 2 * kPi;
    double shift = std::fmod((e.sweep > 0 ? u - e.start : e.start - u), turns);
    if (shift < 0) shift += turns;
    return shift <= std::abs(e.sweep);
  };
  for (const double base : {std::atan2(e.minor.x, e.major.x), std::atan2(e.minor.y, e.major.y)}) {
    for (const double u : {base, base + kPi}) {
      if (inside(u)) box.add(on_ellipse(e, u));
    }
  }
}

Box2 ellipse_bounds(const EllipseArc2& e) {
  Box2 box;
  box.add(on_ellipse(e, e.start));
  box.add(on_ellipse(e, e.start + e.sweep));
  add_extremes(box, e);
  return box;
}

EllipseArc2 as_ellipse(const Arc2& a) {
  return {a.center, {a.radius, 0}, {0, a.radius}, a.start, a.sweep};
}

/// Arc length by adaptive Gauss-Legendre (5 points against 2 x 5): `f` is the speed.
template <class F>
double integrate(const F& f, double a, double b, double tolerance, int depth) {
  const double m = 0.5 * (a + b);
  const double whole = gauss5(f, a, b), halves = gauss5(f, a, m) + gauss5(f, m, b);
  if (depth >= 40 || std::abs(whole - halves) <= tolerance) return halves;
  return integrate(f, a, m, 0.5 * tolerance, depth + 1) + integrate(f, m, b, 0.5 * tolerance, depth + 1);
}

}  // namespace

Result<void> validate(const Curve2& curve) {
  return std::visit(
      Overloaded{[](const Line2& l) -> Result<void> {
                   if (!is_finite(l.a) || !is_finite(l.b))
                     return bad("a line with an end that is not a finite number");
                   return {};
                 },
                 [](const Arc2& a) -> Result<void> {
                   if (!is_finite(a.center) || !finite(a.radius) || !finite(a.start) || !finite(a.sweep)) {
                     return bad("an arc with a value that is not a finite number");
                   }
                   if (!(a.radius > 0)) return bad("an arc of radius 0 or less (a positive radius)");
                   if (a.sweep == 0 || std::abs(a.sweep) > 2 * kPi * (1 + 1e-12)) {
                     return bad("an arc that sweeps nothing or more than a full turn");
                   }
                   return {};
                 },
                 [](const EllipseArc2& e) -> Result<void> {
                   if (!is_finite(e.center) || !is_finite(e.major) || !is_finite(e.minor) ||
                       !finite(e.start) || !finite(e.sweep)) {
                     return bad("an elliptic arc with a value that is not a finite number");
                   }
                   if (norm(e.major) == 0 && norm(e.minor) == 0) return bad("an elliptic arc without extent");
                   if (e.sweep == 0 || std::abs(e.sweep) > 2 * kPi * (1 + 1e-12)) {
                     return bad("an elliptic arc that sweeps nothing or more than a full turn");
                   }
                   return {};
                 },
                 [](const Nurbs2& n) -> Result<void> { return validate_nurbs(n); }},
      curve);
}

Point2 point_at(const Curve2& curve, double t) {
  return std::visit(Overloaded{[&](const Line2& l) { return t == 1 ? l.b : lerp(l.a, l.b, t); },
                               [&](const Arc2& a) {
                                 const double u = a.start + t * a.sweep;
                                 return a.center + a.radius * Vec2{std::cos(u), std::sin(u)};
                               },
                               [&](const EllipseArc2& e) { return on_ellipse(e, e.start + t * e.sweep); },
                               [&](const Nurbs2& n) { return nurbs_derivatives(n, t, 0).point; }},
                    curve);
}

Derivatives2 derivatives_at(const Curve2& curve, double t) {
  return std::visit(
      Overloaded{[&](const Line2& l) {
                   return Derivatives2{t == 1 ? l.b : lerp(l.a, l.b, t), l.b - l.a, Vec2{}};
                 },
                 [&](const Arc2& a) {
                   const double u = a.start + t * a.sweep;
                   const Vec2 r = a.radius * Vec2{std::cos(u), std::sin(u)};
                   return Derivatives2{a.center + r, a.sweep * left(r), -(a.sweep * a.sweep) * r};
                 },
                 [&](const EllipseArc2& e) {
                   const double u = e.start + t * e.sweep, c = std::cos(u), s = std::sin(u);
                   const Vec2 r = c * e.major + s * e.minor;
                   return Derivatives2{e.center + r, e.sweep * (c * e.minor - s * e.major),
                                       -(e.sweep * e.sweep) * r};
                 },
                 [&](const Nurbs2& n) { return nurbs_derivatives(n, t, 2); }},
      curve);
}

Vec2 tangent_at(const Curve2& curve, double t) {
  const Derivatives2 d = derivatives_at(curve, t);
  const Box2 box = bounds(curve);
  const double size = box.width() + box.height();
  // Below this the first derivative is rounding, and the direction comes from a step into the curve.
  constexpr double kVanishing = 1e-9;
  if (norm(d.d1) > kVanishing * size) return unit(d.d1);
  if (norm(d.d2) > kVanishing * size) return t < 1 ? unit(d.d2) : unit(-d.d2);
  for (double step = 1e-6; step < 1; step *= 8) {
    const Point2 q = point_at(curve, t < 1 ? std::min(1.0, t + step) : t - step);
    const Vec2 v = t < 1 ? q - d.point : d.point - q;
    if (norm(v) > kVanishing * size) return unit(v);
  }
  return {};
}

Curve2 reversed(const Curve2& curve) {
  return std::visit(Overloaded{[](const Line2& l) -> Curve2 {
                                 return Line2{l.b, l.a};
                               },
                               [](const Arc2& a) -> Curve2 {
                                 return Arc2{a.center, a.radius, a.start + a.sweep, -a.sweep};
                               },
                               [](const EllipseArc2& e) -> Curve2 {
                                 return EllipseArc2{e.center, e.major, e.minor, e.start + e.sweep, -e.sweep};
                               },
                               [](const Nurbs2& n) -> Curve2 {
                                 Nurbs2 r = n;
                                 std::reverse(r.points.begin(), r.points.end());
                                 std::reverse(r.weights.begin(), r.weights.end());
                                 const double sum = n.knots.front() + n.knots.back();
                                 for (std::size_t i = 0; i < n.knots.size(); ++i)
                                   r.knots[i] = sum - n.knots[n.knots.size() - 1 - i];
                                 return r;
                               }},
                    curve);
}

Curve2 part(const Curve2& curve, double t0, double t1) {
  return std::visit(
      Overloaded{
          [&](const Line2& l) -> Curve2 {
            return Line2{t0 == 0 ? l.a : lerp(l.a, l.b, t0), t1 == 1 ? l.b : lerp(l.a, l.b, t1)};
          },
          [&](const Arc2& a) -> Curve2 {
            return Arc2{a.center, a.radius, a.start + t0 * a.sweep, (t1 - t0) * a.sweep};
          },
          [&](const EllipseArc2& e) -> Curve2 {
            return EllipseArc2{e.center, e.major, e.minor, e.start + t0 * e.sweep, (t1 - t0) * e.sweep};
          },
          [&](const Nurbs2& n) -> Curve2 { return nurbs_part(n, t0, t1); }},
      curve);
}

Curve2 transformed(const Affine2& m, const Curve2& curve) {
  const auto ellipse = [&](const EllipseArc2& e) -> Curve2 {
    return EllipseArc2{m(e.center), m(e.major), m(e.minor), e.start, e.sweep};
  };
  return std::visit(Overloaded{[&](const Line2& l) -> Curve2 {
                                 return Line2{m(l.a), m(l.b)};
                               },
                               [&](const Arc2& a) -> Curve2 {
                                 if (!keeps_circles(m)) return ellipse(as_ellipse(a));
                                 // A rotation by angle w turns the start angle to start + w; a mirror turns
                                 // it to w - start.
                                 const double w = std::atan2(m.b, m.a);
                                 const double scale = std::sqrt(std::abs(m.determinant()));
                                 const bool mirrored = m.determinant() < 0;
                                 return Arc2{m(a.center), a.radius * scale,
                                             mirrored ? w - a.start : w + a.start,
                                             mirrored ? -a.sweep : a.sweep};
                               },
                               [&](const EllipseArc2& e) -> Curve2 { return ellipse(e); },
                               [&](const Nurbs2& n) -> Curve2 {
                                 Nurbs2 r = n;
                                 for (Point2& p : r.points) p = m(p);
                                 return r;
                               }},
                    curve);
}

Box2 bounds(const Curve2& curve) {
  return std::visit(Overloaded{[](const Line2& l) {
                                 Box2 box;
                                 box.add(l.a);
                                 box.add(l.b);
                                 return box;
                               },
                               [](const Arc2& a) { return ellipse_bounds(as_ellipse(a)); },
                               [](const EllipseArc2& e) { return ellipse_bounds(e); },
                               [](const Nurbs2& n) {
                                 Box2 box;
                                 for (const Point2& p : n.points) box.add(p);
                                 return box;
                               }},
                    curve);
}

double length(const Curve2& curve, double tolerance) {
  const auto integral = [&](const Curve2& c) {
    return integrate([&](double t) { return norm(derivatives_at(c, t).d1); }, 0, 1, tolerance, 0);
  };
  return std::visit(Overloaded{[](const Line2& l) { return distance(l.a, l.b); },
                               [](const Arc2& a) { return std::abs(a.radius * a.sweep); },
                               [&](const EllipseArc2& e) { return integral(e); },
                               [&](const Nurbs2& n) {
                                 double sum = 0;
                                 for (const Nurbs2& piece : bezier_pieces(n)) sum += integral(piece);
                                 return sum;
                               }},
                    curve);
}

std::vector<double> corner_parameters(const Curve2& curve, double tangent_rad) {
  const Nurbs2* n = std::get_if<Nurbs2>(&curve);
  return n ? nurbs_corners(*n, tangent_rad) : std::vector<double>{};
}

}  // namespace burin::geom
