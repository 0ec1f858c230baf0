// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/estimate.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace burin::cycle {
namespace {

constexpr int kGrid = 24;

/// The side step that leaves the scallop, for a ball of radius R where the surface bends across the paths:
/// s^2 = 8 R S |S'| / |C'|, as the centres are that much farther apart than the contacts.
double side_step(const Sheet& sheet, const PassTask& task, const Contact& c, Vec3 across) {
  const double flat = std::sqrt(8 * sheet.radius() * task.scallop);
  // Where the ball nearly fits the step grows without bound, where it does not it is that of a plane.
  constexpr double kFits = 0.05;
  const double spread = dot(c.cw, across) / dot(c.sw, across);
  const double step = spread > kFits ? flat / std::sqrt(spread) : flat;
  return task.side_step ? std::min(step, *task.side_step) : step;
}

}  // namespace

Estimate estimate(const Sheet& sheet, const PassTask& task, const Region& region, Method method) {
  const double dt = task.t.length() / kGrid, dw = task.w.length() / kGrid;
  Estimate sum;
  std::array<double, kGrid> columns{};  // paths that cross each line t = const
  for (int j = 0; j < kGrid; ++j) {
    const double w = task.w.lo + (j + 0.5) * dw;
    double most = 0, row = 0;
    for (int i = 0; i < kGrid; ++i) {
      const double t = task.t.lo + (i + 0.5) * dt;
      const Contact c = sheet.contact(t, w);
      const double along = norm(c.st);
      if (c.degenerate || !(along > 0)) continue;
      const Vec3 across = unit(c.sw - (dot(c.sw, c.st) / (along * along)) * c.st);
      const double rate = dot(c.sw, across) / side_step(sheet, task, c, across);
      const Point3 uv = sheet.uv(t, w);
      const double inside = region.inside(uv.x, uv.y) ? along * dt : 0;
      most = std::max(most, rate);
      row += inside;
      columns[static_cast<std::size_t>(i)] += rate * dw;
      if (method == Method::iso_scallop) sum.length += inside * rate * dw;
    }
    if (method == Method::iso_scallop) continue;
    sum.paths += most * dw;
    sum.length += row * most * dw;
  }
  if (method == Method::iso_scallop) sum.paths = *std::max_element(columns.begin(), columns.end());
  return sum;
}

Result<void> check_size(const Sheet& sheet, const PassTask& task, const Estimate& estimate) {
  // The estimate is rough: only what is clearly too much is refused here, the rest when it happens.
  constexpr double kClearly = 1.5;
  if (estimate.paths > kClearly * static_cast<double>(task.max_paths)) return too_many_paths(task);
  // Nodes of some paths, the fewest of them: paths that bend more need more.
  constexpr double kSeveral = 100;  // below that many paths are made faster than told
  if (estimate.paths < kSeveral) return {};
  std::size_t fewest = kMaxNodes;
  for (const double share : {0.3, 0.5, 0.7}) {
    const double w = task.w.lo + share * task.w.length();
    fewest = std::min(fewest, node_count(constant_pass(sheet, task, w).track));
  }
  if (estimate.paths * static_cast<double>(fewest) > kClearly * static_cast<double>(kMaxNodes))
    return too_many_nodes();
  return {};
}

}  // namespace burin::cycle
