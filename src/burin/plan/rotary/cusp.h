// SPDX-License-Identifier: Apache-2.0
// The cusp that a ball leaves between two paths, from the swept balls themselves: at a contact (q, n) the
// height is the smallest t >= 0 for which q + t n lies inside of the ball swept along either path.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "burin/plan/rotary/part.h"
#include "burin/plan/rotary/segment_runs.h"

namespace burin::rotary::detail {

/// The way of a ball's centre, and where on it a point is near.
class CenterLine {
 public:
  CenterLine(std::vector<geom::Point3> points, bool closed) : points_(std::move(points)), closed_(closed) {}

  /// Where the ray from q along the unit vector n enters the swept ball; infinity when it passes by. `hint`:
  /// a segment near which to look; becomes the one that was found. Only that neighbourhood counts, so the
  /// height is never too small.
  double entry(geom::Point3 q, geom::Vec3 n, double radius, std::size_t& hint) const;
  std::size_t segments() const { return closed_ ? points_.size() : points_.size() - 1; }

 private:
  double distance2(geom::Point3 q, std::size_t segment) const;
  geom::Point3 place(geom::Point3 q, std::size_t segment) const;
  std::size_t closest(geom::Point3 q, std::size_t hint) const;

  std::vector<geom::Point3> points_;
  bool closed_;
};

/// As CenterLine::entry, over all segments.
double entry(const SegmentRuns& way, geom::Point3 q, geom::Vec3 n, double radius, std::size_t& hint);

/// Contact number i of the ring at x, wherever it is taken from.
using RingAt = std::function<Contact(std::size_t i, double x)>;
/// The largest cusp between the rings at a < b, of `count` contacts each.
double ring_cusp(const RingAt& ring, std::size_t count, double a, double b, double radius);

/// The step whose cusp is just within `scallop`; `cusp` grows with the step, about as its square. At most
/// `longest`; `guess` > 0.
double step_for(const std::function<double(double)>& cusp, double scallop, double guess, double longest);

}  // namespace burin::rotary::detail
