// SPDX-License-Identifier: Apache-2.0
#include "burin/io/step/exact.h"

#include <algorithm>
#include <cmath>

namespace burin::io::step {

using geom::HPoint;
using geom::Interval;
using geom::NurbsCurve;
using geom::NurbsSurface;
using geom::Point3;
using geom::Vec3;

namespace {

/// Pieces of at most a quarter turn: the weights stay above 0.7 and the net close to the arc.
int pieces_of(Interval angles) {
  constexpr double kQuarter = 0.5 * geom::kPi;
  constexpr double kRounding = 1e-9;  // a quarter turn and rounding is one piece
  return std::clamp(static_cast<int>(std::ceil(angles.length() / kQuarter - kRounding)), 1, 9);
}

double piece_end(Interval range, int pieces, int i) {
  return i == pieces ? range.hi : range.lo + range.length() * i / pieces;
}

/// Knots of `pieces` quadratic arcs.
std::vector<double> arc_knots(Interval range, int pieces) {
  std::vector<double> knots{range.lo};
  for (int i = 0; i <= pieces; ++i) knots.insert(knots.end(), 2, piece_end(range, pieces, i));
  knots.push_back(range.hi);
  return knots;
}

/// The factors of the 2 * pieces + 1 control points of an arc of the unit circle.
struct ArcFactor {
  double c = 1, s = 0;  ///< of the two half axes
  double weight = 1;
};
std::vector<ArcFactor> arc_factors(Interval angles, int pieces) {
  std::vector<ArcFactor> factors;
  const double half = 0.5 * angles.length() / pieces;
  const double weight = std::cos(half);
  for (int i = 0; i <= pieces; ++i) {
    const double end = piece_end(angles, pieces, i);
    factors.push_back({std::cos(end), std::sin(end), 1});
    if (i == pieces) break;
    const double middle = 0.5 * (end + piece_end(angles, pieces, i + 1));
    factors.push_back({std::cos(middle) / weight, std::sin(middle) / weight, weight});
  }
  return factors;
}

}  // namespace

ParamMap ParamMap::arcs(Interval angles, int pieces) {
  ParamMap map;
  map.range_ = angles;
  map.pieces_ = pieces;
  return map;
}

double ParamMap::operator()(double t) const {
  if (pieces_ == 0) return t;
  const double piece = range_.length() / pieces_;
  const int i = std::clamp(static_cast<int>(std::floor((t - range_.lo) / piece)), 0, pieces_ - 1);
  const double lo = piece_end(range_, pieces_, i), hi = piece_end(range_, pieces_, i + 1);
  if (!(t > lo)) return lo;
  if (!(t < hi)) return hi;
  const double half = 0.5 * (hi - lo), middle = 0.5 * (lo + hi);
  const double s = std::tan(0.5 * (t - middle)) / std::tan(0.5 * half);
  return std::clamp(middle + half * s, lo, hi);
}

NurbsCurve line(Point3 origin, Vec3 direction, Interval t) {
  NurbsCurve curve;
  curve.degree = 1;
  curve.knots = {t.lo, t.lo, t.hi, t.hi};
  curve.points = {homogeneous(origin + t.lo * direction, 1), homogeneous(origin + t.hi * direction, 1)};
  return curve;
}

MappedCurve ellipse_arc(Point3 center, Vec3 x, Vec3 y, Interval angles) {
  const int pieces = pieces_of(angles);
  MappedCurve arc;
  arc.map = ParamMap::arcs(angles, pieces);
  arc.curve.degree = 2;
  arc.curve.knots = arc_knots(angles, pieces);
  for (const ArcFactor& f : arc_factors(angles, pieces)) {
    arc.curve.points.push_back(homogeneous(center + f.c * x + f.s * y, f.weight));
  }
  return arc;
}

NurbsSurface plane(Point3 origin, Vec3 x, Vec3 y, Interval u, Interval v) {
  NurbsSurface s;
  s.degree_u = s.degree_v = 1;
  s.count_u = s.count_v = 2;
  s.knots_u = {u.lo, u.lo, u.hi, u.hi};
  s.knots_v = {v.lo, v.lo, v.hi, v.hi};
  for (const double b : {v.lo, v.hi}) {
    for (const double a : {u.lo, u.hi}) s.points.push_back(homogeneous(origin + a * x + b * y, 1));
  }
  return s;
}

MappedSurface extrude(const MappedCurve& curve, Vec3 direction, Interval v) {
  MappedSurface mapped;
  mapped.u = curve.map;
  NurbsSurface& s = mapped.surface;
  s.degree_u = curve.curve.degree;
  s.degree_v = 1;
  s.count_u = static_cast<int>(curve.curve.points.size());
  s.count_v = 2;
  s.knots_u = curve.curve.knots;
  s.knots_v = {v.lo, v.lo, v.hi, v.hi};
  for (const double b : {v.lo, v.hi}) {
    for (const HPoint& p : curve.curve.points) {
      s.points.push_back(p + HPoint{p.w * b * direction.x, p.w * b * direction.y, p.w * b * direction.z, 0});
    }
  }
  return mapped;
}

MappedSurface revolve(const MappedCurve& meridian, Point3 origin, Vec3 axis, Interval angles,
                      double on_axis_mm) {
  const int pieces = pieces_of(angles);
  const std::vector<ArcFactor> factors = arc_factors(angles, pieces);
  MappedSurface mapped;
  mapped.u = ParamMap::arcs(angles, pieces);
  mapped.v = meridian.map;
  NurbsSurface& s = mapped.surface;
  s.degree_u = 2;
  s.degree_v = meridian.curve.degree;
  s.count_u = static_cast<int>(factors.size());
  s.count_v = static_cast<int>(meridian.curve.points.size());
  s.knots_u = arc_knots(angles, pieces);
  s.knots_v = meridian.curve.knots;
  for (const HPoint& h : meridian.curve.points) {
    const Point3 p = project(h);
    const Point3 foot = origin + dot(p - origin, axis) * axis;
    Vec3 x = p - foot;
    if (norm(x) <= on_axis_mm) x = {};
    const Vec3 y = cross(axis, x);
    for (const ArcFactor& f : factors) {
      s.points.push_back(homogeneous(foot + f.c * x + f.s * y, f.weight * h.w));
    }
  }
  return mapped;
}

}  // namespace burin::io::step
