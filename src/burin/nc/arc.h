// SPDX-License-Identifier: Apache-2.0
// Arcs of a part program: G17/G18/G19, I J K from the start or absolute, or R, to a centre and a normal.
#pragma once

#include <optional>

#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/nc/program.h"

namespace burin::nc {

struct ArcWords {
  geom::Point3 start, end;  ///< mm
  Plane plane = Plane::xy;
  bool clockwise = false;
  std::array<std::optional<double>, 3> center;  ///< I J K, mm
  bool center_absolute = false;
  std::optional<double> radius;  ///< R, mm
  double radius_tolerance_mm = 0;
};
/// The error (syntax, geometry) has no place yet.
Result<cl::Arc> make_arc(const ArcWords& words);

}  // namespace burin::nc
