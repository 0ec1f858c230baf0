// SPDX-License-Identifier: Apache-2.0
#include "burin/nc/trim_comment.h"

#include <algorithm>
#include <cmath>

#include "burin/base/text.h"

namespace burin::nc {
namespace {

constexpr std::string_view kMark = "BURIN TRIM";
// Rounding of written parameters may leave the domain by this part of its length.
constexpr double kOutsideDomain = 1e-9;
constexpr std::size_t kMaxLoopPoints = 1'000'000;
constexpr std::size_t kMaxLine = 110;  // of written comments

bool equal_letters(std::string_view a, std::string_view b) {
  return a.size() == b.size() && to_lower(a) == to_lower(b);
}

struct Piece {
  std::string_view text;
  std::size_t at;  // in the comment
};

/// Words between blanks, behind the mark.
std::vector<Piece> pieces(std::string_view comment) {
  std::vector<Piece> found;
  std::size_t at = kMark.size();
  while (true) {
    at = std::min(comment.find_first_not_of(" \t", at), comment.size());
    if (at == comment.size()) return found;
    const std::size_t end = std::min(comment.find_first_of(" \t", at), comment.size());
    found.push_back({comment.substr(at, end - at), at});
    at = end;
  }
}

Place place_in(const Block& block, std::size_t at) {
  return {block.line, block.comment_column + static_cast<int>(at)};
}

/// Within the domain; rounding outside of it is taken back.
std::optional<double> parameter(std::string_view text, geom::Interval domain) {
  const auto value = parse_double(text);
  const double slack = kOutsideDomain * domain.length();
  if (!value || !(*value >= domain.lo - slack && *value <= domain.hi + slack)) return std::nullopt;
  return std::clamp(*value, domain.lo, domain.hi);
}

}  // namespace

bool is_trim_comment(const Block& block) {
  const std::string_view comment = block.comment;
  return comment.size() >= kMark.size() && equal_letters(comment.substr(0, kMark.size()), kMark) &&
         (comment.size() == kMark.size() || comment[kMark.size()] == ' ');
}

Result<void> TrimReader::read(const Source& source, const Block& block, const geom::NurbsSurface& surface,
                              std::size_t remaining) {
  const auto words = pieces(block.comment);
  if (words.empty())
    return source.error(ErrorCode::syntax, "BURIN TRIM without anything (LOOP and a number, or u,v pairs)",
                        place_in(block, 0));
  if (equal_letters(words[0].text, "LOOP")) {
    if (!complete())
      return source.error(ErrorCode::syntax,
                          "a new loop while " + std::to_string(missing_) +
                              " points of the one before are missing (all of them first)",
                          place_in(block, words[0].at));
    const auto count = words.size() == 2 ? parse_integer(words[1].text) : std::nullopt;
    // "u,v " has at least four characters.
    if (!count || *count < 3 || static_cast<std::size_t>(*count) > std::min(kMaxLoopPoints, remaining / 4))
      return source.error(ErrorCode::syntax,
                          "BURIN TRIM LOOP needs one number of points (3 or more, as many as follow)",
                          place_in(block, words.size() > 1 ? words[1].at : words[0].at));
    loop_ = place_in(block, words[0].at);
    missing_ = static_cast<std::size_t>(*count);
    loops_.emplace_back().points.reserve(missing_);
    return {};
  }
  for (const Piece& word : words) {
    if (complete())
      return source.error(ErrorCode::syntax, "a trim point outside of a loop (BURIN TRIM LOOP n before it)",
                          place_in(block, word.at));
    const std::size_t comma = word.text.find(',');
    const bool pair = comma != std::string_view::npos;
    const auto u =
        pair ? parameter(word.text.substr(0, comma), surface.domain(geom::Direction::u)) : std::nullopt;
    const auto v =
        pair ? parameter(word.text.substr(comma + 1), surface.domain(geom::Direction::v)) : std::nullopt;
    if (!u || !v)
      return source.error(ErrorCode::syntax,
                          "a trim point that is no pair of parameters of the surface (u,v within its knots, "
                          "such as 0.25,0.5)",
                          place_in(block, word.at));
    loops_.back().points.push_back({*u, *v});
    --missing_;
  }
  return {};
}

std::string write_trims(const std::vector<TrimLoop>& loops, int decimals) {
  std::string text;
  const std::string open = "(" + std::string(kMark);
  for (const TrimLoop& loop : loops) {
    text += open + " LOOP " + std::to_string(loop.points.size()) + ")\n";
    std::string line = open;
    for (const geom::Point2& p : loop.points) {
      const std::string pair = " " + format_fixed(p.x, decimals) + "," + format_fixed(p.y, decimals);
      if (line.size() + pair.size() > kMaxLine) {
        text += line + ")\n";
        line = open;
      }
      line += pair;
    }
    text += line + ")\n";
  }
  return text;
}

}  // namespace burin::nc
