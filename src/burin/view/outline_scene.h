// SPDX-License-Identifier: Apache-2.0
// Plane curves as points, close enough for the eye. mm.
#pragma once

#include <vector>

#include "burin/geom/curve/arc_spline.h"
#include "burin/io/drawing/drawing.h"
#include "burin/view/scene.h"

namespace burin::view {

/// Every path of every entity, named after it, as drawn: nothing is joined, nested or left out. Paths of more
/// points than `max_points` in all are drawn with fewer.
std::vector<SceneOutline> scene_outlines(const io::Drawing& drawing, std::size_t max_points = 2'000'000);

/// Lines and arcs one after the other.
SceneOutline scene_outline(const std::vector<geom::Segment>& segments, bool closed);

}  // namespace burin::view
