// SPDX-License-Identifier: Apache-2.0
// Whether a motion of the tool (tip straight, axis along the great circle) keeps clear of the part and within
// the machine's travel, asked along the way in steps that follow from how far any point of the tool can move.
// Internal to plan/orient.
#pragma once

#include "burin/kinematics/feed_way.h"
#include "burin/plan/orient/limits.h"
#include "burin/plan/orient/scene.h"

namespace burin::orient {

class MotionCheck {
 public:
  /// Share of the tolerance that a motion between two allowed poses may gouge beyond it: both often touch the
  /// bound of what is allowed, and no straight way between them keeps it exactly.
  static constexpr double kSlackShare = 0.05;

  /// One for each scene that is asked: they know their blockers by different numbers.
  struct Memory {
    Scene::Memory exact, slack, air;
  };

  /// `air_mm`: how far off everything the tool can be expected to be on ways through the air (a larger step
  /// there); 0: no expectation. Keeps scene and limits.
  MotionCheck(const Scene& scene, const MachineLimits& limits, double air_mm);

  /// Cutting: free at every step but for the slack; between steps no point of the cutter is farther than a
  /// quarter of the tolerance from where it is at one of them, none of the holder than an eighth of the
  /// clearance.
  bool cut(const cl::Pose& from, const cl::Pose& to, Memory& memory) const;
  /// Through the air: the end too.
  bool air(const cl::Pose& from, const cl::Pose& to, Memory& memory) const;
  /// The scene and the machine allow it.
  bool at(const cl::Pose& pose, Memory& memory) const;

 private:
  /// How far along a way (share of it) the tool may go from a pose that is free.
  struct Steps {
    double fine = 1, coarse = 1;
  };
  Steps steps(const kinematics::FeedWay& way) const;

  const Scene* scene_;
  const MachineLimits* limits_;
  Scene slack_;               ///< the body less the slack
  std::optional<Scene> air_;  ///< the body grown by air_mm
  double air_mm_ = 0;
  double cutter_lever_ = 0, lever_ = 0;  ///< farthest point of the cutter, of all, from the tip
  double cutter_mm_ = 0, holder_mm_ = 0;
  bool has_holder_ = false;
};

}  // namespace burin::orient
