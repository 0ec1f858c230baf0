// SPDX-License-Identifier: Apache-2.0
#include "burin/post/words.h"

#include <array>
#include <cmath>

#include "burin/base/text.h"

namespace burin::post {
namespace {

constexpr std::array<double, 13> kPower = {1.0, 1e1, 1e2, 1e3,  1e4,  1e5, 1e6,
                                           1e7, 1e8, 1e9, 1e10, 1e11, 1e12};

}  // namespace

std::int64_t to_grid(double value, int decimals) {
  return std::llround(value * kPower[static_cast<std::size_t>(decimals)]);
}

double from_grid(std::int64_t steps, int decimals) {
  return static_cast<double>(steps) / kPower[static_cast<std::size_t>(decimals)];
}

std::string grid_text(std::int64_t steps, int decimals, bool point) {
  const bool negative = steps < 0;
  std::string digits = std::to_string(negative ? -steps : steps);
  const auto places = static_cast<std::size_t>(decimals);
  if (digits.size() <= places) digits.insert(0, places + 1 - digits.size(), '0');
  std::string fraction = digits.substr(digits.size() - places);
  digits.resize(digits.size() - places);
  fraction.erase(fraction.find_last_not_of('0') + 1);
  if (negative) digits.insert(0, 1, '-');
  if (fraction.empty() && !point) return digits;
  return digits + '.' + fraction;
}

std::string number_text(double value, int decimals, bool point) {
  std::string text = format_fixed(value, decimals);
  if (point && text.find('.') == std::string::npos) text += '.';
  return text;
}

std::string fill(std::string text, std::string_view key, std::string_view value) {
  const std::string pattern = '{' + std::string(key) + '}';
  for (std::size_t at = text.find(pattern); at != std::string::npos;
       at = text.find(pattern, at + value.size()))
    text.replace(at, pattern.size(), value);
  return text;
}

std::string comment_text(std::string_view text, const Dialect& dialect, std::size_t limit) {
  std::string safe;
  for (const char c : trim(text)) {
    if (c == '(' || c == '[' || c == '{') {
      safe += '[';
    } else if (c == ')' || c == ']' || c == '}') {
      safe += ']';
    } else if (static_cast<unsigned char>(c) < 0x20) {
      safe += ' ';
    } else if (static_cast<unsigned char>(c) >= 0x7f) {
      safe += '_';
    } else {
      safe += dialect.comment_forbidden.find(c) == std::string::npos ? c : '.';
    }
  }
  std::string begin;
  for (std::size_t i = 0; i < safe.size() && safe[i] != ',' && safe[i] != ' '; ++i) begin += safe[i];
  begin = to_lower(begin);
  for (const std::string& word : dialect.active_comments)
    if (to_lower(word) == begin) safe.insert(0, "* ");
  if (safe.size() > limit) safe.resize(limit);
  return std::string(trim(safe));
}

}  // namespace burin::post
