// SPDX-License-Identifier: Apache-2.0
#include "burin/io/step/scan.h"

#include <algorithm>

namespace burin::io::step {

namespace {

/// The first word, over blanks and comments.
std::string_view beginning(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  while (!text.empty()) {
    if (text.starts_with("/*")) {
      const std::size_t end = text.find("*/", 2);
      if (end == std::string_view::npos) return {};
      text.remove_prefix(end + 2);
    } else if (text.front() == ' ' || text.front() == '\t' || text.front() == '\r' || text.front() == '\n') {
      text.remove_prefix(1);
    } else {
      return text;
    }
  }
  return {};
}

/// The first line has its section letter in column 73.
char section_letter(std::string_view text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  return line.size() >= 73 ? line[72] : '\0';
}

Error not_cad(ErrorCode code, std::string message, const std::string& file) {
  Where where;
  where.file = file;
  return {code, std::move(message), where};
}

}  // namespace

Result<FileKind> scan(std::string_view bytes, const std::string& file_name) {
  if (bytes.find_first_not_of(" \t\r\n") == std::string_view::npos)
    return not_cad(ErrorCode::syntax, "is empty (a STEP or IGES file)", file_name);
  if (bytes.starts_with("\x1f\x8b") || bytes.starts_with("PK\x03\x04"))
    return not_cad(ErrorCode::unsupported, "is compressed (an unpacked STEP or IGES file)", file_name);
  if (beginning(bytes).starts_with("ISO-10303-21")) {
    if (auto fine = scan_step(bytes, file_name); !fine) return fine.error();
    return FileKind::step;
  }
  const char letter = section_letter(bytes);
  if (letter == 'C' || letter == 'B')
    return not_cad(ErrorCode::unsupported,
                   letter == 'C' ? "is IGES in its compressed form (the ASCII form with 80-column lines)"
                                 : "is IGES in its binary form (the ASCII form with 80-column lines)",
                   file_name);
  if (letter == 'S' || letter == 'G') {
    if (auto fine = scan_iges(bytes, file_name); !fine) return fine.error();
    return FileKind::iges;
  }
  return not_cad(
      ErrorCode::syntax,
      "is neither STEP nor IGES (a STEP file begins with ISO-10303-21, an IGES file has an S in column 73)",
      file_name);
}

}  // namespace burin::io::step
