// SPDX-License-Identifier: Apache-2.0
// The volume that a ball leaves swept along polylines: where a line enters it. mm.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::verify {

/// A union of capsules: balls of one radius moved along segments, in a tree of boxes.
class Sweep {
 public:
  struct Segment {
    geom::Point3 a, b;
  };
  Sweep(std::vector<Segment> segments, double radius);

  /// The smallest h in [from, to] for which q + h n (n a unit vector) lies in the volume, nothing when there
  /// is none.
  std::optional<double> entry(geom::Point3 q, geom::Vec3 n, double from, double to) const;

 private:
  struct Node {
    geom::Box3 box;                      ///< of the segments below
    std::uint32_t first = 0, count = 0;  ///< leaf: segments; inner (count 0): children first and first + 1
  };
  void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end);

  std::vector<Segment> segments_;
  double radius_;
  std::vector<Node> nodes_;
};

}  // namespace burin::verify
