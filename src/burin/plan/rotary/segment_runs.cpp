// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/segment_runs.h"

#include <algorithm>

namespace burin::rotary::detail {
namespace {

using geom::Box3;
using geom::Point3;
using geom::Vec3;

double distance2_to(Point3 p, const SegmentRuns::Segment& s) {
  const Vec3 ab = s.b - s.a, ap = p - s.a;
  const double length2 = dot(ab, ab);
  const double f = length2 > 0 ? std::clamp(dot(ap, ab) / length2, 0.0, 1.0) : 0;
  const Vec3 d = ap - f * ab;
  return dot(d, d);
}

double distance2_to(Point3 p, const Box3& b) {
  const Vec3 d{std::max({b.lo.x - p.x, 0.0, p.x - b.hi.x}), std::max({b.lo.y - p.y, 0.0, p.y - b.hi.y}),
               std::max({b.lo.z - p.z, 0.0, p.z - b.hi.z})};
  return dot(d, d);
}

}  // namespace

void SegmentRuns::add(Point3 a, Point3 b) {
  if (segments_.size() % kRun == 0) boxes_.emplace_back();
  boxes_.back().add(a);
  boxes_.back().add(b);
  segments_.push_back({a, b});
}

std::size_t SegmentRuns::nearest(Point3 p, std::size_t hint, double& distance2) const {
  std::size_t best = std::min(hint, segments_.size() - 1);
  distance2 = distance2_to(p, segments_[best]);
  for (std::size_t run = 0; run < boxes_.size(); ++run) {
    if (distance2_to(p, boxes_[run]) >= distance2) continue;
    for (std::size_t i = run * kRun; i < std::min((run + 1) * kRun, segments_.size()); ++i) {
      const double d = distance2_to(p, segments_[i]);
      if (d < distance2) {
        distance2 = d;
        best = i;
      }
    }
  }
  return best;
}

}  // namespace burin::rotary::detail
