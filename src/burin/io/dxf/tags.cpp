// SPDX-License-Identifier: Apache-2.0
#include "burin/io/dxf/tags.h"

#include <array>
#include <cmath>
#include <limits>

#include "burin/base/text.h"

namespace burin::io::dxf {
namespace {

constexpr int kSmallestCode = -5;  // -5..-1 are internal codes that some writers let out
constexpr int kLargestCode = 1071;
constexpr int kFirstExtendedDataCode = 1000;
constexpr int kComment = 999;

// Hands out lines; understands LF, CR LF and, in files without any LF, CR alone.
class LineReader {
 public:
  explicit LineReader(std::string_view bytes)
      : rest_(bytes), end_(bytes.find('\n') != std::string_view::npos ? '\n' : '\r') {}

  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const auto at = rest_.find(end_);
    line = rest_.substr(0, at);
    rest_.remove_prefix(at == std::string_view::npos ? rest_.size() : at + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number_;
    return true;
  }
  int number() const { return number_; }  // of the line handed out last, from 1

 private:
  std::string_view rest_;
  char end_;
  int number_ = 0;
};

bool is_blank(std::string_view text) {
  return trim(text).empty();
}

// What the file is, when it is visibly not an ASCII DXF.
std::optional<Error> recognise_foreign(std::string_view bytes, const std::string& file) {
  const std::string wanted = " (an ASCII DXF of R12 to R2018 is accepted)";
  if (is_blank(bytes)) return syntax_error(file, 1, "the file is empty" + wanted);
  if (bytes.starts_with("AutoCAD Binary DXF")) return syntax_error(file, 1, "binary DXF" + wanted);
  if (bytes.starts_with("AC10") && bytes.substr(0, 64).find('\0') != std::string_view::npos) {
    return syntax_error(file, 1, "this is a DWG file, not a DXF" + wanted);
  }
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    return syntax_error(file, 1, "the file is UTF-16 text" + wanted);
  }
  if (const auto nul = bytes.find('\0'); nul != std::string_view::npos) {
    int line = 1;
    for (const char c : bytes.substr(0, nul)) line += c == '\n' ? 1 : 0;
    return syntax_error(file, line, "NUL byte: not a text file, or damaged" + wanted);
  }
  return std::nullopt;
}

// Which tags of a section the reader needs.
bool has_drawing_data(std::string_view section) {
  constexpr std::array<std::string_view, 4> kNeeded = {"HEADER", "TABLES", "BLOCKS", "ENTITIES"};
  for (const auto name : kNeeded) {
    if (section == name) return true;
  }
  return false;
}

class Scanner {
 public:
  Scanner(std::string_view bytes, const std::string& file, Diagnostics& diagnostics)
      : lines_(bytes), file_(file), diagnostics_(diagnostics) {}

  Result<std::vector<Tag>> run() {
    Tag tag;
    while (true) {
      if (auto read = read_tag(tag); !read) return read.error();
      if (tag.code == kComment) continue;
      if (tag.code == 0 && tag.value == "EOF") break;
      if (auto checked = check_structure(tag); !checked) return checked.error();
      if (wanted(tag)) tags_.push_back(tag);
    }
    if (state_ != State::between) {
      return error(tag.line, "the file ends inside a section that began in line " +
                                 std::to_string(section_line_) + " (0/ENDSEC is missing)");
    }
    return std::move(tags_);
  }

 private:
  enum class State { between, name, inside };  // sections; `name`: 2/NAME must follow

  Error error(int line, std::string message) const { return syntax_error(file_, line, std::move(message)); }

  Result<void> read_tag(Tag& tag) {
    std::string_view code_text;
    if (!lines_.next(code_text)) {
      return error(lines_.number(), "the file is truncated: it ends without 0/EOF");
    }
    tag.line = lines_.number();
    const auto code = parse_integer(code_text);
    if (!code || *code < kSmallestCode || *code > kLargestCode) {
      if (tag.line == 1) {
        return error(1, "not a DXF file: " + quoted(code_text) +
                            " is no group code (an ASCII DXF of R12 to R2018 is accepted)");
      }
      return error(tag.line, "group code expected, found " + quoted(code_text) + " (an integer from " +
                                 std::to_string(kSmallestCode) + " to " + std::to_string(kLargestCode) + ")");
    }
    tag.code = static_cast<int>(*code);
    if (!lines_.next(tag.value)) {
      return error(tag.line, "the file is truncated: group " + std::to_string(tag.code) +
                                 " has no value and 0/EOF is missing");
    }
    if (tag.code == 0) tag.value = trim(tag.value);
    return {};
  }

