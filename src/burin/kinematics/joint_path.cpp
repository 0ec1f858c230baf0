// SPDX-License-Identifier: Apache-2.0
#include "burin/kinematics/joint_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "burin/base/text.h"
#include "burin/kinematics/feed_way.h"

namespace burin::kinematics {
namespace {

using geom::Point3;
using geom::Vec3;

// Where a move passes a pole at a small distance, a table turns half round within a short stretch of it: only
// there it is halved so often.
constexpr int kMaxHalvings = 24;
// A turn of the first rotary axis below this needs no help at a pole.
constexpr double kPoleTurn = 0.1;
// The tip hardly moves (the tool turns about it): its speed says nothing.
constexpr double kStill_mm = 1e-3;
// Measured between the ends of a move.
constexpr double kSamples[] = {0.25, 0.5, 0.75};

/// What a motion record asks for, at t in [0, 1].
struct Wanted {
  Wanted(const cl::Pose& start, const cl::Pose& end, const cl::Arc* along)
      : from(start),
        to(end),
        straight(start, end),
        arc(along),
        sweep(along != nullptr ? cl::arc_sweep(start.tip, *along) : 0) {}
  cl::Pose from, to;
  FeedWay straight;
  const cl::Arc* arc;
  double sweep;

  cl::Pose at(double t) const {
    cl::Pose pose = straight.at(t);
    if (arc != nullptr) {
      const Vec3 spoke = from.tip - arc->center;
      const double rise = dot(to.tip - from.tip, arc->normal);
      pose.tip = arc->center + turned(spoke, arc->normal, t * sweep) + (t * rise) * arc->normal;
    }
    return pose;
  }
};

class Maker {
 public:
  Maker(const Kinematics& machine, const cl::Program& program, const JointPathOptions& options)
      : machine_(machine), program_(program), options_(options), at_(options.start) {}

  Result<JointPath> run() {
    if (program_.from) {
      auto start = machine_.inverse(*program_.from, at_);
      if (!start) return placed(start.error());
      at_ = *start;
      pose_ = *program_.from;
      known_ = true;
    }
    for (; record_ < program_.records.size(); ++record_) {
      const cl::Record& record = program_.records[record_];
      if (const auto* feed = std::get_if<cl::FeedRate>(&record)) feed_ = feed->mm_min;
      const cl::Pose* to = cl::pose_of(record);
      if (to == nullptr) continue;
      if (auto ok = std::holds_alternative<cl::Rapid>(record) ? rapid(*to) : cut(record, *to); !ok)
        return ok.error();
      pose_ = *to;
      known_ = true;
      ++move_;
    }
    if (options_.keep_acceleration)
      out_.acceleration_limited = keep_acceleration(machine_, out_.moves, options_.axis_tolerance_rad);
    return std::move(out_);
  }

 private:
  Error placed(Error error) const {
    error.message =
        "record " + std::to_string(record_) + ", move " + std::to_string(move_) + ": " + error.message;
    return error;
  }

  Result<Joints> joints(const cl::Pose& pose, const Joints& near) const {
    auto j = machine_.inverse(pose, near);
    if (!j) return placed(j.error());
    if (const auto beyond = machine_.violation(*j))
      return placed(Error{ErrorCode::range, "beyond the travel of axis " + beyond->text(), {}});
    return j;
  }

  Result<void> add(const JointMove& move) {
    if (out_.moves.size() >= options_.max_moves)
      return placed(
          Error{ErrorCode::range,
                "more than " + std::to_string(options_.max_moves) + " joint moves (a larger --tolerance)",
                {}});
    out_.moves.push_back(move);
    at_ = move.to;
    return {};
  }

  Result<void> rapid(const cl::Pose& to) {
    auto end = joints(to, at_);
    if (!end) return end.error();
    return add({true, *end, 0, static_cast<std::uint32_t>(record_)});
  }

  Result<void> cut(const cl::Record& record, const cl::Pose& to) {
    if (!known_)
      return placed(Error{ErrorCode::usage, "the first move is at feed from an unknown place (a rapid)", {}});
    const Wanted wanted(pose_, to, std::get_if<cl::Arc>(&record));
    int pieces = 1;
    if (wanted.arc != nullptr) {
      const double half =
          std::acos(std::clamp(1 - 0.5 * options_.tolerance_mm / wanted.arc->radius, -1.0, 1.0));
      pieces =
          std::max(2, static_cast<int>(std::min(1e6, std::ceil(wanted.sweep / std::max(2 * half, 1e-6)))));
    }
    bool first = true;
    for (int i = 0; i < pieces; ++i) {
      const double t0 = static_cast<double>(i) / pieces, t1 = static_cast<double>(i + 1) / pieces;
      if (auto ok = piece(wanted, t0, t1, 0, first); !ok) return ok.error();
    }
    return {};
  }

