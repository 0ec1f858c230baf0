// SPDX-License-Identifier: Apache-2.0
// The map of one contact point's C-space as a picture (Park & Lee, figures 3 and 6). mm, radians.
#pragma once

#include <string>
#include <vector>

#include "burin/model/tool.h"
#include "burin/plan/orient/cspace.h"

namespace burin::view {

struct CSpacePicture {
  std::string title;
  const orient::CSpaceMap* map = nullptr;
  const model::Mill* mill = nullptr;
  /// Marked places: initial and optimal angles.
  struct Mark {
    std::string name;
    orient::Angles angles;
  };
  std::vector<Mark> marks;
};
/// Tilt to the right, yaw upwards; cells by cause, exact contours of the effective radius over them with
/// their values, axes in degrees, legend. PNG, at least 900 x 700.
std::string cspace_png(const CSpacePicture& picture);
std::string cspace_svg(const CSpacePicture& picture);

}  // namespace burin::view
