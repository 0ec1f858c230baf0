// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/motion.h"

#include <algorithm>
#include <cmath>

#include "burin/geom/vec.h"

namespace burin::rotary {
namespace {

using geom::Point3;
using geom::Vec3;

// 2^-40 of a move is below rounding: no interval is halved further.
constexpr int kMaxDepth = 40;

/// Part frame to machine frame at A = theta, and back.
Point3 turned(Point3 p, double theta) {
  const double c = std::cos(theta), s = std::sin(theta);
  return {p.x, p.y * c - p.z * s, p.y * s + p.z * c};
}

/// The centre's way: c'(t) runs linearly in the machine, C(t) = Rx(-theta(t)) c'(t) in the part.
struct Way {
  Point3 from, to;  ///< machine frame
  double theta_from, theta_to;
  double radius;  ///< largest distance from the X axis
  double run_yz;  ///< length of the linear way in y', z'

  Way(const AxisPose& a, const AxisPose& b)
      : from(turned(a.center, a.theta)),
        to(turned(b.center, b.theta)),
        theta_from(a.theta),
        theta_to(b.theta) {
    radius = std::max(std::hypot(from.y, from.z), std::hypot(to.y, to.z));
    run_yz = std::hypot(to.y - from.y, to.z - from.z);
  }
  double theta(double t) const { return theta_from + t * (theta_to - theta_from); }
  Point3 center(double t) const { return turned(lerp(from, to, t), -theta(t)); }
  /// How far the way leaves its chord over a stretch dt: |C''| <= dtheta^2 |c'| + 2 |dtheta| |dc'|, over 8.
  double bend(double dt) const {
    const double turn = std::abs(theta_to - theta_from);
    return (turn * turn * radius + 2 * turn * run_yz) * dt * dt / 8;
  }
};

/// A place of the way with what is known about it.
struct Stop {
  double t = 0;
  Point3 center;
  double distance = 0;  ///< to the part, or a lower bound when it is far
};

class BallCheck {
 public:
  BallCheck(const Way& way, const geom::MeshIndex& part, double radius, double allowed)
      : way_(way), part_(part), radius_(radius), allowed_(allowed) {}

  /// True when the ball is proven to sink in by at most `allowed` everywhere.
  bool run() {
    const double reach = radius_ + norm(way_.center(1) - way_.center(0)) + way_.bend(1) - allowed_;
    return clear(stop(0, reach), stop(1, reach), 0);
  }
  double at() const { return at_; }
  double depth() const { return depth_; }

 private:
  Stop stop(double t, double within) const {
    const Point3 c = way_.center(t);
    const auto hit = part_.nearest(c, within);
    return {t, c, hit ? hit->distance : within};
  }

  /// Over the stretch between a and b. A point q keeps |q - C|^2 >= (1-s) da^2 + s db^2 - s (1-s) h^2 from
  /// the chord; the bend comes on top.
  double depth_bound(const Stop& a, const Stop& b, double bend) const {
    const double h2 = dot(b.center - a.center, b.center - a.center);
    const double da2 = a.distance * a.distance, db2 = b.distance * b.distance;
    double least = std::min(da2, db2);
    if (h2 > 0) {
      const double s = std::clamp(0.5 - (db2 - da2) / (2 * h2), 0.0, 1.0);
      least = std::min(least, (1 - s) * da2 + s * db2 - s * (1 - s) * h2);
    }
    return radius_ - std::sqrt(std::max(0.0, least)) + bend;
  }

  bool clear(const Stop& a, const Stop& b, int level) {
    if (radius_ - a.distance > allowed_) return fail(a);
    if (radius_ - b.distance > allowed_) return fail(b);
    const double dt = b.t - a.t;
    const double bend = way_.bend(dt);
    const double depth = depth_bound(a, b, bend);
    if (depth <= allowed_) {
      depth_ = std::max(depth_, depth);
      return true;
    }
    if (level >= kMaxDepth) return fail(a);
    // Beyond this distance the middle is known to be far enough.
    const double within = radius_ - allowed_ + norm(b.center - a.center) + bend;
    const Stop middle = stop((a.t + b.t) / 2, within);
    return clear(a, middle, level + 1) && clear(middle, b, level + 1);
  }