  /// From where the machine stands, at t0, to t1; halved until shape and speed are kept. The end is sought
  /// anew in each half: near a pole the solution next to the start is not always the one the way leads to.
  Result<void> piece(const Wanted& wanted, double t0, double t1, int halvings, bool& first) {
    const Joints start = at_;
    auto sought = joints(wanted.at(t1), start);
    if (!sought) return sought.error();
    const Joints end = *sought;
    if (options_.joint_linear) return in_parts(start, end, 0, first);
    const double off = deviation(wanted, t0, t1, start, end);
    if (options_.tool_centre && off <= options_.tolerance_mm)
      return add_cut(start, end, geom::distance(wanted.at(t0).tip, wanted.at(t1).tip), first);
    if (off > options_.tolerance_mm && at_pole(wanted.at(t0).axis, start, end) &&
        at_pole(wanted.at(t1).axis, start, end)) {
      // What is left is the turn of an axis that does not matter here: in place, then on.
      const std::array<double, 2> turned{end.rotary[0], start.rotary[1]};
      ++out_.pole_turns;
      if (auto ok =
              in_place(wanted.at(t0).tip, start, machine_.with_rotary(wanted.at(t0).tip, turned), 0, first);
          !ok)
        return ok;
      return piece(wanted, t0, t1, halvings, first);
    }
    const TipMotion tip = tip_motion(machine_, start, end);
    if (!options_.tool_centre && off <= options_.tolerance_mm && (!uneven(tip) || halvings == kMaxHalvings)) {
      out_.deviation_mm = std::max(out_.deviation_mm, off);
      return add_cut(start, end, tip.length, first);
    }
    if (halvings == kMaxHalvings)
      return placed(
          Error{ErrorCode::geometry,
                "the joints would leave the path by " + format_fixed(off, 4) +
                    " mm in steps however small (a path that does not pass so near a pole, or a larger "
                    "--tolerance)",
                {}});
    const double tm = 0.5 * (t0 + t1);
    if (auto ok = piece(wanted, t0, tm, halvings + 1, first); !ok) return ok;
    return piece(wanted, tm, t1, halvings + 1, first);
  }

  /// The tool axis is so near to the first rotary axis that this may turn as it likes, and it has to turn by
  /// much: the turn leaves the axis within its tolerance.
  bool at_pole(const Vec3& axis, const Joints& start, const Joints& end) const {
    if (machine_.rotary_count() < 2 || std::abs(end.rotary[0] - start.rotary[0]) < kPoleTurn) return false;
    const double off = norm(geom::cross(axis, machine_.rotary_axis(0).direction));
    return off <= 0.5 * options_.axis_tolerance_rad;
  }

  /// Turns about a tip that stays within the tolerance.
  Result<void> in_place(const Point3& tip, const Joints& start, const Joints& end, int halvings,
                        bool& first) {
    if (const auto beyond = machine_.violation(end))
      return placed(Error{ErrorCode::range, "beyond the travel of axis " + beyond->text(), {}});
    const Joints middle = between(start, end, 0.5);
    const double off = options_.tool_centre ? 0 : geom::distance(machine_.forward(middle).tip, tip);
    if (off <= options_.tolerance_mm || halvings == kMaxHalvings) {
      out_.deviation_mm = std::max(out_.deviation_mm, off);
      return add_cut(start, end, 0, first);
    }
    if (auto ok = in_place(tip, start, machine_.with_rotary(tip, middle.rotary), halvings + 1, first); !ok)
      return ok;
    return in_place(tip, at_, end, halvings + 1, first);
  }

  /// A joint-linear move in as many parts as even out the tip's speed; they are parts of the same motion.
  Result<void> in_parts(const Joints& start, const Joints& end, int halvings, bool& first) {
    const TipMotion tip = tip_motion(machine_, start, end);
    if (halvings < kMaxHalvings && uneven(tip)) {
      const Joints middle = between(start, end, 0.5);
      if (auto ok = in_parts(start, middle, halvings + 1, first); !ok) return ok;
      return in_parts(middle, end, halvings + 1, first);
    }
    return add_cut(start, end, tip.length, first);
  }

  bool uneven(const TipMotion& tip) const {
    return tip.length > kStill_mm &&
           std::max(tip.fastest - tip.length, tip.length - tip.slowest) > options_.speed_share * tip.length;
  }

  Result<void> add_cut(const Joints& start, const Joints& end, double length, bool& first) {
    if (!first) ++out_.inserted;
    first = false;
    return add({false, end, minutes(start, end, length), static_cast<std::uint32_t>(record_)});
  }

