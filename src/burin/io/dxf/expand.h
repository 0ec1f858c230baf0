// SPDX-License-Identifier: Apache-2.0
// Model -> Drawing: blocks expanded, layers and colours resolved, what is hidden or without outline left
// aside.
#pragma once

#include "burin/base/result.h"
#include "burin/io/drawing/drawing.h"
#include "burin/io/dxf/model.h"
#include "burin/io/dxf/reporter.h"

namespace burin::io::dxf {

/// Errors: range (limits of `options` exceeded), syntax (a block that contains itself).
Result<Drawing> expand(const Model& model, double mm_per_unit, const ReadOptions& options,
                       Reporter& reporter);

}  // namespace burin::io::dxf
