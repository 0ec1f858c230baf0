// SPDX-License-Identifier: Apache-2.0
// Surfaces sampled for pictures: grids of points and normals, a bounded number in total. mm.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/nurbs.h"

namespace burin::view {

/// Point (i, j) at [i + j * u.size()].
struct SurfaceMesh {
  /// Parameters of the columns and rows. Where the surface may have a crease (a knot of full multiplicity)
  /// the line stands twice, with the normals of either side.
  std::vector<double> u, v;
  std::vector<geom::Point3> points;
  std::vector<geom::Vec3> normals;  ///< unit or (0, 0, 0)
  std::vector<int> iso_u, iso_v;    ///< columns and rows that are drawn as lines
  geom::Box3 box;
};

/// Samples a direction of a span gets at most.
inline constexpr int kMaxSamplesPerSpan = 24;

/// Meshes of all surfaces, together at most `most_points` points (but never less than 2 x 2 each). Equal
/// numbers per span as far as that goes; surfaces with more spans than points are sampled at some of their
/// knots.
std::vector<SurfaceMesh> sample_surfaces(const std::vector<const geom::NurbsSurface*>& surfaces,
                                         std::size_t most_points);

/// The column (direction u) or row of the mesh next to the parameter.
int nearest_line(const std::vector<double>& parameters, double at);

}  // namespace burin::view
