// SPDX-License-Identifier: Apache-2.0
#include "burin/model/tool.h"

#include <cmath>
#include <string>

#include "burin/base/text.h"

namespace burin::model {
namespace {

bool positive(double value) {
  return std::isfinite(value) && value > 0;
}
Error bad(const std::string& what, double value, const std::string& accepted) {
  return Error{ErrorCode::range, what + " " + format_shortest(value) + " mm (" + accepted + ")", {}};
}

}  // namespace

Result<void> validate(const BallTool& tool) {
  if (!positive(tool.radius)) return bad("ball radius", tool.radius, "a finite number above 0");
  if (!positive(tool.shank_radius)) return bad("shank radius", tool.shank_radius, "a finite number above 0");
  if (!positive(tool.shank_length) || tool.shank_length < tool.radius)
    return bad("shank length", tool.shank_length,
               "finite, at least the ball's radius of " + format_shortest(tool.radius) + " mm");
  for (std::size_t i = 0; i < tool.holder.size(); ++i) {
    const std::string name = "holder piece " + std::to_string(i + 1);
    if (!positive(tool.holder[i].radius))
      return bad(name + ": radius", tool.holder[i].radius, "a finite number above 0");
    if (!positive(tool.holder[i].height))
      return bad(name + ": height", tool.holder[i].height, "a finite number above 0");
  }
  return {};
}

}  // namespace burin::model
