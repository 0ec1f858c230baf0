// SPDX-License-Identifier: Apache-2.0
// A smooth path -> few straight moves and arcs that ordinary controls run, within a tolerance. mm.
#pragma once

#include <cstddef>
#include <vector>

#include "burin/cl/program.h"
#include "burin/geom/quintic.h"

namespace burin::cl {

struct FitOptions {
  double tolerance_mm = 0.01;
  /// Arcs only in the planes of G17, G18 and G19 (normals along Z, Y, X); a slight rise along the normal
  /// makes a helix.
  bool arcs = true;
  double min_radius_mm = 0.01, max_radius_mm = 10'000;
};

struct FittedMove {
  geom::Point3 to;
  double radius = 0;  ///< 0: straight
  geom::Point3 center;
  geom::Vec3 normal;  ///< unit, counter-clockwise about it
};

struct FitMoves {
  std::vector<FittedMove> moves;
  /// Bound of the distance between the path and the moves, both ways along the path; <= tolerance_mm.
  double deviation_mm = 0;
};

/// Greedy, the longest move first; all ends lie on the path, the first and last exactly at its ends. Lines
/// take chords as far as the control points of the path stay within the tolerance. Precondition: path not
/// empty, tolerance > 0.
FitMoves fit_moves(const geom::QuinticPath& path, const FitOptions& options);

/// Appends them as Feed and Arc records.
void append(Program& program, const FitMoves& fit, std::uint32_t source);

}  // namespace burin::cl
