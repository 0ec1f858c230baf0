// SPDX-License-Identifier: Apache-2.0
#include "burin/view/outline_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace burin::view {
namespace {

constexpr double kArcStep = geom::kPi / 60;
/// Points between two control points of a spline.
constexpr double kOfSpan = 8;
constexpr double kMostOfCurve = 20'000;

double steps_of(double sweep) {
  return std::clamp(std::ceil(std::abs(sweep) / kArcStep), 1.0, kMostOfCurve);
}
double steps_of(const geom::Curve2& curve) {
  if (const auto* arc = std::get_if<geom::Arc2>(&curve)) return steps_of(arc->sweep);
  if (const auto* ellipse = std::get_if<geom::EllipseArc2>(&curve)) return steps_of(ellipse->sweep);
  if (const auto* spline = std::get_if<geom::Nurbs2>(&curve))
    return std::min(kOfSpan * static_cast<double>(spline->points.size()), kMostOfCurve);
  return 1;
}

SceneOutline outline_of(const io::Path& path, double share) {
  SceneOutline out;
  out.closed = path.closed;
  for (const geom::Curve2& curve : path.curves) {
    const double n = std::max(1.0, std::floor(share * steps_of(curve)));
    for (double k = out.points.empty() ? 0 : 1; k <= n; ++k)
      out.points.push_back(geom::at_z(geom::point_at(curve, k / n), 0));
  }
  return out;
}

}  // namespace

std::vector<SceneOutline> scene_outlines(const io::Drawing& drawing, std::size_t max_points) {
  double wanted = 1;
  for (const io::Entity& e : drawing.entities)
    for (const io::Path& path : e.paths)
      for (const geom::Curve2& curve : path.curves) wanted += steps_of(curve);
  const double share = std::min(1.0, static_cast<double>(max_points) / wanted);
  std::vector<SceneOutline> out;
  for (const io::Entity& e : drawing.entities) {
    for (const io::Path& path : e.paths) {
      if (path.curves.empty()) continue;
      out.push_back(outline_of(path, share));
      out.back().name = e.name();
    }
  }
  return out;
}

SceneOutline scene_outline(const std::vector<geom::Segment>& segments, bool closed) {
  SceneOutline out;
  out.closed = closed;
  for (const geom::Segment& s : segments) {
    const double n = s.is_line() ? 1 : steps_of(geom::sweep_of(s));
    for (double k = out.points.empty() ? 0 : 1; k <= n; ++k)
      out.points.push_back(geom::at_z(geom::point_on(s, k / n), 0));
  }
  return out;
}

}  // namespace burin::view
