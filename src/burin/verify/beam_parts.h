// SPDX-License-Identifier: Apache-2.0
// The two halves of the check of beams: what the swept region takes from the part, and what it leaves beside
// the outline. Internal. mm. docs/verify-beam.md
#pragma once

#include <cstdint>
#include <vector>

#include "burin/verify/beam_check.h"
#include "burin/verify/beam_motion.h"
#include "burin/verify/flat.h"

namespace burin::verify {

/// Which side of an edge is looked at: above rounding, below what an NC program can say. On the inner side of
/// an edge the part lies once; more often where outlines overlap or end in tiny loops.
inline constexpr double kBeside_mm = 1e-6;

/// Everything that both look at.
struct BeamScene {
  const BeamCheckOptions& options;
  double radius = 0;  ///< of the beam
  const BeamMotion& motion;
  flat::Tree cut;                                         ///< motion.pieces
  flat::Tree edges;                                       ///< closed outlines, the part on the left
  flat::Tree lines;                                       ///< centre lines
  std::vector<std::uint32_t> edge_outline, line_outline;  ///< of each segment
  bool part_around = false;                               ///< the plane around everything is part
  bool sides_tell = false;  ///< the nearest edge says on which side of the outlines a point is
  double area_from_mm = 0;  ///< what is less is no area
  unsigned threads = 1;

  int winding(flat::Point2 p) const { return edges.winding(p) + (part_around ? 1 : 0); }
  bool in_part(flat::Point2 p) const { return winding(p) > 0; }
};

/// How deep a point lies in what must not be cut: below the edges and out of the reach of a beam on the
/// centre lines. Negative outside. It changes by one mm a mm at most.
struct Depth {
  double mm = 0;
  flat::Vec2 inwards;  ///< where it grows
};
Depth depth_at(const BeamScene& scene, flat::Point2 p);

/// As BeamScene::in_part, by the nearest edge where that tells.
bool in_part(const BeamScene& scene, flat::Point2 p, const flat::Tree::Near& near);

struct GougeResult {
  BeamWorst worst;
  double bound_mm = 0;  ///< the true worst is larger by at most this
  double area_mm2 = 0;
};
GougeResult find_gouge(const BeamScene& scene);

/// Places, excess, corners, what is not cut; `bound_mm` and `spacing_mm` are of the edges.
Result<BeamReport> measure_edges(const BeamScene& scene);

}  // namespace burin::verify
