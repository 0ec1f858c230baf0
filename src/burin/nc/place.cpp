// SPDX-License-Identifier: Apache-2.0
#include "burin/nc/place.h"

#include <cmath>

#include "burin/base/text.h"
#include "burin/nc/codes.h"
#include "burin/nc/modal.h"

namespace burin::nc {

std::string word_text(const Word& word) {
  if (word.letter == 'G' && word.code() >= 0) return code_name('G', word.code());
  const std::string shortest = format_shortest(word.value);
  const bool plain = shortest.find('e') == std::string::npos;
  return word.letter + (plain ? shortest : format_fixed(word.value, 12));
}

std::string coordinate_limit() {
  return format_fixed(kMaxCoordinate_mm, 0) + " mm";
}

Result<int> integer_word(const Source& source, const Block& block, const Word& word, int lo, int hi,
                         const std::string& what) {
  if (!(word.value >= lo && word.value <= hi) || word.value != std::floor(word.value))
    return source.error(ErrorCode::range,
                        word_text(word) + ": " + what + " (an integer from " + std::to_string(lo) + " to " +
                            std::to_string(hi) + ")",
                        place_of(block, word));
  return static_cast<int>(word.value);
}

Result<double> positive_word(const Source& source, const Block& block, const Word& word, double scale,
                             const std::string& what) {
  const double value = word.value * scale;
  if (!(value > 0 && value <= kMaxCoordinate_mm))
    return source.error(ErrorCode::range,
                        word_text(word) + ": " + what + " (above 0, at most " + coordinate_limit() + ")",
                        place_of(block, word));
  return value;
}

Result<void> check_knots(const Source& source, const std::vector<double>& knots,
                         const std::vector<Place>& places, int order, const std::string& of) {
  const auto k = static_cast<std::size_t>(order);
  const std::size_t count = knots.size() - k;  // of control points
  const auto name = [&](std::size_t i) { return "knot " + std::to_string(i + 1) + of; };
  const auto clamped = [&](std::size_t i, const char* which) {
    return source.error(ErrorCode::geometry,
                        name(i) + " differs: the " + which + " " + std::to_string(order) +
                            " knots must be equal (clamped, as many equal as the order)",
                        places[i]);
  };
  for (std::size_t i = 1; i < knots.size(); ++i) {
    if (knots[i] < knots[i - 1])
      return source.error(ErrorCode::geometry,
                          name(i) + " decreases, from " + format_shortest(knots[i - 1]) + " to " +
                              format_shortest(knots[i]) + " (each at least the one before)",
                          places[i]);
    if (i < k && knots[i] != knots[0]) return clamped(i, "first");
    if (i > count && knots[i] != knots[count]) return clamped(i, "last");
  }
  if (knots.front() == knots.back())
    return source.error(ErrorCode::geometry, "all knots" + of + " are equal (the last above the first)",
                        places.back());
  for (std::size_t i = k; i + 1 < knots.size(); ++i) {
    if (knots[i] == knots[i - k + 1])
      return source.error(ErrorCode::geometry,
                          name(i) + ", " + format_shortest(knots[i]) + ", stands there too often (at most " +
                              std::to_string(order - 1) + " times inside, " + std::to_string(order) +
                              " at the ends)",
                          places[i]);
  }
  return {};
}

}  // namespace burin::nc
