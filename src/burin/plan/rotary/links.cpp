// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/links.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/geom/vec.h"

namespace burin::rotary {
namespace {

using geom::kPi;
using geom::Vec3;

// A rapid turns in pieces below half a turn: poses then say which way round it goes.
constexpr double kRapidTurn = 2 * kPi / 3;
// A feed link turns at most by this and is at most this many ball radii long.
constexpr double kLinkTurn = 0.5;
constexpr double kLinkRadii = 6;
// Heights at which a link is tried, in ball radii.
constexpr double kLinkLifts[] = {0, 0.1, 0.5, 2};

Vec3 axis_of(double theta) {
  return {0, std::sin(theta), std::cos(theta)};
}
/// Height of the centre in the machine.
double height(const AxisPose& pose) {
  return pose.center.y * std::sin(pose.theta) + pose.center.z * std::cos(pose.theta);
}

}  // namespace

double tip_length(const AxisPose& from, const AxisPose& to, double radius) {
  const double turn = std::abs(to.theta - from.theta);
  const auto pieces = static_cast<int>(std::min(1000.0, 1 + std::ceil(turn / 0.05)));
  double sum = 0;
  geom::Point3 last = tip_of(from, radius);
  for (int i = 1; i <= pieces; ++i) {
    const geom::Point3 next = tip_of(between(from, to, static_cast<double>(i) / pieces), radius);
    sum += geom::distance(last, next);
    last = next;
  }
  return sum;
}

Linker::Linker(const Shared& shared, RotaryPlan& plan) : shared_(shared), plan_(plan) {
  const RotaryOptions& o = shared.options;
  const double clear = std::max(shared.part.radius_max, o.stock_radius);
  clear_z_ = clear + o.safety_mm + shared.tool.radius;
}

AxisPose Linker::lifted(const AxisPose& pose, double by) const {
  return {pose.center + by * axis_of(pose.theta), pose.theta};
}
AxisPose Linker::above(const AxisPose& pose) const {
  return lifted(pose, std::max(0.0, clear_z_ - height(pose)));
}

bool Linker::can_lift(const AxisPose& pose) const {
  ReachOptions lenient;
  lenient.grow_mm = -0.75 * shared_.options.tolerance_mm;
  return contains(shared_.lift.reachable(pose.center, lenient), pose.theta);
}

void Linker::leg(LegKind kind, std::vector<AxisPose> poses, std::size_t path,
                 std::vector<std::size_t> points) {
  const double radius = shared_.tool.radius;
  double sum = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) sum += tip_length(poses[i - 1], poses[i], radius);
  RotaryLengths& l = plan_.lengths_mm;
  (kind == LegKind::cut ? l.cut : kind == LegKind::link ? l.link : l.rapid) += sum;
  at_ = poses.back();
  Leg out;
  out.kind = kind;
  out.poses = std::move(poses);
  out.path = path;
  out.points = std::move(points);
  plan_.legs.push_back(std::move(out));
}

std::vector<Linker::Run> Linker::runs_of(const PathPlan& path, std::size_t number) {
  std::vector<Run> runs;
  const std::size_t first = plan_.points.size();
  const std::size_t count = path.closed && path.nodes.size() > 1 ? path.nodes.size() - 1 : path.nodes.size();
  for (std::size_t i = 0; i < path.nodes.size(); ++i) {
    const Node& node = path.nodes[i];
    if (i < count) {
      RotaryPoint p;
      p.place = node.place;
      p.path = number;
      p.index = i;
      p.initial = node.initial;
      p.theta = node.theta;
      p.initial_interferes = node.initial_interferes;
      p.reachable = node.reachable;
      plan_.points.push_back(std::move(p));
    }
    if (!node.open()) continue;
    // The first place of a closed path again: only as the end of a cut.
    if (i >= count && !node.cut) continue;
    if (!node.cut || runs.empty()) runs.emplace_back();
    runs.back().poses.push_back(node.pose());
    runs.back().points.push_back(first + i % count);
  }
  return runs;
}

