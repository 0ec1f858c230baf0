// SPDX-License-Identifier: Apache-2.0
// Lines, ellipse arcs, extrusions and revolutions as NURBS, exactly (The NURBS Book, 7.3, 8.3, 8.5), and the
// map from the parameter that CAD gives them (an angle) to the parameter of the NURBS form. Without
// OpenCASCADE. mm, radians.
#pragma once

#include "burin/geom/surface/nurbs.h"

namespace burin::io::step {

/// Parameter of a CAD curve -> parameter of its NURBS form over the same range. Knots and ends map to
/// themselves; the identity unless the curve is an arc.
class ParamMap {
 public:
  ParamMap() = default;
  /// `pieces` equal rational quadratic arcs over the angles [lo, hi]. Within a piece of half angle a around
  /// the angle m the point at the parameter s in [-1, 1] stands at the angle m + 2 atan(s tan(a / 2)).
  static ParamMap arcs(geom::Interval angles, int pieces);
  double operator()(double t) const;

 private:
  geom::Interval range_;
  int pieces_ = 0;  ///< 0: identity
};

struct MappedCurve {
  geom::NurbsCurve curve;
  ParamMap map;
};
struct MappedSurface {
  geom::NurbsSurface surface;
  ParamMap u, v;
};

/// origin + t * direction.
geom::NurbsCurve line(geom::Point3 origin, geom::Vec3 direction, geom::Interval t);
/// center + cos t * x + sin t * y; x and y are half axes. At most two turns.
MappedCurve ellipse_arc(geom::Point3 center, geom::Vec3 x, geom::Vec3 y, geom::Interval angles);
/// S(u, v) = origin + u * x + v * y.
geom::NurbsSurface plane(geom::Point3 origin, geom::Vec3 x, geom::Vec3 y, geom::Interval u, geom::Interval v);
/// S(u, v) = curve(u) + v * direction.
MappedSurface extrude(const MappedCurve& curve, geom::Vec3 direction, geom::Interval v);
/// S(u, v) = meridian(v) turned by u around the axis through `origin` along the unit vector `axis`. Points of
/// the meridian within `on_axis_mm` of the axis are put on it, so that a pole is one point.
/// At most two turns.
MappedSurface revolve(const MappedCurve& meridian, geom::Point3 origin, geom::Vec3 axis,
                      geom::Interval angles, double on_axis_mm);

}  // namespace burin::io::step
