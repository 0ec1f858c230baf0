// SPDX-License-Identifier: Apache-2.0
// DXF R12 to R2018 ASCII -> Drawing, through dxflib (GPL) with checks of our own around it. SUPPORT.md lists
// what is taken.
#pragma once

#include <string_view>

#include "burin/base/result.h"
#include "burin/io/drawing/drawing.h"

namespace burin::io {

/// False when built with -DBURIN_DXF=OFF; read_dxf then returns an error (unsupported) that says so.
bool dxf_supported();

/// Whole file content in. Errors: syntax (truncated, binary, not DXF; with line), range (limits exceeded),
/// unsupported. Unsupported or ignored entities are counted in Drawing::ignored and reported in
/// `diagnostics`.
Result<Drawing> read_dxf(std::string_view bytes, const ReadOptions& options, Diagnostics& diagnostics);

}  // namespace burin::io
