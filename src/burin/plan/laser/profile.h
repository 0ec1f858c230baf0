// SPDX-License-Identifier: Apache-2.0
// Contours -> beam centre lines: arc splines of the outlines, nesting, offset by half the kerf.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/geom/curve/arc_spline.h"
#include "burin/plan/laser/contours.h"

namespace burin::laser {

enum class Role { outer, hole, open, engrave };

/// A contour as an arc spline. Closed ones turn counter-clockwise when outer, clockwise when holes.
/// Segment::source is an index into `pieces`.
struct Outline {
  geom::ArcSpline spline;
  Role role = Role::outer;
  int depth = 0;              ///< nesting: 0 outermost, odd: holes
  std::uint32_t contour = 0;  ///< index into the contours it was made from
};

/// Where segments come from, for messages, statistics and pictures.
struct Piece {
  std::uint32_t entity = 0;  ///< index into Drawing::entities
  bool fitted = false;       ///< free curve (its segments are arcs and lines of a fit)
  double deviation_mm = 0;   ///< certified bound of the fit
};

/// Beam centre line of one closed or open cut, in cutting direction; starts anywhere (the tool path stage
/// chooses).
struct CutPath {
  geom::ArcSpline spline;  ///< Segment::source: index into Profile::pieces, or kCornerSource
  Role role = Role::outer;
  int depth = 0;              ///< of the outline it came from
  std::uint32_t contour = 0;  ///< of the outline it came from
};

struct Profile {
  std::vector<Outline> outlines;  ///< what was drawn, as arc splines: the edges of the part
  std::vector<Piece> pieces;
  std::vector<CutPath> paths;       ///< where the beam goes
  double max_deviation_mm = 0;      ///< certified: largest deviation of paths from the exact offset
  std::size_t fitted_segments = 0;  ///< arcs and lines of free-curve pieces in `paths`
  int g1_breaks = 0;                ///< inside smooth pieces
};

/// Fits, nests, refuses contours that cross ("self_crossing", "contours_cross": left_out, with position),
/// offsets. "contour_vanished" (left_out), "contours_merged" (info). Error (geometry): nothing left to cut.
Result<Profile> make_profile(const std::vector<Contour>& contours, const io::Drawing& drawing,
                             const LaserOptions& options, Diagnostics& diagnostics);

}  // namespace burin::laser
