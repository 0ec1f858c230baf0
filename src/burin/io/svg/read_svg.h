// SPDX-License-Identifier: Apache-2.0
// SVG 1.1 / 2 -> Drawing. SUPPORT.md lists what is taken.
#pragma once

#include <string_view>

#include "burin/base/result.h"
#include "burin/io/drawing/drawing.h"

namespace burin::io {

/// Whole file content in. Errors: syntax (not XML, damaged path data; with line and column or element id),
/// range.
Result<Drawing> read_svg(std::string_view bytes, const ReadOptions& options, Diagnostics& diagnostics);

}  // namespace burin::io
