// SPDX-License-Identifier: Apache-2.0
// Curves of an element -> curves of the drawing: mapped to mm, checked.
#pragma once

#include <vector>

#include "burin/base/result.h"
#include "burin/io/drawing/drawing.h"

namespace burin::io::svg {

struct Placed {
  std::vector<Path> paths;
  std::size_t curve_count = 0;
  bool dropped = false;  ///< a whole subpath collapsed to a point
};

/// Curves are mapped exactly; ellipses that the map made round become arcs. Pieces that collapse to a point
/// are left out. Errors: range (coordinates beyond 1e9 mm), geometry (what validate() refuses, a map that
/// flattens the plane).
Result<Placed> place_outline(const geom::Affine2& map, std::vector<Path> paths);

}  // namespace burin::io::svg