  bool fail(const Stop& s) {
    at_ = s.t;
    depth_ = std::max(depth_, radius_ - s.distance);
    return false;
  }

  const Way& way_;
  const geom::MeshIndex& part_;
  double radius_, allowed_, at_ = 0, depth_ = -1e300;
};

/// Whether the whole of [lo, hi] (any number of turns) is in the set.
bool holds(const AngleSet& set, double lo, double hi) {
  for (const AngleInterval& i : set) {
    if (i.hi - i.lo >= 2 * geom::kPi) return true;
    const double turns = std::ceil((lo - i.hi) / (2 * geom::kPi)) * 2 * geom::kPi;
    if (i.lo + turns <= lo && hi <= i.hi + turns) return true;
  }
  return false;
}

class BodyCheck {
 public:
  BodyCheck(const Way& way, const ReachIndex& reach, double tolerance)
      : way_(way), reach_(reach), give_(0.75 * tolerance), finest_(tolerance / 4) {}

  bool run() { return clear(0, 1, 0); }
  double at() const { return at_; }

 private:
  /// The tool at any time of the stretch is the tool about the middle centre, moved by at most `shift`:
  /// grown by that (and shrunk by what it may sink in) it must be free over the whole range of angles. The
  /// shank's lower end has to grow, too: the centre is moved along the axis. (Shrunk, it need not: what the
  /// end leaves out is less deep than `shift`, and the ball is there.)
  bool clear(double from, double to, int level) {
    const double middle = (from + to) / 2, half = (to - from) / 2;
    const Point3 c = way_.center(middle);
    const double shift = std::max(norm(way_.center(from) - c), norm(way_.center(to) - c)) + way_.bend(half);
    const double theta = way_.theta(middle);
    const double turn = std::abs(way_.theta(to) - way_.theta(from)) / 2;
    const double grow = shift - give_;
    const Vec3 axis{0, std::sin(theta), std::cos(theta)};
    ReachOptions options;
    options.grow_mm = grow + std::abs(grow) * turn;
    const AngleSet set = reach_.reachable(c - std::max(0.0, grow) * axis, options);
    if (holds(set, theta - turn, theta + turn)) return true;
    // A collision in the middle is not looked for in ever smaller steps from the start.
    options.grow_mm = -give_;
    if (level < kEarly && grow > 0 && !contains(reach_.reachable(c, options), theta)) {
      at_ = middle;
      return false;
    }
    if (level >= kMaxDepth || (shift <= finest_ && turn <= kFinestTurn)) {
      at_ = middle;
      return false;
    }
    return clear(from, middle, level + 1) && clear(middle, to, level + 1);
  }

  // A turn about the centre moves the holder sideways: over this one by 2.5 um at 100 mm.
  static constexpr double kFinestTurn = 2.5e-5;
  static constexpr int kEarly = 6;
  const Way& way_;
  const ReachIndex& reach_;
  double give_, finest_, at_ = 0;
};

}  // namespace

AxisPose between(const AxisPose& from, const AxisPose& to, double t) {
  const Way way(from, to);
  return {way.center(t), way.theta(t)};
}

Point3 tip_of(const AxisPose& pose, double radius) {
  return pose.center - radius * Vec3{0, std::sin(pose.theta), std::cos(pose.theta)};
}

MoveCheck check_move(const AxisPose& from, const AxisPose& to, const ReachIndex& reach,
                     const geom::MeshIndex& part, const model::BallTool& tool, const MotionOptions& options) {
  const Way way(from, to);
  MoveCheck out;
  BallCheck ball(way, part, tool.radius, options.ball_mm);
  if (!ball.run()) {
    out.at = ball.at();
    out.ball_depth = ball.depth();
    return out;
  }
  out.ball_depth = ball.depth();
  BodyCheck body(way, reach, options.tolerance_mm);
  out.clear = body.run();
  if (!out.clear) out.at = body.at();
  return out;
}

}  // namespace burin::rotary
