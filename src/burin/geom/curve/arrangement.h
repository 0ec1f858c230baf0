// SPDX-License-Identifier: Apache-2.0
// The boundary of the set of positive winding of raw curves: pieces between crossings are kept when the
// winding number is positive on their left only, and chained to closed loops.
#pragma once

#include <optional>

#include "burin/geom/curve/box_tree.h"

namespace burin::geom::detail {

struct BoundaryLoop {
  std::vector<Segment> segments;  ///< closed, the set to the left
  std::uint32_t contour = 0;      ///< input contour of the first segment
};

struct Boundary {
  std::vector<BoundaryLoop> loops;    ///< by contour, then by place along it
  std::vector<std::uint8_t> used;     ///< per input contour: gave a segment to the boundary
  std::size_t degenerate_places = 0;  ///< pieces that ran along each other, ends that touched
};

struct ArrangementOptions {
  int base = 0;            ///< added to the winding number of the raw curves
  double eps = 1e-9;       ///< points closer than this are one
  double point_mm = 1e-7;  ///< loops thinner than this are dropped
  std::size_t contours = 0;
  std::size_t max_meetings = 50'000'000;  ///< more meeting pairs than this: given up (see `too_many`)
};

enum class ArrangementFailure { inconsistent, too_many };

struct ArrangementResult {
  std::optional<Boundary>
      boundary;  ///< nothing when the windings found around some point contradict each other
  ArrangementFailure failure = ArrangementFailure::inconsistent;
};

ArrangementResult positive_boundary(const RawCurves& curves, const ArrangementOptions& options);

}  // namespace burin::geom::detail
