// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/excess.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burin::rotary::detail {
namespace {

using geom::Box3;
using geom::Point3;
using geom::Vec3;

double distance2_to_segment(Point3 p, Point3 a, Point3 b) {
  const Vec3 ab = b - a, ap = p - a;
  const double length2 = dot(ab, ab);
  const double f = length2 > 0 ? std::clamp(dot(ap, ab) / length2, 0.0, 1.0) : 0;
  const Vec3 d = ap - f * ab;
  return dot(d, d);
}

double distance2_to_box(Point3 p, const Box3& b) {
  const Vec3 d{std::max({b.lo.x - p.x, 0.0, p.x - b.hi.x}), std::max({b.lo.y - p.y, 0.0, p.y - b.hi.y}),
               std::max({b.lo.z - p.z, 0.0, p.z - b.hi.z})};
  return dot(d, d);
}

/// Segments of a way in runs, each with its box.
class Runs {
 public:
  explicit Runs(const std::vector<Point3>& way) : way_(way) {
    for (std::size_t i = 0; i < segments(); ++i) {
      if (i % kRun == 0) boxes_.emplace_back();
      boxes_.back().add(way[i]);
      boxes_.back().add(way[std::min(i + 1, way.size() - 1)]);
    }
  }
  std::size_t segments() const { return std::max<std::size_t>(1, way_.size() - 1); }
  /// The nearest segment, looked for first where the last one was.
  std::size_t nearest(Point3 p, std::size_t hint, double& distance2) const {
    std::size_t best = hint;
    distance2 = to(p, hint);
    for (std::size_t run = 0; run < boxes_.size(); ++run) {
      if (distance2_to_box(p, boxes_[run]) >= distance2) continue;
      for (std::size_t i = run * kRun; i < std::min((run + 1) * kRun, segments()); ++i) {
        const double d = to(p, i);
        if (d < distance2) {
          distance2 = d;
          best = i;
        }
      }
    }
    return best;
  }

 private:
  static constexpr std::size_t kRun = 16;
  double to(Point3 p, std::size_t i) const {
    return distance2_to_segment(p, way_[i], way_[std::min(i + 1, way_.size() - 1)]);
  }
  const std::vector<Point3>& way_;
  std::vector<Box3> boxes_;
};

}  // namespace

double spread_excess(std::vector<Place>& places, const std::vector<Contact>& left, const Place* before,
                     const Place* after, double radius) {
  std::vector<Point3> way;
  if (before) way.push_back(before->center);
  for (const Place& p : places) way.push_back(p.center);
  if (after) way.push_back(after->center);
  if (way.empty()) return 0;
  const Runs runs(way);
  double worst = 0;
  std::size_t hint = 0;
  for (const Contact& c : left) {
    double d2 = 0;
    hint = runs.nearest(c.p, hint, d2);
    const double excess = std::max(0.0, std::sqrt(d2) - radius);
    worst = std::max(worst, excess);
    if (places.empty()) continue;
    const std::size_t at = before && hint > 0 ? hint - 1 : hint;
    Place& place = places[std::min(at, places.size() - 1)];
    place.excess_mm = std::max(place.excess_mm, excess);
  }
  return worst;
}

}  // namespace burin::rotary::detail
