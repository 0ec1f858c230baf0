// SPDX-License-Identifier: Apache-2.0
// Arc splines: chains of line segments and circular arcs, the form in which outlines are offset, intersected,
// ordered and posted. mm.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::geom {

/// A line (radius 0) or a circular arc from a to b about `center`; radius > 0: counter-clockwise (left turn),
/// radius < 0: clockwise; |radius| in mm. The four are redundant on purpose (ends must meet exactly, centres
/// must not drift) and agree within kArcConsistency * (|radius| + 1). An arc sweeps more than 0 and less than
/// a full turn; a circle is two arcs. `source` says where it came from: an index the caller chose, carried
/// through offset and cleaning; kCornerSource on arcs that were added at convex corners.
struct Segment {
  Point2 a, b;
  Point2 center{};
  double radius = 0;
  std::uint32_t source = 0;

  bool is_line() const { return radius == 0; }
  bool operator==(const Segment&) const = default;
};

inline constexpr std::uint32_t kCornerSource = 0xffffffffu;
/// Relative disagreement allowed between ends, centre and radius of an arc (mm per mm of radius + 1).
inline constexpr double kArcConsistency = 1e-9;

Segment make_line(Point2 a, Point2 b, std::uint32_t source = 0);
/// Arc through a and b with the given centre; the radius is taken from `a`.
Segment make_arc(Point2 a, Point2 b, Point2 center, bool counter_clockwise, std::uint32_t source = 0);
/// DXF bulge: tan(sweep / 4), positive counter-clockwise; 0 gives a line.
Segment from_bulge(Point2 a, Point2 b, double bulge, std::uint32_t source = 0);
double bulge_of(const Segment& s);

/// Signed sweep angle in radians, (-2 pi, 2 pi); 0 for a line.
double sweep_of(const Segment& s);
double length_of(const Segment& s);
Box2 bounds_of(const Segment& s);
/// Unit tangents in the direction of travel.
Vec2 start_tangent(const Segment& s);
Vec2 end_tangent(const Segment& s);
/// Point at fraction f of the length.
Point2 point_on(const Segment& s, double f);
Segment reversed(const Segment& s);
/// Distance from p to the segment, and the nearest point.
struct Nearest {
  double distance = 0;
  Point2 point;
};
Nearest nearest_on(const Segment& s, Point2 p);
/// Whether the direction from the centre to p lies in the arc's sweep (ends included).
bool in_sweep(const Segment& s, Point2 p);

struct ArcSpline {
  std::vector<Segment> segments;  ///< each starts where the one before ends
  bool closed = false;            ///< the last ends where the first starts

  bool empty() const { return segments.empty(); }
};

/// Signed area (closed): positive when counter-clockwise. Exact up to rounding.
double signed_area(const ArcSpline& s);
double length_of(const ArcSpline& s);
Box2 bounds_of(const ArcSpline& s);
ArcSpline reversed(const ArcSpline& s);
/// Winding number of a closed spline about p (p not on it).
int winding_number(const ArcSpline& s, Point2 p);
double distance_to(const ArcSpline& s, Point2 p);
/// Breaks inside the spline (and at the seam when closed) where the direction turns by more than
/// `tangent_rad`.
int count_g1_breaks(const ArcSpline& s, double tangent_rad);

}  // namespace burin::geom
