// SPDX-License-Identifier: Apache-2.0
// The motion a cl::Feed asks for: tip straight, axis evenly along the great circle.
#pragma once

#include "burin/cl/program.h"

namespace burin::kinematics {

class FeedWay {
 public:
  /// Opposite axes: along any great circle.
  FeedWay(const cl::Pose& from, const cl::Pose& to);
  /// t in [0, 1].
  cl::Pose at(double t) const;
  /// v turned as the axis is at t.
  geom::Vec3 carried(const geom::Vec3& v, double t) const;
  double length() const { return geom::distance(from_.tip, to_.tip); }  ///< of the tip's way
  double turn() const { return turn_; }                                 ///< of the axis, radians

 private:
  cl::Pose from_, to_;
  geom::Vec3 about_{0, 0, 1};
  double turn_ = 0;
};

}  // namespace burin::kinematics
