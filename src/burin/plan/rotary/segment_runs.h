// SPDX-License-Identifier: Apache-2.0
// The nearest of many segments that follow each other: runs of a few with a box each.
#pragma once

#include <cstddef>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::rotary::detail {

class SegmentRuns {
 public:
  struct Segment {
    geom::Point3 a, b;
  };
  void add(geom::Point3 a, geom::Point3 b);
  std::size_t size() const { return segments_.size(); }
  bool empty() const { return segments_.empty(); }
  const Segment& operator[](std::size_t i) const { return segments_[i]; }

  /// The nearest segment, looked for first at `hint`. Precondition: not empty.
  std::size_t nearest(geom::Point3 p, std::size_t hint, double& distance2) const;

 private:
  static constexpr std::size_t kRun = 16;
  std::vector<Segment> segments_;
  std::vector<geom::Box3> boxes_;
};

}  // namespace burin::rotary::detail
