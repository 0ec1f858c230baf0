// SPDX-License-Identifier: Apache-2.0
// Arc splines for the offset of a smooth curve, within a certified tolerance (Park & Ahn 2007, 4.2.1; Park
// 2004).
//
// The offset curve is C_d(t) = C(t) + d N(t), N = (y', -x') / |C'| (to the right of the direction of travel;
// eq. 3). A circular arc of radius rho about c follows C_d exactly as well as the concentric arc of radius
// rho -+ d follows C, so the fit is returned on the side of C: offsetting each returned arc by d (centre
// kept) gives the arc spline of C_d that was certified. The offset (offset.h) then treats drawn and fitted
// arcs alike, and where the curve is bent tighter than d the concentric arc vanishes as a drawn arc would.
#pragma once

#include <vector>

#include "burin/base/result.h"
#include "burin/geom/curve/arc_spline.h"
#include "burin/geom/curve/curve.h"

namespace burin::geom {

enum class FitMethod {
  minimal,  ///< fewest segments: longest feasible runs over the one-parameter biarc family
  bisect,   ///< the paper's: polygon within 0.2 delta, then bisection with optimal single biarcs within 0.8
            ///< delta
};

struct FitOptions {
  FitMethod method = FitMethod::minimal;
  double tolerance_mm = 0.01;  ///< delta: certified bound on the deviation of the offset arcs from C_d
  double offset_mm = 0.0;      ///< d, signed, to the right of the direction of travel; 0 fits C itself
  double tangent_rad = 1e-3;   ///< corners sharper than this stay corners (the curve is split there)
  /// How far (rad) the direction of the arcs may differ from the curve's at its two ends. 0 keeps the
  /// direction, so that neighbouring curves stay G1. At corners of the outline nothing depends on it, and
  /// corner_freedom() of the corner's turn saves up to an arc a curve. Corners inside the curve are treated
  /// so in any case.
  double start_freedom_rad = 0;
  double end_freedom_rad = 0;
};

/// Freedom of direction (FitOptions) of the two curves that meet under this angle (rad, 0 .. pi): a quarter
/// of the angle, so that the corner stays what it is, and at most 0.1; 0 at joints that are smooth within
/// tangent_rad.
double corner_freedom(double turn_rad, double tangent_rad = 1e-3);

struct FitResult {
  /// Arcs and lines from C(0) to C(1); ends lie exactly on C's end points; G1 inside each smooth piece.
  std::vector<Segment> segments;
  /// Upper bound of the Hausdorff distance between the offset arc spline and the offset curve over the pieces
  /// where the offset curve is regular (1 + d kappa > 0), and of the distance between the returned arcs and C
  /// everywhere. At an end of free direction the offset arcs count together with the arc of radius |d| about
  /// the end point, the one that the offset puts there. Proven (Bernstein coefficients), not sampled. <=
  /// tolerance_mm. 0 for lines and circular arcs.
  double max_deviation_mm = 0;
  /// Index into `segments` of the first segment of each smooth piece (0 first).
  std::vector<std::uint32_t> piece_starts;
};

/// Lines and arcs come back unchanged (a full circle as two arcs). Errors (geometry): a curve of zero length;
/// a tolerance that is not positive; a piece that cannot be fitted within the tolerance in 1e6 segments.
Result<FitResult> fit_arc_spline(const Curve2& curve, const FitOptions& options);

}  // namespace burin::geom
