// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/micro_joints.h"

#include <algorithm>

namespace burin::laser::detail {

namespace {

/// Joints take at most this part of a contour: beyond it is a hole too small to be held.
constexpr double kMostOfContour = 0.25;
/// Steps to either side in which a place is looked for.
constexpr int kSteps = 64;

bool is_clear(Span gap, const std::vector<Span>& zones) {
  const auto after = std::upper_bound(zones.begin(), zones.end(), gap.to,
                                      [](double to, const Span& zone) { return to < zone.from; });
  return after == zones.begin() || std::prev(after)->to <= gap.from;
}

}  // namespace

JointPlan plan_joints(double length, int count, double gap_mm, const std::vector<Span>& zones,
                      double margin_mm) {
  JointPlan plan;
  if (count <= 0) return plan;
  if (!(gap_mm * count <= kMostOfContour * length)) {
    plan.missing = count;
    return plan;
  }
  const double pitch = length / count;
  for (int k = 0; k < count; ++k) {
    const double middle = (k + 0.5) * pitch;
    bool found = false;
    for (int step = 0; step <= 2 * kSteps && !found; ++step) {
      const int away = (step + 1) / 2;  // 0, 1, 1, 2, 2, ... to either side in turn
      const double shift = (step % 2 == 0 ? away : -away) * (pitch - gap_mm) / (2 * kSteps);
      const Span gap{middle + shift - gap_mm / 2, middle + shift + gap_mm / 2};
      if (gap.from < margin_mm || gap.to > length - margin_mm || !is_clear(gap, zones)) continue;
      plan.gaps.push_back(gap);
      found = true;
    }
    if (!found) ++plan.missing;
  }
  return plan;
}

}  // namespace burin::laser::detail
