// SPDX-License-Identifier: Apache-2.0
#include "burin/io/step/trim.h"

#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <Geom2dAdaptor_Curve.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>

#include "burin/geom/point_tools.h"

namespace burin::io::step {

using geom::Box2;
using geom::Interval;
using geom::Point2;
using geom::Vec2;

Point2 BoundaryEdge::at(double t) const {
  const gp_Pnt2d p = curve->Value(t);
  return Point2{p.X(), p.Y()} + shift;
}

namespace {

// --- order -------------------------------------------------------------------------------------------------

bool is_boundary(TopAbs_Orientation o) {
  return o == TopAbs_FORWARD || o == TopAbs_REVERSED;
}

/// The edges of a wire in their order. The explorer follows the connections; where it loses the thread (edges
/// that do not meet) the order of the file stands.
std::vector<TopoDS_Edge> ordered_edges(const TopoDS_Wire& wire, const TopoDS_Face& face) {
  std::vector<TopoDS_Edge> stored, followed;
  for (TopoDS_Iterator it(wire); it.More(); it.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(it.Value());
    if (is_boundary(edge.Orientation())) stored.push_back(edge);
  }
  for (BRepTools_WireExplorer it(wire, face); it.More() && followed.size() <= stored.size(); it.Next())
    followed.push_back(it.Current());
  if (followed.size() == stored.size()) return followed;
  if (wire.Orientation() == TopAbs_REVERSED) std::reverse(stored.begin(), stored.end());
  return stored;
}

/// Whole periods that bring `from` nearest to `to`.
double periods(double from, double to, double period) {
  return period > 0 ? period * std::round((to - from) / period) : 0;
}

Result<BoundaryLoop> boundary_loop(const TopoDS_Wire& wire, const TopoDS_Face& face, const Extent& u,
                                   const Extent& v) {
  BoundaryLoop loop;
  for (const TopoDS_Edge& edge : ordered_edges(wire, face)) {
    double first = 0, last = 0;
    const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
    if (curve.IsNull()) return Error{ErrorCode::geometry, "an edge has no curve on the surface", {}};
    if (!std::isfinite(first) || !std::isfinite(last) || std::abs(first) > 1e100 || std::abs(last) > 1e100)
      return Error{ErrorCode::geometry, "an edge goes on for ever", {}};
    const bool reversed = edge.Orientation() == TopAbs_REVERSED;
    BoundaryEdge piece{curve, reversed ? last : first, reversed ? first : last, {}};
    if (!loop.empty()) {
      const Point2 end = loop.back().at(loop.back().to), start = piece.at(piece.from);
      piece.shift = {periods(start.x, end.x, u.period), periods(start.y, end.y, v.period)};
    }
    loop.push_back(piece);
  }
  return loop;
}

// --- bounds ------------------------------------------------------------------------------------------------

/// Parameters of an edge between which its curve is one smooth piece, in its sense.
std::vector<double> breaks(const BoundaryEdge& edge) {
  const double lo = std::min(edge.from, edge.to), hi = std::max(edge.from, edge.to);
  std::vector<double> list{lo, hi};
  if (lo < hi) {
    const Geom2dAdaptor_Curve adaptor(edge.curve, lo, hi);
    const int n = adaptor.NbIntervals(GeomAbs_CN);
    TColStd_Array1OfReal ends(1, n + 1);
    adaptor.Intervals(ends, GeomAbs_CN);
    for (int i = 2; i <= n; ++i) {
      if (ends(i) > lo && ends(i) < hi) list.push_back(ends(i));
    }
    if (n == 1 && adaptor.GetType() != GeomAbs_Line) list.push_back(0.5 * (lo + hi));
  }
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  if (edge.to < edge.from) std::reverse(list.begin(), list.end());
  return list;
}

bool is_line(const BoundaryEdge& edge) {
  const double lo = std::min(edge.from, edge.to), hi = std::max(edge.from, edge.to);
  return lo < hi && Geom2dAdaptor_Curve(edge.curve, lo, hi).GetType() == GeomAbs_Line;
}

/// The largest value of the parabola through three equidistant values, at least the middle one.
double peak(double a, double b, double c) {
  const double bend = a - 2 * b + c;
  if (!(bend < 0) || b < a || b < c) return b;
  return b - (c - a) * (c - a) / (8 * bend);
}

void add_bounds(const BoundaryEdge& edge, Box2& box) {
  box.add(edge.at(edge.from));
  box.add(edge.at(edge.to));
  if (is_line(edge)) return;
  constexpr int kSamples = 16;  // a smooth piece: the parabola is off by their fourth power at most
  const std::vector<double> ends = breaks(edge);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    std::vector<Point2> p;
    for (int k = 0; k <= kSamples; ++k)
      p.push_back(edge.at(ends[i] + (ends[i + 1] - ends[i]) * k / kSamples));
    for (std::size_t k = 1; k + 1 < p.size(); ++k) {
      const Point2 a = p[k - 1], b = p[k], c = p[k + 1];
      box.add(Point2{peak(a.x, b.x, c.x), peak(a.y, b.y, c.y)});
      box.add(Point2{-peak(-a.x, -b.x, -c.x), -peak(-a.y, -b.y, -c.y)});
    }
    box.add(p.back());
  }
}

/// Inner loops may lie some periods away from the largest one.
void gather(std::vector<BoundaryLoop>& loops, const Extent& u, const Extent& v) {
  std::vector<Box2> boxes;
  for (const BoundaryLoop& loop : loops) boxes.push_back(bounds({loop}));
  std::size_t largest = 0;
  for (std::size_t i = 1; i < boxes.size(); ++i) {
    if (boxes[i].width() * boxes[i].height() > boxes[largest].width() * boxes[largest].height()) largest = i;
  }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const Box2 &b = boxes[i], &l = boxes[largest];
    const Vec2 by{periods(0.5 * (b.lo.x + b.hi.x), 0.5 * (l.lo.x + l.hi.x), u.period),
                  periods(0.5 * (b.lo.y + b.hi.y), 0.5 * (l.lo.y + l.hi.y), v.period)};
    for (BoundaryEdge& edge : loops[i]) edge.shift = edge.shift + by;
  }
}

