// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "burin/base/text.h"
#include "burin/nc/program.h"

namespace burin::nc {
namespace {

// Longer numbers than this are no numbers of a part program; the limit keeps the copy below on the stack.
constexpr std::size_t kMaxDigits = 60;

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}
bool is_control(char c) {
  return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f;
}

std::string quoted(char c) {
  if (static_cast<unsigned char>(c) > 0x20 && static_cast<unsigned char>(c) < 0x7f)
    return std::string("'") + c + "'";
  constexpr std::string_view kHex = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  return std::string("the byte 0x") + kHex[byte >> 4] + kHex[byte & 15];
}

/// A run of letters and digits as it stands, to name it in a message.
std::string word_at(std::string_view line, std::size_t at) {
  std::string word;
  while (at < line.size() && word.size() < 20 && (is_letter(line[at]) || is_digit(line[at])))
    word += upper(line[at++]);
  return word;
}

bool starts_with_letters(std::string_view line, std::size_t at, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    if (at + i >= line.size() || !is_letter(line[at + i])) return false;
  return true;
}

std::size_t skip_blanks(std::string_view line, std::size_t at) {
  while (at < line.size() && is_blank(line[at])) ++at;
  return at;
}

struct Failure {
  ErrorCode code;
  std::string message;
  std::size_t at;
};

/// A number from `at` on; blanks inside are skipped as controls do ("X 1 2.5" is X12.5). Moves `at` behind
/// it.
std::optional<Failure> read_number(std::string_view line, std::size_t& at, char letter, Word& word) {
  std::array<char, kMaxDigits> text;
  std::size_t size = 0;
  bool digits = false;
  std::size_t i = skip_blanks(line, at), end = at;
  const std::size_t begin = i;
  for (; i < line.size(); ++i) {
    const char c = line[i];
    if (is_blank(c)) continue;
    if (c == '+' || c == '-') {
      if (size != 0) break;
    } else if (c == '.') {
      if (word.has_point) break;
      word.has_point = true;
    } else if (is_digit(c)) {
      digits = true;
    } else {
      break;
    }
    if (size == text.size())
      return Failure{ErrorCode::range, "a number of more than 60 characters (fewer)", begin};
    text[size++] = c;
    end = i + 1;
  }
  if (!digits) {
    const char found = begin < line.size() ? line[begin] : '\0';
    if (found == '[' || found == '#')
      return Failure{ErrorCode::unsupported, "expressions and variables are not read (numbers only)", begin};
    return Failure{ErrorCode::syntax,
                   std::string("the letter ") + letter + " without a number (such as " + letter + "12.5)",
                   at - 1};
  }
  const auto value = parse_double({text.data(), size});
  if (!value) return Failure{ErrorCode::syntax, "not a number (a decimal such as -12.5)", begin};
  word.value = *value;
  at = end;
  return std::nullopt;
}

/// Why a character that begins no word is not read.
Failure unexpected(std::string_view line, std::size_t at) {
  const char c = line[at];
  if (c == '#' || c == '[' || c == ']' || c == '=')
    return {ErrorCode::unsupported, "expressions and variables are not read (numbers only)", at};
  if (c == ',')
    return {ErrorCode::unsupported, "words with a comma, such as ,R or ,C, are not read (plain words)", at};
  if (is_digit(c) || c == '.' || c == '+' || c == '-') {
    if (line.find("PGM") != std::string_view::npos || line.find("BLK FORM") != std::string_view::npos)
      return {ErrorCode::unsupported, "conversational programs (Heidenhain) are not read (ISO 6983 words)",
              at};
    return {ErrorCode::syntax, "a number without its letter (a word such as X12.5)", at};
  }
  if (is_control(c))
    return {ErrorCode::syntax, "a control character, " + quoted(c) + " (printable text)", at};
  return {ErrorCode::syntax,
          "unexpected " + quoted(c) + " (words such as G1 X12.5, comments in ( ) or after ;)", at};
}

/// Control flow in words of letters: LinuxCNC's O-words, Fanuc's macro statements.
std::optional<Failure> control_flow(std::string_view line, std::size_t at) {
  static constexpr std::array<std::string_view, 8> kMacro = {"IF",  "GOTO", "WHILE", "DO",
                                                             "END", "THEN", "CALL",  "SUB"};
  if (!starts_with_letters(line, at, 2)) return std::nullopt;
  std::string word;
  for (std::size_t i = at; i < line.size() && is_letter(line[i]) && word.size() < 20; ++i)
    word += upper(line[i]);
  if (std::find(kMacro.begin(), kMacro.end(), word) == kMacro.end()) return std::nullopt;
  return Failure{ErrorCode::unsupported, "control flow (" + word + ") is not read (plain motion programs)",
                 at};
}

/// An O word: a program number, or LinuxCNC's control flow, which is refused.
std::optional<Failure> check_o_word(std::string_view line, std::size_t letter, std::size_t behind) {
  const std::size_t next = skip_blanks(line, behind);
  if (starts_with_letters(line, next, 2))
    return Failure{
        ErrorCode::unsupported,
        "O-word control flow (" + word_at(line, next) + ") is not read (a program number such as O1000)",
        letter};
  return std::nullopt;
}

/// Takes the comment that begins at `at`; moves `at` behind it.
std::optional<Failure> read_comment(std::string_view line, std::size_t& at, Block& block) {
  std::string& comment = block.comment;
  const std::size_t begin = at;
  std::size_t end = line.size(), behind = line.size();
  if (line[at] == '(') {
    end = line.find(')', at);
    if (end == std::string_view::npos)
      return Failure{ErrorCode::syntax, "a comment that is not closed ( ')' on the same line)", begin};
    behind = end + 1;
  }
  std::string_view text = line.substr(begin + 1, end - begin - 1);
  for (std::size_t i = 0; i < text.size(); ++i)
    if (is_control(text[i]))
      return Failure{ErrorCode::syntax,
                     "a control character in a comment, " + quoted(text[i]) + " (printable text)",
                     begin + 1 + i};
  const std::size_t blanks = std::min(text.find_first_not_of(" \t"), text.size());
  text = trim(text);
  if (!text.empty()) {
    if (comment.empty())
      block.comment_column =
          static_cast<int>(std::min<std::size_t>(begin + blanks + 2, std::numeric_limits<int>::max()));
    else
      comment += ' ';
    comment += text;
    std::replace(comment.begin(), comment.end(), '\t', ' ');
  }
  at = behind;
  return std::nullopt;
}

std::optional<Failure> read_word(std::string_view line, std::size_t& at, Block& block) {
  if (auto failure = control_flow(line, at)) return failure;
  const std::size_t letter = at;
  Word word;
  word.letter = upper(line[at]);
  word.column = static_cast<int>(std::min<std::size_t>(at + 1, std::numeric_limits<int>::max()));
  ++at;
  if (word.letter == 'O' && skip_blanks(line, at) < line.size() && line[skip_blanks(line, at)] == '<')
    return Failure{ErrorCode::unsupported, "O-word control flow is not read (a program number such as O1000)",
                   letter};
  if (auto failure = read_number(line, at, word.letter, word)) return failure;
  if (word.letter == 'O') {
    if (auto failure = check_o_word(line, letter, at)) return failure;
  }
  if (word.letter != 'N') {
    block.words.push_back(word);
    return std::nullopt;
  }
  if (block.number) return Failure{ErrorCode::syntax, "two N words in one block (one)", letter};
  if (word.value < 0 || word.value > 999'999'999 || word.value != std::floor(word.value))
    return Failure{ErrorCode::range, "a block number that is no integer from 0 to 999999999 (such as N100)",
                   letter};
  block.number = static_cast<int>(word.value);
  return std::nullopt;
}

std::optional<Failure> read_line(std::string_view line, Block& block) {
  std::size_t at = skip_blanks(line, 0);
  if (at < line.size() && line[at] == '%') {
    block.percent = true;
    ++at;
  } else if (at < line.size() && line[at] == '/') {
    block.skip = true;
    at = skip_blanks(line, at + 1);
    if (at < line.size() && line[at] >= '1' && line[at] <= '9') ++at;  // "/2": one of several skip switches
  }
  while ((at = skip_blanks(line, at)) < line.size()) {
    std::optional<Failure> failure;
    const char c = line[at];
    if (c == '(' || c == ';') {
      failure = read_comment(line, at, block);
    } else if (is_letter(c)) {
      failure = read_word(line, at, block);
    } else {
      failure = unexpected(line, at);
    }
    if (failure) return failure;
  }
  return std::nullopt;
}

}  // namespace

