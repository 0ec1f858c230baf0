// SPDX-License-Identifier: Apache-2.0
// Closest point on a surface. mm.
#pragma once

#include <memory>

#include "burin/geom/surface/nurbs.h"

namespace burin::geom {

struct SurfacePoint {
  double u = 0, v = 0;
  Point3 point;
  double distance = 0;
};

/// Holds a tree of boxes over the Bezier pieces of one surface, so that many points can be asked for.
class ClosestPointFinder {
 public:
  explicit ClosestPointFinder(const NurbsSurface& surface);
  ~ClosestPointFinder();
  ClosestPointFinder(ClosestPointFinder&&) noexcept;
  ClosestPointFinder& operator=(ClosestPointFinder&&) noexcept;

  /// The closest point of the whole surface: branch and bound over boxes, then Newton. The distance is within
  /// `tolerance_mm` of the true minimum (proven by the boxes, not sampled).
  SurfacePoint find(Point3 p, double tolerance_mm = 1e-9) const;
  /// Newton from a guess, clamped to the domain: fast, local. The result is never farther than the guess.
  SurfacePoint refine(Point3 p, double u, double v) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace burin::geom
