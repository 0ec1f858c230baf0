// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>

#include "burin/plan/rotary/rotary.h"

namespace burin::rotary {
namespace {

cl::Pose cl_pose(const AxisPose& pose, double radius) {
  return {tip_of(pose, radius), {0, std::sin(pose.theta), std::cos(pose.theta)}};
}

/// Straight up and down in the air goes as fast as the machine can; what stands on the part goes at the feed.
bool fast(const Leg& leg, std::size_t i) {
  switch (leg.kind) {
    case LegKind::rapid:
      return true;
    case LegKind::retract:
      return i + 1 == leg.poses.size();
    case LegKind::approach:
      return leg.descent > 0 && i <= leg.descent;
    case LegKind::cut:
    case LegKind::link:
      break;
  }
  return false;
}

}  // namespace

cl::Program to_cl(const RotaryPlan& plan, const model::BallTool& tool, const RotaryOptions& options,
                  const std::string& name) {
  cl::Program program;
  program.name = name;
  program.add(cl::FeedRate{options.feed_mm_min});
  bool first = true;
  for (const Leg& leg : plan.legs) {
    for (std::size_t i = 0; i < leg.poses.size(); ++i) {
      // A leg starts where the one before ended.
      if (i == 0 && !first) continue;
      const cl::Pose to = cl_pose(leg.poses[i], tool.radius);
      const auto source = leg.kind == LegKind::cut && i < leg.points.size()
                              ? static_cast<std::uint32_t>(leg.points[i])
                              : cl::Program::kNoSource;
      if (first || fast(leg, i))
        program.add(cl::Rapid{to}, source);
      else
        program.add(cl::Feed{to}, source);
      first = false;
    }
  }
  return program;
}

}  // namespace burin::rotary
