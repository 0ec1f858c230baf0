// SPDX-License-Identifier: Apache-2.0
#include "burin/model/tool.h"

#include <algorithm>
#include <string>

#include "burin/base/text.h"

namespace burin::model {

namespace {

/// Longer or wider than any tool: what is beyond is a mistake of units.
constexpr double kLargest = 1e4;
constexpr const char* kAccepted = "above 0, up to 10000";
constexpr std::size_t kMostPieces = 1000;

Error range(std::string what, double value, const std::string& accepted) {
  return {ErrorCode::range, std::move(what) + " is " + format_shortest(value) + " mm (" + accepted + ")", {}};
}

bool in_range(double v) {
  return v > 0 && v <= kLargest;
}

Result<void> validate_pieces(const std::vector<HolderPiece>& holder) {
  if (holder.size() > kMostPieces) {
    return Error{ErrorCode::range,
                 "the holder has " + std::to_string(holder.size()) + " pieces (up to " +
                     std::to_string(kMostPieces) + ")",
                 {}};
  }
  for (std::size_t i = 0; i < holder.size(); ++i) {
    const std::string piece = " of piece " + std::to_string(i + 1) + " of the holder";
    if (!in_range(holder[i].radius)) return range("the radius" + piece, holder[i].radius, kAccepted);
    if (!in_range(holder[i].height)) return range("the height" + piece, holder[i].height, kAccepted);
  }
  return {};
}

}  // namespace

Result<void> validate(const BallTool& tool) {
  if (!in_range(tool.radius)) return range("the radius of the ball", tool.radius, kAccepted);
  if (!in_range(tool.shank_radius)) return range("the radius of the shank", tool.shank_radius, kAccepted);
  if (!in_range(tool.shank_length)) return range("the length of the shank", tool.shank_length, kAccepted);
  if (tool.shank_length < tool.radius) {
    return range("the length of the shank from the centre of the ball to the holder", tool.shank_length,
                 "at least the radius of the ball, " + format_shortest(tool.radius));
  }
  return validate_pieces(tool.holder);
}

Result<void> validate(const Mill& mill) {
  if (!in_range(mill.radius)) return range("the radius of the mill", mill.radius, kAccepted);
  if (!in_range(mill.length)) return range("the length of the cutting body", mill.length, kAccepted);
  const double r = mill.corner_radius;
  if (mill.kind == MillKind::flat && r != 0)
    return range("the corner radius of a flat mill", r, "0, or kind bull");
  if (mill.kind == MillKind::bull) {
    if (!in_range(r)) return range("the corner radius", r, kAccepted);
    if (r > mill.radius || r > mill.length)
      return range("the corner radius", r,
                   "at most the radius and the length of the cutting body, " +
                       format_shortest(std::min(mill.radius, mill.length)));
  }
  return validate_pieces(mill.holder);
}

}  // namespace burin::model
