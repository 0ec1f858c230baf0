// SPDX-License-Identifier: Apache-2.0
// What passes of a tilted flat, bull or ball end leave standing on a surface, measured from the tool's poses
// alone: the lowest place on the normal of each sample that the moving cutter reaches. Uses nothing of plan/.
// mm. docs/verify-mill.md
#pragma once

#include <cstddef>
#include <vector>

#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/geom/surface/nurbs.h"
#include "burin/verify/mill_check.h"

namespace burin::verify {

/// Where the planner says the tool touches (it only says where to look, and which pass is whose neighbour),
/// and how it stands. Between stations the tip goes straight and the axis along the great circle.
struct StripStation {
  geom::Point3 contact;
  cl::Pose pose;
};
struct StripPass {
  std::vector<std::vector<StripStation>> runs;  ///< without the ways between
};

struct StripOptions {
  bool normal_reversed = false;  ///< the tool is on the side of -(Su x Sv)
  double window_mm = 5;          ///< heights are looked for up to this, either way
  double resolution_mm = 1e-4;   ///< of a height
  std::size_t max_stations = 2000;
  unsigned threads = 1;  ///< 0: as many as there are; the result is the same for any number
};

struct StripReport {
  /// The highest place on the line from a station of pass i to the nearest place of pass i + 1: least and
  /// greatest over the stations. Where the next pass has no place abreast (it ends there) only the greatest
  /// counts. Infinite and 0 when nothing was looked at.
  struct Ridge {
    double min_mm = 0, max_mm = 0;
    geom::Point3 max_at;
  };
  std::vector<Ridge> ridges;  ///< passes - 1
  /// What was looked at, in the order of the passes: for shares and pictures (at the ends of passes more is
  /// left than between).
  struct Station {
    std::size_t pass = 0;
    geom::Point3 contact;
    double mm = 0;
    bool square = false;  ///< the next pass is abreast
  };
  std::vector<Station> stations;
  double scallop_min_mm = 0, scallop_max_mm = 0;  ///< over all ridges
  double gouge_max_mm = 0;                        ///< deepest cut below the surface, on the same lines
  geom::Point3 gouge_at;
  std::size_t samples = 0;
};

/// Errors: tool, options or poses as in check_mill; an invalid surface; contacts that are not finite.
Result<StripReport> measure_strips(const geom::NurbsSurface& surface, const std::vector<StripPass>& passes,
                                   const CheckedMill& tool, const StripOptions& options = {});

}  // namespace burin::verify
