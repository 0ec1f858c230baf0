// SPDX-License-Identifier: Apache-2.0
// Contours of the effective radius over tilt and yaw, from the closed form. mm, radians. Private to view.
#pragma once

#include <vector>

#include "burin/model/tool.h"
#include "burin/plan/orient/tool_angles.h"

namespace burin::view {

/// Round radii (1, 2, 5, then 1.5, 3, 7 times a power of ten) whose contours stand at least `gap` apart on a
/// picture of width x height, where they are widest apart. Falling.
std::vector<double> contour_levels(const orient::AngleRange& range, const model::Mill& mill, double width,
                                   double height, double gap);

/// The pieces of one contour inside the range, with growing yaw; their points lie on it to rounding, their
/// ends on the range's borders.
std::vector<std::vector<orient::Angles>> contour_of(double rho, const orient::AngleRange& range,
                                                    const model::Mill& mill);

}  // namespace burin::view
