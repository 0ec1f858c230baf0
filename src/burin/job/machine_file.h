// SPDX-License-Identifier: Apache-2.0
// The machine that a job or the command line names.
#pragma once

#include <optional>
#include <string>

#include "burin/base/result.h"
#include "burin/job/file_source.h"
#include "burin/kinematics/kinematics.h"

namespace burin::job {

/// A preset has no ending; a file NAME.toml is relative to `folder`; "none" is none. Errors: of the file, of
/// Kinematics::make.
Result<std::optional<kinematics::Kinematics>> load_machine(const std::string& name, const std::string& folder,
                                                           const FileSource& read);

}  // namespace burin::job
