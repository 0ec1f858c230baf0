// SPDX-License-Identifier: Apache-2.0
// The tag stream of an ASCII DXF: pairs of a group-code line and a value line, checked before anything else
// reads them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"

namespace burin::io::dxf {

/// One pair of lines. `line` is that of the group code; `value` points into the scanned bytes, without line
/// end.
struct Tag {
  int code = 0;
  int line = 0;
  std::string_view value;

  int value_line() const { return line + 1; }
};

/// Splits and checks: text at all (no binary DXF, DWG, UTF-16, NUL), integer group codes, sections balanced,
/// EOF there. Comments, extended data (codes from 1000), application groups (102 {...}) and the content of
/// sections without drawing data (OBJECTS, CLASSES, ...) are checked and dropped. Groups between two
/// sections, which some writers leave there, are skipped and reported ("stray_groups"). The EOF tag is not
/// part of the result. Errors (syntax) carry the line.
Result<std::vector<Tag>> scan_tags(std::string_view bytes, const std::string& file, Diagnostics& diagnostics);

/// Number in a tag; nothing when it is not a finite number of plausible size (at most kLargestNumber).
inline constexpr double kLargestNumber = 1e15;  // a coordinate beyond keeps no decimals in a double
std::optional<double> real_value(const Tag& tag);
/// Integer in a tag, also written like "1.0"; nothing when it does not fit 32 bits.
std::optional<int> int_value(const Tag& tag);

/// Syntax error at a line of the file.
Error syntax_error(const std::string& file, int line, std::string message);
/// A value as it can stand in a message: short, printable.
std::string quoted(std::string_view value);

}  // namespace burin::io::dxf
