// SPDX-License-Identifier: Apache-2.0
// Faces -> triangles, as fine as their number allows. Internal to job. mm.
#pragma once

#include <cstddef>
#include <vector>

#include "burin/base/result.h"
#include "burin/geom/mesh/mesh.h"
#include "burin/plan/orient/part.h"

namespace burin::job {

/// More triangles of a design make everything slow before they make it better.
inline constexpr std::size_t kMostDesignTriangles = 1'000'000;
/// Share of the tolerance that triangles may leave their faces by.
inline constexpr double kDesignShare = 1.0 / 40;

void append(geom::Mesh& to, const geom::Mesh& mesh);

/// Triangles of all faces behind those in `mesh`, with the finest deflection from `wanted` on at which they
/// stay within `most`; returns it. Errors name the face.
Result<double> add_faces(const std::vector<orient::DesignFace>& faces, double wanted, std::size_t most,
                         geom::Mesh& mesh);

}  // namespace burin::job
