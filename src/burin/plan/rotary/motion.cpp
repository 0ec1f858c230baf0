// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/motion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::rotary {
namespace {

using geom::Point3;
using geom::Vec3;

// 2^-40 of a move is below rounding: no interval is halved further.
constexpr int kMaxDepth = 40;
constexpr double kFar = 1e300;

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
  double low = 0, high = 0;  ///< bounds of the distance to the part; `low` alone when it is far
  double x = 0;              ///< of the nearest place
  bool known = false;        ///< nothing more can be found out
};

class BallCheck {
 public:
  BallCheck(const Way& way, const geom::MeshIndex& part, double radius, const MotionOptions& options)
      : way_(way), part_(part), radius_(radius), allowed_(options.ball_mm), options_(options) {}

  /// True when the ball is proven to sink in by at most `allowed` everywhere.
  bool run() {
    const double reach = radius_ + norm(way_.center(1) - way_.center(0)) + way_.bend(1) - allowed_;
    Stop first = stop(0, reach), last = stop(1, reach);
    return clear(first, last, 0);
  }
  double at() const { return at_; }
  double depth() const { return depth_; }

 private:
  Stop stop(double t, double within) const {
    const Point3 c = way_.center(t);
    const double off = options_.deflection_mm;
    const auto hit = part_.nearest(c, within + off);
    if (!hit) return {t, c, within, kFar, 0, true};
    return {t, c, std::max(0.0, hit->distance - off), hit->distance + off, hit->p.x, !(off > 0)};
  }

  /// Asks the part itself.
  void find_out(Stop& s) const {
    if (!s.known && options_.design != nullptr)
      s.low = std::max(s.low, options_.design->least(s.center, s.high, s.x));
    s.known = true;
  }

  /// Over the stretch between a and b. A point q keeps |q - C|^2 >= (1-s) da^2 + s db^2 - s (1-s) h^2 from
  /// the chord; the bend comes on top.
  double depth_bound(const Stop& a, const Stop& b, double da, double db, double bend) const {
    const double h2 = dot(b.center - a.center, b.center - a.center);
    const double da2 = da * da, db2 = db * db;
    double least = std::min(da2, db2);
    if (h2 > 0) {
      const double s = std::clamp(0.5 - (db2 - da2) / (2 * h2), 0.0, 1.0);
      least = std::min(least, (1 - s) * da2 + s * db2 - s * (1 - s) * h2);
    }
    return radius_ - std::sqrt(std::max(0.0, least)) + bend;
  }

  bool clear(Stop& a, Stop& b, int level) {
    for (Stop* s : {&a, &b}) {
      if (radius_ - s->low <= allowed_) continue;
      if (radius_ - s->high > allowed_) return fail(*s);
      find_out(*s);
      if (radius_ - s->low > allowed_) return fail(*s);
    }
    const double dt = b.t - a.t;
    const double bend = way_.bend(dt);
    double depth = depth_bound(a, b, a.low, b.low, bend);
    // Where no better knowledge of the ends would do, the stretch is too long.
    const bool ask = depth > allowed_ && !(a.known && b.known) &&
                     depth_bound(a, b, a.known ? a.low : a.high, b.known ? b.low : b.high, bend) <= allowed_;
    if (ask) {
      find_out(a);
      find_out(b);
      depth = depth_bound(a, b, a.low, b.low, bend);
    }
    if (depth <= allowed_) {
      depth_ = std::max(depth_, depth);
      return true;
    }
    if (level >= kMaxDepth) return fail(a);
    // Beyond this distance the middle is known to be far enough.
    const double within = radius_ - allowed_ + norm(b.center - a.center) + bend;
    Stop middle = stop((a.t + b.t) / 2, within);
    return clear(a, middle, level + 1) && clear(middle, b, level + 1);
  }

  bool fail(const Stop& s) {
    at_ = s.t;
    depth_ = std::max(depth_, radius_ - s.low);
    return false;
  }

  const Way& way_;
  const geom::MeshIndex& part_;
  double radius_, allowed_, at_ = 0, depth_ = -1e300;
  const MotionOptions& options_;
};

/// One cylinder of the tool: the shank or a piece of the holder.
struct Piece {
  double radius, low, high;  ///< heights above the ball's centre
};

