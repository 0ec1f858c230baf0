// SPDX-License-Identifier: Apache-2.0
// Written by examples/k/make_k.py, which also writes examples/k/k.dxf; a test compares the two.
// The letter K for tests and benchmarks: 13 cubic B-splines in a box of 41 x 42 mm, counter-clockwise.
#pragma once

#include <vector>

#include "burin/geom/curve/curve.h"

namespace burin::geom {

/// Clamped, uniform knots; one curve starts where the one before ends.
inline std::vector<Nurbs2> letter_k() {
  const std::vector<std::vector<Point2>> control_points{
      // stem, left edge, upper half
      {{0, 42}, {3.6, 39.6}, {5.3, 37.2}, {5.0, 33.0}, {5.7, 28.5}, {5.3, 25.0}, {5.3, 21.0}},
      // stem, left edge, lower half
      {{5.3, 21.0}, {5.3, 17.0}, {5.8, 12.5}, {4.9, 8.0}, {5.4, 4.6}, {3.6, 2.4}, {0, 0}},
      // stem, foot
      {{0, 0}, {4.2, 0.5}, {8, 1.1}, {12, 0.4}, {16, 0}},
      // stem, right edge below
      {{16, 0}, {12.6, 2.2}, {10.7, 4.4}, {11.3, 8.0}, {10.8, 11.5}, {11, 14.5}, {11, 17.5}},
      // leg, left edge
      {{11, 17.5}, {13.2, 16.4}, {16.5, 13.2}, {19.0, 9.0}, {22.6, 5.6}, {25.2, 3.4}, {25.0, 1.2}, {22.5, 0}},
      // leg, foot
      {{22.5, 0}, {27, 0.6}, {32, 1.2}, {37, 0.3}, {41, 0}},
      // leg, right edge, lower half
      {{41, 0}, {37.8, 1.6}, {35.6, 3.8}, {33.2, 7.4}, {30.6, 11.2}, {28.2, 14.2}},
      // leg, right edge, upper half
      {{28.2, 14.2}, {25.8, 17.2}, {22.6, 19.6}, {21.6, 21.8}, {19.6, 22.6}, {18.2, 24.4}},
      // arm, lower edge
      {{18.2, 24.4}, {21.6, 27.4}, {25.8, 31.6}, {29.6, 34.4}, {33.2, 38.4}, {36.9, 39.6}, {40, 42}},
      // arm, head
      {{40, 42}, {36, 41.5}, {32.5, 40.9}, {29, 41.6}, {25.5, 42}},
      // arm, upper edge
      {{25.5, 42},
       {28.2, 40.4},
       {28.8, 38.2},
       {26.4, 35.6},
       {22.4, 31.6},
       {17.2, 27.0},
       {13.6, 23.6},
       {11, 21.6}},
      // stem, right edge above
      {{11, 21.6}, {11.2, 25}, {10.6, 29}, {11.3, 33.4}, {10.8, 37.4}, {12.8, 40.2}, {16, 42}},
      // stem, head
      {{16, 42}, {12, 41.6}, {8, 40.9}, {4, 41.5}, {0, 42}},
  };
  std::vector<Nurbs2> curves;
  for (const std::vector<Point2>& points : control_points) {
    Nurbs2 curve{3, {0, 0, 0}, points, std::vector<double>(points.size(), 1.0)};
    const auto spans = static_cast<int>(points.size()) - 3;
    for (int i = 0; i <= spans; ++i) curve.knots.push_back(i);
    curve.knots.insert(curve.knots.end(), 3, spans);
    curves.push_back(curve);
  }
  return curves;
}

}  // namespace burin::geom
