// SPDX-License-Identifier: Apache-2.0
// Triangles of a file as they come -> a mesh with shared vertices. Internal to io/stl.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "burin/base/result.h"
#include "burin/geom/mesh/mesh.h"

namespace burin::io::stl {

class Builder {
 public:
  Builder(double scale, std::size_t max_triangles) : scale_(scale), max_(max_triangles) {}

  /// Corners in the file's unit. Error without place: not finite, too far out, too many.
  Result<void> add(const std::array<std::array<double, 3>, 3>& corners);
  std::size_t degenerate() const { return degenerate_; }
  geom::Mesh mesh() && { return std::move(mesh_); }

 private:
  struct Hash {
    std::size_t operator()(const std::array<std::uint64_t, 3>& key) const;
  };
  std::uint32_t vertex(geom::Point3 p);

  double scale_;
  std::size_t max_, degenerate_ = 0;
  geom::Mesh mesh_;
  std::unordered_map<std::array<std::uint64_t, 3>, std::uint32_t, Hash> index_;
};

Error too_many(std::size_t max_triangles);

}  // namespace burin::io::stl
