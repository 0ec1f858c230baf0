// SPDX-License-Identifier: Apache-2.0
// A tree of boxes over the triangles of a mesh: nearest point, the ball that touches, inside or outside. mm.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "burin/geom/mesh/mesh.h"

namespace burin::geom {

/// Immutable after construction: any number of threads may ask. Answers do not depend on earlier questions.
class MeshIndex {
 public:
  explicit MeshIndex(const Mesh& mesh);
  ~MeshIndex();
  MeshIndex(MeshIndex&&) noexcept;
  MeshIndex& operator=(MeshIndex&&) noexcept;

  struct Hit {
    Point3 p;
    double distance = 0;
    std::uint32_t triangle = 0;
  };
  /// The nearest point of the mesh when it is nearer than `within` (of equally near ones that of the lowest
  /// triangle); nothing else.
  std::optional<Hit> nearest(Point3 c, double within) const;
  /// Whether a closed mesh contains c (generalised winding number or parity of crossings, robust at edges).
  bool inside(Point3 c) const;

  /// The smallest t in [0, limit] for which a ball of `radius` about c + t * direction holds no point of the
  /// mesh deeper than `allowed` and for which c + t * direction is not inside of the closed mesh; nothing
  /// when there is none. `direction` is a unit vector. Found by sphere tracing and polished to `accuracy_mm`.
  std::optional<double> ball_out(Point3 c, Vec3 direction, double radius, double allowed, double limit,
                                 double accuracy_mm) const;

  Box3 bounds() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace burin::geom
