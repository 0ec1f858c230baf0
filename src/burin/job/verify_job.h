// SPDX-License-Identifier: Apache-2.0
// `burin verify`: a design, a tool path and tools from any files -> one report. Nothing is printed or written
// here. mm. docs/verify.md
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/job/file_source.h"
#include "burin/job/verify_laser.h"
#include "burin/kinematics/kinematics.h"
#include "burin/removal/removal.h"
#include "burin/verify/beam_check.h"
#include "burin/verify/collisions.h"
#include "burin/verify/deviation.h"
#include "burin/verify/path.h"

namespace burin::job {

struct VerifyOptions {
  std::string
      design;        ///< JOB.toml (rotary, orient, or any with [part]), STEP, IGES, STL, DXF, SVG, surface NC
  std::string path;  ///< CL or NC, told by content
  std::optional<std::string> machine;  ///< else the job's; NC with rotary words needs one
  std::optional<double> tool_diameter, tool_corner, tool_length;  ///< else the job's, else CUTTER/
  std::optional<double> kerf_mm;                                  ///< laser
  LaserOutlineOptions laser;
  std::optional<std::string> stock;  ///< "block", "cylinder", STL; else [stock] of the job; else none
  std::optional<std::size_t> samples;
  std::optional<double> spacing_mm;
  double reach_mm = 5;
  std::optional<double> tolerance_mm;  ///< else the job's, else 0.01
  bool tcp = false;                    ///< poses of CL data run by tool-centre-point control (default)
  bool joints = false;                 ///< CL data posted to joint-linear moves of the machine
  double resolution_mm = 0;            ///< of the stock; 0: from its size
  bool keep_times = false;             ///< of the stock, for the viewer's clock
  unsigned threads = 0;
};

/// All that was read. Kept for the report and the viewer.
struct VerifyInput {
  std::string operation;  ///< "laser", "cycle", "rotary", "orient" or "" when only geometry is known
  cl::Program program;
  std::string program_text;
  bool program_is_nc = false;
  std::optional<kinematics::Kinematics> machine;
  std::vector<kinematics::Joints> joints;  ///< by motion; empty: poses
  std::vector<bool> tip_straight;          ///< the same, under G43.4
  geom::Mesh design, obstacles;
  std::vector<bool> machined;              ///< a triangle; empty: all
  std::vector<geom::Vec3> normals;         ///< a vertex of design; empty: of triangles
  double deflection_mm = 0;                ///< of the design's triangles
  std::vector<verify::Outline> outlines;   ///< laser
  std::vector<std::string> outline_names;  ///< what the drawing calls them
  double kerf_mm = 0;
  std::optional<removal::Stock> stock;
  double tolerance_mm = 0.01;
  verify::CheckedPath path;  ///< not for laser
};
Result<VerifyInput> read_verify_input(const VerifyOptions& options, const FileSource& read,
                                      Diagnostics& diagnostics, ProgressSink* progress);

/// `bound_mm` of the reports includes the deflection here.
struct VerifyResult {
  verify::SampledSurface surface;
  verify::DeviationReport deviation;
  verify::Histogram histogram;
  std::vector<verify::Collision> collisions;  ///< with part, obstacles and stock; by move
  std::optional<removal::Removal> removal;
  std::optional<verify::BeamReport> beam;
  double bound_mm = 0;
  bool clean() const;  ///< no collision and nothing unmachined
};
Result<VerifyResult> run_verify(const VerifyInput& input, const VerifyOptions& options,
                                Diagnostics& diagnostics, ProgressSink* progress);

}  // namespace burin::job
