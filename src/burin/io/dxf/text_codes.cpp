// SPDX-License-Identifier: Apache-2.0
#include "burin/io/dxf/text_codes.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>

#include "burin/base/text.h"

namespace burin::io::dxf {
namespace {

constexpr std::uint32_t kReplacement = 0xFFFD;

void append_utf8(std::string& out, std::uint32_t c) {
  if ((c >= 0xD800 && c <= 0xDFFF) || c > 0x10FFFF || c < 0x20) c = kReplacement;
  const auto byte = [&](std::uint32_t b) { out += static_cast<char>(static_cast<unsigned char>(b)); };
  if (c < 0x80) {
    byte(c);
  } else if (c < 0x800) {
    byte(0xC0 | (c >> 6));
    byte(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    byte(0xE0 | (c >> 12));
    byte(0x80 | ((c >> 6) & 0x3F));
    byte(0x80 | (c & 0x3F));
  } else {
    byte(0xF0 | (c >> 18));
    byte(0x80 | ((c >> 12) & 0x3F));
    byte(0x80 | ((c >> 6) & 0x3F));
    byte(0x80 | (c & 0x3F));
  }
}

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

// Length of the UTF-8 character at the start, 0 when it is none.
std::size_t utf8_length(std::string_view text) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = at(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((at(i) & 0xC0) != 0x80) return 0;
  }
  const bool overlong = (first == 0xE0 && at(1) < 0xA0) || (first == 0xF0 && at(1) < 0x90);
  const bool surrogate = first == 0xED && at(1) > 0x9F;
  const bool beyond = first == 0xF4 && at(1) > 0x8F;
  return overlong || surrogate || beyond ? 0 : length;
}

}  // namespace

bool is_utf8(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t length = utf8_length(bytes);
    if (length == 0) return false;
    bytes.remove_prefix(length);
  }
  return true;
}

std::string decode_text(std::string_view bytes, std::string_view code_page) {
  const bool utf8 = is_utf8(bytes);
  const std::string page = to_lower(trim(code_page));
  const bool western = page.empty() || page == "ansi_1252";
  std::string out;
  out.reserve(bytes.size());
  for (std::size_t i = 0; i < bytes.size();) {
    if (const auto character = escaped(bytes.substr(i))) {
      append_utf8(out, *character);
      i += 7;
      continue;
    }
    const auto byte = static_cast<unsigned char>(bytes[i]);
    if (byte < 0x20) {
      append_utf8(out, kReplacement);
    } else if (byte < 0x80 || utf8) {
      out += bytes[i];
    } else {
      append_utf8(out, western ? windows_1252(byte) : kReplacement);
    }
    ++i;
  }
  return out;
}

}  // namespace burin::io::dxf
