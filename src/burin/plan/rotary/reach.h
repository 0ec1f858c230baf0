// SPDX-License-Identifier: Apache-2.0
// The tool axis directions in which shank and holder miss the whole part, for a given centre of the ball: a
// set of intervals of theta (tool axis (0, sin theta, cos theta)). Suh & Lee 3.2 ask for one cone in one
// section; this is exact for the part. mm, radians.
//   A point at offset dx along X and at (rho, phi) about the centre forbids |theta - phi| < asin(s / rho),
//   s = sqrt(Rs^2 - dx^2), for the shank; 90 degrees where rho <= s (the shank begins at the ball's centre:
//   the point that is touched forbids the half plane behind it, and no more). A holder piece of radius Rk
//   from height h0 to h1 forbids the part of |theta - phi| < asin(sk / rho) with h0 <= rho cos(theta - phi)
//   <= h1.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "burin/geom/mesh/mesh.h"
#include "burin/model/tool.h"

namespace burin::rotary {

/// lo < hi; lo in [-pi, pi), hi <= lo + 2 pi (beyond pi across the seam).
struct AngleInterval {
  double lo = 0, hi = 0;
  bool operator==(const AngleInterval&) const = default;
};
/// Ascending, disjoint; empty: nothing. The whole circle is one interval of 2 pi from -pi.
using AngleSet = std::vector<AngleInterval>;

bool contains(const AngleSet& set, double theta);
/// Intervals narrowed by `clearance` at either end; one narrower than that keeps its middle tenth. The whole
/// circle stays.
AngleSet narrowed(const AngleSet& set, double clearance);
double total(const AngleSet& set);
/// The angle of the set that is nearest to theta (any number of turns), given near it: the result differs
/// from theta by at most pi. Precondition: not empty.
double nearest(const AngleSet& set, double theta);

struct ReachOptions {
  /// Radii of shank and holder (and the holder's lower faces) grown by this; negative: shrunk. For checks
  /// over a stretch of motion. The flat lower end of the shank stays at the centre's height.
  double grow_mm = 0;
  bool shank = true, holder = true;
};

class ReachIndex {
 public:
  ReachIndex(const geom::Mesh& mesh, const model::BallTool& tool);
  ~ReachIndex();
  ReachIndex(ReachIndex&&) noexcept;
  ReachIndex& operator=(ReachIndex&&) noexcept;

  /// Everything at once. Never fails; not-a-number in, nothing out. Thread safe; the answer does not depend
  /// on earlier questions.
  AngleSet reachable(geom::Point3 center, const ReachOptions& options = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The paper's procedure 3 in the plane x = center.x, on the part's section offset by the ball's radius;
/// `erratum` of eq. 8 corrected. One interval or nothing.
struct SectionReach {
  AngleSet reachable;
  double theta = 0;  ///< the middle of T1 and T2 (eq. 4)
};
class SectionAxis {
 public:
  SectionAxis(const geom::Mesh& mesh, const std::vector<std::array<geom::Vec3, 3>>& corner_normals,
              double ball_radius);
  ~SectionAxis();
  SectionReach at(geom::Point3 center, geom::Vec3 normal) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace burin::rotary
