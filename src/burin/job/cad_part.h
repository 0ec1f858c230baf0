// SPDX-License-Identifier: Apache-2.0
// A rotational part from the faces of a STEP or IGES file. mm.
#pragma once

#include <string>
#include <string_view>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/plan/rotary/part.h"

namespace burin::job {

/// Meshes of the faces within options.deflection_mm, sewn where neighbours meet. Errors of the reader and of
/// make_meshed.
Result<rotary::Part> part_from_cad(std::string_view bytes, const std::string& file_name,
                                   const rotary::PartOptions& options, Diagnostics& diagnostics);

}  // namespace burin::job
