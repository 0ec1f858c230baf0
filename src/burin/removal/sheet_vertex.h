// SPDX-License-Identifier: Apache-2.0
// The place that fits best to the planes of a few crossings: on a face, an edge or a corner. Internal to
// removal. mm.
#pragma once

#include "burin/geom/vec.h"
#include "burin/removal/crossings.h"

namespace burin::removal {

class SheetVertex {
 public:
  void add(const Crossing& c);
  /// Inside the cell. Precondition: something was added.
  geom::Point3 place(const geom::Box3& cell) const;

 private:
  std::array<std::array<double, 3>, 3> planes_{};  ///< sum of n n^T
  geom::Vec3 pull_, sum_;                          ///< sums of n (n . p), p
  int count_ = 0;
};

}  // namespace burin::removal
