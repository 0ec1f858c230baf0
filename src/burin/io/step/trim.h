// SPDX-License-Identifier: Apache-2.0
// The boundary of a face in the parameters of its surface. Inside of this folder only.
#pragma once

#include <Geom2d_Curve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TopoDS_Face.hxx>
#include <vector>

#include "burin/base/result.h"
#include "burin/io/step/convert.h"
#include "burin/io/step/read_step.h"

namespace burin::io::step {

/// A piece of boundary in the parameters of the CAD surface, in the sense of the loop.
struct BoundaryEdge {
  Handle(Geom2d_Curve) curve;
  double from = 0, to = 0;  ///< to < from: against the curve
  geom::Vec2 shift;         ///< by whole periods, so that the pieces meet
  geom::Point2 at(double t) const;
};
using BoundaryLoop = std::vector<BoundaryEdge>;

/// The wires of the face with its material on the left of each (seen against Su x Sv). Empty when the face
/// has none (a whole sphere).
Result<std::vector<BoundaryLoop>> boundary(const TopoDS_Face& face, const Extent& u, const Extent& v);

/// Of all loops; the extrema of curves to second order between samples.
geom::Box2 bounds(const std::vector<BoundaryLoop>& loops);

/// The loops as polygons in the parameters of `surface`, within `tolerance_mm`, inside of its domain; outer
/// ones counter-clockwise and first, holes clockwise.
std::vector<TrimLoop> polygons(const std::vector<BoundaryLoop>& loops, const ParamMap& u, const ParamMap& v,
                               const Handle(Geom_BSplineSurface) & surface, double tolerance_mm);

/// Whether the one loop runs along the four sides of the surface, nowhere farther than `tolerance_mm` off.
bool is_natural(const std::vector<TrimLoop>& loops, const Handle(Geom_BSplineSurface) & surface,
                double tolerance_mm);

}  // namespace burin::io::step
