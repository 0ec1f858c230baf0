// SPDX-License-Identifier: Apache-2.0
// Long narrow triangles cut across. mm. docs/verify-deviation.md
#pragma once

#include "burin/geom/mesh/mesh.h"

namespace burin::verify {

/// The same surface: triangles more than twice as long as their shortest side are cut across into pieces
/// about as long as `length` (at most sqrt(2) of it) along their long sides. Halving them instead, as samples
/// do, makes pieces as many times too narrow as they were too long: a tenth of the samples does as well. The
/// cut of a side depends on the side alone, so that neighbours share the new vertices. Triangles come in the
/// order of their originals. Stops cutting (the rest stays as it is) when there would be more than `most`
/// triangles.
geom::Mesh cut_slivers(const geom::Mesh& mesh, double length, std::size_t most = 4'000'000);

}  // namespace burin::verify
