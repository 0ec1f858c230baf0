// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/certificate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burin::geom::fit {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Subdivision stops when the upper bound is within this of a value that is attained ...
constexpr double kTightness = 1.01;
/// ... or below this part of the tolerance, where nobody asks.
constexpr double kNegligible = 1e-3;
constexpr int kMaxDepth = 24;
/// Rounding errors of the formulas below, in units of the largest coordinate.
constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();
/// Below this value of 1 + d k the offset arc is nearly a point and the first-order bound is used.
constexpr double kNearPoint = 0.05;

/// c[k] += scale * sum over i + j = k of f_i g_j, f and g scaled by their binomials: the Bernstein product
/// without its final division by the binomials.
template <class F, class G, class Times>
void convolve(const F* f, int m, const G* g, int n, Times times, double* c) {
  std::fill(c, c + m + n + 1, 0.0);
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j) c[i + j] += times(f[i], g[j]);
  }
}

/// Deviation of one arc from one Bezier piece: bounds over the piece, and what is attained at its ends.
struct PieceBound {
  double lo = 0, hi = 0;
  double attained_lo = 0, attained_hi = 0;
  bool ok = false;
};

class ArcBound {
 public:
  ArcBound(const Arc& arc, double d) : arc_(arc), normal_(left(arc.ta)), d_(d) {}

  PieceBound of(const Bezier& b, bool offset_too) {
    load(b);
    PieceBound bound;
    double f_lo = kInfinity, f_hi = -kInfinity;
    radial(b, f_lo, f_hi);
    const double k = arc_.k;
    // |path - centre|^2 k^2; not positive when the path may pass the centre.
    const double m2 = std::min(1 - 2 * k * f_lo, 1 - 2 * k * f_hi);
    if (!(m2 > 0)) return bound;
    const double e_lo = distance_of(f_lo), e_hi = distance_of(f_hi);
    bound.lo = e_lo;
    bound.hi = e_hi;
    bound.attained_lo = std::min(distance_of(f_first_), distance_of(f_last_));
    bound.attained_hi = std::max(distance_of(f_first_), distance_of(f_last_));
    const double sine = sine_bound(b, m2);
    if (!(sine < 1)) return bound;
    bound.ok = true;
    if (d_ == 0 || !offset_too) return bound;
    const double shift = offset_shift(e_lo, e_hi, sine);
    if (d_ > 0) {
      bound.hi += shift;
    } else {
      bound.lo -= shift;
    }
    const double first = distance_of(f_first_), last = distance_of(f_last_);
    const double shifted_first = first + offset_shift(first, first, end_sine(b, 0));
    const double shifted_last = last + offset_shift(last, last, end_sine(b, 1));
    if (d_ > 0) {
      bound.attained_hi = std::max({bound.attained_hi, shifted_first, shifted_last});
    } else {
      bound.attained_lo = std::min({bound.attained_lo, 2 * first - shifted_first, 2 * last - shifted_last});
    }
    return bound;
  }

 private:
  static constexpr int kMax = kMaxDegree + 1;

  double distance_of(double f) const { return 2 * f / (1 + std::sqrt(std::max(0.0, 1 - 2 * arc_.k * f))); }

  /// Control points about the arc's start, times w and binomials; m = w n - k (X - w a), the direction
  /// across.
  void load(const Bezier& b) {
    const Vec2 a{arc_.a.x, arc_.a.y};
    for (int i = 0; i <= b.degree; ++i) {
      const auto u = static_cast<std::size_t>(i);
      const double c = binomial(b.degree, i);
      w_[u] = c * b.w[u];
      q_[u] = c * (b.x[u] - b.w[u] * a);
      m_[u] = w_[u] * normal_ - arc_.k * q_[u];
    }
  }