// --- limits of the rotary axis

bool Linker::fits(const Run& run, double turns) const {
  const RotaryOptions& o = shared_.options;
  return std::all_of(run.poses.begin(), run.poses.end(), [&](const AxisPose& p) {
    return p.theta + turns >= o.theta_min && p.theta + turns <= o.theta_max;
  });
}

bool Linker::place(Run& run) const {
  const double from = std::round((at_.theta - run.poses.front().theta) / (2 * kPi));
  for (int k = 0; k < 64; ++k) {
    for (const int sign : {1, -1}) {
      const double turns = (from + sign * k) * 2 * kPi;
      if (!fits(run, turns)) continue;
      for (AxisPose& p : run.poses) p.theta += turns;
      return true;
    }
  }
  return false;
}

std::vector<Linker::Run> Linker::cut_to_limits(const Run& run) const {
  const RotaryOptions& o = shared_.options;
  std::vector<Run> out;
  double turns = 0;
  for (std::size_t i = 0; i < run.poses.size(); ++i) {
    AxisPose p = run.poses[i];
    const auto inside = [&](double theta) { return theta >= o.theta_min && theta <= o.theta_max; };
    if (out.empty() || !inside(p.theta + turns)) {
      // As low as possible when it grows, as high as possible when it falls.
      const bool grows = run.poses.back().theta >= run.poses.front().theta;
      const double edge = grows ? o.theta_min : o.theta_max;
      turns = 2 * kPi *
              (grows ? std::ceil((edge - p.theta) / (2 * kPi)) : std::floor((edge - p.theta) / (2 * kPi)));
      if (!inside(p.theta + turns)) continue;  // an angle that the machine does not have
      const bool again = !out.empty() && i > 0 && inside(run.poses[i - 1].theta + turns);
      out.emplace_back();
      if (again) {
        out.back().poses.push_back({run.poses[i - 1].center, run.poses[i - 1].theta + turns});
        out.back().points.push_back(run.points[i - 1]);
      }
    }
    p.theta += turns;
    out.back().poses.push_back(p);
    out.back().points.push_back(run.points[i]);
  }
  return out;
}

// --- motion between cuts

bool Linker::link(const AxisPose& to, std::size_t path) {
  const double radius = shared_.tool.radius;
  if (up_ || geom::distance(at_.center, to.center) > kLinkRadii * radius) return false;
  if (std::abs(to.theta - at_.theta) > kLinkTurn) return false;
  const MotionOptions o = shared_.cutting();
  for (const double lift : kLinkLifts) {
    std::vector<AxisPose> poses{at_};
    if (lift > 0) {
      poses.push_back(lifted(at_, lift * radius));
      poses.push_back(lifted(to, lift * radius));
    }
    poses.push_back(to);
    bool clear = true;
    for (std::size_t i = 1; clear && i < poses.size(); ++i) {
      const MoveCheck c = check_move(poses[i - 1], poses[i], shared_.body, shared_.mesh, shared_.tool, o);
      clear = c.clear;
      if (clear) plan_.quality.gouge_max_mm = std::max(plan_.quality.gouge_max_mm, c.ball_depth);
    }
    if (!clear) continue;
    leg(LegKind::link, std::move(poses), path);
    return true;
  }
  return false;
}

void Linker::retract(std::size_t path) {
  if (up_) return;
  // Back along the cut to a place from which the tool comes out.
  std::vector<AxisPose> poses{at_};
  for (std::size_t i = behind_.size(); !can_lift(poses.back()) && i-- > 0;)
    if (!(behind_[i].center == at_.center && behind_[i].theta == at_.theta)) poses.push_back(behind_[i]);
  poses.push_back(above(poses.back()));
  leg(LegKind::retract, std::move(poses), path);
  up_ = true;
}

