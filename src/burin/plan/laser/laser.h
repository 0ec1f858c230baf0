// SPDX-License-Identifier: Apache-2.0
// The laser planner as one call: drawing -> contours -> beam centre lines -> moves (Park & Ahn 2007).
#pragma once

#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/io/drawing/drawing.h"
#include "burin/plan/laser/contours.h"
#include "burin/plan/laser/options.h"
#include "burin/plan/laser/profile.h"
#include "burin/plan/laser/toolpath.h"

namespace burin::laser {

struct LaserJob {
  std::vector<Contour> contours;
  Profile profile;
  Toolpath toolpath;
};

/// Checks the options (usage errors say what would be accepted) and runs the three stages. `progress` may be
/// nullptr; when it asks for a stop the error is `usage` "stopped".
Result<LaserJob> plan_laser(const io::Drawing& drawing, const LaserOptions& options, Diagnostics& diagnostics,
                            ProgressSink* progress = nullptr);

}  // namespace burin::laser
