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
    // Always: each point of the offset curve is this far from the one at the path's foot, 2 d sin(phi / 2).
    const double chord = d * std::sqrt(2 * versine);
    if (!(a > 0)) return chord;
    const double denominator = x <= 0 ? 2 * a : a + std::sqrt(std::max(0.0, a * a - 2 * x * versine));
    return std::min(chord, 2 * d * versine / denominator);
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

/// Bounds of |C'|: C' = H / w^2 with H = X' w - X w', taken about the first control point to save digits.
Range speed_of(const Bezier& b) {
  const int p = b.degree;
  const Vec2 origin = b.x[0] / b.w[0];
  std::array<Vec2, 2 * kMaxDegree> h{};
  double w_lo = kInfinity, w_hi = 0;
  for (int i = 0; i <= p; ++i) {
    const auto u = static_cast<std::size_t>(i);
    w_lo = std::min(w_lo, b.w[u]);
    w_hi = std::max(w_hi, b.w[u]);
    for (int j = 0; j < p; ++j) {
      const auto v = static_cast<std::size_t>(j);
      const Vec2 dx = (b.x[v + 1] - b.w[v + 1] * origin) - (b.x[v] - b.w[v] * origin);
      const Vec2 term = b.w[u] * dx - (b.w[v + 1] - b.w[v]) * (b.x[u] - b.w[u] * origin);
      h[u + v] = h[u + v] + (p * binomial(p, i) * binomial(p - 1, j)) * term;
    }
  }
  Vec2 direction;
  for (int i = 0; i < 2 * p; ++i) direction = direction + h[static_cast<std::size_t>(i)];
  direction = unit(direction);
  Range speed{kInfinity, 0};
  for (int i = 0; i < 2 * p; ++i) {
    const Vec2 c = h[static_cast<std::size_t>(i)] / binomial(2 * p - 1, i);
    speed.lo = std::min(speed.lo, dot(c, direction));
    speed.hi = std::max(speed.hi, norm(c));
  }
  return {std::max(0.0, speed.lo) / (w_hi * w_hi), speed.hi / (w_lo * w_lo)};
}

