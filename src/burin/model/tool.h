// SPDX-License-Identifier: Apache-2.0
// A tool as data: cutter, shank, holder. mm; heights count from the ball's centre (ball) or the tip centre
// upwards along the tool axis.
#pragma once

#include <vector>

#include "burin/base/result.h"

namespace burin::model {

/// A cylinder about the tool axis; pieces are stacked upwards.
struct HolderPiece {
  double radius = 0;
  double height = 0;
  bool operator==(const HolderPiece&) const = default;
};

/// Ball of `radius` at the origin, shank from 0 to shank_length, holder pieces from there on.
struct BallTool {
  double radius = 0;
  double shank_radius = 0;
  double shank_length = 60;
  std::vector<HolderPiece> holder;
};

/// Error (range): numbers that are not finite and positive, a shank shorter than the ball's radius, with what
/// would be accepted.
Result<void> validate(const BallTool& tool);

}  // namespace burin::model
