// SPDX-License-Identifier: Apache-2.0
// Joining patches into few surfaces (Koo & Jee 2007, section 2.1 and 2.2, eq. 4 to 26), exactly: patches that
// share an edge are brought to a common form (orientation, degree, knots, weights) and become one net with a
// knot of multiplicity p at the joint. Partial contacts split the larger patch along iso-parametric lines.
// mm.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/geom/surface/nurbs.h"

namespace burin::geom {

/// The E word of G106.2.
enum class Grouping {
  largest = 1,  ///< E1: of all rectangles of patches that can become one surface the largest area, then again
  first_block = 2,  ///< E2: grow from the first patch by whole sides, u and v in turn
  u_first = 3,      ///< E3: longest runs in u, then equal runs in v
  v_first = 4,      ///< E4: the other way round
};

struct JoinOptions {
  double tolerance_mm = 1e-4;  ///< edges match when their curves agree within this
  /// Largest deviation that a forced partial join may bring (Koo & Jee's eq. 15 to 26 bend the base).
  double max_deviation_mm = 0.01;
  Grouping grouping = Grouping::largest;
};

enum class Continuity { g0, g1, g2 };

/// One line along which two patches were joined, in the parameters of the joined surface.
struct Joint {
  Direction direction = Direction::u;  ///< u: joined in u, the joint is the line u = at
  double at = 0;
  double gap_mm = 0;  ///< largest distance of the two edges before they were closed
  Continuity continuity =
      Continuity::g0;  ///< along the whole line, angles within 1e-6 rad, curvature 1e-4 relative
};

/// Where a part of an input patch went: u, v of the joined surface over `u` x `v`. The patch's own parameters
/// follow in two steps (patch_parameters): along each direction the projective map that keeps the ends of the
/// interval, x' = lo + L b f / (1 + (b - 1) f) with f = (x - lo) / L and b = bend (1 in nearly all cases: no
/// change), then linearly: patch_u = pu[0] + pu[1] * u' + pu[2] * v', patch_v = pv[0] + pv[1] * u' + pv[2] *
/// v'. (Swaps and reversals are in the coefficients.) After a forced join the map is an approximation.
struct Member {
  std::size_t patch = 0;  ///< index into the input
  Interval u, v;
  std::array<double, 3> pu{}, pv{};
  double bend_u = 1, bend_v = 1;  ///< > 0
};
/// Parameters of the patch for parameters of the joined surface, and back. Outside the member the maps go on.
Point2 patch_parameters(const Member& member, Point2 joined);
Point2 joined_parameters(const Member& member, Point2 patch);

struct JoinedSurface {
  NurbsSurface surface;  ///< domain of u from 0, of v from 0
  std::vector<Member> members;
  std::vector<Joint> joints;
  /// Largest distance between the joined surface and the patches it came from, measured by sampling 9 x 9
  /// points (and Newton) in every span: the gaps that were closed, and what forced joins bent.
  double deviation_mm = 0;
};

/// Contacts that could not be joined, for the report.
struct JoinReport {
  struct Unjoined {
    std::size_t patch_a = 0, patch_b = 0;
    std::string reason;
    double deviation_mm = 0;
  };
  std::vector<Unjoined> unjoined;
  double gap_max_mm = 0;
  double deviation_max_mm = 0;
};

struct Composite {
  std::vector<JoinedSurface> surfaces;  ///< in the order of their first patch
  JoinReport report;
};

/// Never fails on valid patches: what cannot be joined stays a surface of its own. Error (geometry): an
/// invalid patch (its index in the message), no patch. The orientation of a joined surface is that of its
/// first (lowest-numbered) patch. A forced join beyond max_deviation_mm is not made: diagnostics (left_out,
/// "join_refused") give the figure.
Result<Composite> join(const std::vector<NurbsSurface>& patches, const JoinOptions& options,
                       Diagnostics& diagnostics);

}  // namespace burin::geom
