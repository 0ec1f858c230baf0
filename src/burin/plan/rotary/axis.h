// SPDX-License-Identifier: Apache-2.0
// The tool axis along a path: the shortest way through the layers of reachable angles. radians, mm.
#pragma once

#include <cstddef>
#include <vector>

#include "burin/plan/rotary/reach.h"

namespace burin::rotary {

struct Layer {
  AngleSet reachable;  ///< empty: no axis; the chain breaks here
  double normal = 0;   ///< atan2(n.y, n.z) of the contact normal
  double initial = 0;  ///< atan2(yc, zc): the paper's first axis (eq. 1)
  double length = 0;   ///< mm of centre path from the layer before
};

struct AxisOptions {
  double clearance = 0;  ///< kept from the ends of an interval where there is room
  bool smooth = true;    ///< false: each layer takes the angle nearest to `initial` on its own
  double lean = 0;  ///< the axis stays this far from the normal where it can: the tip does not cut with its
                    ///< centre; 0: no preference
  double max_step = 0.5;  ///< a step above this breaks the chain: retract, turn, come back
  /// The angle that stood before the first layer (any number of turns): the chain starts near it.
  double start = 0;
};

struct AxisChain {
  std::vector<double> theta;        ///< one a layer, unwrapped; meaningless where the layer is empty
  std::vector<std::size_t> breaks;  ///< the step to this layer is not to be cut
  double turn_total = 0;            ///< sum of |steps| within chains
  double step_max = 0;
  std::size_t reversals = 0;  ///< changes of direction of turning by more than a degree
};
/// Global over the path: least sum of squared steps per length (and lean), fewest breaks before that.
AxisChain choose_axes(const std::vector<Layer>& layers, const AxisOptions& options);

}  // namespace burin::rotary
