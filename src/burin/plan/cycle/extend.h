// SPDX-License-Identifier: Apache-2.0
// A surface continued beyond its edges by its own polynomials, so that paths can run over an edge by the
// little that covers what they meet at a slant.
#pragma once

#include <optional>

#include "burin/geom/surface/nurbs.h"

namespace burin::cycle {

/// The surface with its domain in `direction` widened to `to` (which holds the domain), unchanged inside it:
/// the pieces at the ends go on. Nothing when a weight would not be positive.
std::optional<geom::NurbsSurface> extended(const geom::NurbsSurface& surface, geom::Direction direction,
                                           geom::Interval to);

/// A surface continued at both edges across `direction` so far that everywhere at least `distance` mm are
/// won square to the edge, as far as that goes without a fold, a sharp bend or a pole; else it ends there.
geom::NurbsSurface continued(const geom::NurbsSurface& surface, geom::Direction direction, double distance);

}  // namespace burin::cycle
