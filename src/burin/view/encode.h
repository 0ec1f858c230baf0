// SPDX-License-Identifier: Apache-2.0
// Numbers as text for pages: base64 of little-endian arrays; text that cannot leave the element it stands in.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace burin::view {

std::string base64(const std::vector<std::uint8_t>& bytes);
/// Little-endian, whatever the machine's order.
std::string base64(const std::vector<float>& values);
std::string base64(const std::vector<std::uint32_t>& values);
std::string base64(const std::vector<std::int32_t>& values);
std::string base64(const std::vector<std::uint16_t>& values);
std::string base64(const std::vector<std::int16_t>& values);
std::string base64(const std::vector<std::int8_t>& values);

/// For the content of an HTML element and for quoted attributes. Control characters other than newline and
/// tab are left out.
std::string html_text(std::string_view text);

/// JSON that may stand in a script element: every '<' becomes \u003c.
std::string script_safe(std::string_view json);

/// Every "@NAME@" of the template replaced by its value, in one pass: values are never searched. Unknown
/// names stay as they are.
std::string fill_template(std::string_view page,
                          const std::vector<std::pair<std::string_view, std::string_view>>& values);

}  // namespace burin::view
