// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/placing.h"

#include <cmath>

namespace burin::io::svg {

using geom::Curve2;

namespace {

/// Up to here doubles resolve 1e-7 mm, the distance at which points count as the same.
constexpr double kMaxCoordinateMm = 1e9;
/// An ellipse that differs from a circle by less is one: files give matrices with six to eight digits, and
/// points this close are the same (Tolerance::point_mm).
constexpr double kRoundnessMm = 1e-7;

/// Conjugate half-diameters of a circle are perpendicular and equal; the deviation is at most the sum of both
/// errors.
Curve2 round_if_round(Curve2 curve) {
  const auto* ellipse = std::get_if<geom::EllipseArc2>(&curve);
  if (ellipse == nullptr) return curve;
  const double a = norm(ellipse->major), b = norm(ellipse->minor);
  const double radius = (a + b) / 2;
  if (!(radius > 0)) return curve;
  const double skew = std::abs(dot(ellipse->major, ellipse->minor)) / radius;
  if (!(std::abs(a - b) + skew <= kRoundnessMm)) return curve;
  const double angle = std::atan2(ellipse->major.y, ellipse->major.x);
  const double sense = cross(ellipse->major, ellipse->minor) < 0 ? -1 : 1;
  return geom::Arc2{ellipse->center, radius, angle + sense * ellipse->start, sense * ellipse->sweep};
}

bool collapsed(const Curve2& curve) {
  if (const auto* line = std::get_if<geom::Line2>(&curve)) return line->a == line->b;
  if (const auto* nurbs = std::get_if<geom::Nurbs2>(&curve)) {
    for (const geom::Point2& p : nurbs->points) {
      if (!(p == nurbs->points.front())) return false;
    }
    return true;
  }
  const geom::Box2 box = geom::bounds(curve);
  return box.lo == box.hi;
}

Result<void> check(const Curve2& curve) {
  const geom::Box2 box = geom::bounds(curve);
  const bool inside = box.lo.x >= -kMaxCoordinateMm && box.lo.y >= -kMaxCoordinateMm &&
                      box.hi.x <= kMaxCoordinateMm && box.hi.y <= kMaxCoordinateMm;
  if (!inside)
    return Error{ErrorCode::range, "coordinates beyond 1e9 mm (smaller drawings are accepted)", {}};
  return geom::validate(curve);
}

}  // namespace

Result<Placed> place_outline(const geom::Affine2& map, std::vector<Path> paths) {
  Placed placed;
  for (Path& path : paths) {
    std::vector<Curve2> curves;
    curves.reserve(path.curves.size());
    for (const Curve2& original : path.curves) {
      Curve2 curve = round_if_round(geom::transformed(map, original));
      if (collapsed(curve)) continue;
      if (auto fine = check(curve); !fine) return fine.error();
      curves.push_back(std::move(curve));
    }
    if (curves.empty()) {
      placed.dropped = true;
      continue;
    }
    placed.curve_count += curves.size();
    placed.paths.push_back({std::move(curves), path.closed});
  }
  return placed;
}

}  // namespace burin::io::svg