int Word::code() const {
  constexpr double kExact = 1e-6;  // far below the second decimal, far above the rounding of value * 100
  if (!(value >= 0 && value <= 9999)) return -1;
  const double hundredths = std::round(value * 100);
  return std::abs(value * 100 - hundredths) <= kExact ? static_cast<int>(hundredths) : -1;
}

const Word* Block::find(char letter) const {
  for (const Word& word : words)
    if (word.letter == letter) return &word;
  return nullptr;
}

Lexer::Lexer(std::string_view text, LexOptions options) : text_(text), options_(std::move(options)) {
  if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;  // UTF-8 byte order mark
}

Result<bool> Lexer::next(Block& block) {
  while (at_ < text_.size()) {
    const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    const std::string_view line = text_.substr(at_, end - at_);
    at_ = end;
    if (at_ < text_.size()) at_ += text_.substr(at_, 2) == "\r\n" ? 2 : 1;
    if (line_ == std::numeric_limits<int>::max())
      return Error{ErrorCode::range, "too many lines", {.file = options_.file_name}};
    ++line_;
    block.line = line_;
    block.number.reset();
    block.skip = block.percent = false;
    block.words.clear();
    block.comment.clear();
    block.comment_column = 0;
    if (const auto failure = read_line(line, block)) {
      const auto column =
          static_cast<int>(std::min<std::size_t>(failure->at + 1, std::numeric_limits<int>::max()));
      return Error{
          failure->code, failure->message, {.file = options_.file_name, .line = line_, .column = column}};
    }
    if (block.words.empty() && block.comment.empty() && !block.percent && !block.number) continue;
    if (++blocks_ > options_.max_blocks)
      return Error{ErrorCode::range,
                   "more than " + std::to_string(options_.max_blocks) + " blocks (split the program)",
                   {.file = options_.file_name, .line = line_}};
    return true;
  }
  return false;
}

Result<std::vector<Block>> lex(std::string_view text, const LexOptions& options) {
  Lexer lexer(text, options);
  std::vector<Block> blocks;
  Block block;
  while (true) {
    auto more = lexer.next(block);
    if (!more) return std::move(more).error();
    if (!*more) return blocks;
    blocks.push_back(block);
  }
}

}  // namespace burin::nc
