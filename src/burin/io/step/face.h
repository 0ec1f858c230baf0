// SPDX-License-Identifier: Apache-2.0
// One face of OpenCASCADE -> CadFace. Inside of this folder only.
#pragma once

#include <TopoDS_Face.hxx>

#include "burin/base/result.h"
#include "burin/io/step/read_step.h"

namespace burin::io::step {

/// Surface, orientation, kind and loops; number and name are the caller's. Error (geometry): why the face
/// cannot be had, as the end of a sentence; (range): nothing of it is wider than the trim tolerance. May
/// throw what OpenCASCADE throws.
Result<CadFace> convert_face(const TopoDS_Face& face, const ReadCadOptions& options);

}  // namespace burin::io::step
