// SPDX-License-Identifier: Apache-2.0
// Plain tables on standard output.
#pragma once

#include <string>
#include <vector>

namespace burin::cli {

/// Lines of columns, each as wide as its widest cell; the first line is the heading.
std::string table(const std::vector<std::vector<std::string>>& rows);

}  // namespace burin::cli
