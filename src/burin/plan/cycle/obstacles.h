// SPDX-License-Identifier: Apache-2.0
// What the ball and the shank above it must not cut: all surfaces of the composite, inside their trimming
// loops. Drop cutter on the true surfaces. mm.
#pragma once

#include <cstdint>
#include <optional>
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

  /// Asks; one per thread. Places that follow each other are fast: the cell that was touched last is looked
  /// at first. Answers to the same questions in the same order since forget() are the same to the last bit.
  class Probe {
   public:
    explicit Probe(const Obstacles& obstacles);
    void forget() { last_ = kNone; }

    /// Nothing is cut deeper than `depth` by the ball (and its shank) whose centre is here.
    bool clear(geom::Point3 centre, double depth);
    /// The lowest height of the tip over (x, y) that cuts nothing; -infinity when nothing is below.
    double lowest_tip(geom::Point2 p);
    /// The lowest one that is above `floor`, else `floor`: faster.
    double lowest_tip(geom::Point2 p, double floor);
    /// How deep the ball cuts here, within 1 % or 1e-6; 0 when it does not. Not more than `most` is looked
    /// for.
    double depth(geom::Point3 centre, double most);

   private:
    static constexpr std::uint32_t kNone = 0xffffffff;
    /// The highest centre over p at which a ball of radius `reach` touches, when above `floor`; else `floor`.
    /// `stop_above`: any height above it is enough.
    double highest(geom::Point2 p, double reach, double floor, double stop_above);
    double visit(std::uint32_t index, geom::Point2 p, double reach, double floor);
    geom::SurfaceEvaluator& evaluator(std::uint32_t surface);

    const Obstacles* obstacles_;
    std::vector<std::optional<geom::SurfaceEvaluator>> evaluators_;  ///< made when first needed
    std::uint32_t last_ = kNone;
  };

  /// Highest point of all cells with the stock.
  double top() const { return top_; }
  std::size_t cells() const { return cells_.size(); }

 private:
  struct Cell {
    geom::Box3 box;
    geom::Point3 middle;
    geom::Vec3 normal;          ///< of its plane
    geom::Vec3 half_u, half_v;  ///< from the middle to the middles of two edges
    geom::Vec3 side;       ///< unit, in the plane: the cell's box has the axes normal, side, normal x side
    double thickness = 0;  ///< all of the cell is this near to the plane
    double extent_side = 0, extent_across = 0;  ///< and this near to the middle along the other two
    bool plane = false;  ///< flat enough for its plane to tell where the ball is nearest
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
  static bool out_of_reach(const Cell& cell, geom::Point3 centre, double reach2);
  void build_tree();
  std::uint32_t build_node(std::vector<std::uint32_t>& order, std::size_t first, std::size_t last);
  double radius_, stock_;
  double top_ = 0;
  std::vector<Cell> cells_;
  std::vector<Node> nodes_;
  std::vector<geom::SurfaceEvaluator> evaluators_;
};

}  // namespace burin::cycle
