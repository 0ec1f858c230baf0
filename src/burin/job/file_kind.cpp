// SPDX-License-Identifier: Apache-2.0
#include "burin/job/file_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string>
#include <utility>

#include "burin/base/text.h"

namespace burin::job {
namespace {

/// So much of a file is looked at, and so many of its lines that say something.
constexpr std::size_t kBeginning = 65'536;
constexpr int kLines = 200;

bool begins(std::string_view text, std::string_view with) {
  return text.substr(0, with.size()) == with;
}

/// The next line without blanks around, comments of TOML and `$$` remarks of APT left out; false at the end.
bool next_line(std::string_view& text, std::string_view& line) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    line = trim(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!line.empty() && line.front() != '#' && !begins(line, "$$")) return true;
  }
  return false;
}

/// A word of APT before '/' or alone on its line. NC words are one letter and a number.
bool is_apt_line(std::string_view line) {
  constexpr std::array kAlone{"RAPID", "FINI", "END", "PARTNO", "PPRINT", "REMARK", "STOP"};
  std::size_t letters = 0;
  while (letters < line.size() && std::isalpha(static_cast<unsigned char>(line[letters]))) ++letters;
  if (letters < 2) return false;
  const std::string word = to_lower(line.substr(0, letters));
  for (const char* alone : kAlone)
    if (word == to_lower(alone)) return true;
  const std::string_view rest = trim(line.substr(letters));
  return !rest.empty() && rest.front() == '/' && letters <= 8;
}

/// A letter and a number, a comment, or the sign of a tape.
bool is_nc_line(std::string_view line) {
  if (line.front() == '%' || line.front() == '(' || line.front() == ';' || line.front() == '/') return true;
  if (!std::isalpha(static_cast<unsigned char>(line.front())) || line.size() < 2) return false;
  const std::string_view number = trim(line.substr(1));
  return !number.empty() && std::string_view("+-.0123456789").find(number.front()) != std::string_view::npos;
}

FileKind kind_of_lines(std::string_view text) {
  std::string_view line;
  int apt = 0, nc = 0;
  for (int i = 0; i < kLines && next_line(text, line); ++i) {
    if (line.front() == '[') return apt || nc ? FileKind::unknown : FileKind::job;
    if (is_apt_line(line))
      ++apt;
    else if (is_nc_line(line))
      ++nc;
  }
  if (apt == 0 && nc == 0) return FileKind::unknown;
  return apt >= nc ? FileKind::cl : FileKind::nc;
}

FileKind kind_of_text(std::string_view text) {
  if (begins(text, "\xef\xbb\xbf")) text.remove_prefix(3);
  std::string_view rest = text, line;
  if (!next_line(rest, line)) return FileKind::unknown;
  if (begins(line, "ISO-10303-21")) return FileKind::step;
  if (begins(line, "<?xml") || begins(line, "<svg") || begins(line, "<!"))
    return text.find("<svg") != std::string_view::npos ? FileKind::svg : FileKind::unknown;
  if (line.front() == '{') return FileKind::json;
  if (begins(line, "solid") && text.find("facet") != std::string_view::npos) return FileKind::stl;
  std::string_view after;
  if ((line == "0" || line == "999") && next_line(rest, after) &&
      (line == "999" || after == "SECTION" || after == "EOF"))
    return FileKind::dxf;
  if (begins(to_lower(line), "x,y,z")) return FileKind::csv;
  return kind_of_lines(text);
}

/// Records of IGES are 80 wide, the letter of the section in column 73.
bool is_iges(std::string_view text) {
  return text.size() > 80 && (text[72] == 'S' || text[72] == 'F') &&
         text.substr(73, 7).find('1') != std::string_view::npos && (text[80] == '\n' || text[80] == '\r');
}

/// A count of triangles that the file holds.
bool is_binary_stl(std::string_view bytes) {
  if (bytes.size() < 84) return false;
  std::size_t count = 0;
  for (std::size_t k = 0; k < 4; ++k)
    count |= static_cast<std::size_t>(static_cast<unsigned char>(bytes[80 + k])) << 8 * k;
  return count > 0 && bytes.size() >= 84 + 50 * count && bytes.size() < 84 + 50 * (count + 1);
}

FileKind kind_of_name(std::string_view name) {
  static constexpr std::array<std::pair<const char*, FileKind>, 19> kEndings{{
      {".cl", FileKind::cl},     {".apt", FileKind::cl},    {".cls", FileKind::cl},
      {".nc", FileKind::nc},     {".ngc", FileKind::nc},    {".gcode", FileKind::nc},
      {".tap", FileKind::nc},    {".cnc", FileKind::nc},    {".toml", FileKind::job},
      {".step", FileKind::step}, {".stp", FileKind::step},  {".iges", FileKind::iges},
      {".igs", FileKind::iges},  {".stl", FileKind::stl},   {".dxf", FileKind::dxf},
      {".svg", FileKind::svg},   {".json", FileKind::json}, {".csv", FileKind::csv},
      {".aptcl", FileKind::cl},
  }};
  const std::string ending = to_lower(std::filesystem::path(name).extension().string());
  for (const auto& [known, kind] : kEndings)
    if (ending == known) return kind;
  return FileKind::unknown;
}

}  // namespace

FileKind kind_of_file(std::string_view bytes, std::string_view name) {
  if (is_binary_stl(bytes)) return FileKind::stl;
  const std::string_view beginning = bytes.substr(0, kBeginning);
  if (begins(beginning, "AutoCAD Binary DXF")) return FileKind::dxf;
  if (is_iges(beginning)) return FileKind::iges;
  const FileKind kind = kind_of_text(beginning);
  return kind == FileKind::unknown ? kind_of_name(name) : kind;
}

std::string_view describe(FileKind kind) {
  switch (kind) {
    case FileKind::cl:
      return "CL data";
    case FileKind::nc:
      return "an NC program";
    case FileKind::job:
      return "a job file";
    case FileKind::step:
      return "a STEP file";
    case FileKind::iges:
      return "an IGES file";
    case FileKind::stl:
      return "an STL file";
    case FileKind::dxf:
      return "a DXF drawing";
    case FileKind::svg:
      return "an SVG drawing";
    case FileKind::json:
      return "a JSON report";
    case FileKind::csv:
      return "a table of points";
    case FileKind::unknown:
      break;
  }
  return "of no known kind";
}

}  // namespace burin::job
