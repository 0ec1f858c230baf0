// SPDX-License-Identifier: Apache-2.0
// A tool path from a file of any origin: APT CL data or a part program, told by content. mm.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/kinematics/kinematics.h"

namespace burin::job {

struct ProgramFile {
  cl::Program program;
  bool is_nc = false;
  /// NC of a machine with rotary axes: by motion; tip_straight: under G43.4.
  std::vector<kinematics::Joints> joints;
  std::vector<bool> tip_straight;
  std::vector<bool> unknown;  ///< NC: by motion, where it ends is the machine's
  /// Tools that comments describe as some CAM systems write them: "(T1 D=6. CR=3. - ...)".
  std::map<int, cl::ToolChange> described;
};
/// `machine`: with rotary axes, else nullptr. Errors: of the readers, with file, line and column; a program
/// of another kind (syntax, says which); one that moves nothing (geometry). `beam`: S, M3 and M4 of NC are a
/// beam.
Result<ProgramFile> read_program(std::string_view text, const std::string& file_name,
                                 const kinematics::Kinematics* machine, Diagnostics& diagnostics,
                                 bool beam = false);

}  // namespace burin::job
