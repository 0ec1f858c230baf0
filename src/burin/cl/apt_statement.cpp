// SPDX-License-Identifier: Apache-2.0
#include "burin/cl/apt_statement.h"

#include <algorithm>
#include <limits>

#include "burin/base/text.h"

namespace burin::cl {
namespace {

constexpr std::size_t kMaxStatement = 100'000;
constexpr std::string_view kBlank = " \t";

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

std::string upper(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](char c) { return upper(c); });
  return result;
}

std::string_view first_word(std::string_view line) {
  const std::size_t begin = std::min(line.find_first_not_of(kBlank), line.size());
  const std::size_t end = std::min(line.find_first_of(" \t/,$", begin), line.size());
  return line.substr(begin, end - begin);
}

/// Words whose rest of the line is text, as it stands: no continuation, no comment in it.
bool is_literal(std::string_view word) {
  const std::string name = upper(word);
  return name == "PARTNO" || name == "PPRINT" || name == "INSERT" || name == "REMARK";
}

int to_int(std::size_t value) {
  return static_cast<int>(std::min<std::size_t>(value, std::numeric_limits<int>::max()));
}

}  // namespace

bool AptParameter::is(std::string_view word) const {
  return std::equal(text.begin(), text.end(), word.begin(), word.end(),
                    [](char a, char b) { return upper(a) == b; });
}

std::string_view AptScanner::take_line() {
  const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
  const std::string_view line = text_.substr(at_, end - at_);
  at_ = end;
  if (at_ < text_.size()) at_ += text_.substr(at_, 2) == "\r\n" ? 2 : 1;
  if (line_ < std::numeric_limits<int>::max()) ++line_;
  return line;
}

Result<bool> AptScanner::next(AptStatement& statement) {
  while (at_ < text_.size()) {
    auto ok = join(statement);
    if (!ok) return ok;
    if (!*ok) continue;
    split(statement);
    return true;
  }
  return false;
}

/// One statement from as many lines as it has; false when there is nothing but comment.
Result<bool> AptScanner::join(AptStatement& statement) {
  statement = {};
  pieces_.clear();
  bool more = true;
  while (more && at_ < text_.size()) {
    std::string_view line = take_line();
    for (std::size_t i = 0; i < line.size(); ++i) {
      const auto byte = static_cast<unsigned char>(line[i]);
      if ((byte < 0x20 && byte != '\t') || byte == 0x7f)
        return Error{ErrorCode::syntax,
                     "a control character (printable text)",
                     {.line = line_, .column = to_int(i + 1)}};
    }
    more = false;
    if (!(pieces_.empty() && is_literal(first_word(line)))) {
      const std::size_t dollar = line.find('$');
      if (dollar != std::string_view::npos) {
        // A single $ continues the statement; what follows it is no part of it.
        more = line.substr(dollar, 2) != "$$";
        line = line.substr(0, dollar);
      }
    }
    const std::size_t begin = line.find_first_not_of(kBlank);
    if (begin != std::string_view::npos) {
      pieces_.push_back({statement.text.size(), line_, to_int(begin + 1)});
      statement.text += line.substr(begin);
    }
    if (statement.text.size() > kMaxStatement)
      return Error{ErrorCode::range,
                   "a statement of more than 100000 characters (shorter)",
                   {.line = line_, .column = 1}};
  }
  statement.unfinished = more;
  return !pieces_.empty();
}

AptParameter AptScanner::parameter(const AptStatement& statement, std::size_t begin, std::size_t end) const {
  const std::string_view whole = statement.text;
  std::size_t first = std::min(whole.find_first_not_of(kBlank, begin), end);
  AptParameter result;
  result.text = trim(whole.substr(first, end - first));
  const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), first,
                                      [](std::size_t at, const Piece& piece) { return at < piece.begin; });
  const Piece& piece = after == pieces_.begin() ? pieces_.front() : *std::prev(after);
  result.line = piece.line;
  result.column = to_int(static_cast<std::size_t>(piece.column) + (first - piece.begin));
  result.number = parse_double(result.text);
  return result;
}

void AptScanner::split(AptStatement& statement) const {
  statement.line = pieces_.front().line;
  statement.column = pieces_.front().column;
  const std::string_view word = first_word(statement.text);
  statement.word = upper(word);
  if (is_literal(word)) {
    // One blank or slash separates the word from its text.
    statement.literal = statement.text.substr(std::min(word.size() + 1, statement.text.size()));
    return;
  }
  statement.text.erase(statement.text.find_last_not_of(kBlank) + 1);
  std::size_t at = statement.text.find_first_not_of(kBlank, word.size());
  if (at == std::string::npos) return;
  if (statement.text[at] == '/') ++at;
  while (true) {
    const std::size_t comma = std::min(statement.text.find(',', at), statement.text.size());
    statement.parameters.push_back(parameter(statement, at, comma));
    if (comma == statement.text.size()) return;
    at = comma + 1;
  }
}

}  // namespace burin::cl
