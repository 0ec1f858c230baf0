// SPDX-License-Identifier: Apache-2.0
// All tolerances of a job in one object, owned by the caller and handed down; algorithms bring no epsilons of
// their own except relative rounding bounds, which have a name and a derivation where they stand.
#pragma once

namespace burin {

struct Tolerance {
  /// Largest deviation of the tool path from the exact one, mm. Certified, not sampled.
  double path_mm = 0.01;
  /// Ends of curves this close are joined, mm.
  double join_mm = 0.01;
  /// Two points this close are the same point, two curves this close along their length the same curve, mm.
  /// Well above the rounding of coordinates up to 1e5 mm (2e-11 mm), well below any decimal of an NC program.
  double point_mm = 1e-7;
  /// Tangents that differ by less are smooth (G1), radians.
  double tangent_rad = 1e-3;
};

}  // namespace burin
