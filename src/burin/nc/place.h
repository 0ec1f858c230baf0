// SPDX-License-Identifier: Apache-2.0
// Places in a program, and words that must be whole numbers or positive.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burin/base/result.h"
#include "burin/nc/program.h"

namespace burin::nc {

struct Place {
  int line = 0, column = 1;
};

/// Errors of one file.
struct Source {
  std::string file;

  Error error(ErrorCode code, std::string message, Place place) const {
    return {code, std::move(message), {.file = file, .line = place.line, .column = place.column}};
  }
};

inline Place place_of(const Block& block, const Word& word) {
  return {block.line, word.column};
}
/// Of its first word; column 1 when there is none.
inline Place place_of(const Block& block) {
  return {block.line, block.words.empty() ? 1 : block.words.front().column};
}

/// "X12.5", "G6.23": a word as it is named in messages.
std::string word_text(const Word& word);
/// "10000000 mm"
std::string coordinate_limit();

/// A whole number from `lo` to `hi`; `what` names it in the message.
Result<int> integer_word(const Source& source, const Block& block, const Word& word, int lo, int hi,
                         const std::string& what);
/// Above 0 after `scale`, and at most kMaxCoordinate_mm.
Result<double> positive_word(const Source& source, const Block& block, const Word& word, double scale,
                             const std::string& what);

/// The knots of `count` points of that order: as many as needed, never decreasing, clamped, inside at most
/// order - 1 times the same. `places` holds where each was read; `of` is "" or " of U". The count itself is
/// the caller's.
Result<void> check_knots(const Source& source, const std::vector<double>& knots,
                         const std::vector<Place>& places, int order, const std::string& of);

/// Control points that differ by less than this are one point: less than programs write. mm.
inline constexpr double kNoExtent_mm = 1e-6;

}  // namespace burin::nc
