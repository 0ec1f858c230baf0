// SPDX-License-Identifier: Apache-2.0
// Numbers and separators of the small languages inside SVG attributes (path data, transform lists, lengths).
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace burin::io::svg {

constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f';
}
constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
constexpr bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// Reads a text from left to right; a failed read leaves the position where it was.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  bool done() const { return position_ >= text_.size(); }
  char peek() const { return done() ? '\0' : text_[position_]; }
  void skip() { ++position_; }
  std::size_t position() const { return position_; }

  void skip_blank();
  /// Blanks with at most one comma in between; true when there was a comma.
  bool skip_separator();
  /// An SVG number: optional sign, digits with at most one point, optional exponent; ends where no digit can
  /// follow ("1.5.5-3" is 1.5, .5, -3; "1em" is 1). Nothing when there is none or it overflows.
  std::optional<double> number();
  /// An arc flag: one character, 0 or 1, which need not be separated from what follows.
  std::optional<bool> flag();
  /// Letters from here on.
  std::string_view word();

 private:
  std::string_view text_;
  std::size_t position_ = 0;
};

/// All numbers of a list separated by blanks or single commas; nothing when anything else is in it.
/// Stops with nothing beyond `max_count` numbers.
template <class Container>
bool read_numbers(std::string_view text, std::size_t max_count, Container& out) {
  Scanner scan(text);
  scan.skip_blank();
  while (!scan.done()) {
    const auto value = scan.number();
    if (!value || out.size() >= max_count) return false;
    out.push_back(*value);
    if (scan.skip_separator() && scan.done()) return false;
  }
  return true;
}

}  // namespace burin::io::svg
