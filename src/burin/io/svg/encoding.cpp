// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/encoding.h"

#include <algorithm>
#include <cstdint>

#include "burin/base/text.h"
#include "burin/base/utf8.h"

namespace burin::io::svg {
namespace {

std::string from_latin1(std::string_view bytes) {
  std::string out;
  out.reserve(bytes.size() + bytes.size() / 8);
  for (const char c : bytes) append_utf8(out, static_cast<unsigned char>(c));
  return out;
}

std::string from_utf16(std::string_view bytes, bool big_endian) {
  const auto unit_at = [&](std::size_t i) {
    const auto a = static_cast<unsigned char>(bytes[i]), b = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<std::uint32_t>(big_endian ? (a << 8) | b : (b << 8) | a);
  };
  std::string out;
  out.reserve(bytes.size());
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t c = unit_at(i);
    if (c >= 0xD800 && c < 0xDC00 && i + 3 < bytes.size()) {
      const std::uint32_t low = unit_at(i + 2);
      if (low >= 0xDC00 && low < 0xE000) {
        c = 0x10000 + ((c - 0xD800) << 10) + (low - 0xDC00);
        i += 2;
      }
    }
    append_utf8(out, c);  // half a pair becomes U+FFFD
  }
  return out;
}

bool declares_latin1(std::string_view bytes) {
  if (!bytes.starts_with("<?xml")) return false;
  const std::string declaration = to_lower(bytes.substr(0, bytes.substr(0, 400).find("?>")));
  return declaration.find("iso-8859-1") != std::string::npos ||
         declaration.find("latin1") != std::string::npos ||
         declaration.find("windows-1252") != std::string::npos;
}

int line_of(std::string_view text, std::size_t offset) {
  return 1 +
         static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
}

}  // namespace

Result<std::string> to_utf8(std::string_view bytes) {
  if (bytes.starts_with("\x1F\x8B")) {
    return Error{ErrorCode::unsupported,
                 "the file is compressed (svgz; decompress it first: an SVG text is accepted)",
                 {}};
  }
  std::string text;
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    text = from_utf16(bytes.substr(2), bytes[0] == '\xFE');
  } else if (bytes.size() >= 2 &&
             ((bytes[0] == '<' && bytes[1] == '\0') || (bytes[0] == '\0' && bytes[1] == '<'))) {
    text = from_utf16(bytes, bytes[0] == '\0');
  } else {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
    text = declares_latin1(bytes) || !is_utf8(bytes) ? from_latin1(bytes) : std::string(bytes);
  }
  if (const std::size_t nul = text.find('\0'); nul != std::string::npos) {
    return Error{ErrorCode::syntax,
                 "a NUL byte in the text (an SVG file is an XML text)",
                 {{}, line_of(text, nul), 0, {}}};
  }
  if (trim(text).empty())
    return Error{ErrorCode::syntax, "the file is empty (an SVG file has an <svg> element)", {}};
  return text;
}

}  // namespace burin::io::svg
