// SPDX-License-Identifier: Apache-2.0
#include "burin/post/round_arc.h"

#include <algorithm>
#include <cmath>

#include "burin/post/words.h"

namespace burin::post {
namespace {

using geom::kPi;
using geom::Point2;
using geom::Vec2;

// A line may stand for an arc that it leaves by less than half a step: rounding does as much.
constexpr double kLineSteps = 0.5;
// Below four steps of radius no centre on the grid makes a circle of it.
constexpr double kMinRadiusSteps = 4;
constexpr int kMaxSplits = 6;
constexpr double kMaxPieces = 1e6;
// The ends move by up to 1.42 steps against each other, and the centre along the bisector; a sweep off by
// more than this many steps on the arc means the control turns another way round.
constexpr double kSweepSteps = 6;

Vec2 vec(GridPoint p) {
  return {static_cast<double>(p.a), static_cast<double>(p.b)};
}

class Rounder {
 public:
  Rounder(const PlaneArc& arc, GridPoint start, const ArcGrid& grid)
      : arc_(arc), grid_(grid), at_(start), scale_(1 / from_grid(1, grid.decimals)) {
    const Vec2 first = arc.start - arc.center, last = arc.end - arc.center;
    r_start_ = norm(first);
    r_end_ = norm(last);
    angle_ = std::atan2(first.y, first.x);
    min_radius_ = std::max(grid.min_radius_mm * scale_, kMinRadiusSteps);
    slack_ = std::abs(r_start_ - r_end_) * scale_;
  }

  std::optional<std::vector<ArcPiece>> run() {
    const double radius = std::max(r_start_, r_end_);
    const bool fits = radius * scale_ >= min_radius_ && radius <= grid_.max_radius_mm && !grid_.lines_only;
    if (!(fits ? arcs(0, 1, 0) : lines(0, 1))) return std::nullopt;
    return std::move(pieces_);
  }

 private:
  /// The exact arc at a part of its sweep, mm.
  Point2 exact(double t) const {
    if (t <= 0) return arc_.start;
    if (t >= 1) return arc_.end;
    const double angle = angle_ + (arc_.clockwise ? -1 : 1) * t * arc_.sweep;
    const double radius = r_start_ + t * (r_end_ - r_start_);
    return arc_.center + radius * Vec2{std::cos(angle), std::sin(angle)};
  }
  GridPoint rounded(Point2 p) const { return {to_grid(p.x, grid_.decimals), to_grid(p.y, grid_.decimals)}; }
  /// In steps, relative to the rounded start of the piece at hand (small numbers, no cancellation).
  Vec2 steps_from_start(Point2 p) const { return Vec2{p.x * scale_, p.y * scale_} - vec(at_); }

  void put(ArcPiece piece) {
    at_ = piece.end;
    pieces_.push_back(piece);
  }

  bool lines(double from, double to) {
    const double radius = std::max(r_start_, r_end_) * scale_;
    const double sweep = (to - from) * arc_.sweep;
    // A chord over the angle s has the sagitta 2 r sin^2(s/4).
    const double step = radius > kLineSteps ? 4 * std::asin(std::sqrt(kLineSteps / (2 * radius))) : 2 * kPi;
    const double count = std::max(1.0, std::ceil(sweep / step));
    if (!(static_cast<double>(pieces_.size()) + count <= kMaxPieces)) return false;
    const int n = static_cast<int>(count);
    for (int i = 1; i <= n; ++i) {
      const double t = i == n ? to : from + (to - from) * i / n;
      put({.line = true, .end = rounded(exact(t)), .at = t});
    }
    return true;
  }

  bool arcs(double from, double to, int splits) {
    const double sweep = (to - from) * arc_.sweep;
    const double radius = std::max(r_start_, r_end_) * scale_;
    const double sagitta = sweep <= kPi ? 2 * radius * std::pow(std::sin(sweep / 4), 2) : 2 * radius;
    if (sagitta < kLineSteps || (sweep < grid_.min_sweep && sagitta < 1)) {
      put({.line = true, .end = rounded(exact(to)), .at = to});
      return true;
    }
    if (const auto piece = one_arc(from, to)) {
      put(*piece);
      return true;
    }
    if (splits == kMaxSplits) return lines(from, to);
    const double middle = (from + to) / 2;
    return arcs(from, middle, splits + 1) && arcs(middle, to, splits + 1);
  }

