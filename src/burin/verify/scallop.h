// SPDX-License-Identifier: Apache-2.0
// Scallop and gouge of ball-end paths, measured by brute force on the design surface from the tool's
// positions. Uses nothing of plan/: a check must not share the planner's mistakes. mm.
#pragma once

#include <cstddef>
#include <vector>

#include "burin/geom/surface/nurbs.h"
#include "burin/geom/vec.h"

namespace burin::verify {

/// Tip positions along one pass: polylines dense enough that their chords may stand for the path (the caller
/// samples it), one for each stretch on the surface.
struct TipPass {
  std::vector<std::vector<geom::Point3>> stretches;
};

struct ScallopOptions {
  double radius_mm = 0;
  double stock_mm = 0;           ///< heights count from the surface moved by this along its normal
  bool normal_reversed = false;  ///< the tool is on the side of -(Su x Sv)
  /// Sampling of the surface, mm: the height between samples differs by less than spacing^2 / (8 R) + slope
  /// terms; chosen from radius and side step when 0.
  double spacing_mm = 0;
  std::size_t max_samples = 5'000'000;
};

struct ScallopReport {
  std::size_t samples = 0;
  /// Material left above the surface between pass i and i + 1, largest along the line between them: minimum
  /// and maximum of that ridge over the length of pass i. Where pass i + 1 has no place abreast (it ends, or
  /// stops at a border) or the ball stands over an edge, what is left counts for the maximum only. Infinite
  /// and 0 where there is no such place at all.
  struct Ridge {
    double min_mm = 0, max_mm = 0;
  };
  std::vector<Ridge> ridges;
  double scallop_min_mm = 0, scallop_max_mm = 0;  ///< over all ridges but the last
  double gouge_max_mm = 0;                        ///< deepest cut below the surface
  geom::Point3 gouge_at;
};

/// For every sample q of the surface with normal n: how far q + h n is left uncovered by all balls swept
/// along the passes (h > 0 left standing, h < 0 cut away), up to 2 R either way. The ridges are walked from
/// each pass to the next; cuts are looked for there and on a grid over the whole surface. No samples: an
/// invalid surface, no pass, or numbers that are not finite and positive.
ScallopReport measure_scallop(const geom::NurbsSurface& surface, const std::vector<TipPass>& passes,
                              const ScallopOptions& options);

}  // namespace burin::verify
