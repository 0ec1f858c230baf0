// SPDX-License-Identifier: Apache-2.0
// Files of any kind that burin knows -> one scene for the viewer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burin/base/result.h"
#include "burin/view/scene.h"
#include "session.h"

namespace burin::cli {

struct ViewOptions {
  std::string machine;  ///< name or file; "": none, or the job's
  std::optional<double> kerf_mm;
};

/// What the files are is told by their content. At most one tool path, any number of parts and drawings.
Result<view::Scene> scene_of_files(const std::vector<std::string>& files, const ViewOptions& options,
                                   Session& session);

}  // namespace burin::cli
