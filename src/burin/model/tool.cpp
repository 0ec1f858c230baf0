// SPDX-License-Identifier: Apache-2.0
#include "burin/model/tool.h"

#include <string>

#include "burin/base/text.h"

namespace burin::model {

namespace {

/// Longer or wider than any tool: what is beyond is a mistake of units.
constexpr double kLargest = 1e4;
constexpr std::size_t kMostPieces = 1000;

Error range(std::string what, double value, const std::string& accepted) {
  return {ErrorCode::range, std::move(what) + " is " + format_shortest(value) + " mm (" + accepted + ")", {}};
}

bool in_range(double v) {
  return v > 0 && v <= kLargest;
}

}  // namespace

Result<void> validate(const BallTool& tool) {
  const std::string accepted = "above 0, up to " + format_shortest(kLargest);
  if (!in_range(tool.radius)) return range("the radius of the ball", tool.radius, accepted);
  if (!in_range(tool.shank_radius)) return range("the radius of the shank", tool.shank_radius, accepted);
  if (!in_range(tool.shank_length)) return range("the length of the shank", tool.shank_length, accepted);
  if (tool.shank_length < tool.radius) {
    return range("the length of the shank from the centre of the ball to the holder", tool.shank_length,
                 "at least the radius of the ball, " + format_shortest(tool.radius));
  }
  if (tool.holder.size() > kMostPieces) {
    return Error{ErrorCode::range,
                 "the holder has " + std::to_string(tool.holder.size()) + " pieces (up to " +
                     std::to_string(kMostPieces) + ")",
                 {}};
  }
  for (std::size_t i = 0; i < tool.holder.size(); ++i) {
    const std::string piece = " of piece " + std::to_string(i + 1) + " of the holder";
    if (!in_range(tool.holder[i].radius)) return range("the radius" + piece, tool.holder[i].radius, accepted);
    if (!in_range(tool.holder[i].height)) return range("the height" + piece, tool.holder[i].height, accepted);
  }
  return {};
}

}  // namespace burin::model