  /// F = (X - w a) . n / w - k |X - w a|^2 / (2 w^2) between the quotients of the Bernstein coefficients.
  void radial(const Bezier& b, double& f_lo, double& f_hi) {
    const int p = b.degree;
    for (int i = 0; i <= p; ++i) {
      const auto u = static_cast<std::size_t>(i);
      h_[u] = w_[u] * normal_ - (0.5 * arc_.k) * q_[u];
    }
    convolve(
        q_.data(), p, h_.data(), p, [](Vec2 s, Vec2 t) { return dot(s, t); }, product_.data());
    convolve(
        w_.data(), p, w_.data(), p, [](double s, double t) { return s * t; }, weight_.data());
    for (int i = 0; i <= 2 * p; ++i) {
      const auto u = static_cast<std::size_t>(i);
      const double f = product_[u] / weight_[u];
      f_lo = std::min(f_lo, f);
      f_hi = std::max(f_hi, f);
    }
    f_first_ = product_[0] / weight_[0];
    f_last_ = product_[static_cast<std::size_t>(2 * p)] / weight_[static_cast<std::size_t>(2 * p)];
  }

  /// |sin| of the angle between path and arc: |D . m| / (|D| |m|), m2 a lower bound of |m / w|^2.
  double sine_bound(const Bezier& b, double m2) {
    const int p = b.degree, q = b.hodograph_degree;
    std::array<Vec2, 2 * kMaxDegree> scaled;
    Vec2 direction;
    for (int i = 0; i <= q; ++i) direction = direction + b.d[static_cast<std::size_t>(i)];
    direction = unit(direction);
    double speed = kInfinity;
    for (int i = 0; i <= q; ++i) {
      const auto u = static_cast<std::size_t>(i);
      speed = std::min(speed, dot(b.d[u], direction));
      const double c = binomial(q, i);
      scaled[u] = c * b.d[u];
      ones_[u] = c;
    }
    if (!(speed > 0)) return 1;
    convolve(
        scaled.data(), q, m_.data(), p, [](Vec2 s, Vec2 t) { return dot(s, t); }, product_.data());
    convolve(
        ones_.data(), q, w_.data(), p, [](double s, double t) { return s * t; }, weight_.data());
    double largest = 0;
    for (int i = 0; i <= p + q; ++i) {
      const auto u = static_cast<std::size_t>(i);
      largest = std::max(largest, std::abs(product_[u]) / weight_[u]);
    }
    return largest / (speed * std::sqrt(m2));
  }

  double end_sine(const Bezier& b, int end) const {
    const auto u = static_cast<std::size_t>(end == 0 ? 0 : b.degree);
    const auto v = static_cast<std::size_t>(end == 0 ? 0 : b.hodograph_degree);
    return std::min(1.0, std::abs(dot(unit(b.d[v]), unit(m_[u]))));
  }

  /// How much further than the path its offset may deviate, for |sin phi| <= sine and e in [e_lo, e_hi].
  double offset_shift(double e_lo, double e_hi, double sine) const {
    const double cosine = std::sqrt(std::max(0.0, 1 - sine * sine));
    const double versine = sine * sine / (1 + cosine);
    const double d = std::abs(d_), k = arc_.k;
    const double x = std::min(d_ * k / (1 - k * e_lo), d_ * k / (1 - k * e_hi));
    const double a = 1 + x;
    if (!(a >= kNearPoint)) return d * std::sqrt(2 * versine);  // 2 d sin(phi / 2)
    if (x <= 0) return d * versine / a;
    return 2 * d * versine / (a + std::sqrt(std::max(0.0, a * a - 2 * x * versine)));
  }

  const Arc arc_;
  const Vec2 normal_;
  const double d_;
  double f_first_ = 0, f_last_ = 0;
  std::array<double, kMax> w_;
  std::array<Vec2, kMax> q_, m_, h_;
  std::array<double, 2 * kMaxDegree> ones_;
  std::array<double, 4 * kMaxDegree> product_, weight_;
};

