// SPDX-License-Identifier: Apache-2.0
// Layers of allowed angles, one a contact point, and the shortest path through them. Internal to plan/orient.
#pragma once

#include <vector>

#include "burin/plan/orient/axis_motion.h"
#include "burin/plan/orient/cspace.h"

namespace burin::orient {

/// Allowed angles of one contact point.
struct Choice {
  Angles angles;
  double value = 0, loss = 0;  ///< of the goal; mm of path
  cl::Pose pose;
  Rotary rotary;
};
using Layer = std::vector<Choice>;

struct EdgeCost {
  const AxisMotion* motion = nullptr;
  double turn_weight = 1;
  double overspeed_weight = 1;  ///< of the time that rotary axes need beyond the tip's
};

/// mm of path; `way` is the contact's from one layer to the next.
double edge_cost(const EdgeCost& cost, const Choice& a, int branch_a, const Choice& b, int branch_b,
                 double way);

/// The choice in each layer on the cheapest way through all; every layer has at least one. ways[i]: of the
/// contact from layer i to i + 1.
std::vector<std::size_t> cheapest_way(const std::vector<Layer>& layers, const std::vector<double>& ways,
                                      const EdgeCost& cost);

}  // namespace burin::orient
