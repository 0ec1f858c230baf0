// SPDX-License-Identifier: Apache-2.0
// Length of a drawing unit.
#pragma once

#include <string>

#include "burin/io/drawing/drawing.h"
#include "burin/io/dxf/model.h"

namespace burin::io::dxf {

struct UnitChoice {
  double mm_per_unit = 1;
  std::string reason;   // Drawing::units_reason
  std::string warning;  // "" or what the user should know
};

/// The override, else $INSUNITS, else mm.
UnitChoice choose_units(const Model& model, Units override_units);

}  // namespace burin::io::dxf
