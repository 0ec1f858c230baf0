// SPDX-License-Identifier: Apache-2.0
// Angles along a whole path (what the paper leaves open): a shortest path through layers of allowed angles,
// one layer a contact point, that gives up as little of the goal as it must for axes that turn evenly within
// the machine's speed and acceleration. docs/orient.md
#pragma once

#include <vector>

#include "burin/kinematics/kinematics.h"
#include "burin/plan/orient/cspace.h"

namespace burin::orient {

struct SmoothOptions {
  double feed_mm_min = 1000;
  /// What is weighed against each other, all in mm of path at the feed: the share of the goal that is lost,
  /// times the way of the contact; the way by which the tip goes farther than the contact; the time that
  /// rotary axes need beyond the tip's (as long as there is a choice, none); and this for a radian of
  /// turning.
  double turn_weight = 1;
  const kinematics::Kinematics* machine = nullptr;  ///< nullptr: turning of the tool axis itself counts
};
struct SmoothPoint {
  bool found = false;
  Angles angles;
  double value = 0;
};
struct SmoothPath {
  std::vector<SmoothPoint> points;   ///< as many as contacts
  double value_loss = 0;             ///< mean of 1 - value / best, over the points found
  double turn = 0, turn_before = 0;  ///< total turn of the tool axis, of the best angles before
  /// Largest share of a rotary axis' speed and acceleration at the feed; above 1 only where the allowed set
  /// leaves no choice (the feed is then lowered by the post).
  double speed_share = 0, acceleration_share = 0;
};
/// `best` are the single optima (find_optimal), in order. Points without one split the path.
SmoothPath smooth_path(const Setting& setting, const Goal& goal, const std::vector<CcPoint>& points,
                       const std::vector<Optimum>& best, const SmoothOptions& options, Scene::Memory& memory);

}  // namespace burin::orient
