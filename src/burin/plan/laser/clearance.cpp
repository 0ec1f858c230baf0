// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/clearance.h"

#include <array>
#include <cmath>
#include <limits>

#include "burin/geom/curve/intersect.h"

namespace burin::laser::detail {

using geom::Box2;
using geom::Point2;
using geom::Segment;
using geom::Vec2;

namespace {

std::vector<Box2> boxes_of(const std::vector<Segment>& segments) {
  std::vector<Box2> boxes;
  boxes.reserve(segments.size());
  for (const Segment& s : segments) boxes.push_back(geom::bounds_of(s));
  return boxes;
}

/// Distance from the two points of `arc` in direction +-u from its centre, as far as they lie in its sweep.
double distance_along(const Segment& arc, Vec2 u, const Segment& other) {
  double best = std::numeric_limits<double>::infinity();
  for (const double side : {1.0, -1.0}) {
    const Point2 p = arc.center + side * std::abs(arc.radius) * u;
    if (geom::in_sweep(arc, p)) best = std::min(best, geom::nearest_on(other, p).distance);
  }
  return best;
}

}  // namespace

double segment_distance(const Segment& s, const Segment& t) {
  // Closer than the rounding of coordinates and centres is meeting.
  constexpr double kMeeting = 1e-9;
  if (!std::holds_alternative<geom::NoIntersection>(geom::intersect(s, t, kMeeting))) return 0;
  double best = std::min({geom::nearest_on(s, t.a).distance, geom::nearest_on(s, t.b).distance,
                          geom::nearest_on(t, s.a).distance, geom::nearest_on(t, s.b).distance});
  if (s.is_line() && t.is_line()) return best;
  if (s.is_line()) return std::min(best, distance_along(t, geom::left(geom::unit(s.b - s.a)), s));
  if (t.is_line()) return std::min(best, distance_along(s, geom::left(geom::unit(t.b - t.a)), t));
  const Vec2 u = geom::unit(t.center - s.center);
  if (u == Vec2{}) return best;  // concentric: the distance is the same wherever they face each other
  return std::min({best, distance_along(s, u, t), distance_along(t, u, s)});
}

Segment moved(const Segment& s, Vec2 by) {
  Segment m = s;
  m.a = s.a + by;
  m.b = s.b + by;
  if (!s.is_line()) m.center = s.center + by;
  return m;
}

// --- clearance
// ------------------------------------------------------------------------------------------------

Clearance::Clearance(std::vector<Segment> segments, std::vector<std::uint32_t> owner, Tiling tiling)
    : segments_(std::move(segments)), owner_(std::move(owner)), tiling_(tiling), tree_(boxes_of(segments_)) {}

bool Clearance::is_free_of_copy(const Segment& move, const Box2& box, double distance, Vec2 shift,
                                std::uint32_t skip) const {
  // Instead of moving the copy to the place, the move is taken back to the first copy.
  const Segment here = shift == Vec2{} ? move : moved(move, -shift);
  const Box2 area{box.lo - shift, box.hi - shift};
  return tree_.query(area, [&](std::uint32_t i) {
    return owner_[i] == skip || segment_distance(here, segments_[i]) >= distance;
  });
}

bool Clearance::is_free(const Segment& move, double distance, std::uint32_t skip) const {
  if (segments_.empty()) return true;
  const Box2 box = geom::bounds_of(move).grown(distance);
  if (!is_free_of_copy(move, box, distance, {}, skip)) return false;
  const Box2 all = tree_.bounds();
  // Copy i overlaps the box in x when box.lo - all.hi <= i pitch <= box.hi - all.lo; seen from any copy, the
  // others lie up to n - 1 steps to either side.
  const auto range = [](double low, double high, double pitch, int n) {
    if (n <= 1 || pitch <= 0) return std::array{0, 0};
    const double most = n - 1;
    return std::array{static_cast<int>(std::clamp(std::ceil(low / pitch), -most, most)),
                      static_cast<int>(std::clamp(std::floor(high / pitch), -most, most))};
  };
  const auto columns = range(box.lo.x - all.hi.x, box.hi.x - all.lo.x, tiling_.pitch.x, tiling_.columns);
  const auto rows = range(box.lo.y - all.hi.y, box.hi.y - all.lo.y, tiling_.pitch.y, tiling_.rows);
  for (int j = rows[0]; j <= rows[1]; ++j) {
    for (int i = columns[0]; i <= columns[1]; ++i) {
      if (i == 0 && j == 0) continue;
      const Vec2 shift{i * tiling_.pitch.x, j * tiling_.pitch.y};
      if (!is_free_of_copy(move, box, distance, shift, kNobody)) return false;
    }
  }
  return true;
}

namespace {

template <class Items>
Clearance clearance_of(const Items& items, const Tiling& tiling) {
  std::vector<Segment> segments;
  std::vector<std::uint32_t> owner;
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    const auto& all = items[i].spline.segments;
    segments.insert(segments.end(), all.begin(), all.end());
    owner.resize(segments.size(), i);
  }
  return {std::move(segments), std::move(owner), tiling};
}

}  // namespace

Clearance clearance_of_outlines(const Profile& profile, const Tiling& tiling) {
  return clearance_of(profile.outlines, tiling);
}
Clearance clearance_of_paths(const Profile& profile, const Tiling& tiling) {
  return clearance_of(profile.paths, tiling);
}

}  // namespace burin::laser::detail
