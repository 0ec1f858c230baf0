// SPDX-License-Identifier: Apache-2.0
// Whole files in, whole files out: a reader that checks sizes first, and a writer that never leaves half a
// file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "burin/base/result.h"

namespace burin {

/// The bytes of a file. Errors (io): not there, not readable, a folder, or larger than `max_bytes`.
Result<std::string> read_file(const std::string& path, std::uint64_t max_bytes = 1ull << 30);

/// Writes to a temporary name in the same folder and renames: `path` holds the old or the new content, never
/// a part. On failure (io) nothing is left behind.
Result<void> write_file(const std::string& path, std::string_view content);

/// Lower-case hexadecimal SHA-256 (FIPS 180-4), for `inputs_sha256` of the JSON reports.
std::string sha256_hex(std::string_view bytes);

}  // namespace burin
