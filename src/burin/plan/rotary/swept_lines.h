// SPDX-License-Identifier: Apache-2.0
// Lines along X on a swept section.
#pragma once

#include "burin/plan/rotary/patterns.h"
#include "burin/plan/rotary/sweep.h"

namespace burin::rotary::detail {

Result<PatternResult> swept_lines(const Sweep& sweep, const PatternOptions& options);

}  // namespace burin::rotary::detail
