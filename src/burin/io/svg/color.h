// SPDX-License-Identifier: Apache-2.0
// CSS colours.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace burin::io::svg {

/// 0xRRGGBB of a name, #rgb, #rgba, #rrggbb, #rrggbbaa, rgb(), rgba(), hsl() or hsla(); opacity is not
/// considered. Nothing for "none", "currentColor", url() and what is no colour.
std::optional<std::uint32_t> parse_color(std::string_view text);

}  // namespace burin::io::svg