  /// How far tip and axis are from what is wanted; an axis off by its tolerance counts as a tip off by its.
  double deviation(const Wanted& wanted, double t0, double t1, const Joints& start, const Joints& end) const {
    double worst = 0;
    for (const double s : kSamples) {
      const cl::Pose is = machine_.forward(between(start, end, s)), should = wanted.at(t0 + s * (t1 - t0));
      // The tip may be early or late: what counts is how far it is beside the way.
      const Vec3 way = wanted.at(t1).tip - wanted.at(t0).tip, off = is.tip - should.tip;
      const double length = norm(way);
      const Vec3 beside = length > 0 ? off - (dot(off, way) / (length * length)) * way : off;
      const double tilt = norm(is.axis - should.axis);
      worst = std::max({worst, options_.tool_centre ? 0.0 : norm(beside),
                        options_.tolerance_mm * tilt / options_.axis_tolerance_rad});
    }
    return worst;
  }

  double minutes(const Joints& start, const Joints& end, double length) {
    const double least = least_minutes(machine_, start, end);
    const double wanted = feed_ > 0 ? length / feed_ : 0;
    if (least > wanted * (1 + 1e-9)) ++out_.feed_limited;
    return std::max(least, wanted);
  }

  const Kinematics& machine_;
  const cl::Program& program_;
  const JointPathOptions& options_;
  JointPath out_;
  Joints at_;
  cl::Pose pose_;
  bool known_ = false;
  double feed_ = 0;
  std::size_t record_ = 0, move_ = 0;
};

/// mm or degrees.
double travel(const Kinematics& machine, const model::Axis& axis, const Joints& a, const Joints& b) {
  if (axis.kind == model::AxisKind::linear) {
    const std::size_t i = static_cast<std::size_t>(axis.letter - 'X');
    return std::abs(b.linear[i] - a.linear[i]);
  }
  for (int i = 0; i < machine.rotary_count(); ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    if (machine.rotary_axis(i).letter == axis.letter)
      return geom::degrees(std::abs(b.rotary[k] - a.rotary[k]));
  }
  return 0;
}

}  // namespace

double least_minutes(const Kinematics& machine, const Joints& from, const Joints& to) {
  double least = 0;
  for (const model::Axis& axis : machine.machine().axes)
    if (axis.speed > 0) least = std::max(least, travel(machine, axis, from, to) / axis.speed);
  return least;
}

Result<JointPath> make_joint_path(const Kinematics& machine, const cl::Program& program,
                                  const JointPathOptions& options) {
  if (auto ok = cl::validate(program); !ok) return ok.error();
  return Maker(machine, program, options).run();
}

Joints between(const Joints& a, const Joints& b, double t) {
  Joints j;
  for (std::size_t i = 0; i < 3; ++i) j.linear[i] = a.linear[i] + t * (b.linear[i] - a.linear[i]);
  for (std::size_t i = 0; i < 2; ++i) j.rotary[i] = a.rotary[i] + t * (b.rotary[i] - a.rotary[i]);
  return j;
}

double total_minutes(const Kinematics& machine, const std::vector<JointMove>& moves) {
  double minutes = 0;
  const Joints* at = nullptr;
  for (const JointMove& move : moves) {
    minutes += move.minutes;
    if (move.rapid && at != nullptr) minutes += least_minutes(machine, *at, move.to);
    at = &move.to;
  }
  return minutes;
}

TipMotion tip_motion(const Kinematics& machine, const Joints& from, const Joints& to) {
  // The speed is smooth over a move: differences over a thousandth are exact to 1e-6 of it, and five nodes of
  // Simpson's rule (which hold both ends) are as exact for turns below half a radian.
  constexpr int kNodes = 5;
  constexpr double kStep = 1e-3, kWeights[kNodes] = {1, 4, 2, 4, 1};
  TipMotion motion;
  motion.slowest = std::numeric_limits<double>::infinity();
  double turn = 0;
  for (std::size_t i = 0; i < 2; ++i) turn = std::max(turn, std::abs(to.rotary[i] - from.rotary[i]));
  const int panels = 1 + static_cast<int>(std::min(1000.0, turn / 0.5));
  for (int p = 0; p < panels; ++p) {
    for (int n = 0; n < kNodes; ++n) {
      const double t = (p + n / (kNodes - 1.0)) / panels;
      const double lo = std::max(0.0, t - kStep), hi = std::min(1.0, t + kStep);
      const double speed = geom::distance(machine.forward(between(from, to, lo)).tip,
                                          machine.forward(between(from, to, hi)).tip) /
                           (hi - lo);
      motion.slowest = std::min(motion.slowest, speed);
      motion.fastest = std::max(motion.fastest, speed);
      motion.length += kWeights[n] / 12.0 / panels * speed;
    }
  }
  return motion;
}

}  // namespace burin::kinematics
