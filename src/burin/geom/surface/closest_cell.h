// SPDX-License-Identifier: Apache-2.0
// A rational Bezier patch as seen from a point: bounds of its distance from the origin. Internal to
// geom/surface.
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "burin/geom/surface/nurbs.h"

namespace burin::geom::detail {

/// Rounding of the coordinates of a cell, relative to the largest coordinate: a few operations each time it
/// is halved, at most about a hundred times.
inline constexpr double kCellRounding = 256 * std::numeric_limits<double>::epsilon();

struct Cell {
  Interval u, v;
  int p = 0, q = 0;
  std::vector<HPoint> net;  // relative to the point; u fastest

  struct Bounds {
    double lower = 0;                               // no point of the patch is nearer
    double corner = 0, corner_u = 0, corner_v = 0;  // the nearest of the four corners
  };
  Bounds bounds();
  bool can_be_split() const;
  /// Halves across the direction in which the distance varies more, as far as bounds() has seen.
  std::pair<Cell, Cell> split() const;

 private:
  const HPoint& at(int i, int j) const {
    return net[static_cast<std::size_t>(i) + static_cast<std::size_t>(j) * static_cast<std::size_t>(p + 1)];
  }
  HPoint& at(int i, int j) {
    return net[static_cast<std::size_t>(i) + static_cast<std::size_t>(j) * static_cast<std::size_t>(p + 1)];
  }
  double lower_by_plane(Vec3 toward) const;
  double lower_by_square();
  void measure_legs();
  double varies_u_ = 0, varies_v_ = 0;
};

}  // namespace burin::geom::detail
