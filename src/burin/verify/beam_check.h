// SPDX-License-Identifier: Apache-2.0
// Laser: the region that the beam sweeps against the outline of the part, both sides. Shares nothing with
// plan/laser or the offset. mm, part frame, z ignored. docs/verify-beam.md
//
// The beam is a disc of diameter `kerf_mm`, swept along the lines and arcs while it is on. Inside of the
// outline (the part) what it takes is gouge, in mm below the outline's edge. Outside, the material between
// outline and cut is excess: at each place of the outline the distance outwards to the swept region; nothing
// within reach is an edge that is not cut. What stays in an inner corner that is narrower than the beam
// cannot be helped with this kerf: it is corner excess, a figure of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/geom/curve/arc_spline.h"

namespace burin::verify {

/// Closed outlines of lines and arcs, the part on the left of all of them (outer counter-clockwise, holes
/// clockwise); each segment starts where the one before ends. Open ones are centre lines, engraved loops too:
/// the beam is to run along them, and what it takes there is no gouge.
struct Outline {
  std::vector<geom::Segment> segments;
  bool closed = true;
};

struct BeamCheckOptions {
  double kerf_mm = 0;
  double reach_mm = 5;
  double tolerance_mm = 0.01;
  double spacing_mm = 0;  ///< of the places on the outline; 0: from the bound asked for
  double bound_mm = 0.001;
  std::size_t max_samples = 5'000'000;
  bool rapids_cut = true;  ///< the beam stays on in rapids until it is switched off
  unsigned threads = 1;
};

struct BeamPlace {
  geom::Point2 p;
  geom::Vec2 n;  ///< unit, out of the part
  /// Along the normal; negative: taken from the part; NaN: not cut. In corners and on centre lines the
  /// distance to the cut, to the beam's centre.
  double deviation_mm = 0;
  double length_mm = 0;  ///< of the outline it stands for
  std::uint32_t outline = 0;
  bool corner = false;  ///< the beam does not fit in here
};
struct BeamWorst {
  double mm = 0;
  geom::Point2 at;
  std::uint32_t move = 0;  ///< GOTO
};
struct BeamReport {
  std::vector<BeamPlace> places;
  BeamWorst gouge, excess;
  BeamWorst corner_excess;  ///< not part of `excess`, its mean and its area
  double excess_mean_mm = 0;
  /// Of the part taken away and of what is left between outline and cut, where that is beyond the tolerance
  /// (by more than `bound_mm` of the options).
  double gouge_area_mm2 = 0, excess_area_mm2 = 0;
  double uncut_mm = 0, outline_mm = 0;
  std::vector<std::uint32_t> uncut_outlines;
  double spacing_mm = 0, bound_mm = 0;
};

/// Also found: the beam that crosses the part away from every outline sample (a rapid with the beam on, a
/// lead-in on the wrong side): the whole swept region is taken against the part, not places on the outline
/// alone. Where outlines cross, the part is where their winding number is positive. Errors: no kerf, numbers
/// that are not finite (range), an outline with gaps, an arc that is not in the plane (geometry), sizes
/// (range).
Result<BeamReport> check_beam(const std::vector<Outline>& outlines, const cl::Program& program,
                              const BeamCheckOptions& options);

}  // namespace burin::verify
