// SPDX-License-Identifier: Apache-2.0
// What a ball leaves of contacts that it does not touch.
#pragma once

#include <vector>

#include "burin/plan/rotary/center_path.h"

namespace burin::rotary::detail {

/// The largest distance of the contacts `left` from the ball swept along `before`, `places`, `after` (the
/// ends may be missing), 0 when the ball holds them all. Each is noted as excess_mm of the place nearest to
/// it.
double spread_excess(std::vector<Place>& places, const std::vector<Contact>& left, const Place* before,
                     const Place* after, double radius);

}  // namespace burin::rotary::detail