  /// The centre for rounded ends: on the bisector of their chord, where it comes nearest to the exact centre.
  Vec2 best_center(GridPoint end) const {
    const Vec2 center = steps_from_start(arc_.center), chord = vec(end) - vec(at_);
    const double length2 = norm2(chord);
    if (length2 == 0) return center;
    return center + (0.5 - dot(center, chord) / length2) * chord;
  }

  std::optional<ArcPiece> one_arc(double from, double to) const {
    const bool full = to - from >= 1 && arc_.sweep >= 2 * kPi;
    const GridPoint end = full ? at_ : rounded(exact(to));
    if (!full && end == at_) return std::nullopt;  // the control would make a full circle of it
    const Vec2 center = best_center(end);
    const GridPoint middle{std::llround(center.x), std::llround(center.y)};
    std::optional<ArcPiece> best;
    double best_deviation = kMaxArcDeviation + slack_;
    // The nearest grid point first; its neighbours only while that is not good.
    for (const auto& [da, db] :
         {GridPoint{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) {
      if (best && best_deviation < 0.75) break;
      const ArcPiece piece{.end = end, .offset = {middle.a + da, middle.b + db}, .at = to};
      const double off = deviation(piece, from, to);
      if (off < best_deviation && accepted(piece, (to - from) * arc_.sweep)) {
        best = piece;
        best_deviation = off;
      }
    }
    return best;
  }

  /// How far the exact arc runs from what goes out, in steps. Controls differ where start and end radius
  /// differ (a spiral, or a circle of either radius and a last step): the worst of them counts. The distance
  /// varies as the sine of an angle that turns by at most one turn: nine samples see it within 8 %.
  double deviation(const ArcPiece& piece, double from, double to) const {
    const Vec2 center = vec(piece.offset);
    const double first = norm(center), last = norm(vec(piece.end) - vec(at_) - center);
    double worst = 0;
    constexpr int kSamples = 8;
    for (int i = 0; i <= kSamples; ++i) {
      const double part = static_cast<double>(i) / kSamples;
      const double radius = norm(steps_from_start(exact(from + part * (to - from))) - center);
      worst = std::max({worst, std::abs(radius - first), std::abs(radius - last)});
    }
    return worst;
  }

  /// The control's own checks, with half of its tolerance left.
  bool accepted(const ArcPiece& piece, double sweep) const {
    const ControlRadii radii = control_radii(at_, piece.end, piece.offset);
    if (radii.smaller < 1) return false;
    const double limit = std::max(grid_.absolute_mm * scale_, grid_.relative * radii.smaller);
    if (radii.difference > limit / 2) return false;
    const double turned = control_sweep(at_, piece.end, piece.offset, arc_.clockwise);
    return std::abs(turned - sweep) * radii.smaller <= kSweepSteps + slack_;
  }

  const PlaneArc& arc_;
  const ArcGrid& grid_;
  GridPoint at_;
  double scale_;
  double r_start_ = 0, r_end_ = 0, angle_ = 0, min_radius_ = 0, slack_ = 0;
  std::vector<ArcPiece> pieces_;
};

}  // namespace

double control_sweep(GridPoint start, GridPoint end, GridPoint offset, bool clockwise) {
  if (start == end) return 2 * kPi;
  const Vec2 first = -vec(offset), last = vec(end) - vec(start) - vec(offset);
  const double turned = std::atan2(cross(first, last), dot(first, last));
  const double angle = clockwise ? -turned : turned;
  return angle > 0 ? angle : angle + 2 * kPi;
}

ControlRadii control_radii(GridPoint start, GridPoint end, GridPoint offset) {
  const double first = norm(vec(offset)), last = norm(vec(end) - vec(start) - vec(offset));
  return {std::abs(first - last), std::min(first, last)};
}

std::optional<std::vector<ArcPiece>> round_arc(const PlaneArc& arc, GridPoint start, const ArcGrid& grid) {
  return Rounder(arc, start, grid).run();
}

}  // namespace burin::post
