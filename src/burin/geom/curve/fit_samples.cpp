// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "burin/geom/curve/fit_internal.h"

namespace burin::geom::fit {

namespace {

constexpr std::size_t kMaxSamples = 4'000'000;
constexpr int kMaxSampleDepth = 30;
/// Samples turn by at most this (rad) from one to the next.
constexpr double kSampleTurn = 0.2;
/// With chord angles alpha and beta at its ends a stretch of length h has |alpha - beta| = |kappa'| h^2 / 6.
/// The best arcs have a length H with |kappa'| H^3 = tolerance / 0.00802 (docs/arc-fitting.md); for h = H /
/// 16 that gives |alpha - beta| h = tolerance / 197.
constexpr double kSampleSkew = 1.0 / 197;

double angle_between(Vec2 a, Vec2 b) {
  return std::atan2(cross(a, b), dot(a, b));
}

struct Sampler {
  const Path& path;
  double tolerance;
  std::vector<Sample>& out;

  void between(const Sample& a, const Sample& b, int depth) {
    const Vec2 chord = b.p - a.p;
    const double h = norm(chord);
    const double turn = angle_between(a.t, b.t);
    // sin alpha - sin beta times h, from cross products alone.
    const double skew = std::abs(cross(a.t, chord) - cross(chord, b.t));
    const bool dense =
        std::abs(turn) <= kSampleTurn && skew <= kSampleSkew * tolerance && dot(a.t, chord) > 0;
    const double mid = 0.5 * (a.tau + b.tau);
    if (dense || depth >= kMaxSampleDepth || out.size() >= kMaxSamples || !(a.tau < mid && mid < b.tau) ||
        h == 0) {
      out.push_back(b);
      return;
    }
    const PointTangent m = path.at(mid);
    const Sample middle{m.point, m.tangent, mid, 0};
    between(a, middle, depth + 1);
    between(middle, b, depth + 1);
  }
};

}  // namespace

std::vector<Sample> sample_path(const Path& path, double tolerance) {
  std::vector<Sample> out;
  const PointTangent start = path.at(0);
  out.push_back({start.point, start.tangent, 0, 0});
  Sampler sampler{path, tolerance, out};
  // Eight stretches a piece to begin with: symmetric S-shapes must not look straight from their ends.
  constexpr int kFirst = 8;
  for (std::size_t k = 0; k < path.pieces.size(); ++k) {
    for (int i = 1; i <= kFirst; ++i) {
      const double tau = static_cast<double>(k) + static_cast<double>(i) / kFirst;
      const PointTangent c = path.at(tau);
      const Sample from = out.back();
      sampler.between(from, {c.point, c.tangent, tau, 0}, 0);
    }
  }
  if (out.size() >= kMaxSamples) return {};
  for (std::size_t i = 1; i < out.size(); ++i)
    out[i].turn = out[i - 1].turn + angle_between(out[i - 1].t, out[i].t);
  return out;
}

double deviation_at_samples(const Biarc& biarc, const Sample* first, const Sample* last, double enough) {
  const Arc& one = biarc[0];
  const Arc& two = biarc[1];
  double worst = 0;
  for (const Sample* s = first; s <= last && worst <= enough; ++s) {
    const bool before = dot(s->p - two.a, two.ta) < 0;
    const Arc& arc = before ? one : two;
    worst = std::max(worst, std::abs(signed_distance(arc.a, arc.ta, arc.k, s->p)));
  }
  return worst;
}

bool best_biarc(Point2 a, Vec2 ta, Point2 b, Vec2 tb, const Sample* first, const Sample* last,
                double good_enough, Biarc& best, double& deviation) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kGolden = 0.6180339887498949;
  constexpr double kWidest = 2.1;  // log of the ratio of the tangent lengths: 1/8 .. 8
  constexpr int kSteps = 14;
  deviation = kInfinity;
  const auto at = [&](double log_ratio) {
    Biarc biarc;
    if (!make_biarc(a, ta, b, tb, std::exp(log_ratio), biarc)) return kInfinity;
    const double worst = deviation_at_samples(biarc, first, last, kInfinity);
    if (worst < deviation) {
      deviation = worst;
      best = biarc;
    }
    return worst;
  };
  double lo = -kWidest, hi = kWidest;
  double x0 = hi - kGolden * (hi - lo), x1 = lo + kGolden * (hi - lo);
  double f0 = at(x0), f1 = at(x1);
  for (int i = 0; i < kSteps && deviation > good_enough; ++i) {
    if (f0 <= f1) {
      hi = x1;
      x1 = x0;
      f1 = f0;
      x0 = hi - kGolden * (hi - lo);
      f0 = at(x0);
    } else {
      lo = x0;
      x0 = x1;
      f0 = f1;
      x1 = lo + kGolden * (hi - lo);
      f1 = at(x1);
    }
  }
  return deviation < kInfinity;
}

}  // namespace burin::geom::fit
