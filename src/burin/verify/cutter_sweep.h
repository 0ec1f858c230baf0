// SPDX-License-Identifier: Apache-2.0
// The volume a moving cutter goes through: where a line enters it. Internal to verify. mm.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/verify/mill_body.h"
#include "burin/verify/mill_motion.h"

namespace burin::verify {

class CutterSweep {
 public:
  /// `stretches` in the order of the motion: neighbours in the list are expected to be near each other.
  CutterSweep(const MillBody& body, std::vector<Stretch> stretches);

  /// The smallest h in [-window, window] within `resolution` for which q + h n is in the volume at some
  /// moment; window when there is none. Looks at the stretches around `hints` first, which only makes it
  /// faster.
  double entry(geom::Point3 q, geom::Vec3 n, double window, double resolution,
               const std::vector<std::size_t>& hints) const;

 private:
  struct Line;
  struct Block {
    geom::Point3 center;  ///< of the tips
    double reach = 0;     ///< no place of the cutter is farther from it
  };
  void lower(Line& line, const Stretch& stretch) const;
  void lower(Line& line, const Stretch& stretch, double middle, double half) const;

  MillBody body_;
  std::vector<Stretch> stretches_;
  std::vector<Block> blocks_;
};

}  // namespace burin::verify