// --- polygons ----------------------------------------------------------------------------------------------

/// The part of the tolerance for the samples of a curve; the rest is for leaving out of those what need not
/// be. Small: even sampling by halves wastes points, thinning does not.
constexpr double kSampling = 0.1;

/// Samples one loop in the parameters of the NURBS surface.
class Sampler {
 public:
  Sampler(const ParamMap& u, const ParamMap& v, const Handle(Geom_BSplineSurface) & surface, double tolerance)
      : u_(u),
        v_(v),
        surface_(surface),
        sampling_(kSampling * tolerance),
        thinning_((1 - kSampling) * tolerance) {
    surface->Bounds(u_range_.lo, u_range_.hi, v_range_.lo, v_range_.hi);
  }

  TrimLoop operator()(const BoundaryLoop& loop) {
    points_.clear();
    for (const BoundaryEdge& edge : loop) {
      const std::vector<double> ends = breaks(edge);
      std::vector<Point2> points{at(edge, ends.front())};
      for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const Point2 a = at(edge, ends[i]), b = at(edge, ends[i + 1]);
        bisect(edge, ends[i], a, ends[i + 1], b, 0, points);
        points.push_back(b);
      }
      for (const Point2 p : thinned(points)) add(p);
    }
    while (points_.size() > 1 && same(points_.front(), points_.back())) points_.pop_back();
    return {points_};
  }

 private:
  Point2 at(const BoundaryEdge& edge, double t) const {
    const Point2 p = edge.at(t);
    return {std::clamp(u_(p.x), u_range_.lo, u_range_.hi), std::clamp(v_(p.y), v_range_.lo, v_range_.hi)};
  }

  /// Far below what the decimals of a program keep, above the rounding of pieces that meet.
  bool same(Point2 a, Point2 b) const {
    constexpr double kSame = 1e-12;
    return std::abs(a.x - b.x) <= kSame * u_range_.length() &&
           std::abs(a.y - b.y) <= kSame * v_range_.length();
  }
  void add(Point2 p) {
    if (points_.empty() || !same(points_.back(), p)) points_.push_back(p);
  }

  /// Distance of p from the chord a b on the surface, to first order around p.
  double deviation(Point2 p, Point2 a, Point2 b) const {
    gp_Pnt at;
    gp_Vec su, sv;
    surface_->D1(p.x, p.y, at, su, sv);
    const auto lifted = [&](Vec2 d) { return su * d.x + sv * d.y; };
    const gp_Vec chord = lifted(b - a), to = lifted(p - a);
    const double length2 = chord.SquareMagnitude();
    const double s = length2 > 0 ? std::clamp(to.Dot(chord) / length2, 0.0, 1.0) : 0.0;
    return (to - chord * s).Magnitude();
  }

  /// Points between a and b so that chords stay within the tolerance of sampling.
  void bisect(const BoundaryEdge& edge, double ta, Point2 a, double tb, Point2 b, int depth,
              std::vector<Point2>& points) const {
    constexpr int kMaxDepth = 12;
    double worst = 0;
    for (const double s : {0.25, 0.5, 0.75})
      worst = std::max(worst, deviation(at(edge, ta + s * (tb - ta)), a, b));
    // The negation also ends the recursion where the surface is no number.
    if (!(worst > sampling_) || depth == kMaxDepth) return;
    const double tm = 0.5 * (ta + tb);
    const Point2 m = at(edge, tm);
    bisect(edge, ta, a, tm, m, depth + 1, points);
    points.push_back(m);
    bisect(edge, tm, m, tb, b, depth + 1, points);
  }

  /// Without the points that the tolerance of thinning can do without: from each point that stays the longest
  /// chord that holds. Curves with many knots, and halving, bring more than are needed.
  std::vector<Point2> thinned(const std::vector<Point2>& p) const {
    constexpr std::size_t kLongest = 256;  // points a chord spans: bounds the time
    const auto holds = [&](std::size_t a, std::size_t b) {
      for (std::size_t i = a + 1; i < b; ++i) {
        if (!(deviation(p[i], p[a], p[b]) <= thinning_)) return false;
      }
      return true;
    };
    std::vector<Point2> kept{p.front()};
    for (std::size_t a = 0; a + 1 < p.size();) {
      std::size_t b = a + 1;
      while (b + 1 < p.size() && b - a < kLongest && holds(a, b + 1)) ++b;
      kept.push_back(p[b]);
      a = b;
    }
    return kept;
  }

  const ParamMap &u_, &v_;
  Handle(Geom_BSplineSurface) surface_;
  double sampling_, thinning_;
  Interval u_range_, v_range_;
  std::vector<Point2> points_;
};