/// Bounds over one Bezier piece by halving until tight; `total` collects them and what is attained.
class Refinement {
 public:
  /// `attained`: a deviation known to occur; saves refining where it is smaller.
  Refinement(ArcBound& arc, double tolerance, double attained, Deviation& total)
      : arc_(arc), tolerance_(tolerance), total_(total), attained_(attained) {}

  bool run(const Bezier& b, bool offset_too, int depth = 0) {
    const PieceBound bound = arc_.of(b, offset_too);
    const double attained = std::max(-bound.attained_lo, bound.attained_hi);
    if (attained > tolerance_) return false;
    attained_ = std::max(attained_, attained);
    const double wanted = std::min(tolerance_, std::max(kTightness * attained_, kNegligible * tolerance_));
    const double known = std::max(wanted, total_.bound());
    if (bound.ok && bound.lo >= -known && bound.hi <= known) {
      total_.lo = std::min(total_.lo, bound.lo);
      total_.hi = std::max(total_.hi, bound.hi);
      return true;
    }
    if (depth >= kMaxDepth) return false;
    Bezier lower, upper;
    split(b, 0.5, &lower, &upper);
    return run(lower, offset_too, depth + 1) && run(upper, offset_too, depth + 1);
  }

 private:
  ArcBound& arc_;
  const double tolerance_;
  Deviation& total_;
  double attained_;
};

Vec2 offset_vector(double d, Vec2 tangent) {
  return d * right(tangent);
}

bool inside(const std::vector<Range>& ranges, double tau) {
  for (const Range& r : ranges) {
    if (r.lo <= tau && tau <= r.hi) return true;
  }
  return false;
}

/// Parameters at which the refinement starts anew: ends, Bezier joints, ends of singular ranges.
std::vector<double> breaks_within(const Target& target, double lo, double hi) {
  std::vector<double> breaks{lo};
  for (double k = std::floor(lo) + 1; k < hi; ++k) breaks.push_back(k);
  for (const Range& r : target.singular.ranges) {
    for (const double tau : {r.lo, r.hi}) {
      if (lo < tau && tau < hi) breaks.push_back(tau);
    }
  }
  breaks.push_back(hi);
  std::sort(breaks.begin(), breaks.end());
  return breaks;
}

bool certify_run(const Target& target, const Arc& arc, double lo, double hi, Deviation& total) {
  ArcBound bound(arc, target.d);
  double attained = 0;
  constexpr int kProbes = 8;
  for (int i = 1; i < kProbes; ++i) {
    const Point2 p = target.path->point(lo + (hi - lo) * i / kProbes);
    attained = std::max(attained, std::abs(signed_distance(arc.a, arc.ta, arc.k, p)));
  }
  if (attained > target.tolerance) return false;
  Refinement refinement(bound, target.tolerance, attained, total);
  const std::vector<double> breaks = breaks_within(target, lo, hi);
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double t0 = breaks[i], t1 = breaks[i + 1];
    if (!(t0 < t1)) continue;
    const double k = std::min(std::floor(0.5 * (t0 + t1)), target.path->end() - 1);
    const bool offset_too = !inside(target.singular.ranges, 0.5 * (t0 + t1));
    const Bezier& whole = target.path->pieces[static_cast<std::size_t>(k)];
    if (!refinement.run(part(whole, t0 - k, t1 - k), offset_too)) return false;
  }
  return true;
}

/// Bounds of the curvature of a piece; infinite where the derivative may vanish.
struct CurvatureBound {
  double lo = -kInfinity, hi = kInfinity;
};

