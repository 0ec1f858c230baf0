// SPDX-License-Identifier: Apache-2.0
// The region of a joined surface that is machined: loops in the parameters of the patches it came from.
#pragma once

#include <vector>

#include "burin/geom/surface/join.h"
#include "burin/plan/cycle/cycle.h"
#include "burin/plan/cycle/graph.h"

namespace burin::cycle {

/// In (u, v) of the joined surface; empty loops: everything.
class Region {
 public:
  Region(const geom::JoinedSurface& surface, const std::vector<Trim>& trims);

  /// Nothing is cut away.
  bool whole() const { return whole_; }
  /// Of what is inside.
  geom::Interval u_range() const { return u_; }
  geom::Interval v_range() const { return v_; }
  bool inside(double u, double v) const;
  /// Conservative: some loop or edge passes through the rectangle.
  bool on_edge(geom::Interval u, geom::Interval v) const;
  /// The parts of a graph that lie inside. `along`: the direction that t stands for.
  std::vector<geom::Interval> cut(const Graph& graph, geom::Direction along) const;
  /// The straight line of parameters from a to b (u, v) stays inside; within `slack` (relative to the
  /// line's length) of the edge counts as inside.
  bool stays_inside(geom::Point2 a, geom::Point2 b, double slack) const;

 private:
  struct Part {
    geom::Interval u, v;  ///< rectangle of a member
    std::vector<std::vector<geom::Point2>> loops;
  };
  double distance_to_edge(geom::Point2 p) const;

  bool whole_ = true;
  geom::Interval u_, v_;
  std::vector<Part> parts_;
};

}  // namespace burin::cycle