double area(const TrimLoop& loop) {
  double twice = 0;
  const std::vector<Point2>& p = loop.points;
  for (std::size_t i = 0; i < p.size(); ++i) {
    // Relative to the first point: loops far from the origin lose no digits.
    twice += cross(p[i] - p[0], p[(i + 1) % p.size()] - p[0]);
  }
  return 0.5 * twice;
}

/// How many of `loops` contain the loop, by most of its points (single ones may touch).
int depth_of(const TrimLoop& loop, const std::vector<TrimLoop>& loops) {
  int depth = 0;
  for (const TrimLoop& other : loops) {
    if (&other == &loop || std::abs(area(other)) <= std::abs(area(loop))) continue;
    std::size_t in = 0;
    for (const Point2 p : loop.points) in += geom::inside_polygon(other.points, p);
    depth += 2 * in > loop.points.size();
  }
  return depth;
}

}  // namespace

Result<std::vector<BoundaryLoop>> boundary(const TopoDS_Face& face, const Extent& u, const Extent& v) {
  const TopoDS_Face forward = TopoDS::Face(face.Oriented(TopAbs_FORWARD));
  std::vector<BoundaryLoop> loops;
  for (TopoDS_Iterator it(forward); it.More(); it.Next()) {
    if (it.Value().ShapeType() != TopAbs_WIRE || !is_boundary(it.Value().Orientation())) continue;
    auto loop = boundary_loop(TopoDS::Wire(it.Value()), forward, u, v);
    if (!loop) return loop.error();
    if (!loop->empty()) loops.push_back(std::move(*loop));
  }
  gather(loops, u, v);
  return loops;
}

Box2 bounds(const std::vector<BoundaryLoop>& loops) {
  Box2 box;
  for (const BoundaryLoop& loop : loops) {
    for (const BoundaryEdge& edge : loop) add_bounds(edge, box);
  }
  return box;
}

std::vector<TrimLoop> polygons(const std::vector<BoundaryLoop>& loops, const ParamMap& u, const ParamMap& v,
                               const Handle(Geom_BSplineSurface) & surface, double tolerance_mm) {
  std::vector<TrimLoop> sampled;
  Sampler sampler(u, v, surface, tolerance_mm);
  for (const BoundaryLoop& loop : loops) {
    TrimLoop polygon = sampler(loop);
    if (polygon.points.size() >= 3 && area(polygon) != 0) sampled.push_back(std::move(polygon));
  }
  std::vector<TrimLoop> outer, holes;
  for (const TrimLoop& loop : sampled) {
    const bool is_outer = depth_of(loop, sampled) % 2 == 0;
    TrimLoop turned = loop;
    if ((area(loop) > 0) != is_outer) std::reverse(turned.points.begin(), turned.points.end());
    (is_outer ? outer : holes).push_back(std::move(turned));
  }
  outer.insert(outer.end(), holes.begin(), holes.end());
  return outer;
}

bool is_natural(const std::vector<TrimLoop>& loops, const Handle(Geom_BSplineSurface) & surface,
                double tolerance_mm) {
  if (loops.size() != 1) return false;
  Interval u, v;
  surface->Bounds(u.lo, u.hi, v.lo, v.hi);
  const double whole = u.length() * v.length();
  if (!(std::abs(area(loops[0])) > 0.5 * whole)) return false;
  const auto near = [&](Point2 p, Point2 q) {
    return surface->Value(p.x, p.y).Distance(surface->Value(q.x, q.y)) <= tolerance_mm;
  };
  // The four sides as bits: a chord lies on a side when both of its ends do.
  const auto sides = [&](Point2 p) {
    return (near(p, {u.lo, p.y}) ? 1 : 0) | (near(p, {u.hi, p.y}) ? 2 : 0) | (near(p, {p.x, v.lo}) ? 4 : 0) |
           (near(p, {p.x, v.hi}) ? 8 : 0);
  };
  const std::vector<Point2>& p = loops[0].points;
  int before = sides(p.back());
  for (const Point2 q : p) {
    const int here = sides(q);
    if ((before & here) == 0) return false;
    before = here;
  }
  return true;
}

}  // namespace burin::io::step
