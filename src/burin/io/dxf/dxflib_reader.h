// SPDX-License-Identifier: Apache-2.0
// Document -> Model through dxflib. The only part that touches dxflib.
#pragma once

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/io/dxf/document.h"
#include "burin/io/dxf/model.h"

namespace burin::io::dxf {

/// dxflib turns groups into fields; names, handles, lines, visibility and block structure come from the
/// records.
Result<Model> read_model(const Document& document, const std::string& file, Diagnostics& diagnostics);

}  // namespace burin::io::dxf
