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

enum class MillKind { flat, bull };
/// Face or end mill: cutting body from the tip centre (0) to `length`, above it the pieces of shank, holder
/// and spindle head, stacked. The corner of a bull nose is a quarter of a torus tube of `corner_radius`.
struct Mill {
  MillKind kind = MillKind::flat;
  double radius = 0;
  double corner_radius = 0;  ///< 0 for flat; at most the radius
  double length = 0;
  std::vector<HolderPiece> holder;
  bool operator==(const Mill&) const = default;
};

/// Error (range): numbers that are not finite and positive, a corner beyond the radius or the length, or one
/// on a flat mill; with what would be accepted.
Result<void> validate(const Mill& mill);

/// Error (range): numbers that are not finite and positive, a shank shorter than the ball's radius, with what
/// would be accepted.
Result<void> validate(const BallTool& tool);

}  // namespace burin::model
