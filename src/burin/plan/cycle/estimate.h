// SPDX-License-Identifier: Apache-2.0
// What a plan will be like, before it is made: a grid of places instead of the cusps of all paths.
#pragma once

#include "burin/plan/cycle/cycle.h"
#include "burin/plan/cycle/passes.h"
#include "burin/plan/cycle/trim.h"

namespace burin::cycle {

struct Estimate {
  double paths = 0;
  double length = 0;  ///< of the paths, mm
};

/// Paths and their length, from the curvature on a grid: within some ten per cent where the surface changes
/// slowly between the places of the grid; what lies between them only adds to I1.
Estimate estimate(const Sheet& sheet, const PassTask& task, const Region& region, Method method);

/// Says at once what would be found out after all paths were made: too many paths, or too many nodes.
Result<void> check_size(const Sheet& sheet, const PassTask& task, const Estimate& estimate);

}  // namespace burin::cycle
