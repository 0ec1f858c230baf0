// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/closest_newton.h"

#include <algorithm>
#include <cmath>

#include "burin/geom/surface/basis.h"

namespace burin::geom::detail {
namespace {

constexpr int kMaxSteps = 60;     // of Newton in one part
constexpr int kMaxParts = 64;     // that one search may cross
constexpr int kMaxHalvings = 40;  // of a step

constexpr double kRounding = 1e-15;  // of the square of the distance, relative
constexpr double kFall = 1e-14;      // what it must fall by to be worth another part
constexpr double kConvex = 1e-14;  // determinants of the second derivative this small (relative) are rounding
constexpr double kBend = 1e-3;     // below this share of |S'|^2 a second derivative makes wild steps

struct Part {
  std::size_t iu = 0, iv = 0;  // between walls i and i + 1
};

struct Place {
  double u = 0, v = 0;
  SurfaceDerivatives d;
  Vec3 r;        // from the point to the surface
  double f = 0;  // |r|^2 / 2
};

/// A step that stays within [lo, hi]; 0 for a direction that is held at its end.
struct Step {
  double u = 0, v = 0;
};

std::vector<double> walls(const std::vector<double>& knots, int degree) {
  std::vector<double> w{knots.front()};
  for (const Knot& k : inner_knots(knots, degree)) {
    if (k.multiplicity > degree - 2) w.push_back(k.value);
  }
  w.push_back(knots.back());
  return w;
}

std::size_t part_of(const std::vector<double>& w, double t) {
  const auto at = std::upper_bound(w.begin() + 1, w.end() - 1, t);
  return static_cast<std::size_t>(at - w.begin()) - 1;
}

class Local {
 public:
  Local(const NurbsSurface& s, Point3 p, const std::vector<double>& wu, const std::vector<double>& wv)
      : s_(s), p_(p), wu_(wu), wv_(wv) {}

  Place at(Part part, double u, double v) const {
    const Side a = u >= wu_[part.iu + 1] ? Side::left : Side::right;
    const Side b = v >= wv_[part.iv + 1] ? Side::left : Side::right;
    Place x{u, v, derivatives(s_, u, v, a, b), {}, 0};
    x.r = x.d.p - p_;
    x.f = 0.5 * dot(x.r, x.r);
    return x;
  }
  double gradient_u(const Place& x) const { return dot(x.r, x.d.du); }
  double gradient_v(const Place& x) const { return dot(x.r, x.d.dv); }

  /// Newton's step, or along the projected gradient where the second derivative is not positive.
  Step step(Part part, const Place& x) const {
    const double gu = gradient_u(x), gv = gradient_v(x);
    const bool held_u = (x.u <= wu_[part.iu] && gu >= 0) || (x.u >= wu_[part.iu + 1] && gu <= 0);
    const bool held_v = (x.v <= wv_[part.iv] && gv >= 0) || (x.v >= wv_[part.iv + 1] && gv <= 0);
    const double auu = dot(x.d.du, x.d.du), auv = dot(x.d.du, x.d.dv), avv = dot(x.d.dv, x.d.dv);
    if (held_u && held_v) return {};
    if (held_v) return {one(gu, auu, dot(x.r, x.d.duu)), 0};
    if (held_u) return {0, one(gv, avv, dot(x.r, x.d.dvv))};
    const double huu = auu + dot(x.r, x.d.duu), huv = auv + dot(x.r, x.d.duv), hvv = avv + dot(x.r, x.d.dvv);
    if (const double det = huu * hvv - huv * huv; huu > 0 && det > kConvex * huu * hvv) {
      return {-(hvv * gu - huv * gv) / det, -(huu * gv - huv * gu) / det};
    }
    return {one(gu, auu, 0), one(gv, avv, 0)};
  }

  Place minimise(Part part, double u, double v) const {
    Place x = at(part, u, v);
    for (int k = 0; k < kMaxSteps; ++k) {
      Step s = step(part, x);
      if (s.u == 0 && s.v == 0) break;
      bool moved = false;
      for (int h = 0; h < kMaxHalvings; ++h, s.u *= 0.5, s.v *= 0.5) {
        const double a = std::clamp(x.u + s.u, wu_[part.iu], wu_[part.iu + 1]);
        const double b = std::clamp(x.v + s.v, wv_[part.iv], wv_[part.iv + 1]);
        if (a == x.u && b == x.v) break;
        const Place y = at(part, a, b);
        if (!(y.f < x.f)) continue;
        // Enough when the square of the distance falls by rounding only.
        moved = y.f < x.f * (1 - kRounding);
        x = y;
        break;
      }
      if (!moved) break;
    }
    return x;
  }

  /// Neighbouring parts at x into which the distance falls.
  bool leave(Part& part, const Place& x) const {
    const auto beside = [](const std::vector<double>& w, std::size_t i, double t) -> std::ptrdiff_t {
      if (t <= w[i] && i > 0) return -1;
      if (t >= w[i + 1] && i + 2 < w.size()) return 1;
      return 0;
    };
    const std::ptrdiff_t du = beside(wu_, part.iu, x.u), dv = beside(wv_, part.iv, x.v);
    for (const auto& [a, b] : {std::pair{du, std::ptrdiff_t{0}}, {std::ptrdiff_t{0}, dv}, {du, dv}}) {
      if (a == 0 && b == 0) continue;
      const Part next{part.iu + static_cast<std::size_t>(a), part.iv + static_cast<std::size_t>(b)};
      const Place y = at(next, x.u, x.v);
      const Step s = step(next, y);
      if (s.u == 0 && s.v == 0) continue;
      const Place z = minimise(next, x.u, x.v);
      if (!(z.f < x.f * (1 - kFall))) continue;
      part = next;
      return true;
    }
    return false;
  }

 private:
  /// In one direction: Newton, or Gauss-Newton when the second derivative is not clearly positive.
  static double one(double g, double a, double r2) {
    const double h = a + r2;
    if (h > kBend * a && h > 0) return -g / h;
    return a > 0 ? -g / a : 0;
  }

  const NurbsSurface& s_;
  Point3 p_;
  const std::vector<double>&wu_, &wv_;
};

}  // namespace

Newton::Newton(const NurbsSurface& s)
    : walls_u_(walls(s.knots_u, s.degree_u)), walls_v_(walls(s.knots_v, s.degree_v)) {}

SurfacePoint Newton::refine(const NurbsSurface& s, Point3 p, double u, double v) const {
  u = clamped(s.knots_u, u);
  v = clamped(s.knots_v, v);
  const Local local(s, p, walls_u_, walls_v_);
  Part part{part_of(walls_u_, u), part_of(walls_v_, v)};
  Place x = local.minimise(part, u, v);
  for (int k = 0; k < kMaxParts && local.leave(part, x); ++k) x = local.minimise(part, x.u, x.v);
  return {x.u, x.v, x.d.p, norm(x.r)};
}

}  // namespace burin::geom::detail