  Result<void> check_structure(const Tag& tag) {
    switch (state_) {
      case State::between:
        if (any_section_ && tag.code != 0) {
          report_stray(tag);
          break;
        }
        if (tag.code != 0 || tag.value != "SECTION") {
          return error(tag.line,
                       std::string(any_section_ ? "outside of the sections: " : "not a DXF file: ") +
                           "group " + std::to_string(tag.code) + " with " + quoted(tag.value) +
                           " (0/SECTION or 0/EOF is expected)");
        }
        state_ = State::name;
        section_line_ = tag.line;
        any_section_ = true;
        break;
      case State::name:
        if (tag.code != 2) return error(tag.line, "the section has no name (group 2 is expected)");
        keep_ = has_drawing_data(trim(tag.value));
        state_ = State::inside;
        break;
      case State::inside:
        if (tag.code == 0 && tag.value == "SECTION") {
          return error(tag.line, "a section begins inside the one of line " + std::to_string(section_line_) +
                                     " (0/ENDSEC is missing)");
        }
        if (tag.code == 0 && tag.value == "ENDSEC") state_ = State::between;
        break;
    }
    return {};
  }

  void report_stray(const Tag& tag) {
    if (stray_reported_) return;
    stray_reported_ = true;
    Where where;
    where.file = file_;
    where.line = tag.line;
    diagnostics_.info("stray_groups",
                      "groups between two sections are skipped, first " + std::to_string(tag.code) +
                          " with " + quoted(tag.value),
                      std::move(where));
  }

  // Application groups (102 "{NAME" ... 102 "}") and all after 101 (embedded objects) hold codes with another
  // meaning.
  bool wanted(const Tag& tag) {
    if (tag.code != 0 && state_ == State::between) return false;
    if (tag.code == 0) {
      foreign_ = Foreign::none;
      return keep_ || tag.value == "SECTION" || tag.value == "ENDSEC";
    }
    if (state_ == State::inside && tag.code == 2 && !keep_ && tag.line == section_line_ + 2) return true;
    if (!keep_ || tag.code < 0 || tag.code >= kFirstExtendedDataCode) return false;
    if (foreign_ == Foreign::embedded) return false;
    if (tag.code == 101) foreign_ = Foreign::embedded;
    if (tag.code == 102) {
      foreign_ = trim(tag.value).starts_with('{') ? Foreign::application : Foreign::none;
      return false;
    }
    return foreign_ == Foreign::none;
  }

  enum class Foreign { none, application, embedded };

  LineReader lines_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  std::vector<Tag> tags_;
  State state_ = State::between;
  Foreign foreign_ = Foreign::none;
  bool keep_ = false;
  bool any_section_ = false;
  bool stray_reported_ = false;
  int section_line_ = 0;
};

}  // namespace

Error syntax_error(const std::string& file, int line, std::string message) {
  Where where;
  where.file = file;
  where.line = line;
  return {ErrorCode::syntax, std::move(message), std::move(where)};
}

std::string quoted(std::string_view value) {
  constexpr std::size_t kLongest = 40;
  std::string text = "'";
  for (const char c : trim(value).substr(0, kLongest)) text += c < ' ' || c > '~' ? '?' : c;
  if (trim(value).size() > kLongest) text += "...";
  return text + "'";
}

std::optional<double> real_value(const Tag& tag) {
  const auto value = parse_double(tag.value);
  return value && std::abs(*value) <= kLargestNumber ? value : std::nullopt;
}

std::optional<int> int_value(const Tag& tag) {
  const auto value = parse_double(tag.value);
  if (!value || *value != std::floor(*value)) return std::nullopt;
  if (*value < std::numeric_limits<int>::min() || *value > std::numeric_limits<int>::max())
    return std::nullopt;
  return static_cast<int>(*value);
}

Result<std::vector<Tag>> scan_tags(std::string_view bytes, const std::string& file,
                                   Diagnostics& diagnostics) {
  // More lines than an int counts; files are limited far below by what reads them.
  if (bytes.size() >= static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    Error error = syntax_error(file, 0, "the file is too large (less than 2 GiB is accepted)");
    error.code = ErrorCode::range;
    return error;
  }
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  if (auto foreign = recognise_foreign(bytes, file)) return *foreign;
  return Scanner(bytes, file, diagnostics).run();
}

}  // namespace burin::io::dxf