CurvatureBound curvature_of(const Bezier& b) {
  // X about its first point over w: C' = H / w^2 with H = X' w - X w', curvature = cross(H, H') w^... only
  // the polynomial case has a short form, so rational pieces are bounded through C' and C'' of the quotient
  // rule.
  const int p = b.degree;
  const Vec2 origin = b.x[0] / b.w[0];
  std::array<Vec2, kMaxDegree + 1> x;
  double w_lo = kInfinity, w_hi = 0;
  for (int i = 0; i <= p; ++i) {
    const auto u = static_cast<std::size_t>(i);
    x[u] = b.x[u] - b.w[u] * origin;
    w_lo = std::min(w_lo, b.w[u]);
    w_hi = std::max(w_hi, b.w[u]);
  }
  // cross(C', C'') w^3 = det(X, X', X'' with weights) = w (X' x X'') - w' (X x X'') + w'' (X x X').
  const auto at = [](const auto& c, int i, int order) {
    const auto u = static_cast<std::size_t>(i);
    if (order == 0) return c[u];
    if (order == 1) return c[u + 1] - c[u];
    return c[u + 2] - 2.0 * c[u + 1] + c[u];
  };
  const double p1 = p, p2 = p * (p - 1.0);
  double cross_lo = 0, cross_hi = 0, speed_lo = kInfinity, speed_hi = 0;
  if (p >= 2) {
    std::array<double, 3 * kMaxDegree> sum{};
    for (int i = 0; i <= p; ++i) {
      for (int j = 0; j <= p - 1; ++j) {
        for (int k = 0; k <= p - 2; ++k) {
          const double c = binomial(p, i) * binomial(p - 1, j) * binomial(p - 2, k) * p1 * p2;
          sum[static_cast<std::size_t>(i + j + k)] += c * (at(b.w, i, 0) * cross(at(x, j, 1), at(x, k, 2)) -
                                                           at(b.w, j, 1) * cross(at(x, i, 0), at(x, k, 2)) +
                                                           at(b.w, k, 2) * cross(at(x, i, 0), at(x, j, 1)));
        }
      }
    }
    cross_lo = kInfinity;
    cross_hi = -kInfinity;
    for (int i = 0; i <= 3 * p - 3; ++i) {
      const double c = sum[static_cast<std::size_t>(i)] / binomial(3 * p - 3, i);
      cross_lo = std::min(cross_lo, c);
      cross_hi = std::max(cross_hi, c);
    }
  }
  // C' = H / w^2; H by its own coefficients.
  std::array<Vec2, 2 * kMaxDegree> h{};
  for (int i = 0; i <= p; ++i) {
    for (int j = 0; j < p; ++j) {
      const double c = binomial(p, i) * binomial(p - 1, j) * p1;
      const auto u = static_cast<std::size_t>(i + j);
      h[u] = h[u] + c * (at(b.w, i, 0) * at(x, j, 1) - at(b.w, j, 1) * at(x, i, 0));
    }
  }
  Vec2 direction;
  for (int i = 0; i < 2 * p; ++i) {
    const auto u = static_cast<std::size_t>(i);
    h[u] = h[u] / binomial(2 * p - 1, i);
    direction = direction + h[u];
  }
  direction = unit(direction);
  for (int i = 0; i < 2 * p; ++i) {
    const auto u = static_cast<std::size_t>(i);
    speed_lo = std::min(speed_lo, dot(h[u], direction));
    speed_hi = std::max(speed_hi, norm(h[u]));
  }
  if (!(speed_lo > 0)) return {};
  // kappa = (cross / w^3) / (|H| / w^2)^3 = cross w^3 / |H|^3.
  const double least = w_lo * w_lo * w_lo / (speed_hi * speed_hi * speed_hi);
  const double most = w_hi * w_hi * w_hi / (speed_lo * speed_lo * speed_lo);
  return {cross_lo < 0 ? cross_lo * most : cross_lo * least,
          cross_hi > 0 ? cross_hi * most : cross_hi * least};
}

/// Upper bound of the length: that of the control polygon.
double length_bound(const Bezier& b) {
  double sum = 0;
  for (int i = 0; i < b.degree; ++i) {
    const auto u = static_cast<std::size_t>(i);
    sum += norm(b.x[u + 1] / b.w[u + 1] - b.x[u] / b.w[u]);
  }
  return sum;
}

