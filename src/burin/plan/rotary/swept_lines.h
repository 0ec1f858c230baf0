// SPDX-License-Identifier: Apache-2.0
// Lines along X on a swept section.
#pragma once

#include <vector>

#include "burin/plan/rotary/patterns.h"
#include "burin/plan/rotary/sweep.h"

namespace burin::rotary::detail {

/// The ring at x, closed.
ContactPath ring_path(const Sweep& sweep, const std::vector<RingNode>& nodes, double x);

Result<PatternResult> swept_lines(const Sweep& sweep, const PatternOptions& options);

}  // namespace burin::rotary::detail
