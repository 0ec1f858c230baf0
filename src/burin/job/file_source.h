// SPDX-License-Identifier: Apache-2.0
// Where jobs get the content of the files they name.
#pragma once

#include <functional>
#include <string>

#include "burin/base/result.h"

namespace burin::job {

/// Content of a file; the application's (it keeps count of inputs).
using FileSource = std::function<Result<std::string>(const std::string& path)>;

}  // namespace burin::job