/// C' is a positive multiple of D, hence kappa = cross(D, D') / (|D|^2 |C'|).
CurvatureBound curvature_of(const Bezier& b) {
  const int q = b.hodograph_degree;
  if (q == 0) return {0, 0};
  std::array<double, 4 * kMaxDegree> sum{};
  Vec2 direction;
  for (int i = 0; i <= q; ++i) direction = direction + b.d[static_cast<std::size_t>(i)];
  direction = unit(direction);
  double d_lo = kInfinity, d_hi = 0;
  for (int i = 0; i <= q; ++i) {
    const auto u = static_cast<std::size_t>(i);
    d_lo = std::min(d_lo, dot(b.d[u], direction));
    d_hi = std::max(d_hi, norm(b.d[u]));
    for (int j = 0; j < q; ++j) {
      const auto v = static_cast<std::size_t>(j);
      sum[u + v] += q * binomial(q, i) * binomial(q - 1, j) * cross(b.d[u], b.d[v + 1] - b.d[v]);
    }
  }
  if (!(d_lo > 0)) return {};
  double cross_lo = kInfinity, cross_hi = -kInfinity;
  for (int i = 0; i < 2 * q; ++i) {
    const double c = sum[static_cast<std::size_t>(i)] / binomial(2 * q - 1, i);
    cross_lo = std::min(cross_lo, c);
    cross_hi = std::max(cross_hi, c);
  }
  const Range speed = speed_of(b);
  const double least = 1 / (d_hi * d_hi * speed.hi),
               most = 1 / (d_lo * d_lo * speed.lo);  // most: up to infinity
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

namespace {

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
double end_gap(const Path& path, double d, double tau0, double tau1) {
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

/// The parameter range without singular ranges around a regular tau, within [lo, hi].
Range regular_around(const std::vector<Range>& singular, double tau, double lo, double hi) {
  Range result{lo, hi};
  for (const Range& r : singular) {
    if (r.hi < tau) result.lo = std::max(result.lo, r.hi);
    if (r.lo > tau) result.hi = std::min(result.hi, r.lo);
  }
  return result;
}

/// Keeps the account of where the offset curve leaves the sectors of the arcs that stand for it.
class Sectors {
 public:
  explicit Sectors(const Target& target) : target_(target), path_(*target.path) {}

  bool singular(double tau) const { return inside(target_.singular.ranges, tau); }

  /// Where the offset curve passes the normal at a joint of two runs; tau1 itself when it does not: then what
  /// sticks out is counted in gap().
  double hand_over(const Run& before, const Run& after) {
    const double tau = before.tau1;
    if (target_.d == 0 || singular(tau)) return tau;
    const Range r = regular_around(target_.singular.ranges, tau, before.tau0, after.tau1);
    const Point2 joint = offset_end(before.arc, true);
    const double found = parameter_on_normal(path_, target_.d, joint, before.arc.tb, tau, r.lo, r.hi);
    if (found >= 0) return found;
    const Place c = place(tau, joint, before.arc.tb);
    stick_out(c, std::abs(c.along));
    return tau;
  }

  /// Next to a singular range the offset curve turns back, possibly beyond the ends of the run's sector.
  void check_turning_points(const Run& run) {
    for (const Range& r : target_.singular.ranges) {
      for (const double tau : {r.lo, r.hi}) {
        if (tau <= run.tau0 || tau >= run.tau1) continue;
        const Place from_start = place(tau, offset_end(run.arc, false), run.arc.ta);
        if (from_start.along < 0) stick_out(from_start, -from_start.along);
        const Place from_end = place(tau, offset_end(run.arc, true), run.arc.tb);
        if (from_end.along > 0) stick_out(from_end, from_end.along);
      }
    }
  }

  /// An end of the path where the arc's direction differs from the path's.
  void check_end(const Run& run, bool at_end) {
    const double tau = at_end ? run.tau1 : run.tau0;
    const Vec2 tangent = at_end ? run.arc.tb : run.arc.ta;
    constexpr double kSameDirection = 1e-12;
    if (target_.d == 0 || singular(tau) || std::abs(cross(path_.at(tau).tangent, tangent)) <= kSameDirection)
      return;
    const Range r = regular_around(target_.singular.ranges, tau, run.tau0, run.tau1);
    const double entry =
        parameter_on_normal(path_, target_.d, offset_end(run.arc, at_end), tangent, tau, r.lo, r.hi);
    if (entry < 0 || entry == tau) return;  // the offset curve begins inside the sector
    gap_ = std::max(gap_, end_gap(path_, target_.d, std::min(tau, entry), std::max(tau, entry)));
  }

  double gap() const { return gap_; }

 private:
  struct Place {
    double along = 0, away = 0, cosine = 0;
  };

  Point2 offset_end(const Arc& arc, bool at_end) const {
    return at_end ? arc.b + offset_vector(target_.d, arc.tb) : arc.a + offset_vector(target_.d, arc.ta);
  }
  Place place(double tau, Point2 joint, Vec2 tangent) const {
    const PointTangent c = path_.at(tau);
    const Vec2 v = c.point + offset_vector(target_.d, c.tangent) - joint;
    return {dot(v, tangent), norm(v), dot(c.tangent, tangent)};
  }
  /// A stretch of the offset curve lies beyond a sector's end by up to `by` along the tangent there; with
  /// directions within 60 degrees of it, it is no longer than twice that, and it is as near to the sector's
  /// end as its own end is, plus its length.
  void stick_out(const Place& c, double by) {
    constexpr double kLeastCosine = 0.5;
    gap_ = std::max(gap_, c.cosine >= kLeastCosine ? c.away + 2 * by : kInfinity);
  }

  const Target& target_;
  const Path& path_;
  double gap_ = 0;
};

}  // namespace

Deviation certify(const Target& target, const std::vector<Run>& runs) {
  const Deviation failed{-kInfinity, kInfinity};
  const Path& path = *target.path;
  Sectors sectors(target);
  sectors.check_end(runs.front(), false);
  sectors.check_end(runs.back(), true);
  Deviation total;
  double handed_over = runs.front().tau0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Run& run = runs[i];
    if (!starts_sector(path, run.arc, false, run.tau0) || !starts_sector(path, run.arc, true, run.tau1))
      return failed;
    // The path passes from this arc's sector to the next one's at tau1, its offset at `next`.
    const double next = i + 1 < runs.size() ? sectors.hand_over(run, runs[i + 1]) : run.tau1;
    sectors.check_turning_points(run);
    if (sectors.gap() > target.tolerance) return failed;
    const double lo = std::min(run.tau0, handed_over), hi = std::max(run.tau1, next);
    if (!certify_run(target, run.arc, lo, hi, total)) return failed;
    handed_over = next;
  }
  const double pad = kRounding * path.magnitude + target.singular.slack;
  total.lo = std::min(total.lo, -sectors.gap()) - pad;
  total.hi = std::max(total.hi, sectors.gap()) + pad;
  return total.bound() <= target.tolerance ? total : failed;
}

}  // namespace burin::geom::fit