/// A cylinder along the way. Seen from the tool, a point of the part moves by at most h over a stretch, along
/// a line but for a bend. One that is in the cylinder at some time is within its heights grown by h at both
/// ends of the stretch; with distances da and db from the axis line there it comes no nearer to it than
/// sqrt((1-s) da^2 + s db^2 - s (1-s) h^2) - bend.
class PieceCheck {
 public:
  PieceCheck(const Way& way, const BodyIndex& body, const Piece& piece, double tolerance)
      : way_(way), body_(body), piece_(piece), tolerance_(tolerance) {
    // Sinking in along the axis is allowed for, too, by half.
    piece_.low += tolerance / 2;
    piece_.high -= tolerance / 2;
    const double turn = std::abs(way.theta_to - way.theta_from);
    // No point of the part stands higher than its radius in the machine.
    const double lowest = std::min(way.from.z, way.to.z);
    room_above_ = body.radius() - lowest;
    const double far = std::hypot(std::max(0.0, room_above_), piece.radius);
    speed_ = norm(way.center(1) - way.center(0)) + 4 * way.bend(1) + turn * far;
    turn_ = turn;
    bend_ = body.radius() * turn * turn / 8;
  }

  bool run() { return room_above_ < piece_.low || clear(0, 1, 0); }
  double at() const { return at_; }

 private:
  bool clear(double from, double to, int level) {
    const double dt = std::ldexp(1, -level);
    // A point within reach at one time is as far as that and its own motion at the others.
    if (turn_ * dt < 0.5) {
      const double h = dt * speed_ / (1 - turn_ * dt), bend = std::ldexp(bend_, -2 * level);
      if (h < kLongest * piece_.radius && stretch(from, to, h, bend)) return true;
      if (level >= kMaxDepth || h < kShortest * tolerance_) {
        at_ = from;
        return false;
      }
    }
    const double middle = (from + to) / 2;
    return clear(from, middle, level + 1) && clear(middle, to, level + 1);
  }

  bool stretch(double from, double to, double h, double bend) {
    // More than this is of no use: then the whole stretch is proven by one end.
    const double within = piece_.radius + h + bend;
    const double da = distance(from, h, within), allowed = piece_.radius - tolerance_ + bend;
    if (da >= within) return true;
    if (da < allowed) return false;
    const double db = distance(to, h, within);
    if (db >= within) return true;
    if (db < allowed) return false;
    const double a2 = da * da, b2 = db * db, h2 = h * h;
    const double s = std::clamp(0.5 - (b2 - a2) / (2 * h2), 0.0, 1.0);
    const double least = h > 0 ? (1 - s) * a2 + s * b2 - s * (1 - s) * h2 : std::min(a2, b2);
    return least > 0 && std::sqrt(least) >= allowed;
  }
  /// The end of one stretch is the start of the next.
  double distance(double t, double h, double within) {
    if (t == asked_t_ && h == asked_h_) return answer_;
    asked_t_ = t;
    asked_h_ = h;
    return answer_ = body_.to_axis(way_.center(t), way_.theta(t), piece_.low - h, piece_.high + h, within);
  }

  // Where a stretch is so short (part of the tolerance) and not clear, the tool gouges.
  static constexpr double kShortest = 1e-3;
  // Motions above some radii are never proven in one.
  static constexpr double kLongest = 8;
  const Way& way_;
  const BodyIndex& body_;
  Piece piece_;
  double tolerance_, room_above_ = 0, speed_ = 0, turn_ = 0, bend_ = 0, at_ = 0;
  double asked_t_ = -1, asked_h_ = -1, answer_ = 0;
};

std::vector<Piece> pieces_of(const model::BallTool& tool) {
  // Above the shank the holder begins; without one the shank has no end.
  std::vector<Piece> out{{tool.shank_radius, 0, 1e9}};
  double from = tool.shank_length;
  for (const model::HolderPiece& piece : tool.holder) {
    out.push_back({piece.radius, from, from + piece.height});
    from += piece.height;
  }
  return out;
}

}  // namespace

AxisPose between(const AxisPose& from, const AxisPose& to, double t) {
  const Way way(from, to);
  return {way.center(t), way.theta(t)};
}

Point3 tip_of(const AxisPose& pose, double radius) {
  return pose.center - radius * Vec3{0, std::sin(pose.theta), std::cos(pose.theta)};
}

MoveCheck check_move(const AxisPose& from, const AxisPose& to, const BodyIndex& body,
                     const geom::MeshIndex& part, const model::BallTool& tool, const MotionOptions& options) {
  const Way way(from, to);
  MoveCheck out;
  BallCheck ball(way, part, tool.radius, options);
  if (!ball.run()) {
    out.at = ball.at();
    out.ball_depth = ball.depth();
    return out;
  }
  out.ball_depth = ball.depth();
  for (const Piece& piece : pieces_of(tool)) {
    PieceCheck check(way, body, piece, options.tolerance_mm - options.deflection_mm);
    if (check.run()) continue;
    out.at = check.at();
    return out;
  }
  out.clear = true;
  return out;
}

}  // namespace burin::rotary
