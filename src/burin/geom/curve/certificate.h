// SPDX-License-Identifier: Apache-2.0
// Internal to the fit: a proven bound of the distance between an arc spline and a path, and between their
// offsets. Method and proof: docs/arc-fitting.md.
#pragma once

#include <vector>

#include "burin/geom/curve/bezier_path.h"
#include "burin/geom/curve/biarc.h"

namespace burin::geom::fit {

/// An arc and the part of the path it stands for: path(tau0) and path(tau1) lie on the normals at its ends.
struct Run {
  Arc arc;
  double tau0 = 0, tau1 = 0;
};

/// Closed interval of path parameters.
struct Range {
  double lo = 0, hi = 0;
};

/// Where the offset curve is singular (1 + d kappa <= 0): there only the path itself is approximated. `slack`
/// is how far the regular part of the offset curve may go unseen because the ranges are rounded outwards.
struct SingularRanges {
  std::vector<Range> ranges;
  double slack = 0;
};
SingularRanges singular_ranges(const Path& path, double d, double tolerance);

/// What the fit is measured against.
struct Target {
  const Path* path = nullptr;
  double d = 0;          ///< offset to the right
  double tolerance = 0;  ///< of both the path and its offset
  /// How far (rad) the arcs may leave the path's direction at its ends.
  double start_freedom = 0, end_freedom = 0;
  SingularRanges singular;
};

/// Bounds of the signed deviation (path, and its offset, to the left of the arcs). Infinite when the
/// deviation is beyond the tolerance or cannot be bounded (the path turns across an arc's normal).
struct Deviation {
  double lo = 0, hi = 0;

  double bound() const { return std::max(-lo, hi); }
};
Deviation certify(const Target& target, const std::vector<Run>& runs);

/// The parameter in [lo, hi] at which path + d N lies on the normal of `tangent` through `joint`, starting at
/// `guess`; negative when there is none.
double parameter_on_normal(const Path& path, double d, Point2 joint, Vec2 tangent, double guess, double lo,
                           double hi);

}  // namespace burin::geom::fit
