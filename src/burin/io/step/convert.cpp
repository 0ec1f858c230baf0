// SPDX-License-Identifier: Apache-2.0
#include "burin/io/step/convert.h"

#include <GeomConvert_ApproxCurve.hxx>
#include <GeomConvert_ApproxSurface.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Precision.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <cmath>

namespace burin::io::step {

using geom::Direction;
using geom::HPoint;
using geom::Interval;
using geom::NurbsSurface;
using geom::Point3;
using geom::Vec3;

namespace {

/// Points of a meridian this close to the axis are poles: rounding of coordinates up to 1e5 mm.
constexpr double kOnAxis = 1e-10;

Point3 point(const gp_Pnt& p) {
  return {p.X(), p.Y(), p.Z()};
}
Vec3 vec(const gp_XYZ& v) {
  return {v.X(), v.Y(), v.Z()};
}
Vec3 vec(const gp_Dir& d) {
  return vec(d.XYZ());
}

std::vector<double> values(const TColStd_Array1OfReal& array) {
  std::vector<double> list;
  for (Standard_Integer i = array.Lower(); i <= array.Upper(); ++i) list.push_back(array(i));
  return list;
}

Error cannot(const std::string& what) {
  return {ErrorCode::geometry, what, {}};
}

/// Moves all knots so that the first is `lo`: a periodic curve that was cut comes back some periods off.
void shift_knots(std::vector<double>& knots, Interval to) {
  const double by = to.lo - knots.front();
  if (std::abs(by) <= 1e-9 * to.length()) return;
  for (double& k : knots) k += by;
}

// --- curves ------------------------------------------------------------------------------------------------

MappedCurve from_bspline(const Handle(Geom_BSplineCurve) & source, Interval t) {
  Handle(Geom_BSplineCurve) curve = Handle(Geom_BSplineCurve)::DownCast(source->Copy());
  curve->Segment(t.lo, t.hi, Precision::PConfusion());
  if (curve->IsPeriodic()) {
    curve->SetNotPeriodic();
    curve->Segment(curve->FirstParameter(), curve->LastParameter());
  }
  MappedCurve mapped;
  mapped.curve.degree = curve->Degree();
  mapped.curve.knots = values(curve->KnotSequence());
  shift_knots(mapped.curve.knots, t);
  for (Standard_Integer i = 1; i <= curve->NbPoles(); ++i) {
    mapped.curve.points.push_back(homogeneous(point(curve->Pole(i)), curve->Weight(i)));
  }
  return mapped;
}

MappedCurve from_bezier(const Handle(Geom_BezierCurve) & source, Interval t) {
  Handle(Geom_BezierCurve) curve = Handle(Geom_BezierCurve)::DownCast(source->Copy());
  curve->Segment(t.lo, t.hi);
  MappedCurve mapped;
  mapped.curve.degree = curve->Degree();
  mapped.curve.knots.assign(static_cast<std::size_t>(curve->Degree()) + 1, t.lo);
  mapped.curve.knots.resize(2 * mapped.curve.knots.size(), t.hi);
  for (Standard_Integer i = 1; i <= curve->NbPoles(); ++i) {
    mapped.curve.points.push_back(homogeneous(point(curve->Pole(i)), curve->Weight(i)));
  }
  return mapped;
}

MappedCurve from_ellipse(const gp_Ax2& at, double a, double b, Interval t) {
  return ellipse_arc(point(at.Location()), a * vec(at.XDirection()), b * vec(at.YDirection()), t);
}

/// The part of a curve over `t`.
Result<MappedCurve> to_nurbs(const Handle(Geom_Curve) & curve, Interval t, double approximation_mm) {
  if (curve.IsNull()) return cannot("it has no curve to be swept");
  if (const auto c = Handle(Geom_TrimmedCurve)::DownCast(curve); !c.IsNull())
    return to_nurbs(c->BasisCurve(), t, approximation_mm);
  if (const auto c = Handle(Geom_Line)::DownCast(curve); !c.IsNull())
    return MappedCurve{line(point(c->Position().Location()), vec(c->Position().Direction()), t), {}};
  if (const auto c = Handle(Geom_Circle)::DownCast(curve); !c.IsNull())
    return from_ellipse(c->Position(), c->Radius(), c->Radius(), t);
  if (const auto c = Handle(Geom_Ellipse)::DownCast(curve); !c.IsNull())
    return from_ellipse(c->Position(), c->MajorRadius(), c->MinorRadius(), t);
  if (const auto c = Handle(Geom_BSplineCurve)::DownCast(curve); !c.IsNull()) return from_bspline(c, t);
  if (const auto c = Handle(Geom_BezierCurve)::DownCast(curve); !c.IsNull()) return from_bezier(c, t);
  constexpr int kMaxSegments = 200, kMaxDegree = 9;
  GeomConvert_ApproxCurve approximation(new Geom_TrimmedCurve(curve, t.lo, t.hi), approximation_mm,
                                        GeomAbs_C1, kMaxSegments, kMaxDegree);
  if (!approximation.HasResult() || !(approximation.MaxError() <= approximation_mm))
    return cannot("its curve of another kind cannot be approximated within the tolerance");
  return from_bspline(approximation.Curve(), t);
}

// --- surfaces ----------------------------------------------------------------------------------------------

struct Frame {
  Point3 origin;
  Vec3 x, y, z, turn;  ///< turn: x turns to y around it (-z in a left-handed frame)
};
Frame frame(const gp_Ax3& a) {
  Frame f{point(a.Location()), vec(a.XDirection()), vec(a.YDirection()), vec(a.Direction()), {}};
  f.turn = cross(f.x, f.y);
  return f;
}

/// A meridian in the plane of f.x and f.z, turned.
MappedSurface turned(const Frame& f, const MappedCurve& meridian, Interval u) {
  return revolve(meridian, f.origin, f.turn, u, kOnAxis);
}

Result<MappedSurface> from_elementary(const Handle(Geom_ElementarySurface) & surface, Interval u,
                                      Interval v) {
  const Frame f = frame(surface->Position());
  if (surface->IsKind(STANDARD_TYPE(Geom_Plane)))
    return MappedSurface{plane(f.origin, f.x, f.y, u, v), {}, {}};
  if (const auto s = Handle(Geom_CylindricalSurface)::DownCast(surface); !s.IsNull())
    return turned(f, {line(f.origin + s->Radius() * f.x, f.z, v), {}}, u);
  if (const auto s = Handle(Geom_ConicalSurface)::DownCast(surface); !s.IsNull()) {
    const double a = s->SemiAngle();
    return turned(f, {line(f.origin + s->RefRadius() * f.x, std::sin(a) * f.x + std::cos(a) * f.z, v), {}},
                  u);
  }
  if (const auto s = Handle(Geom_SphericalSurface)::DownCast(surface); !s.IsNull())
    return turned(f, ellipse_arc(f.origin, s->Radius() * f.x, s->Radius() * f.z, v), u);
  if (const auto s = Handle(Geom_ToroidalSurface)::DownCast(surface); !s.IsNull()) {
    const Point3 center = f.origin + s->MajorRadius() * f.x;
    return turned(f, ellipse_arc(center, s->MinorRadius() * f.x, s->MinorRadius() * f.z, v), u);
  }
  return cannot("surfaces of this kind are not known");
}

MappedSurface from_bspline(const Handle(Geom_BSplineSurface) & source, Interval u, Interval v) {
  Handle(Geom_BSplineSurface) s = Handle(Geom_BSplineSurface)::DownCast(source->Copy());
  s->CheckAndSegment(u.lo, u.hi, v.lo, v.hi, Precision::PConfusion(), Precision::PConfusion());
  if (s->IsUPeriodic()) s->SetUNotPeriodic();
  if (s->IsVPeriodic()) s->SetVNotPeriodic();
  // Whole periods, and surfaces that come so from the file, do not begin and end with full knots yet.
  const bool clamped = s->UMultiplicity(1) > s->UDegree() && s->UMultiplicity(s->NbUKnots()) > s->UDegree() &&
                       s->VMultiplicity(1) > s->VDegree() && s->VMultiplicity(s->NbVKnots()) > s->VDegree();
  if (!clamped) {
    geom::Interval all_u, all_v;
    s->Bounds(all_u.lo, all_u.hi, all_v.lo, all_v.hi);
    s->Segment(all_u.lo, all_u.hi, all_v.lo, all_v.hi);
  }
  MappedSurface mapped;
  NurbsSurface& n = mapped.surface;
  n.degree_u = s->UDegree();
  n.degree_v = s->VDegree();
  n.count_u = s->NbUPoles();
  n.count_v = s->NbVPoles();
  n.knots_u = values(s->UKnotSequence());
  n.knots_v = values(s->VKnotSequence());
  shift_knots(n.knots_u, u);
  shift_knots(n.knots_v, v);
  for (Standard_Integer j = 1; j <= s->NbVPoles(); ++j) {
    for (Standard_Integer i = 1; i <= s->NbUPoles(); ++i)
      n.points.push_back(homogeneous(point(s->Pole(i, j)), s->Weight(i, j)));
  }
  return mapped;
}

/// As a B-spline surface over its own parameters, 0 to 1.
Handle(Geom_BSplineSurface) as_bspline(const Handle(Geom_BezierSurface) & s) {
  TColgp_Array2OfPnt poles(1, s->NbUPoles(), 1, s->NbVPoles());
  TColStd_Array2OfReal weights(1, s->NbUPoles(), 1, s->NbVPoles());
  s->Poles(poles);
  s->Weights(weights);
  TColStd_Array1OfReal ends(1, 2);
  ends(1) = 0;
  ends(2) = 1;
  TColStd_Array1OfInteger mu(1, 2), mv(1, 2);
  mu.Init(s->UDegree() + 1);
  mv.Init(s->VDegree() + 1);
  return new Geom_BSplineSurface(poles, weights, ends, ends, mu, mv, s->UDegree(), s->VDegree());
}

Result<MappedSurface> approximated(const Handle(Geom_Surface) & surface, Interval u, Interval v,
                                   double approximation_mm) {
  constexpr int kMaxSegments = 400, kMaxDegree = 9;
  const Handle(Geom_Surface) part = new Geom_RectangularTrimmedSurface(surface, u.lo, u.hi, v.lo, v.hi);
  const GeomConvert_ApproxSurface fit(part, approximation_mm, GeomAbs_C1, GeomAbs_C1, kMaxDegree, kMaxDegree,
                                      kMaxSegments, 0);
  if (!fit.HasResult() || !(fit.MaxError() <= approximation_mm))
    return cannot("it cannot be approximated by NURBS within the tolerance");
  return from_bspline(fit.Surface(), u, v);
}

}  // namespace

Handle(Geom_Surface) plain_surface(const Handle(Geom_Surface) & surface) {
  constexpr int kMaxWrappings = 16;  // a file can hardly mean more than two
  Handle(Geom_Surface) s = surface;
  for (int i = 0; i < kMaxWrappings && !s.IsNull(); ++i) {
    if (const auto t = Handle(Geom_RectangularTrimmedSurface)::DownCast(s); !t.IsNull()) {
      s = t->BasisSurface();
    } else if (const auto o = Handle(Geom_OffsetSurface)::DownCast(s); !o.IsNull()) {
      const Handle(Geom_Surface) closed_form = o->Surface();
      if (closed_form.IsNull()) return s;
      s = closed_form;
    } else {
      return s;
    }
  }
  return s;
}

std::string kind_of(const Handle(Geom_Surface) & s) {
  if (s->IsKind(STANDARD_TYPE(Geom_Plane))) return "plane";
  if (s->IsKind(STANDARD_TYPE(Geom_CylindricalSurface))) return "cylinder";
  if (s->IsKind(STANDARD_TYPE(Geom_ConicalSurface))) return "cone";
  if (s->IsKind(STANDARD_TYPE(Geom_SphericalSurface))) return "sphere";
  if (s->IsKind(STANDARD_TYPE(Geom_ToroidalSurface))) return "torus";
  if (s->IsKind(STANDARD_TYPE(Geom_SurfaceOfRevolution))) return "revolution";
  if (s->IsKind(STANDARD_TYPE(Geom_SurfaceOfLinearExtrusion))) return "extrusion";
  if (s->IsKind(STANDARD_TYPE(Geom_BezierSurface))) return "bezier";
  if (s->IsKind(STANDARD_TYPE(Geom_BSplineSurface))) return "bspline";
  if (s->IsKind(STANDARD_TYPE(Geom_OffsetSurface))) return "offset";
  return "other";
}

Extent extent(const Handle(Geom_Surface) & s, Direction direction) {
  Interval u, v;
  s->Bounds(u.lo, u.hi, v.lo, v.hi);
  Extent e;
  e.range = direction == Direction::u ? u : v;
  if (direction == Direction::u && s->IsUPeriodic()) e.period = s->UPeriod();
  if (direction == Direction::v && s->IsVPeriodic()) e.period = s->VPeriod();
  if (Precision::IsInfinite(e.range.lo)) e.range.lo = -std::numeric_limits<double>::infinity();
  if (Precision::IsInfinite(e.range.hi)) e.range.hi = std::numeric_limits<double>::infinity();
  return e;
}

Result<MappedSurface> to_nurbs(const Handle(Geom_Surface) & s, Interval u, Interval v,
                               double approximation_mm) {
  if (const auto e = Handle(Geom_ElementarySurface)::DownCast(s); !e.IsNull())
    return from_elementary(e, u, v);
  if (const auto b = Handle(Geom_BSplineSurface)::DownCast(s); !b.IsNull()) return from_bspline(b, u, v);
  if (const auto b = Handle(Geom_BezierSurface)::DownCast(s); !b.IsNull())
    return from_bspline(as_bspline(b), u, v);
  if (const auto r = Handle(Geom_SurfaceOfRevolution)::DownCast(s); !r.IsNull()) {
    auto meridian = to_nurbs(r->BasisCurve(), v, approximation_mm);
    if (!meridian) return meridian.error();
    const gp_Ax1 axis = r->Axis();
    return revolve(*meridian, point(axis.Location()), vec(axis.Direction()), u, kOnAxis);
  }
  if (const auto x = Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(s); !x.IsNull()) {
    auto profile = to_nurbs(x->BasisCurve(), u, approximation_mm);
    if (!profile) return profile.error();
    return extrude(*profile, vec(x->Direction()), v);
  }
  return approximated(s, u, v, approximation_mm);
}

Handle(Geom_BSplineSurface) to_occt(const NurbsSurface& s) {
  TColgp_Array2OfPnt poles(1, s.count_u, 1, s.count_v);
  TColStd_Array2OfReal weights(1, s.count_u, 1, s.count_v);
  for (int j = 0; j < s.count_v; ++j) {
    for (int i = 0; i < s.count_u; ++i) {
      const Point3 p = project(s.at(i, j));
      poles(i + 1, j + 1) = gp_Pnt(p.x, p.y, p.z);
      weights(i + 1, j + 1) = s.at(i, j).w;
    }
  }
  const auto distinct = [](const std::vector<double>& knots) {
    std::vector<std::pair<double, int>> list;
    for (const double k : knots) {
      if (list.empty() || k != list.back().first) list.emplace_back(k, 0);
      ++list.back().second;
    }
    return list;
  };
  const auto split = [](const std::vector<std::pair<double, int>>& list, TColStd_Array1OfReal& knots,
                        TColStd_Array1OfInteger& multiplicities) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      knots(static_cast<int>(i) + 1) = list[i].first;
      multiplicities(static_cast<int>(i) + 1) = list[i].second;
    }
  };
  const auto u = distinct(s.knots_u), v = distinct(s.knots_v);
  const int nu = static_cast<int>(u.size()), nv = static_cast<int>(v.size());
  TColStd_Array1OfReal ku(1, nu), kv(1, nv);
  TColStd_Array1OfInteger mu(1, nu), mv(1, nv);
  split(u, ku, mu);
  split(v, kv, mv);
  return new Geom_BSplineSurface(poles, weights, ku, kv, mu, mv, s.degree_u, s.degree_v);
}

