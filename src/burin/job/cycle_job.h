// SPDX-License-Identifier: Apache-2.0
// One surface program from text to motion: read, join, plan, and lay out as stretches for the interpolator
// and as CL data for ordinary controls. What `burin cycle` and the C interface share; nothing is written or
// printed here.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/geom/surface/join.h"
#include "burin/nc/surface_program.h"
#include "burin/plan/cycle/cycle.h"
#include "burin/servo/plan.h"

namespace burin::job {

struct CycleOptions {
  std::string file_name;
  bool strict = false;
  double tolerance_mm = 0.01;  ///< of NC blocks, of lifting, and (unless given) of forced joins
  double join_mm = 1e-4;
  std::optional<double> join_deviation_mm;
  cycle::Along along = cycle::Along::automatic;
  unsigned threads = 1;  ///< the job does not depend on it
  /// Largest coordinate that the control takes, mm: what clearly exceeds it is refused before it is planned.
  double coordinate_limit_mm = std::numeric_limits<double>::infinity();
};

/// The surfaces that some blocks became, whatever number of times they are machined.
struct CycleSurfaces {
  std::vector<std::size_t> blocks;  ///< indices into the program's blocks, in the order of the patches
  geom::Composite composite;
  std::size_t first_surface = 0;  ///< number of the first of them over the whole program
};

/// One machining of them.
struct CycleRun {
  std::size_t surfaces = 0;  ///< index into CycleJob::surfaces
  nc::MachineGroup group;
  cycle::SurfacePlan plan;  ///< displaced already, with the way from where the tool stood
  std::string title;        ///< "G106.2 I1 E1, N10 to N20"
};

struct CycleJob {
  nc::SurfaceProgram program;
  std::vector<CycleSurfaces> surfaces;
  std::vector<CycleRun> runs;
  /// Everything that moves, in order, without gaps.
  std::vector<servo::Stretch> stretches;
  /// The same as lines and arcs within the tolerance; `source` is the line of the program.
  cl::Program cl;
  double fit_deviation_mm = 0;  ///< bound of the distance between `cl` and the exact path
  std::size_t surfaces_out = 0, paths = 0, lifted = 0, repeats = 0;
  double cut_mm = 0, link_mm = 0, rapid_mm = 0;
};

/// Errors of the reader, of joining and of planning, the last two with the line of the cycle.
Result<CycleJob> make_cycle_job(std::string_view text, const CycleOptions& options, Diagnostics& diagnostics,
                                ProgressSink* progress);

/// Length of the paths on the surfaces (cuts only) by either method, and of parallel passes for the same
/// scallop.
struct PathLengths {
  double iso_parametric_mm = 0, iso_scallop_mm = 0;
  std::optional<double> parallel_mm;  ///< nothing where a wall stands along the passes either way
};
/// Plans the run again by the method that it does not use. Errors of the planner.
Result<PathLengths> compare_methods(const CycleJob& job, const CycleRun& run, const CycleOptions& options);

/// The same motion as straight lines only (G01), for the comparison of program sizes.
cl::Program as_lines(const CycleJob& job, double tolerance_mm);

}  // namespace burin::job