bool Linker::approach(const Run& run, std::size_t path) {
  std::size_t k = 0;
  while (k < run.poses.size() && !can_lift(run.poses[k])) ++k;
  if (k == run.poses.size()) return false;
  retract(path);
  const AxisPose top = above(run.poses[k]);
  if (started_) {
    std::vector<AxisPose> poses{at_};
    const double turn = top.theta - at_.theta;
    const auto pieces =
        static_cast<int>(std::min(1e6, std::max(1.0, std::ceil(std::abs(turn) / kRapidTurn))));
    const AxisPose from = at_;
    for (int i = 1; i < pieces; ++i) poses.push_back(between(from, top, static_cast<double>(i) / pieces));
    poses.push_back(top);
    leg(LegKind::rapid, std::move(poses), path);
  }
  started_ = true;
  std::vector<AxisPose> poses{top};
  // Fast in the air: above the place itself when nothing is said about the stock.
  const double fast =
      shared_.options.stock_radius > 0 ? 0 : height(top) - height(run.poses[k]) - shared_.options.safety_mm;
  if (fast > 0) poses.push_back(lifted(run.poses[k], shared_.options.safety_mm));
  for (std::size_t i = k + 1; i-- > 0;) poses.push_back(run.poses[i]);
  leg(LegKind::approach, std::move(poses), path);
  plan_.legs.back().descent = fast > 0 ? 1 : 0;
  up_ = false;
  return true;
}

void Linker::add_run(Run run, std::size_t path) {
  if (!link(run.poses.front(), path)) {
    // The way back leads over the cut that was made, the one before is behind a link.
    if (!approach(run, path)) {
      ++plan_.counts.broken;
      left_.insert(left_.end(), run.points.begin(), run.points.end());
      return;
    }
    behind_.clear();
  } else if (!behind_.empty()) {
    const Leg& made = plan_.legs.back();
    behind_.insert(behind_.end(), made.poses.begin(), made.poses.end());
  }
  behind_.insert(behind_.end(), run.poses.begin(), run.poses.end());
  leg(LegKind::cut, std::move(run.poses), path, std::move(run.points));
}

bool Linker::better_backwards(const PathPlan& path) const {
  if (!path.closed || path.nodes.size() < 3) return false;
  for (std::size_t i = 1; i < path.nodes.size(); ++i)
    if (!path.nodes[i].cut) return false;
  Run forward;
  for (const Node& node : path.nodes) forward.poses.push_back(node.pose());
  Run backward = forward;
  std::reverse(backward.poses.begin(), backward.poses.end());
  const auto turn = [&](Run& run) {
    return place(run) ? std::abs(run.poses.front().theta - at_.theta)
                      : std::numeric_limits<double>::infinity();
  };
  return turn(backward) + kPi < turn(forward);
}

void Linker::add(PathPlan path, std::size_t number) {
  if (better_backwards(path)) {
    std::reverse(path.nodes.begin(), path.nodes.end());
    for (std::size_t i = 0; i < path.nodes.size(); ++i) path.nodes[i].cut = i > 0;
  }
  std::vector<Run> runs = runs_of(path, number);
  for (Run& run : runs) {
    if (place(run)) {
      add_run(std::move(run), number);
      continue;
    }
    for (Run& piece : cut_to_limits(run)) {
      if (!place(piece)) continue;
      add_run(std::move(piece), number);
    }
  }
}

void Linker::finish() {
  if (!plan_.legs.empty()) retract(plan_.legs.back().path);
  // A point where two runs meet may have been cut by the other one.
  std::vector<char> cut(plan_.points.size(), 0);
  for (const Leg& made : plan_.legs)
    for (const std::size_t p : made.points) cut[p] = 1;
  for (const std::size_t p : left_)
    if (!cut[p]) plan_.points[p].place.state = State::unreachable;
}

}  // namespace burin::rotary
