// SPDX-License-Identifier: Apache-2.0
// Why a tool position is not allowed, in the order in which one is named when several hold.
#pragma once

#include <cstdint>

namespace burin::orient {

/// bound: the ranges of tilt and yaw themselves end there. none: allowed.
enum class Cause : std::uint8_t { none, gouge, collision, limit, bound };
/// "none", "gouge", "collision", "limit", "bound": the words of the CSV files.
const char* word(Cause cause);

}  // namespace burin::orient
