// SPDX-License-Identifier: Apache-2.0
// Small text helpers: numbers in and out without the locale, nearest word for "did you mean".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace burin {

/// Fixed-point decimal text, rounded half away from zero on the decimal value of `value`, trailing zeros and
/// a trailing point removed, never "-0". `decimals` 0..12.
std::string format_fixed(double value, int decimals);

/// The shortest text that reads back as the same double.
std::string format_shortest(double value);

/// A whole text as a finite number ("12", "-1.5", ".5", "1.e-3", with a leading '+'); surrounding blanks are
/// allowed. Nothing for anything else, including nan and inf.
std::optional<double> parse_double(std::string_view text);
std::optional<long long> parse_integer(std::string_view text);

/// The candidate with the smallest edit distance to `word`, or "" when none is near (more than a third
/// differs).
std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates);

std::string_view trim(std::string_view text);
std::string to_lower(std::string_view text);

}  // namespace burin
