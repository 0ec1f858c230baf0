// SPDX-License-Identifier: Apache-2.0
// Values measured at places on a mesh, as values of its vertices: a heat map. mm.
#pragma once

#include <cstddef>
#include <vector>

#include "burin/geom/mesh/mesh.h"
#include "burin/verify/deviation.h"

namespace burin::view {

/// Long edges are halved until none is longer than `longest_mm` or the next round would make more than
/// `max_triangles`. Neighbours stay neighbours: an edge is halved for both.
geom::Mesh refined(geom::Mesh mesh, double longest_mm, std::size_t max_triangles);

/// An edge length that gives about `triangles` of them.
double edge_for(const geom::Mesh& mesh, std::size_t triangles);

/// For each vertex the value farthest from 0 among the samples next to it that look the same way; NaN where
/// they all are. A vertex without samples has the mean of its neighbours.
std::vector<float> vertex_values(const geom::Mesh& mesh, const std::vector<verify::SurfaceSample>& samples,
                                 const std::vector<float>& values);

}  // namespace burin::view
