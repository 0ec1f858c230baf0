// SPDX-License-Identifier: Apache-2.0
// Internal to joining: one net from the nets of a grid of pieces.
#pragma once

#include <vector>

#include "burin/base/result.h"
#include "burin/geom/surface/nurbs.h"

namespace burin::geom::detail {

/// width x height, x fastest; in place: a column has one domain in u, a row one in v, and neighbours meet.
struct Pieces {
  int width = 0, height = 0;
  std::vector<NurbsSurface> nets;
  std::vector<int> orders;  ///< of each piece: where they differ by gaps and rounding, the lowest is right

  std::size_t place(int x, int y) const { return static_cast<std::size_t>(x + y * width); }
  NurbsSurface& at(int x, int y) { return nets[place(x, y)]; }
  const NurbsSurface& at(int x, int y) const { return nets[place(x, y)]; }
};

/// Common degrees, knots and weights, then the nets side by side. Error: what stands against it.
Result<NurbsSurface> put_together(Pieces pieces, double tolerance_mm);

}  // namespace burin::geom::detail
