// SPDX-License-Identifier: Apache-2.0
#include "burin/view/encode.h"

#include <algorithm>
#include <bit>

namespace burin::view {
namespace {

template <class Unsigned>
void put(std::vector<std::uint8_t>& bytes, Unsigned value) {
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
    bytes.push_back(static_cast<std::uint8_t>((value >> (8 * i)) & 0xffu));
  }
}

template <class Unsigned, class Value>
std::string encoded(const std::vector<Value>& values) {
  static_assert(sizeof(Unsigned) == sizeof(Value));
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size() * sizeof(Value));
  for (const Value v : values) put(bytes, std::bit_cast<Unsigned>(v));
  return base64(bytes);
}

}  // namespace

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t have = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = (group << 8) | (k < have ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= have ? kDigits[(group >> (18 - 6 * k)) & 63u] : '=';
    }
  }
  return out;
}

std::string base64(const std::vector<float>& values) {
  return encoded<std::uint32_t>(values);
}
std::string base64(const std::vector<std::uint32_t>& values) {
  return encoded<std::uint32_t>(values);
}
std::string base64(const std::vector<std::int32_t>& values) {
  return encoded<std::uint32_t>(values);
}
std::string base64(const std::vector<std::uint16_t>& values) {
  return encoded<std::uint16_t>(values);
}
std::string base64(const std::vector<std::int16_t>& values) {
  return encoded<std::uint16_t>(values);
}
std::string base64(const std::vector<std::int8_t>& values) {
  return encoded<std::uint8_t>(values);
}

std::string html_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') out += c;
    }
  }
  return out;
}

std::string script_safe(std::string_view json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

std::string fill_template(std::string_view page,
                          const std::vector<std::pair<std::string_view, std::string_view>>& values) {
  std::string out;
  while (!page.empty()) {
    std::size_t first = page.size();
    const std::pair<std::string_view, std::string_view>* found = nullptr;
    for (const auto& v : values) {
      const std::size_t at = page.find(v.first);
      if (at < first) {
        first = at;
        found = &v;
      }
    }
    out += page.substr(0, first);
    if (!found) break;
    out += found->second;
    page.remove_prefix(first + found->first.size());
  }
  return out;
}

}  // namespace burin::view