void collect_singular(const Bezier& b, double d, double lo, double hi, double enough, int depth,
                      SingularRanges& out) {
  const CurvatureBound kappa = curvature_of(b);
  const double a_lo = 1 + std::min(d * kappa.lo, d * kappa.hi),
               a_hi = 1 + std::max(d * kappa.lo, d * kappa.hi);
  if (a_lo > 0) return;
  const bool certain = a_hi <= 0;
  // The part of the offset curve over an undecided piece is at most this long, and it hangs on to a decided
  // one.
  const double unseen = (a_hi - a_lo) * length_bound(b);
  if (certain || unseen <= enough || depth >= kMaxDepth) {
    if (!certain && std::isfinite(unseen)) out.slack += unseen;
    if (!out.ranges.empty() && out.ranges.back().hi == lo) {
      out.ranges.back().hi = hi;
    } else {
      out.ranges.push_back({lo, hi});
    }
    return;
  }
  Bezier lower, upper;
  split(b, 0.5, &lower, &upper);
  const double mid = 0.5 * (lo + hi);
  collect_singular(lower, d, lo, mid, enough, depth + 1, out);
  collect_singular(upper, d, mid, hi, enough, depth + 1, out);
}

}  // namespace

SingularRanges singular_ranges(const Path& path, double d, double tolerance) {
  SingularRanges out;
  if (d == 0) return out;
  constexpr double kUnseen = 1e-3;  // of the tolerance, for each transition
  for (std::size_t k = 0; k < path.pieces.size(); ++k) {
    const auto lo = static_cast<double>(k);
    collect_singular(path.pieces[k], d, lo, lo + 1, kUnseen * tolerance, 0, out);
  }
  return out;
}

double parameter_on_normal(const Path& path, double d, Point2 joint, Vec2 tangent, double guess, double lo,
                           double hi) {
  const auto along = [&](double tau) {
    const PointTangent c = path.at(tau);
    return dot(c.point + offset_vector(d, c.tangent) - joint, tangent);
  };
  // A bracket that grows from the guess, then regula falsi (Illinois): C_d runs forward near a joint.
  const double at_guess = along(guess);
  if (at_guess == 0) return guess;
  double step = (hi - lo) / 64, other = guess, at_other = at_guess;
  for (int i = 0; i < 8 && at_other * at_guess > 0; ++i, step *= 2) {
    other = std::clamp(guess + (at_guess < 0 ? step : -step), lo, hi);
    at_other = along(other);
    if ((other == lo || other == hi) && at_other * at_guess > 0) return -1;
  }
  if (at_other * at_guess > 0) return -1;
  double a = guess, fa = at_guess, b = other, fb = at_other;
  for (int i = 0; i < 60; ++i) {
    if (fb == 0 || std::abs(b - a) <= 4e-16 * (1 + std::abs(b))) break;
    const double c = b - fb * (b - a) / (fb - fa);
    const double fc = along(c);
    if (fc * fb < 0) {
      a = b;
      fa = fb;
    } else {
      fa *= 0.5;
    }
    if (c == b) break;
    b = c;
    fb = fc;
    if (std::abs(fb) <= kRounding * path.magnitude) break;
  }
  return std::clamp(b, lo, hi);
}

/// Whether the path at tau lies on the normal at an end of an arc, on this side of the centre, and runs
/// forward there: what the sectors of the proof begin and end with.
bool starts_sector(const Path& path, const Arc& arc, bool at_end, double tau) {
  const PointTangent c = path.at(tau);
  const Point2 p = at_end ? arc.b : arc.a;
  const Vec2 t = at_end ? arc.tb : arc.ta;
  const double height = cross(t, c.point - p);
  return arc.k * height < 1 && dot(c.tangent, t) > 0;
}

