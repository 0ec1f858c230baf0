// SPDX-License-Identifier: Apache-2.0
// The bytes of a file -> UTF-8, so that names in reports are always valid text.
#pragma once

#include <string>
#include <string_view>

#include "burin/base/result.h"

namespace burin::io::svg {

/// UTF-8 with or without a byte order mark, UTF-16 with one (or declared by its first bytes), ISO-8859-1 when
/// the XML declaration says so or the bytes are not UTF-8. Errors: unsupported (compressed), syntax (empty,
/// NUL bytes).
Result<std::string> to_utf8(std::string_view bytes);

}  // namespace burin::io::svg
