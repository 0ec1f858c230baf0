// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/air_ways.h"

#include <algorithm>
#include <cmath>

namespace burin::orient {
namespace {

using geom::Vec3;

// The tool turns over the part in straight moves of the tip of at most this: half of it squared is what they
// cut off the round way.
constexpr double kTurnStep = 3 * geom::kPi / 180;
constexpr double kRounding = 1.002;

}  // namespace

AirWays::AirWays(const geom::Box3& part, const MotionCheck& check, double safety_mm)
    : middle_(lerp(part.lo, part.hi, 0.5)),
      half_(0.5 * (part.hi - part.lo)),
      check_(&check),
      safety_mm_(safety_mm) {}

/// Of the tip above the middle, along the axis: nothing of the part reaches so far.
double AirWays::height(const Vec3& axis) const {
  const double support = std::abs(axis.x) * half_.x + std::abs(axis.y) * half_.y + std::abs(axis.z) * half_.z;
  return kRounding * support + safety_mm_;
}

cl::Pose AirWays::raised(const cl::Pose& pose) const {
  const double by = height(pose.axis) - dot(pose.tip - middle_, pose.axis);
  return {by > 0 ? pose.tip + by * pose.axis : pose.tip, pose.axis};
}

bool AirWays::clear(const cl::Pose& from, const Way& way) const {
  MotionCheck::Memory memory;
  cl::Pose at = from;
  for (const cl::Pose& to : way) {
    if (!check_->air(at, to, memory)) return false;
    at = to;
  }
  return true;
}

std::optional<Way> AirWays::out(const RunPoint& from) const {
  if (Way way{raised(from.pose)}; clear(from.pose, way)) return way;
  // First off the surface, then along the axis: a tool that leans under something above it.
  for (const double share : {0.25, 1.0, 4.0}) {
    const cl::Pose off{from.pose.tip + (share * safety_mm_) * from.normal, from.pose.axis};
    if (Way way{off, raised(off)}; clear(from.pose, way)) return way;
  }
  return std::nullopt;
}

/// Rigidly about the part's middle until the tool points along `axis`, as high as each direction asks.
std::optional<Way> AirWays::turn(const cl::Pose& from, const Vec3& axis) const {
  const kinematics::FeedWay way(from, {from.tip, axis});
  const Vec3 arm = from.tip - middle_;
  const Vec3 aside = arm - dot(arm, from.axis) * from.axis;
  const int steps = static_cast<int>(std::ceil(way.turn() / kTurnStep));
  Way poses;
  for (int k = 1; k <= steps; ++k) {
    const double t = static_cast<double>(k) / steps;
    const cl::Pose at = way.at(t);
    poses.push_back({middle_ + height(at.axis) * at.axis + way.carried(aside, t), at.axis});
  }
  if (!clear(from, poses)) return std::nullopt;
  return poses;
}

std::optional<Way> AirWays::over(const cl::Pose& from, const cl::Pose& to) const {
  const auto then_across = [&](std::optional<Way> way) -> std::optional<Way> {
    if (!way) return std::nullopt;
    const cl::Pose at = way->empty() ? from : way->back();
    // Down or up to the plane of the end first, then across in it: both keep beyond it.
    way->push_back({at.tip + std::max(0.0, dot(to.tip - at.tip, to.axis)) * to.axis, to.axis});
    way->push_back(to);
    if (!clear(at, {way->end() - 2, way->end()})) return std::nullopt;
    return way;
  };
  if (auto way = then_across(turn(from, to.axis))) return way;
  // By way of the upright tool, where the machine does not follow the direct turn.
  auto up = turn(from, {0, 0, 1});
  if (!up || up->empty()) return std::nullopt;
  auto down = turn(up->back(), to.axis);
  if (!down) return std::nullopt;
  up->insert(up->end(), down->begin(), down->end());
  return then_across(std::move(up));
}

std::optional<Way> AirWays::across(const RunPoint& from, const RunPoint& to) const {
  // A turn beyond this sweeps the holder through too much to hope that it is clear.
  constexpr double kMostTurn = 60 * geom::kPi / 180;
  const kinematics::FeedWay way(from.pose, to.pose);
  if (way.turn() > kMostTurn) return std::nullopt;
  const double around =
      geom::distance(from.pose.tip, raised(from.pose).tip) + geom::distance(to.pose.tip, raised(to.pose).tip);
  for (const double share : {0.25, 1.0, 4.0}) {
    const double by = share * safety_mm_;
    if (2 * by >= around) break;
    const Way near{{from.pose.tip + by * from.pose.axis, from.pose.axis},
                   {to.pose.tip + by * to.pose.axis, to.pose.axis},
                   to.pose};
    if (clear(from.pose, near)) return near;
  }
  return std::nullopt;
}

}  // namespace burin::orient
