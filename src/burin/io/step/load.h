// SPDX-License-Identifier: Apache-2.0
// Bytes -> shape through the readers of OpenCASCADE, and what the rest needs of their sessions. Inside of
// this folder only.
#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <exception>
#include <functional>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/io/step/read_step.h"

namespace burin::io::step {

struct LoadedFace {
  TopoDS_Face face;
  std::string name;
  std::string entity;  ///< "face #12", "entity 144 D17"; "" when not known
  bool of_solid = false;
};

struct Loaded {
  TopoDS_Shape shape;
  std::vector<LoadedFace> faces;  ///< in the order of the shape
  std::string name, unit;
};

/// Runs `work` alone (OpenCASCADE keeps its settings in globals), with its printing off and its exceptions
/// turned into errors.
Result<void> with_occt(const ReadCadOptions& options, const std::function<Result<void>()>& work);

/// Everything that changes a result, whatever the program or the environment has set before. After the
/// controllers have been initialised.
void set_statics();

/// Inside of with_occt only. Errors as read_cad.
Result<Loaded> load(std::string_view bytes, const ReadCadOptions& options, Diagnostics& diagnostics);

}  // namespace burin::io::step
