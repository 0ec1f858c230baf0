// SPDX-License-Identifier: Apache-2.0
// Boxes over runs of consecutive segments of closed curves, four to one, level by level. The order along the
// curves is the index: nothing is sorted, and the tree adapts to any mixture of long and short segments. Used
// to find the pairs of segments whose boxes overlap, and for winding numbers, where a run beyond the point
// counts by its two ends alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "burin/geom/curve/arc_spline.h"

namespace burin::geom::detail {

/// Closed curves, one after another; each segment starts bit by bit where the one before ends, arcs sweep at
/// most a half turn.
struct RawCurves {
  std::vector<Segment> segments;
  /// 1: a connector that runs inside the swept region; it counts for winding but is never boundary.
  std::vector<std::uint8_t> inside;
  std::vector<std::uint32_t> first;    ///< loop k is segments [first[k], first[k + 1])
  std::vector<std::uint32_t> contour;  ///< input contour of loop k

  std::size_t loops() const { return contour.size(); }
};

class BoxTree {
 public:
  static constexpr std::size_t kFanBits = 2, kFan = std::size_t{1} << kFanBits;

  /// Boxes are grown by eps. `curves` must outlive the tree.
  BoxTree(const RawCurves& curves, double eps);

  /// visit(i, j), i < j, for segments whose grown boxes overlap; returns false to stop.
  template <class Visit>
  void overlapping_pairs(Visit&& visit) const {
    if (levels_.back().size() == 1) self(levels_.size() - 1, 0, visit);
  }

  /// Winding number on the far side (direction +x for axis 0, +y for axis 1) of point p that lies on all the
  /// segments `on`. Other segments that come within `tolerance` of p are put into `close`.
  int winding_beyond(Point2 p, int axis, std::span<const std::uint32_t> on, double tolerance,
                     std::vector<std::uint32_t>& close) const;

  std::uint32_t loop_of(std::size_t segment) const { return loop_of_[segment]; }
  const Box2& box(std::size_t segment) const { return levels_[0][segment]; }

 private:
  template <class Visit>
  void self(std::size_t level, std::size_t node, Visit& visit) const {
    if (level == 0) return;
    const std::size_t lo = node * kFan, hi = std::min(lo + kFan, levels_[level - 1].size());
    for (std::size_t i = lo; i < hi; ++i) {
      self(level - 1, i, visit);
      for (std::size_t j = i + 1; j < hi; ++j) {
        if (meets(levels_[level - 1][i], levels_[level - 1][j])) pair(level - 1, i, j, visit);
      }
    }
  }
  template <class Visit>
  void pair(std::size_t level, std::size_t a, std::size_t b, Visit& visit) const {
    if (level == 0) {
      visit(a, b);
      return;
    }
    const Box2 *below = levels_[level - 1].data(), box_a = levels_[level][a], box_b = levels_[level][b];
    const std::size_t size = levels_[level - 1].size();
    // Only children that reach the other node.
    std::size_t in_b[kFan], count = 0;
    for (std::size_t j = b * kFan, end = std::min(j + kFan, size); j < end; ++j) {
      in_b[count] = j;
      count += meets(below[j], box_a) ? 1 : 0;
    }
    for (std::size_t i = a * kFan, end = std::min(i + kFan, size); i < end; ++i) {
      if (!meets(below[i], box_b)) continue;
      for (std::size_t k = 0; k < count; ++k) {
        if (meets(below[i], below[in_b[k]])) pair(level - 1, i, in_b[k], visit);
      }
    }
  }

  /// Box2::overlaps without branches, which could not be predicted here.
  static bool meets(const Box2& a, const Box2& b) {
    return bool(int(a.lo.x <= b.hi.x) & int(b.lo.x <= a.hi.x) & int(a.lo.y <= b.hi.y) &
                int(b.lo.y <= a.hi.y));
  }

  struct Ray {
    Point2 p;
    int axis;
    std::span<const std::uint32_t> on;
    double tolerance;
    std::vector<std::uint32_t>& close;
    int number = 0;
  };
  void cast(std::size_t level, std::size_t node, Ray& ray) const;
  void cast_segment(std::size_t i, Ray& ray) const;

  const RawCurves& curves_;
  std::vector<std::uint32_t> loop_of_;
  std::vector<std::vector<Box2>> levels_;
};

}  // namespace burin::geom::detail
