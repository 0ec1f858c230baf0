// SPDX-License-Identifier: Apache-2.0
// The job file of `burin orient` and `burin cspace` (TOML) and what it leads to. Nothing is printed or
// written here. mm, degrees in the file, radians in the types.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/job/file_source.h"
#include "burin/model/propeller.h"
#include "burin/model/tool.h"
#include "burin/plan/orient/orient.h"
#include "burin/plan/orient/to_cl.h"

namespace burin::job {

struct OrientSurface {
  std::string file;        ///< STEP or IGES
  std::vector<int> faces;  ///< only these are milled (all others of the file are obstacles); empty: all
  bool flip = false;       ///< the tool stands on the other side of the faces than the file says
};
struct OrientMesh {
  std::string file;
  bool flip = false;  ///< the triangles are clockwise seen from the tool
};
struct OrientJobFile {
  std::variant<OrientSurface, OrientMesh, model::PropellerData> part;
  std::vector<std::string> obstacles;
  std::string contacts;  ///< "": generated
  model::Mill mill;
  orient::OrientOptions options;
  std::string machine = "none";
};

/// Every key checked; errors with file, line, column and what would be accepted.
Result<OrientJobFile> read_orient_job(std::string_view toml, const std::string& file_name);

/// Paths of the job are relative to `folder`. The design's triangles lie within tolerance / 40 of its faces
/// (coarser, said as a message, when that takes too many); obstacles within tolerance / 4.
Result<orient::Part> load_orient_part(const OrientJobFile& job, const std::string& folder,
                                      const FileSource& read, Diagnostics& diagnostics);

}  // namespace burin::job
