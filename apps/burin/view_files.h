// SPDX-License-Identifier: Apache-2.0
// Files of any kind that burin knows -> one scene for the viewer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burin/base/result.h"
#include "burin/job/verify_job.h"
#include "burin/view/scene.h"
#include "session.h"

namespace burin::cli {

struct ViewOptions {
  /// Of the check; design and path are found among the files.
  job::VerifyOptions check;
  std::string machine;  ///< name or file; "": none, or the job's
  std::string stock;    ///< "block", "cylinder", STL; "": the job's, or none
  bool verify = false;  ///< colour by deviation, list collisions
};

/// What the files are is told by their content. At most one tool path, any number of parts and drawings.
/// With a job, or when a check or stock is asked for, design and path are read as `burin verify` reads them.
Result<view::Scene> scene_of_files(const std::vector<std::string>& files, const ViewOptions& options,
                                   Session& session);

}  // namespace burin::cli
