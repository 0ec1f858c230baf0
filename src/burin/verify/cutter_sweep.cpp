// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/cutter_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

constexpr std::size_t kBlock = 16;
// Newton from outside converges without overshooting, because f is concave; it is quadratic off the edges.
constexpr int kNewton = 60;
constexpr double kLeastSpan = 1e-9;  // of a stretch: shorter times are not divided further

}  // namespace

struct CutterSweep::Line {
  Point3 q;
  Vec3 n;
  double from = 0, resolution = 0;
  double best = 0;  ///< lowest entry so far
};

CutterSweep::CutterSweep(const MillBody& body, std::vector<Stretch> stretches)
    : body_(body), stretches_(std::move(stretches)) {
  const double span = std::hypot(body.radius, std::max(std::abs(body.low), std::abs(body.high)));
  for (std::size_t i = 0; i < stretches_.size(); i += kBlock) {
    geom::Box3 tips;
    for (std::size_t k = i; k < std::min(stretches_.size(), i + kBlock); ++k) {
      tips.add(stretches_[k].from.tip);
      tips.add(stretches_[k].from.tip + stretches_[k].way);
    }
    blocks_.push_back({lerp(tips.lo, tips.hi, 0.5), 0.5 * tips.diagonal() + span});
  }
}

double CutterSweep::entry(Point3 q, Vec3 n, double window, double resolution,
                          const std::vector<std::size_t>& hints) const {
  Line line{q, n, -window, resolution, window};
  for (const std::size_t h : hints)
    for (std::size_t k = h < 2 ? 0 : h - 2; k < std::min(stretches_.size(), h + 2); ++k)
      lower(line, stretches_[k]);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (distance(q, blocks_[b].center) > blocks_[b].reach + window) continue;
    for (std::size_t k = b * kBlock; k < std::min(stretches_.size(), (b + 1) * kBlock); ++k)
      lower(line, stretches_[k]);
  }
  return line.best;
}

void CutterSweep::lower(Line& line, const Stretch& stretch) const {
  lower(line, stretch, 0.5, 0.5);
}

/// Lowers `best` by what the cutter does at the times middle +- half, or proves that it does nothing there:
/// at no height up to `best` less the resolution is f positive then.
void CutterSweep::lower(Line& line, const Stretch& stretch, double middle, double half) const {
  const double top = line.best - line.resolution;
  if (top <= line.from) return;
  const Placed at = stretch.at(middle);
  const Point3 p = line.q + top * line.n;
  const BodyAt b = body_at(body_, at.tip, at.axis, p);
  const Vec3 from_tip = p - at.tip, motion = -(stretch.way + cross(stretch.turn, from_tip));
  const double below = top - line.from, turn = norm(stretch.turn), way = norm(stretch.way);
  const double far = norm(from_tip) + below + way * half;
  const double bend = 0.5 * turn * (turn * far + 2 * way) * half * half;
  double upper = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < b.count && upper > 0; ++i) {
    const Vec3 g = b.sides[i].gradient;
    // Lower on the line it may be more, and may move otherwise.
    const double lower_down = std::max(0.0, -dot(g, line.n)) * below;
    const double varies = turn > 0 ? std::abs(dot(cross(g, stretch.turn), line.n)) * below : 0;
    upper = std::min(upper, b.sides[i].f + lower_down + half * (std::abs(dot(g, motion)) + varies) + bend);
  }
  if (upper <= 0) return;
  // Where the line enters at the middle, from below.
  double h = line.from;
  for (int i = 0; i < kNewton; ++i) {
    const BodyAt here = body_at(body_, at.tip, at.axis, line.q + h * line.n);
    if (here.f >= -0.01 * line.resolution) {
      line.best = std::min(line.best, h);
      break;
    }
    const BodySide& side = here.sides[here.least];
    const double slope = dot(side.gradient, line.n);
    if (slope <= 0) break;  // it only gets less
    h += -side.f / slope;
    if (h >= line.best) break;
  }
  if (half < kLeastSpan) return;
  lower(line, stretch, middle - 0.5 * half, 0.5 * half);
  lower(line, stretch, middle + 0.5 * half, 0.5 * half);
}

}  // namespace burin::verify
