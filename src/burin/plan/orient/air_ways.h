// SPDX-License-Identifier: Apache-2.0
// Ways through the air between runs: out along the tool axis, over the part, in along the next axis; each leg
// is asked of the scene. Internal to plan/orient.
#pragma once

#include <optional>
#include <vector>

#include "burin/plan/orient/cutting_runs.h"

namespace burin::orient {

/// Poses after the start; the tool goes straight from one to the next.
using Way = std::vector<cl::Pose>;

class AirWays {
 public:
  AirWays(const geom::Box3& part, const MotionCheck& check, double safety_mm);

  /// From a contact to where the whole tool stands beyond the plane across its axis that keeps safety_mm from
  /// the part. Nothing when no way that was tried is clear. Reversed it is the way in.
  std::optional<Way> out(const RunPoint& from) const;
  /// Between two poses that out() ended in: the tool turns about the part's middle and stays beyond those
  /// planes; then goes across with its axis at rest.
  std::optional<Way> over(const cl::Pose& from, const cl::Pose& to) const;
  /// From contact to contact near the part, a little way up; nothing when that is not clear or not worth it.
  std::optional<Way> across(const RunPoint& from, const RunPoint& to) const;

 private:
  double height(const geom::Vec3& axis) const;
  cl::Pose raised(const cl::Pose& pose) const;
  std::optional<Way> turn(const cl::Pose& from, const geom::Vec3& axis) const;
  bool clear(const cl::Pose& from, const Way& way) const;

  geom::Point3 middle_;
  geom::Vec3 half_;
  const MotionCheck* check_;
  double safety_mm_;
};

}  // namespace burin::orient
