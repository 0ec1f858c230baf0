// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/scanner.h"

#include <charconv>
#include <cmath>

namespace burin::io::svg {
namespace {

std::size_t skip_digits(std::string_view text, std::size_t i) {
  while (i < text.size() && is_digit(text[i])) ++i;
  return i;
}

/// One past the number that starts at `from`, or `from` when none does.
std::size_t number_end(std::string_view text, std::size_t from) {
  std::size_t i = from;
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
  const std::size_t whole = i;
  i = skip_digits(text, i);
  std::size_t digits = i - whole;
  if (i < text.size() && text[i] == '.') {
    const std::size_t end = skip_digits(text, i + 1);
    digits += end - (i + 1);
    if (digits > 0) i = end;
  }
  if (digits == 0) return from;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    std::size_t exponent = i + 1;
    if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
    const std::size_t end = skip_digits(text, exponent);
    if (end > exponent) i = end;
  }
  return i;
}

}  // namespace

void Scanner::skip_blank() {
  while (!done() && is_blank(peek())) skip();
}

bool Scanner::skip_separator() {
  skip_blank();
  if (peek() != ',') return false;
  skip();
  skip_blank();
  return true;
}

std::optional<double> Scanner::number() {
  const std::size_t end = number_end(text_, position_);
  if (end == position_) return std::nullopt;
  std::string_view digits = text_.substr(position_, end - position_);
  if (digits.front() == '+') digits.remove_prefix(1);
  double value = 0;
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    // Too small reads as zero; too large is not a coordinate anybody means.
    const std::size_t e = digits.find_first_of("eE");
    if (e == std::string_view::npos || digits[e + 1] != '-') return std::nullopt;
    value = 0;
  } else if (error != std::errc{} || rest != digits.data() + digits.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  position_ = end;
  return value;
}

std::optional<bool> Scanner::flag() {
  if (peek() != '0' && peek() != '1') return std::nullopt;
  const bool value = peek() == '1';
  skip();
  return value;
}

std::string_view Scanner::word() {
  const std::size_t from = position_;
  while (!done() && is_letter(peek())) skip();
  return text_.substr(from, position_ - from);
}

}  // namespace burin::io::svg
