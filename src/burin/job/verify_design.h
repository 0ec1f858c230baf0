// SPDX-License-Identifier: Apache-2.0
// The design of `burin verify` from any file: job, STEP, IGES, STL, surface program. Internal to job. mm.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/geom/mesh/mesh.h"
#include "burin/job/file_source.h"
#include "burin/job/verify_tables.h"

namespace burin::job {

struct VerifyDesign {
  std::string operation;  ///< "rotary", "orient", "cycle" or ""
  std::string folder;     ///< that paths are relative to
  geom::Mesh design, obstacles;
  double deflection_mm = 0;
  std::vector<JobTool> tools;
  std::map<int, cl::ToolChange> described;  ///< by the surface program; a diameter of 0: by two at once
  std::optional<double> tolerance_mm;
  std::string machine = "none";
  std::optional<StockTable> stock;
};

/// `tolerance_mm`: instead of the job's. Triangles leave the design by at most a twentieth of it, as far as
/// their number allows (what is coarser is said). Errors: of the readers.
Result<VerifyDesign> load_verify_design(const std::string& path, std::optional<double> tolerance_mm,
                                        const FileSource& read, Diagnostics& diagnostics);

/// An STL file as it is.
Result<geom::Mesh> load_stl(const std::string& path, const FileSource& read, Diagnostics& diagnostics);

}  // namespace burin::job
