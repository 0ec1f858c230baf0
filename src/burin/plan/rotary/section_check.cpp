// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/section_check.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "burin/base/text.h"
#include "burin/geom/box_tree.h"
#include "burin/geom/curve/intersect.h"

namespace burin::rotary::detail {
namespace {

using geom::ArcSpline;
using geom::Box2;
using geom::Point2;
using geom::Segment;

/// Ends that should meet may differ by this (per mm of size): well above rounding, well below drawing units.
constexpr double kMeetRelative = 1e-7;

std::string text(Point2 p) {
  return "y " + format_fixed(p.x, 4) + ", z " + format_fixed(p.y, 4);
}

Error geometry(std::string message) {
  return {ErrorCode::geometry, std::move(message), {}};
}

bool finite(const Segment& s) {
  for (const double v : {s.a.x, s.a.y, s.b.x, s.b.y, s.center.x, s.center.y, s.radius}) {
    if (!std::isfinite(v)) return false;
  }
  return true;
}

std::optional<Error> check_chain(const ArcSpline& s, double meet) {
  const std::size_t n = s.segments.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 end = s.segments[i].b, next = s.segments[(i + 1) % n].a;
    const double gap = distance(end, next);
    if (gap <= meet && (s.closed || i + 1 < n)) continue;
    if (gap <= meet) continue;  // closed in fact, whatever the flag says
    return geometry("the section is open: " + format_fixed(gap, 4) + " mm are missing after " + text(end) +
                    " (a part needs one closed curve around the axis)");
  }
  return std::nullopt;
}

/// Where s and t meet besides at the ends that they share as neighbours.
std::optional<Point2> meeting(const Segment& s, const Segment& t, bool t_follows, bool s_follows,
                              double tolerance, double near_joint) {
  const auto at_joint = [&](Point2 p) {
    return (t_follows && distance(p, s.b) <= near_joint) || (s_follows && distance(p, t.b) <= near_joint);
  };
  const geom::Intersection meet = intersect(s, t, tolerance);
  if (const auto* points = std::get_if<geom::PointIntersections>(&meet)) {
    for (int k = 0; k < points->count; ++k) {
      if (!at_joint(points->point[std::size_t(k)])) return points->point[std::size_t(k)];
    }
  } else if (const auto* shared = std::get_if<geom::Overlap>(&meet)) {
    if (!at_joint(shared->a) || !at_joint(shared->b)) return at_joint(shared->a) ? shared->b : shared->a;
  }
  return std::nullopt;
}

std::optional<Error> check_crossing(const ArcSpline& s, double size) {
  const double tolerance = 1e-9 * size;
  // Two arcs that leave their joint along each other stay within the tolerance for about sqrt(tolerance r).
  const double near_joint = 4 * std::sqrt(tolerance * size);
  const std::size_t n = s.segments.size();
  std::vector<Box2> boxes;
  boxes.reserve(n);
  for (const Segment& seg : s.segments) boxes.push_back(bounds_of(seg).grown(tolerance));
  const geom::BoxTree2 tree(boxes);
  for (std::size_t i = 0; i < n; ++i) {
    std::optional<Point2> found;
    tree.query(boxes[i], [&](std::uint32_t j) {
      if (j <= i) return true;
      found = meeting(s.segments[i], s.segments[j], j == i + 1, i == (j + 1) % n, tolerance, near_joint);
      return !found;
    });
    if (found) {
      return geometry("the section crosses or touches itself at " + text(*found) +
                      " (one simple closed curve is needed)");
    }
  }
  return std::nullopt;
}

}  // namespace

Result<ArcSpline> checked_section(const ArcSpline& section, double margin_mm) {
  ArcSpline s;
  s.closed = true;
  for (const Segment& seg : section.segments) {
    if (!finite(seg)) return geometry("the section has coordinates that are not numbers");
    if (seg.a == seg.b && seg.is_line()) continue;
    s.segments.push_back(seg);
  }
  if (s.segments.empty())
    return geometry("the section is empty (a part needs one closed curve around the axis)");
  const Box2 box = bounds_of(s);
  const double size = std::max(box.width(), box.height());
  s.closed = section.closed;
  if (auto error = check_chain(s, kMeetRelative * (1 + size))) return *error;
  s.closed = true;
  const double area = std::abs(signed_area(s));
  if (!(std::min(box.width(), box.height()) > 4 * margin_mm) || !(area > margin_mm * size)) {
    return geometry("the section is too small: " + format_fixed(box.width(), 4) + " x " +
                    format_fixed(box.height(), 4) + " mm (it must be much larger than the deflection of " +
                    format_shortest(margin_mm) + " mm)");
  }
  // Small gaps are closed exactly, so that the mesh is.
  for (std::size_t i = 0; i < s.segments.size(); ++i) {
    s.segments[i].b = s.segments[(i + 1) % s.segments.size()].a;
  }
  if (auto error = check_crossing(s, size)) return *error;
  if (signed_area(s) < 0) s = reversed(s);
  const double distance = distance_to(s, {0, 0});
  if (winding_number(s, {0, 0}) != 1 || !(distance > margin_mm)) {
    return geometry("the axis (y 0, z 0) is not inside of the section, which spans y " +
                    format_fixed(box.lo.x, 3) + " to " + format_fixed(box.hi.x, 3) + ", z " +
                    format_fixed(box.lo.y, 3) + " to " + format_fixed(box.hi.y, 3) +
                    " (draw it around the origin)");
  }
  return s;
}

}  // namespace burin::rotary::detail
