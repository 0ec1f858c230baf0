// SPDX-License-Identifier: Apache-2.0
// The text of single words: numbers on the grid of a dialect, filled templates, comments a control can bear.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "burin/post/dialect.h"

namespace burin::post {

/// `value` in steps of 10^-decimals, rounded half away from zero. Precondition: fits (the emitter checks the
/// limit).
std::int64_t to_grid(double value, int decimals);
double from_grid(std::int64_t steps, int decimals);
/// Exactly that decimal, without trailing zeros; with `point` always with a point ("1.").
std::string grid_text(std::int64_t steps, int decimals, bool point);
/// A number rounded to `decimals`.
std::string number_text(double value, int decimals, bool point);
/// `text` with {key} replaced.
std::string fill(std::string text, std::string_view key, std::string_view value);
/// `text` as it may stand inside a comment of this dialect, at most `limit` characters: no bracket that ends
/// it, no byte that is not printable ASCII, nothing the control would act on.
std::string comment_text(std::string_view text, const Dialect& dialect, std::size_t limit);

}  // namespace burin::post
