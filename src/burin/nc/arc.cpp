// SPDX-License-Identifier: Apache-2.0
#include "burin/nc/arc.h"

#include <cmath>

#include "burin/base/text.h"
#include "burin/geom/point_tools.h"

namespace burin::nc {
namespace {

using geom::Point2;
using geom::Vec2;

Error syntax(std::string message) {
  return {ErrorCode::syntax, std::move(message), {}};
}
Error geometry(std::string message) {
  return {ErrorCode::geometry, std::move(message), {}};
}

constexpr std::array<const char*, 3> kPlaneName = {"G17", "G18", "G19"};
constexpr std::array<char, 3> kOffset = {'I', 'J', 'K'};

/// The two axes of a plane in their right-handed order, and the one normal to it: 0 X, 1 Y, 2 Z.
struct PlaneAxes {
  std::size_t first, second, third;
};
PlaneAxes axes_of(Plane plane) {
  if (plane == Plane::zx) return {2, 0, 1};
  if (plane == Plane::yz) return {1, 2, 0};
  return {0, 1, 2};
}

Result<Point2> center_from_offsets(const ArcWords& w, PlaneAxes axes, Point2 start) {
  const auto first = w.center[axes.first];
  const auto second = w.center[axes.second];
  if (w.center[axes.third])
    return syntax(std::string("a ") + kOffset[axes.third] + " word with an arc in " +
                  kPlaneName[static_cast<std::size_t>(w.plane)] + " (" + kOffset[axes.first] + " and " +
                  kOffset[axes.second] + ", or another plane)");
  if (!w.center_absolute) return start + Vec2{first.value_or(0), second.value_or(0)};
  if (!first || !second) return syntax("an absolute arc centre (G90.1) with one word missing (both)");
  return Point2{*first, *second};
}

Result<Point2> center_from_radius(const ArcWords& w, Point2 start, Point2 end) {
  const Vec2 chord = end - start;
  const double length = norm(chord), radius = *w.radius;
  if (length <= cl::kSamePoint_mm)
    return geometry("an arc with R that ends where it starts (I and J for a full circle)");
  const double half = length / 2;
  if (std::abs(radius) < half - w.radius_tolerance_mm || radius == 0)
    return geometry("R of " + format_fixed(std::abs(radius), 6) + " mm does not reach over a chord of " +
                    format_fixed(length, 6) + " mm (at least half of it)");
  const double height = std::sqrt(std::max(0.0, (std::abs(radius) - half) * (std::abs(radius) + half)));
  // Counter-clockwise and less than half a turn has the centre on the left of the chord.
  const bool on_left = w.clockwise == (radius < 0);
  const Vec2 aside = left(chord / length) * (on_left ? height : -height);
  return lerp(start, end, 0.5) + aside;
}

}  // namespace

Result<cl::Arc> make_arc(const ArcWords& w) {
  const PlaneAxes axes = axes_of(w.plane);
  const Point2 start{component(w.start, axes.first), component(w.start, axes.second)};
  Point2 end{component(w.end, axes.first), component(w.end, axes.second)};
  const bool offsets = w.center[0] || w.center[1] || w.center[2];
  if (offsets && w.radius) return syntax("an arc with R and I, J or K (one of them)");
  if (!offsets && !w.radius) return syntax("an arc without a centre (I, J, K or R)");
  const auto center = offsets ? center_from_offsets(w, axes, start) : center_from_radius(w, start, end);
  if (!center) return center.error();
  const double r_start = distance(*center, start), r_end = distance(*center, end);
  if (!std::isfinite(r_start) || !std::isfinite(r_end))
    return geometry("an arc beyond all bounds (finite numbers)");
  if (r_start <= cl::kSamePoint_mm || r_end <= cl::kSamePoint_mm)
    return geometry("an arc of radius 0 (a centre away from its ends)");
  if (std::abs(r_start - r_end) > w.radius_tolerance_mm)
    return geometry("the arc starts at a radius of " + format_fixed(r_start, 6) + " mm and ends at " +
                    format_fixed(r_end, 6) + " mm (a difference of at most " +
                    format_shortest(w.radius_tolerance_mm) + " mm)");
  cl::Arc arc;
  arc.center = w.start;
  set_component(arc.center, axes.first, center->x);
  set_component(arc.center, axes.second, center->y);
  const double up = w.clockwise ? -1 : 1;
  arc.normal = axes.third == 0   ? geom::Vec3{up, 0, 0}
               : axes.third == 1 ? geom::Vec3{0, up, 0}
                                 : geom::Vec3{0, 0, up};
  arc.radius = (r_start + r_end) / 2;
  arc.to.tip = w.end;
  // Decimals that went through inches or increments meet within rounding: the same point, a full turn.
  if (distance(start, end) <= cl::kSamePoint_mm) {
    set_component(arc.to.tip, axes.first, start.x);
    set_component(arc.to.tip, axes.second, start.y);
  }
  return arc;
}

}  // namespace burin::nc
