// SPDX-License-Identifier: Apache-2.0
// Drawing -> contours: pieces are joined end to end, what is drawn twice is removed, and everything doubtful
// is reported with entity and position.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/io/drawing/drawing.h"
#include "burin/plan/laser/options.h"

namespace burin::laser {

/// A chain of drawn curves, each in the direction of the chain. `joints[i]` is the point where curve i
/// starts; it lies within half a join tolerance of the drawn ends (exactly there when they agree). For an
/// open chain joints has one more entry, the end.
struct Contour {
  std::vector<geom::Curve2> curves;
  std::vector<std::uint32_t> entity;  ///< parallel to curves: index into Drawing::entities
  std::vector<geom::Point2> joints;
  bool closed = false;
  Treatment treatment = Treatment::cut;
};

/// In this order: ignored layers dropped (unknown names in `options.layers` are a usage error that lists the
/// layers), zero-length pieces dropped ("zero_length"), duplicates removed ("duplicate_removed": the same
/// curve within a tenth of the join tolerance and 0.001 mm, in either direction, whatever its kind; edges
/// that two contours share stay for both, "shared_edge"), partly overlapping lines and arcs reduced to one
/// ("overlap_removed"), ends joined within tolerance.join_mm ("ends_joined", with the widest gap), branch
/// points resolved by the smoothest continuation that closes contours ("branch_point"), open chains reported
/// ("open_chain", left_out, with both ends and the gap). Cut and engraved pieces are never joined with each
/// other. Contours come in file order of their first entity. Cost O(n log n).
Result<std::vector<Contour>> join_contours(const io::Drawing& drawing, const LaserOptions& options,
                                           Diagnostics& diagnostics);

}  // namespace burin::laser