NurbsSurface transformed(const NurbsSurface& surface, const gp_Trsf& by) {
  NurbsSurface out = surface;
  for (HPoint& h : out.points) {
    const Point3 p = project(h);
    gp_XYZ xyz(p.x, p.y, p.z);
    by.Transforms(xyz);
    h = geom::homogeneous({xyz.X(), xyz.Y(), xyz.Z()}, h.w);
  }
  return out;
}

geom::Box3 close_bounds(const NurbsSurface& surface) {
  constexpr int kParts = 4;  // of each span: what the net stands off shrinks by their square
  constexpr std::size_t kMaxPoints = 20000;
  if (surface.points.size() > kMaxPoints) return geom::bounds(surface);
  const Handle(Geom_BSplineSurface) s = to_occt(surface);
  const auto between = [](const std::vector<double>& flat) {
    std::vector<double> list;
    for (std::size_t i = 0; i + 1 < flat.size(); ++i) {
      for (int k = 1; k < kParts && flat[i] < flat[i + 1]; ++k)
        list.push_back(flat[i] + (flat[i + 1] - flat[i]) * k / kParts);
    }
    return list;
  };
  const auto insert = [&](const std::vector<double>& list, const auto& into) {
    TColStd_Array1OfReal knots(1, static_cast<int>(list.size()));
    TColStd_Array1OfInteger once(1, knots.Upper());
    once.Init(1);
    for (int i = 1; i <= knots.Upper(); ++i) knots(i) = list[static_cast<std::size_t>(i) - 1];
    into(knots, once);
  };
  insert(between(surface.knots_u),
         [&](const auto& k, const auto& m) { s->InsertUKnots(k, m, 0, Standard_False); });
  insert(between(surface.knots_v),
         [&](const auto& k, const auto& m) { s->InsertVKnots(k, m, 0, Standard_False); });
  geom::Box3 box;
  for (int j = 1; j <= s->NbVPoles(); ++j) {
    for (int i = 1; i <= s->NbUPoles(); ++i) box.add(point(s->Pole(i, j)));
  }
  return box;
}

std::string what_is_wrong(const NurbsSurface& s) {
  if (s.degree_u > geom::kMaxSurfaceDegree || s.degree_v > geom::kMaxSurfaceDegree)
    return "its degree is " + std::to_string(std::max(s.degree_u, s.degree_v)) + " (at most " +
           std::to_string(geom::kMaxSurfaceDegree) + ")";
  if (s.points.size() > static_cast<std::size_t>(geom::kMaxControlPoints))
    return "it has " + std::to_string(s.points.size()) + " control points (at most " +
           std::to_string(geom::kMaxControlPoints) + ")";
  for (const HPoint& h : s.points) {
    const Point3 p = project(h);
    if (!std::isfinite(h.w) || !(h.w > 0)) return "a weight is not above 0";
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      return "a control point is not a number";
    if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kMaxCoordinate)
      return "a control point lies farther than 10 km out";
  }
  return "";
}

}  // namespace burin::io::step
