// SPDX-License-Identifier: Apache-2.0
// Looks through the text of a STEP or IGES file before OpenCASCADE does: what kind it is, whether it is
// complete, whether references and counts hold. OpenCASCADE trusts such things. Inside of this folder only.
#pragma once

#include <string>
#include <string_view>

#include "burin/base/result.h"

namespace burin::io::step {

enum class FileKind { step, iges };

/// Error (syntax): neither of the two, or damaged, with the line; (unsupported): compressed forms.
Result<FileKind> scan(std::string_view bytes, const std::string& file_name);

/// ISO 10303-21: tokens, statements `#id = ... ;`, every reference defined, none in a circle.
Result<void> scan_step(std::string_view bytes, const std::string& file_name);
/// 80-column lines by section, the counts of the last line, directory entries against parameter data, and the
/// counts that entities declare against the values that follow.
Result<void> scan_iges(std::string_view bytes, const std::string& file_name);

}  // namespace burin::io::step
