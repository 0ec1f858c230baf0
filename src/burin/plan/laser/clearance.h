// SPDX-License-Identifier: Apache-2.0
// Distances between moves and outlines, answered from a tree of boxes. Internal to the laser planner.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/geom/box_tree.h"
#include "burin/geom/curve/arc_spline.h"
#include "burin/plan/laser/profile.h"

namespace burin::laser::detail {

/// Smallest distance between two segments; 0 when they meet. Exact up to rounding: the minimum is at a
/// crossing, at an end of one of the two, or where the line of centres (the normal of the line) meets an arc.
double segment_distance(const geom::Segment& s, const geom::Segment& t);

geom::Segment moved(const geom::Segment& s, geom::Vec2 by);

/// Where the copies of the part lie: copy (i, j) is moved by (i pitch.x, j pitch.y).
struct Tiling {
  int columns = 1, rows = 1;
  geom::Vec2 pitch{};
};

/// Segments with an owner, repeated over all copies.
class Clearance {
 public:
  Clearance(std::vector<geom::Segment> segments, std::vector<std::uint32_t> owner, Tiling tiling);

  /// Whether `move` keeps at least `distance` from every segment of every copy. `skip`: an owner of the same
  /// copy that does not count.
  bool is_free(const geom::Segment& move, double distance, std::uint32_t skip = kNobody) const;

  static constexpr std::uint32_t kNobody = 0xffffffffu;

 private:
  bool is_free_of_copy(const geom::Segment& move, const geom::Box2& box, double distance, geom::Vec2 shift,
                       std::uint32_t skip) const;

  std::vector<geom::Segment> segments_;
  std::vector<std::uint32_t> owner_;
  Tiling tiling_;
  geom::BoxTree2 tree_;
};

Clearance clearance_of_outlines(const Profile& profile, const Tiling& tiling);
Clearance clearance_of_paths(const Profile& profile, const Tiling& tiling);

}  // namespace burin::laser::detail
