// SPDX-License-Identifier: Apache-2.0
#include "burin/io/step/face.h"

#include <BRep_Tool.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_ElementarySurface.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <TopLoc_Location.hxx>
#include <algorithm>
#include <cmath>

#include "burin/base/text.h"
#include "burin/io/step/convert.h"
#include "burin/io/step/trim.h"

namespace burin::io::step {

using geom::Box2;
using geom::Direction;
using geom::Interval;

namespace {

Error cannot(std::string why) {
  return {ErrorCode::geometry, std::move(why), {}};
}

double at(const Interval& range, int i, int n) {
  return range.lo + range.length() * i / n;
}

/// Largest distance of the iso-curves at `a` and `b` over the range of the other parameter, sampled.
double gap(const Handle(Geom_Surface) & s, Direction direction, double a, double b, Interval across) {
  constexpr int kSamples = 8;
  double largest = 0;
  for (int i = 0; i <= kSamples; ++i) {
    const double t = at(across, i, kSamples);
    const gp_Pnt p = direction == Direction::u ? s->Value(a, t) : s->Value(t, a);
    const gp_Pnt q = direction == Direction::u ? s->Value(b, t) : s->Value(t, b);
    const double d = p.Distance(q);
    if (!(d <= largest)) largest = d;  // also when it is not a number
  }
  return largest;
}

/// Where a cut may go instead of beside it: the sides of the surface and the knots of a B-spline.
std::vector<double> marks(const Handle(Geom_Surface) & s, Direction direction, const Extent& extent) {
  std::vector<double> list;
  const auto b = Handle(Geom_BSplineSurface)::DownCast(s);
  if (!b.IsNull()) {
    const int n = direction == Direction::u ? b->NbUKnots() : b->NbVKnots();
    for (int i = 1; i <= n; ++i) {
      const double k = direction == Direction::u ? b->UKnot(i) : b->VKnot(i);
      list.push_back(k);
      if (extent.period > 0) list.insert(list.end(), {k - extent.period, k + extent.period});
    }
  } else if (extent.period == 0) {
    if (std::isfinite(extent.range.lo)) list.push_back(extent.range.lo);
    if (std::isfinite(extent.range.hi)) list.push_back(extent.range.hi);
  }
  return list;
}

/// Moves the end `t` of a range to the nearest mark when that moves the side of the surface by less than
/// `tolerance`: no slivers of knots, and natural sides stay what they are.
double snapped(double t, const std::vector<double>& marks, const Handle(Geom_Surface) & s,
               Direction direction, Interval across, double tolerance) {
  double best = t;
  for (const double m : marks) {
    if (best == t || std::abs(m - t) < std::abs(best - t)) best = m;
  }
  if (best == t || !(gap(s, direction, t, best, across) <= tolerance)) return t;
  return best;
}

/// How often a NURBS form may go round in this direction. A face never covers a place twice, but with a seam
/// that is no iso-curve its loop needs more than one period of parameters. Arcs can give it.
int max_turns(const Handle(Geom_Surface) & s, Direction direction) {
  const bool arcs = s->IsKind(STANDARD_TYPE(Geom_ElementarySurface)) ||
                    (direction == Direction::u && s->IsKind(STANDARD_TYPE(Geom_SurfaceOfRevolution)));
  return arcs ? 2 : 1;
}

/// The range of one parameter that the loops need, inside of what the surface has.
Result<Interval> clipped(Interval range, const Extent& extent, int turns) {
  if (extent.period > 0) {
    constexpr double kRounding = 1e-6;  // of a turn, as the loops of files have it
    if (range.length() > extent.period * (turns + kRounding))
      return cannot("its boundary goes round more than " + std::string(turns == 1 ? "once" : "twice"));
    if (std::abs(range.length() - extent.period) <= extent.period * kRounding)
      range.hi = range.lo + extent.period;
  } else {
    range.lo = std::max(range.lo, extent.range.lo);
    range.hi = std::min(range.hi, extent.range.hi);
  }
  if (!std::isfinite(range.lo) || !std::isfinite(range.hi)) return cannot("it has no end");
  if (!(range.length() > 0)) return cannot("it has no area");
  return range;
}

struct Rectangle {
  Interval u, v;
};

Result<Rectangle> rectangle(const Handle(Geom_Surface) & s, const std::vector<BoundaryLoop>& loops,
                            double snap_mm) {
  const Extent eu = extent(s, Direction::u), ev = extent(s, Direction::v);
  Rectangle r{eu.range, ev.range};
  if (!loops.empty()) {
    const Box2 box = bounds(loops);
    r = {{box.lo.x, box.hi.x}, {box.lo.y, box.hi.y}};
  }
  auto u = clipped(r.u, eu, max_turns(s, Direction::u));
  if (!u) return u.error();
  auto v = clipped(r.v, ev, max_turns(s, Direction::v));
  if (!v) return v.error();
  r = {*u, *v};
  const std::vector<double> mu = marks(s, Direction::u, eu), mv = marks(s, Direction::v, ev);
  // From the ranges before the snapping: no order of the four sides.
  const Rectangle before = r;
  const auto snap = [&](Interval& to, const std::vector<double>& m, Direction d, Interval across) {
    const Interval wanted{snapped(to.lo, m, s, d, across, snap_mm), snapped(to.hi, m, s, d, across, snap_mm)};
    if (wanted.length() > 0) to = wanted;
  };
  snap(r.u, mu, Direction::u, before.v);
  snap(r.v, mv, Direction::v, before.u);
  // Snapping may have gone to marks a rounding more than a period apart.
  if (before.u.length() <= eu.period && r.u.length() > eu.period) r.u.hi = r.u.lo + eu.period;
  if (before.v.length() <= ev.period && r.v.length() > ev.period) r.v.hi = r.v.lo + ev.period;
  return r;
}

/// Faces thinner than this in one direction everywhere are slits that no tool sees: rounding of the file.
constexpr double kSlit = 1e-6;

}  // namespace

Result<CadFace> convert_face(const TopoDS_Face& face, const ReadCadOptions& options) {
  TopLoc_Location location;
  const Handle(Geom_Surface) stored = BRep_Tool::Surface(face, location);
  if (stored.IsNull()) return cannot("it has no surface");
  const Handle(Geom_Surface) surface = plain_surface(stored);
  if (surface.IsNull()) return cannot("its surface is damaged");
  const Extent eu = extent(surface, Direction::u), ev = extent(surface, Direction::v);
  auto loops = boundary(face, eu, ev);
  if (!loops) return loops.error();
  auto r = rectangle(surface, *loops, options.approximation_mm);
  if (!r) return r.error();
  if (!(gap(surface, Direction::u, r->u.lo, r->u.hi, r->v) > 0) &&
      !(gap(surface, Direction::u, r->u.lo, 0.5 * (r->u.lo + r->u.hi), r->v) > kSlit))
    return cannot("it has no area");

  auto mapped = to_nurbs(surface, r->u, r->v, options.approximation_mm);
  if (!mapped) return mapped.error();
  CadFace result;
  result.kind = kind_of(surface);
  // In the surface's own frame: locations are rigid, so lengths are those of the part.
  if (std::string wrong = what_is_wrong(mapped->surface); !wrong.empty()) return cannot(std::move(wrong));
  if (!loops->empty()) {
    const Handle(Geom_BSplineSurface) nurbs = to_occt(mapped->surface);
    result.loops = polygons(*loops, mapped->u, mapped->v, nurbs, options.trim_tolerance_mm);
    if (result.loops.empty())
      return Error{
          ErrorCode::range, "it is thinner than " + format_shortest(options.trim_tolerance_mm) + " mm", {}};
    result.trimmed = !is_natural(result.loops, nurbs, options.trim_tolerance_mm);
    if (!result.trimmed) result.loops.clear();
  }
  const gp_Trsf& transformation = location.Transformation();
  result.surface = transformed(mapped->surface, transformation);
  if (std::string wrong = what_is_wrong(result.surface); !wrong.empty()) return cannot(std::move(wrong));
  result.box = close_bounds(result.surface);
  result.reversed = (face.Orientation() == TopAbs_REVERSED) != transformation.IsNegative();
  return result;
}

}  // namespace burin::io::step
