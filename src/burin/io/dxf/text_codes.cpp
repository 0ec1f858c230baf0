// SPDX-License-Identifier: Apache-2.0
#include "burin/io/dxf/text_codes.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>

#include "burin/base/text.h"
#include "burin/base/utf8.h"

namespace burin::io::dxf {
namespace {

// Windows-1252 differs from Latin-1 only from 0x80 to 0x9F.
std::uint32_t windows_1252(unsigned char byte) {
  constexpr std::array<std::uint16_t, 32> kHigh = {
      0x20AC, 0xFFFD, 0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
      0x2039, 0x0152, 0xFFFD, 0x017D, 0xFFFD, 0xFFFD, 0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
      0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0xFFFD, 0x017E, 0x0178};
  return byte >= 0x80 && byte < 0xA0 ? kHigh[byte - 0x80u] : byte;
}

// The character of "\U+XXXX" at the start of the text.
std::optional<std::uint32_t> escaped(std::string_view text) {
  constexpr std::size_t kLength = 7;
  if (text.size() < kLength || !text.starts_with("\\U+")) return std::nullopt;
  std::uint32_t value = 0;
  const char* const last = text.data() + kLength;
  const auto [end, error] = std::from_chars(text.data() + 3, last, value, 16);
  return error == std::errc{} && end == last ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string decode_text(std::string_view bytes, std::string_view code_page) {
  const bool utf8 = is_utf8(bytes);
  const std::string page = to_lower(trim(code_page));
  const bool western = page.empty() || page == "ansi_1252";
  std::string out;
  out.reserve(bytes.size());
  for (std::size_t i = 0; i < bytes.size();) {
    if (const auto character = escaped(bytes.substr(i))) {
      append_utf8(out, *character < 0x20 ? kReplacementCharacter : *character);
      i += 7;
      continue;
    }
    const auto byte = static_cast<unsigned char>(bytes[i]);
    if (byte < 0x20) {
      append_utf8(out, kReplacementCharacter);
    } else if (byte < 0x80 || utf8) {
      out += bytes[i];
    } else {
      append_utf8(out, western ? windows_1252(byte) : kReplacementCharacter);
    }
    ++i;
  }
  return out;
}

}  // namespace burin::io::dxf