/// At an end whose direction differs from the path's, the offset of the path begins beside the offset arc:
/// its first stretch [0, tau] (last for the end) lies outside the arc's sector, close to the circle of radius
/// |d| about the end point P. With |path - P| <= rho and directions within an angle theta there, the distance
/// to P differs from |d| by at most rho^2 / (2 |d|) + rho sin(theta).
static double end_gap(const Path& path, double d, double tau0, double tau1) {
  const double k = std::min(std::floor(0.5 * (tau0 + tau1)), path.end() - 1);
  const Bezier b =
      part(path.pieces[static_cast<std::size_t>(k)], std::max(0.0, tau0 - k), std::min(1.0, tau1 - k));
  if (tau1 - k > 1 || tau0 < k) return kInfinity;  // longer than a Bezier piece: not a small gap
  const double rho = length_bound(b);
  double sine = 0;
  const Vec2 direction = unit(b.d[0]);
  for (int i = 0; i <= b.hodograph_degree; ++i) {
    const Vec2 other = unit(b.d[static_cast<std::size_t>(i)]);
    if (dot(direction, other) < 0) return kInfinity;
    sine = std::max(sine, std::abs(cross(direction, other)));
  }
  return rho * rho / (2 * std::abs(d)) + rho * std::min(1.0, 2 * sine);
}

Deviation certify(const Target& target, const std::vector<Run>& runs) {
  const Deviation failed{-kInfinity, kInfinity};
  const Path& path = *target.path;
  const double d = target.d;
  Deviation total;
  double gap = 0, handed_over = runs.front().tau0;
  // Where the offset curve enters the sector of the first arc, if not at once.
  const auto offset_on_normal = [&](Point2 p, Vec2 tangent, double guess, double lo, double hi) {
    return parameter_on_normal(path, d, p + offset_vector(d, tangent), tangent, guess, lo, hi);
  };
  const auto turned = [&](double tau, Vec2 tangent) {
    constexpr double kSameDirection = 1e-12;
    return d != 0 && !inside(target.singular.ranges, tau) &&
           std::abs(cross(path.at(tau).tangent, tangent)) > kSameDirection;
  };
  const Run& first = runs.front();
  if (turned(first.tau0, first.arc.ta)) {
    const double entry = offset_on_normal(first.arc.a, first.arc.ta, first.tau0, first.tau0, first.tau1);
    // No entry: the offset curve begins inside the sector.
    if (entry > first.tau0) gap = std::max(gap, end_gap(path, d, first.tau0, entry));
  }
  const Run& final = runs.back();
  if (turned(final.tau1, final.arc.tb)) {
    const double exit = offset_on_normal(final.arc.b, final.arc.tb, final.tau1, final.tau0, final.tau1);
    if (exit >= 0 && exit < final.tau1) gap = std::max(gap, end_gap(path, d, exit, final.tau1));
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Run& run = runs[i];
    // Where the offset curve passes from this arc's sector to the next one's; the path itself does so at
    // tau1.
    double next = run.tau1;
    const bool last = i + 1 == runs.size();
    if (!last && d != 0 && !inside(target.singular.ranges, run.tau1)) {
      next = offset_on_normal(run.arc.b, run.arc.tb, run.tau1, run.tau0, runs[i + 1].tau1);
      if (next < 0) return failed;
    }
    if (!starts_sector(path, run.arc, false, run.tau0) || !starts_sector(path, run.arc, true, run.tau1))
      return failed;
    const double lo = std::min(run.tau0, handed_over), hi = std::max(run.tau1, next);
    if (!certify_run(target, run.arc, lo, hi, total)) return failed;
    handed_over = next;
  }
  const double pad = kRounding * path.magnitude + target.singular.slack;
  total.lo = std::min(total.lo, -gap) - pad;
  total.hi = std::max(total.hi, gap) + pad;
  return total.bound() <= target.tolerance ? total : failed;
}

}  // namespace burin::geom::fit
