// SPDX-License-Identifier: Apache-2.0
// Curves in the parameters of a sheet: paths w(t) as C2 cubic splines, and straight lines for links.
#pragma once

#include <functional>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::cycle {

/// A place on a parameter curve with derivatives by its own parameter s.
struct UvPoint {
  double t = 0, w = 0;
  double t1 = 0, w1 = 0;  ///< first
  double t2 = 0, w2 = 0;  ///< second
};
using UvCurve = std::function<UvPoint(double s)>;

/// w(t) through nodes, C2; t strictly increasing, at least two. `m`: second derivatives at the nodes.
struct Graph {
  std::vector<double> t, w, m;

  double lo() const { return t.front(); }
  double hi() const { return t.back(); }
  /// s = t. Clamped to the range.
  UvPoint at(double s) const;
};

Graph constant(double t0, double t1, double w);
/// The complete cubic spline: end slopes from the cubic through the four nodes at each end (fewer: parabola,
/// line), so that it is fourth-order accurate up to the ends.
Graph spline(std::vector<double> t, std::vector<double> w);

/// Where w(t) = value inside (lo, hi) of the graph, ascending.
std::vector<double> crossings(const Graph& graph, double value);
/// Where the graph meets the segment from a to b (x = t, y = w), ascending in t.
std::vector<double> crossings(const Graph& graph, geom::Point2 a, geom::Point2 b);

}  // namespace burin::cycle
