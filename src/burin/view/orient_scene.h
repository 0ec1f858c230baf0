// SPDX-License-Identifier: Apache-2.0
// A tool-orientation job as the viewer shows it. mm, degrees.
#pragma once

#include "burin/view/orient_html.h"
#include "burin/view/scene.h"

namespace burin::view {

/// Part, obstacles, the path with its ways through the air; along it effective radius (initial and chosen,
/// and their ratio), tilt, yaw, width of the strip and tests; the C-spaces with their radii; machining time
/// against other ways to mill, gain of each path; figures, messages. Errors: of put_path.
/// Precondition: picture.program.
Result<Scene> orient_scene(const OrientPicture& picture);

}  // namespace burin::view
