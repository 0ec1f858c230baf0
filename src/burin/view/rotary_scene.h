// SPDX-License-Identifier: Apache-2.0
// A rotary finishing job as the viewer shows it. mm, degrees.
#pragma once

#include "burin/view/rotary_html.h"
#include "burin/view/scene.h"

namespace burin::view {

/// Part and path with its ways through the air; along it the axis (chosen, first, without smoothing), the
/// reachable angles about it, what is left; the places that were moved or not reached; figures, messages.
/// Precondition: picture.program. Errors: of put_path.
Result<Scene> rotary_scene(const RotaryPicture& picture);

}  // namespace burin::view
