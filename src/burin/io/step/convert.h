// SPDX-License-Identifier: Apache-2.0
// Surfaces of OpenCASCADE <-> NurbsSurface. Inside of this folder only.
#pragma once

#include <Geom_BSplineSurface.hxx>
#include <Geom_Surface.hxx>
#include <gp_Trsf.hxx>
#include <string>

#include "burin/base/result.h"
#include "burin/geom/surface/nurbs.h"
#include "burin/io/step/exact.h"

namespace burin::io::step {

/// Without the wrappings that say nothing about the shape (trimming to a rectangle, offsets that have a
/// closed form).
Handle(Geom_Surface) plain_surface(const Handle(Geom_Surface) & surface);

/// "plane", "cylinder", "cone", "sphere", "torus", "revolution", "extrusion", "bezier", "bspline", "offset",
/// "other".
std::string kind_of(const Handle(Geom_Surface) & plain);

/// Where the surface is defined; infinite where it goes on for ever. `period` is 0 when it has none.
struct Extent {
  geom::Interval range;
  double period = 0;
};
Extent extent(const Handle(Geom_Surface) & plain, geom::Direction direction);

/// The part over `u` x `v` (inside of the extent, or anywhere up to one period long) as NURBS, with the maps
/// from the parameters of `plain`. `approximation_mm` is for offset surfaces, hyperbolas and the like.
Result<MappedSurface> to_nurbs(const Handle(Geom_Surface) & plain, geom::Interval u, geom::Interval v,
                               double approximation_mm);

/// Precondition: validate(surface) is fine.
Handle(Geom_BSplineSurface) to_occt(const geom::NurbsSurface& surface);

geom::NurbsSurface transformed(const geom::NurbsSurface& surface, const gp_Trsf& by);

/// Contains the surface: the net after knots have been inserted, which is close to the surface.
geom::Box3 close_bounds(const geom::NurbsSurface& surface);

/// Finite, no coordinate beyond kMaxCoordinate, weights above 0, degrees at most kMaxSurfaceDegree: what
/// damaged numbers in a file break. Empty when fine, else the reason.
std::string what_is_wrong(const geom::NurbsSurface& surface);
/// 10 km: farther out a double has no micrometres to spare, and files that say so are damaged.
inline constexpr double kMaxCoordinate = 1e7;

}  // namespace burin::io::step
