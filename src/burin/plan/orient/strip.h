// SPDX-License-Identifier: Apache-2.0
// The strip one pass leaves within the scallop: how far to either side of the contact point the tool's
// silhouette, seen along the feed, stays within `scallop_mm` of the surface. mm. docs/strip.md
#pragma once

#include "burin/plan/orient/cspace.h"

namespace burin::orient {

/// Distances along t, both >= 0: left towards +t, right towards -t.
struct Strip {
  double left = 0, right = 0;
  double width() const { return left + right; }
};
/// The silhouette of the flat end is the turned ellipse of Park & Lee, fig. 4, of the bull nose its offset by
/// the corner radius; the surface is the circle of curvature k_tt. Never wider than the silhouette.
Strip strip_at(const CcPoint& at, const Angles& angles, const model::Mill& mill, double scallop_mm);
/// Of a ball of the radius (symmetric); 0 where the ball does not fit (k_tt >= 1 / radius).
Strip ball_strip(const CcPoint& at, double ball_radius, double scallop_mm);

/// objective = "strip". What counts of a strip:
/// narrower: twice the narrower side, what the neighbours can count on whatever way single points lean;
/// whole: both sides together, which is right where all points lean the same way (yaws of one sign).
enum class StripCount { narrower, whole };

class StripGoal final : public Goal {
 public:
  StripGoal(const model::Mill& mill, double scallop_mm, StripCount count)
      : mill_(&mill), scallop_mm_(scallop_mm), count_(count) {}
  double value(const CcPoint& at, const Angles& angles) const override;

 private:
  const model::Mill* mill_;
  double scallop_mm_;
  StripCount count_;
};

}  // namespace burin::orient
