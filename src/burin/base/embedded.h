// SPDX-License-Identifier: Apache-2.0
// Data files that are part of the program (machines, dialects, the built-in kerf table): made by
// burin_embed().
#pragma once

#include <string_view>
#include <vector>

namespace burin::embedded {

struct File {
  std::string_view name;  // file name without folder, e.g. "linuxcnc.toml"
  std::string_view text;
};

}  // namespace burin::embedded
