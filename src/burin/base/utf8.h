// SPDX-License-Identifier: Apache-2.0
// Texts of files as UTF-8, so that names in reports are always valid text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace burin {

/// What stands for a character that cannot be had.
inline constexpr std::uint32_t kReplacementCharacter = 0xFFFD;

/// Surrogates and numbers beyond U+10FFFF, which are no characters, become U+FFFD.
void append_utf8(std::string& out, std::uint32_t character);

/// Whole and shortest encodings of characters only.
bool is_utf8(std::string_view bytes);

}  // namespace burin
