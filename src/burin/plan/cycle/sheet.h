// SPDX-License-Identifier: Apache-2.0
// A joined surface as the planner sees it: paths run along t, the next path lies at a larger w (t, w are u, v
// or v, u); the normal points to the tool. The ball's centre runs on the offset surface
//   C(t, w) = S(t, w) + r n(t, w),  r = R + L,     tip = C - R k.
#pragma once

#include <optional>
#include <vector>

#include "burin/base/result.h"
#include "burin/geom/quintic.h"
#include "burin/geom/surface/evaluate.h"

namespace burin::cycle {

using geom::Point3;
using geom::Vec3;

/// One place with its tool.
struct Contact {
  Point3 s;                 ///< on the surface
  Vec3 st, sw;              ///< tangents
  Vec3 n;                   ///< unit, towards the tool
  Point3 c;                 ///< centre of the ball
  Vec3 ct, cw;              ///< derivatives of the centre (those of the surface where degenerate)
  bool degenerate = false;  ///< st and sw are parallel or vanish; n is a limit from inside
};

/// Derivatives of the centre's surface C(t, w).
struct CentreDerivatives {
  Contact at;
  Vec3 ctt, ctw, cww;
};

class Sheet {
 public:
  /// `sign`: +1 when n = Su x Sv points to the tool, else -1. `inner`: what of t_range() is the surface that
  /// is machined, where it was continued beyond its edges; nothing: all of it.
  Sheet(const geom::NurbsSurface& surface, geom::Direction along, double sign, double radius, double stock,
        std::optional<geom::Interval> inner = std::nullopt);

  geom::Direction along() const { return along_; }
  geom::Interval t_range() const { return t_; }
  geom::Interval t_inner() const { return inner_; }
  double sign() const { return along_ == geom::Direction::u ? sign_ : -sign_; }
  geom::Interval w_range() const { return w_; }
  double radius() const { return radius_; }
  double stock() const { return stock_; }
  /// Inner knots in t and in w.
  const std::vector<geom::Knot>& t_knots() const { return t_knots_; }
  const std::vector<geom::Knot>& w_knots() const { return w_knots_; }
  /// Places of w where the normal jumps somewhere (creases run along the paths).
  const std::vector<double>& w_creases() const { return w_creases_; }
  /// The same in t: paths cross them.
  const std::vector<double>& t_creases() const { return t_creases_; }

  Point3 point(double t, double w) const;
  Contact contact(double t, double w, geom::Side side_t = geom::Side::right,
                  geom::Side side_w = geom::Side::right) const;
  CentreDerivatives derivatives(double t, double w, geom::Side side_t = geom::Side::right,
                                geom::Side side_w = geom::Side::right) const;
  Point3 tip(const Contact& c) const { return {c.c.x, c.c.y, c.c.z - radius_}; }

  /// The surface point nearest to x by Gauss-Newton from (t, w), clamped to the domain; t, w are moved.
  /// `step`: good enough when the last correction was shorter, mm.
  Contact nearest(Point3 x, double& t, double& w, double step) const;

  /// (u, v, 0) from (t, w), on the edge where t lies beyond it.
  Point3 uv(double t, double w) const;
  Vec3 uv_vector(double t, double w) const;

 private:
  geom::SurfaceDerivatives at(double t, double w, geom::Side side_t, geom::Side side_w) const;
  bool normal_of(const geom::SurfaceDerivatives& d, Vec3& n) const;
  bool creased(double value, bool in_t) const;
  geom::Point2 pulled_inside(double t, double w, double fraction) const;

  geom::Direction along_;
  double sign_;  ///< of St x Sw
  double radius_, stock_;
  geom::Interval t_, w_, inner_;
  double size_t_ = 1, size_w_ = 1;  ///< typical |St|, |Sw|
  std::vector<geom::Knot> t_knots_, w_knots_;
  std::vector<double> w_creases_, t_creases_;
  mutable geom::SurfaceEvaluator evaluator_;
};

/// +1 or -1 so that sign (Su x Sv).k > 0 in the middle of the surface; when the middle is vertical, what most
/// of the surface says; 0 when the surface has no side that looks up.
double side_that_looks_up(const geom::NurbsSurface& surface);

}  // namespace burin::cycle
