// SPDX-License-Identifier: Apache-2.0
// The paper's initial solution, with what is known already about the contact point.
#pragma once

#include <optional>

#include "burin/plan/orient/relaxation.h"

namespace burin::orient {

struct Initial {
  bool found = false;
  bool at_corner = false;  ///< the corner of the largest radius itself
  Angles angles;
  Cause cause = Cause::none;  ///< what ends the allowed set there; not found: what was met most often
};
/// Places that stood in the way are added to `known`; what is known already changes the tests it takes, not
/// the result.
Initial initial_solution(const Setting& setting, const CcPoint& at, Relaxation& known, Scene::Memory& memory);
/// Of the curve's parameter, 0 to 1.
inline constexpr double kCurveTolerance = 2e-5;

/// What ends the allowed set at an optimum towards greater radii, as far as one pose beyond it says.
Cause cause_beyond(const Setting& setting, const CcPoint& at, const Angles& best, const Relaxation& known,
                   Scene::Memory& memory);

/// The first tilt from `from` on within the machine's travel at this yaw, above `to`: none.
double first_within(const Setting& setting, const CcPoint& at, double beta, double from, double to);

/// The curve of the paper's step 1: a quarter of an ellipse as a rational quadratic B-spline.
class StartCurve {
 public:
  StartCurve(const AngleRange& range, double end_yaw);
  Angles at(double s) const;

 private:
  Angles start_, corner_, end_;
};

}  // namespace burin::orient
