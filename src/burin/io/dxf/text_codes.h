// SPDX-License-Identifier: Apache-2.0
// Names of a DXF as UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace burin::io::dxf {

/// UTF-8 stays as it is (R2007 and later). Other bytes are read as Windows-1252 when `code_page` says so or
/// is empty, else they become U+FFFD. "\U+XXXX" becomes the character.
std::string decode_text(std::string_view bytes, std::string_view code_page);

}  // namespace burin::io::dxf
