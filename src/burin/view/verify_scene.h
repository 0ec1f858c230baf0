// SPDX-License-Identifier: Apache-2.0
// A verification as the viewer shows it: the part coloured by deviation, the path, what was found. mm.
#pragma once

#include <string>

#include "burin/base/diagnostics.h"
#include "burin/job/verify_job.h"
#include "burin/view/scene.h"

namespace burin::view {

struct VerifySceneOptions {
  std::string title, command_line, program_name;
  std::size_t stock_nodes = 1'500'000;   ///< of the clock, about
  std::size_t heat_triangles = 150'000;  ///< of the part, so that the heat map shows
};

/// `result` may be nothing: then only what was read is shown. `diagnostics` become findings. Errors: of
/// put_path.
Result<Scene> verify_scene(const job::VerifyInput& input, const job::VerifyResult* result,
                           const Diagnostics* diagnostics, const VerifySceneOptions& options);

/// Warnings as findings, the first of them.
void put_warnings(const Diagnostics& diagnostics, Scene& scene);

}  // namespace burin::view
