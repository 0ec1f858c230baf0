// SPDX-License-Identifier: Apache-2.0
// Evaluation of NURBS curves and surfaces: single points, sequences with the span kept, whole iso-curves,
// batches. The NURBS Book, A2.2, A2.3, A4.2, A4.4. All parameters are clamped to the domain; a parameter that
// is not a number gives not-a-number, never a crash. At an inner knot the piece on the right counts unless
// Side::left is asked for; at the end of the domain the last piece.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "burin/geom/surface/nurbs.h"

namespace burin::geom {

enum class Side { right, left };

/// Derivatives with respect to the parameter.
struct CurveDerivatives {
  Point3 p;
  Vec3 d1, d2, d3;
};
Point3 point(const NurbsCurve& curve, double t);
CurveDerivatives derivatives(const NurbsCurve& curve, double t, Side side = Side::right);

struct SurfaceDerivatives {
  Point3 p;
  Vec3 du, dv, duu, duv, dvv;
};
/// Also the third ones: what the second derivative of a tool path on the offset surface needs.
struct SurfaceDerivatives3 : SurfaceDerivatives {
  Vec3 duuu, duuv, duvv, dvvv;
};

Point3 point(const NurbsSurface& surface, double u, double v);
SurfaceDerivatives derivatives(const NurbsSurface& surface, double u, double v, Side side_u = Side::right,
                               Side side_v = Side::right);
SurfaceDerivatives3 derivatives3(const NurbsSurface& surface, double u, double v, Side side_u = Side::right,
                                 Side side_v = Side::right);

/// The same values, bit for bit independent of what was asked before, but fast when parameters come in order:
/// keeps the current span in a form that is cheap to evaluate. Owns a copy of what it needs; cheap to copy;
/// one per thread.
class SurfaceEvaluator {
 public:
  explicit SurfaceEvaluator(const NurbsSurface& surface);
  ~SurfaceEvaluator();
  SurfaceEvaluator(const SurfaceEvaluator&);
  SurfaceEvaluator& operator=(const SurfaceEvaluator&);
  SurfaceEvaluator(SurfaceEvaluator&&) noexcept;
  SurfaceEvaluator& operator=(SurfaceEvaluator&&) noexcept;

  Point3 point(double u, double v);
  SurfaceDerivatives derivatives(double u, double v, Side side_u = Side::right, Side side_v = Side::right);
  SurfaceDerivatives3 derivatives3(double u, double v, Side side_u = Side::right, Side side_v = Side::right);

  /// Along an iso-curve: `moving` runs through `parameters` (any order, ascending is fast), the other
  /// parameter stays at `fixed`. out.size() == parameters.size().
  void iso_points(Direction moving, double fixed, std::span<const double> parameters, std::span<Point3> out);
  void iso_derivatives(Direction moving, double fixed, std::span<const double> parameters,
                       std::span<SurfaceDerivatives> out);
  /// Any places; neighbours in the list that share a span are fast.
  void points(std::span<const Point2> uv, std::span<Point3> out);
  void derivatives(std::span<const Point2> uv, std::span<SurfaceDerivatives> out);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Unit normal along Su x Sv. Where these are parallel or vanish (poles, collapsed edges) the limit from
/// inside the surface; (0, 0, 0) only when the surface has no area around the place. Never not-a-number for
/// finite input.
Vec3 normal(const NurbsSurface& surface, double u, double v);
/// From derivatives already at hand; (0, 0, 0) where they are degenerate (|Su x Sv| <= 1e-12 |Su| |Sv|).
Vec3 normal(const SurfaceDerivatives& d);

/// Principal curvatures with respect to the normal Su x Sv: positive where the surface bends towards the
/// normal (concave for a tool on the side of the normal). Directions are unit tangents. 1/mm.
struct Curvature {
  double k_min = 0, k_max = 0;
  Vec3 direction_min, direction_max;
  double gaussian() const { return k_min * k_max; }
  double mean() const { return 0.5 * (k_min + k_max); }
};
/// Zero curvature where the normal is degenerate.
Curvature curvature(const SurfaceDerivatives& d);
/// Of the normal section along du * Su + dv * Sv.
double normal_curvature(const SurfaceDerivatives& d, double du, double dv);

}  // namespace burin::geom
