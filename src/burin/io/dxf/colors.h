// SPDX-License-Identifier: Apache-2.0
// AutoCAD colour index -> RGB.
#pragma once

#include <cstdint>

namespace burin::io::dxf {

/// 0xRRGGBB of index 1..255. 7 is white or black depending on the background: black here, as on paper.
std::uint32_t indexed_color(int index);

}  // namespace burin::io::dxf
