// SPDX-License-Identifier: Apache-2.0
// What the ball and the shank above it must not cut: all surfaces of the composite, inside their trimming
// loops. Drop cutter on the true surfaces. mm.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/join.h"
#include "burin/plan/cycle/trim.h"

namespace burin::cycle {

class Obstacles {
 public:
  /// `regions`: one for each surface. `stock` is left on all of them. `fine_mm`: how flat the cells are that
  /// the surfaces are cut into; results do not depend on it, speed does.
  Obstacles(const geom::Composite& composite, const std::vector<Region>& regions, double radius, double stock,
            double fine_mm);

  /// Nothing is cut deeper than `depth` by the ball (and its shank) whose centre is here.
  bool clear(geom::Point3 centre, double depth) const;
  /// The lowest height of the tip over (x, y) that cuts nothing; -infinity when nothing is below.
  double lowest_tip(geom::Point2 p) const;
  /// The lowest one that is above `floor`, else `floor`: faster.
  double lowest_tip(geom::Point2 p, double floor) const;
  /// How deep the ball cuts here, within 1 % or 1e-6; 0 when it does not. Not more than `most` is looked for.
  double depth(geom::Point3 centre, double most) const;
  /// Highest point of all cells with the stock.
  double top() const { return top_; }
  std::size_t cells() const { return cells_.size(); }

 private:
  struct Cell {
    geom::Box3 box;
    geom::Point3 middle;
    geom::Vec3 normal;     ///< of its plane
    double thickness = 0;  ///< all of the cell is this near to the plane
    double extent = 0;     ///< and this near to the middle
    std::uint32_t surface = 0;
    geom::Interval u, v;
  };
  struct Node {
    geom::Box3 box;
    std::uint32_t first = 0, count = 0;  ///< cells of a leaf
    std::uint32_t right = 0;             ///< second child; the first one follows its parent
  };

  void add_surface(const geom::JoinedSurface& surface, const Region& region, std::uint32_t index,
                   double fine_mm, std::size_t budget, bool& over);
  void add_rectangle(const Region& region, std::uint32_t index, geom::Interval u, geom::Interval v,
                     double fine_mm, int depth, std::size_t budget, bool& over);
  void build_tree();
  std::uint32_t build_node(std::vector<std::uint32_t>& order, std::size_t first, std::size_t last);
  /// The highest centre over p at which a ball of radius `reach` touches, when above `floor`; else `floor`.
  /// `stop_above`: any height above it is enough.
  double highest(geom::Point2 p, double reach, double floor, double stop_above) const;
  double climb(const Cell& cell, geom::Point2 p, double reach, double floor) const;

  double radius_, stock_;
  double top_ = 0;
  std::vector<Cell> cells_;
  std::vector<Node> nodes_;
  mutable std::vector<geom::SurfaceEvaluator> evaluators_;
};

}  // namespace burin::cycle
