// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/motion_check.h"

#include <algorithm>
#include <cmath>

namespace burin::orient {
namespace {

using kinematics::FeedWay;

// A tolerance or clearance below this is not asked for in steps as small: below what machines resolve, mm.
constexpr double kLeastStep_mm = 1e-3;

// From one place that is asked to the next no point of the cutter goes farther than this share of the
// tolerance: what lies between is within half of it of one that is free.
constexpr double kStepShare = 0.5;

/// Smaller by `by`: what comes nearer to the result comes nearer than `by` to the outside of the piece.
std::vector<BodyPiece> shrunk(const std::vector<BodyPiece>& body, double by) {
  std::vector<BodyPiece> result;
  for (BodyPiece piece : body) {
    const double off_grow = std::min(piece.grow, by), rest = by - off_grow;
    piece.grow -= off_grow;
    piece.radius -= rest;
    piece.from += rest;
    // The bottom of a bull nose is a disc without height, grown.
    const bool solid = piece.from < piece.to || (piece.from == piece.to && piece.grow > 0);
    if (piece.radius > 0 && solid) result.push_back(piece);
  }
  return result;
}

std::vector<BodyPiece> grown(std::vector<BodyPiece> body, double by) {
  for (BodyPiece& piece : body) piece.grow += by;
  return body;
}

/// What the cutter may gouge: how much the body is less than the mill.
double tolerance_of(const Scene& scene) {
  const model::Mill& mill = scene.mill();
  for (const BodyPiece& piece : scene.body())
    if (piece.cause == Cause::gouge) return std::max(0.0, mill.radius - piece.radius - piece.grow);
  return mill.radius;
}

double lever_of(const BodyPiece& piece) {
  return std::hypot(piece.radius, std::max(std::abs(piece.from), std::abs(piece.to))) + piece.grow;
}

}  // namespace

MotionCheck::MotionCheck(const Scene& scene, const MachineLimits& limits, double air_mm)
    : scene_(&scene),
      limits_(&limits),
      slack_(scene, shrunk(scene.body(), kSlackShare * tolerance_of(scene))),
      air_mm_(air_mm) {
  if (air_mm > 0) air_.emplace(scene, grown(scene.body(), air_mm));
  double clearance = std::numeric_limits<double>::infinity();
  for (const BodyPiece& piece : scene.body()) {
    lever_ = std::max(lever_, lever_of(piece));
    if (piece.cause == Cause::gouge) {
      cutter_lever_ = std::max(cutter_lever_, lever_of(piece));
    } else {
      has_holder_ = true;
      clearance = std::min(clearance, piece.grow);
    }
  }
  cutter_mm_ = std::max(tolerance_of(scene), kLeastStep_mm);
  holder_mm_ = std::max(0.5 * clearance, kLeastStep_mm);
}

MotionCheck::Steps MotionCheck::steps(const FeedWay& way) const {
  const double cutter = way.length() + cutter_lever_ * way.turn();
  const double all = way.length() + lever_ * way.turn();
  Steps steps;
  if (cutter > 0) steps.fine = kStepShare * cutter_mm_ / cutter;
  if (has_holder_ && all > 0) steps.fine = std::min(steps.fine, kStepShare * holder_mm_ / all);
  if (all > 0) steps.coarse = air_mm_ / all;
  return steps;
}

bool MotionCheck::cut(const cl::Pose& from, const cl::Pose& to, Memory& memory) const {
  const FeedWay way(from, to);
  const double count = std::ceil(1 / steps(way).fine);
  for (double i = 1; i < count; ++i) {
    const cl::Pose pose = way.at(i / count);
    if (slack_.blocker(pose, memory.slack) || !limits_->within(pose)) return false;
  }
  return true;
}

bool MotionCheck::air(const cl::Pose& from, const cl::Pose& to, Memory& memory) const {
  const FeedWay way(from, to);
  const Steps step = steps(way);
  // Where the grown body is not free, it is tried again after the tool has gone a part of what it grew by.
  constexpr double kAgain = 0.25;
  double again = 0;
  for (double t = 0;;) {
    const cl::Pose pose = way.at(std::min(t, 1.0));
    if (!limits_->within(pose)) return false;
    if (air_ && t >= again) {
      if (!air_->blocker(pose, memory.air)) {
        if (t >= 1) return true;
        t = std::min(1.0, t + step.coarse);
        continue;
      }
      again = t + kAgain * step.coarse;
    }
    if (slack_.blocker(pose, memory.slack)) return false;
    if (t >= 1) return true;
    t = std::min(1.0, t + step.fine);
  }
}

bool MotionCheck::at(const cl::Pose& pose, Memory& memory) const {
  return limits_->within(pose) && !scene_->blocker(pose, memory.exact);
}

}  // namespace burin::orient
