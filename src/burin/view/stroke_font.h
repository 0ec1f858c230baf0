// SPDX-License-Identifier: Apache-2.0
// A font of strokes for pictures without a font library: ASCII, some Greek and signs. Private to view.
#pragma once

#include <string_view>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::view {

/// Height of capitals above the base line in the font's units; small letters are 10 high, descend by 4.
inline constexpr double kCapital = 14;
/// A capital's share of the em.
inline constexpr double kCapitalShare = 0.72;

struct GlyphRun {
  std::vector<std::vector<geom::Point2>> strokes;  ///< font units, y up, first base point at (0, 0)
  double width = 0;                                ///< advance of the whole, font units
};
/// Characters of the text; what is no UTF-8 becomes U+FFFD.
std::vector<char32_t> code_points(std::string_view text);

/// Characters the font has not are drawn as an empty box.
GlyphRun lay_text(std::string_view utf8);

}  // namespace burin::view
