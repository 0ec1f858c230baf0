// SPDX-License-Identifier: Apache-2.0
// The text form of STL. Internal to io/stl.
#pragma once

#include <string_view>

#include "burin/base/result.h"
#include "burin/io/stl/stl_builder.h"

namespace burin::io::stl {

/// Feeds the triangles to `builder`. Returns the number of solids. Error: syntax, with the line.
Result<std::size_t> read_text(std::string_view text, Builder& builder);

}  // namespace burin::io::stl
