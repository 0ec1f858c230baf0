// SPDX-License-Identifier: Apache-2.0
// One entity of a DXF -> plane curves. Nothing is tessellated.
#pragma once

#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/geom/vec.h"
#include "burin/io/drawing/drawing.h"
#include "burin/io/dxf/map3.h"
#include "burin/io/dxf/model.h"

namespace burin::io::dxf {

/// What came to light while an entity was converted.
struct Finding {
  Severity severity = Severity::info;
  std::string code;
  std::string message;
};

struct Converted {
  std::vector<Path> paths;  // empty: nothing to cut, `findings` says why
  std::vector<Finding> findings;
  geom::Point3 at;  // a point of the entity, mapped: the place of the findings
  double z_lowest = 0, z_highest = 0;
};

/// `map` leads from the coordinates that hold the entity (model or block) to the drawing, mm. An INSERT or an
/// item without shape gives nothing.
Converted convert(const Item& item, const Map3& map);

/// A spline as the file gives it -> NURBS in the XY plane of its own coordinates; repairs are added to
/// `findings`. Errors (geometry): knots, weights, degree or fit points that make no curve.
Result<geom::Nurbs2> spline_curve(const SplineShape& spline, std::vector<Finding>& findings);

/// An inner knot that stands degree + 1 times or more breaks a spline (chains of Bezier pieces are written
/// so): its pieces, in order. Precondition: valid.
std::vector<geom::Nurbs2> split_at_breaks(const geom::Nurbs2& spline);

}  // namespace burin::io::dxf
