// SPDX-License-Identifier: Apache-2.0
// One CC path as a unit of work: its angles from its points, and the result as bytes. Internal to
// plan/orient.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "burin/plan/orient/orient.h"

namespace burin::orient {

/// What all paths of a job have in common. Keeps pointers.
struct PathTask {
  Setting setting;
  const OrientOptions* options = nullptr;
  const kinematics::Kinematics* machine = nullptr;
  const Goal* goal = nullptr;
  double sturz_tilt = 0;  ///< search = sturz

  const model::Mill& mill() const { return setting.scene->mill(); }
  /// Angles at the points of a path, in order; what one learns helps the next. Depends on the arguments only.
  OrientedPath run(const std::vector<CcPoint>& points) const;
};

/// Exact bytes, for this machine (they travel between ranks of one run only).
std::string to_bytes(const std::vector<OrientedPath>& paths);
std::vector<OrientedPath> paths_from_bytes(std::string_view bytes);

}  // namespace burin::orient
