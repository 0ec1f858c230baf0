// SPDX-License-Identifier: Apache-2.0
// STL, binary and text: bytes <-> triangles. mm (STL has no unit).
#pragma once

#include <string>
#include <string_view>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/geom/mesh/mesh.h"

namespace burin::io {

struct ReadStlOptions {
  std::string file_name;
  double scale = 1.0;  ///< mm per unit of the file
  std::size_t max_triangles = 20'000'000;
};

/// Corners that are the same to the last bit become one vertex. Which form it is, is decided by the content
/// (a binary file may begin with "solid"). Errors (syntax) with line or triangle: truncated, a count that the
/// file does not hold, numbers that are not finite or beyond 10 km, no triangles; (range) more triangles than
/// allowed. Diagnostics: triangles with a corner twice are left out (info), several solids in one text file
/// are one mesh (info), bytes behind the last triangle (left out when a triangle would fit in).
Result<geom::Mesh> read_stl(std::string_view bytes, const ReadStlOptions& options, Diagnostics& diagnostics);

/// Binary; normals from the corners.
std::string write_stl(const geom::Mesh& mesh);

}  // namespace burin::io
