// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/cspace.h"

#include <algorithm>
#include <cmath>

#include "burin/plan/orient/initial.h"

namespace burin::orient {
namespace {

// Steps of tilt in which a machine's travel is looked for, over the whole range of tilts: what the machine
// allows for less than that may be passed over.
constexpr int kLimitSteps = 128;
// rad
constexpr double kTiltTolerance = 1e-9;
// How far beyond an optimum its cause is looked for: rad of tilt; share of the way to the widest corner's
// yaw, to begin with.
constexpr double kJustBelow = 1e-6, kJustBeside = 2.5e-4;
// rad: Goal::tilt_of by bisection.
constexpr double kGoalTilt = 1e-6;
// Scene and machine in turns: each turn raises the tilt by a step, so more turns than steps mean nothing.
constexpr int kMostTurns = 2 * kLimitSteps;

bool within(const Setting& setting, const CcPoint& at, const Angles& angles) {
  return setting.limits->within(pose(at, angles, setting.scene->mill()));
}

/// Lying in the tangent plane the tool has no yaw: a pose of its own, before the walk over the tilts.
Scene::FirstFree first_in_scene(const Setting& setting, const CcPoint& at, double beta, double from,
                                Scene::Memory& memory) {
  const Scene& scene = *setting.scene;
  const double to = setting.range.alpha_hi;
  if (from > kNoTilt || beta == 0) return scene.first_free(at, beta, from, to, memory);
  const Scene::FirstFree flat = scene.first_free(at, 0, from, from, memory);
  if (flat.found || to <= 2 * kNoTilt) return flat;
  return scene.first_free(at, beta, 2 * kNoTilt, to, memory);
}

}  // namespace

double first_within(const Setting& setting, const CcPoint& at, double beta, double from, double to) {
  if (within(setting, at, {from, beta})) return from;
  const double step =
      std::max((setting.range.alpha_hi - setting.range.alpha_lo) / kLimitSteps, kTiltTolerance);
  double out = from, in = from;
  do {
    if (in >= to) return std::nextafter(to, 10.0);
    out = in;
    in = std::min(in + step, to);
  } while (!within(setting, at, {in, beta}));
  while (in - out > kTiltTolerance) {
    const double middle = (in + out) / 2;
    (within(setting, at, {middle, beta}) ? in : out) = middle;
  }
  return in;
}

Cause cause_beyond(const Setting& setting, const CcPoint& at, const Angles& best, const Relaxation& known,
                   Scene::Memory& memory) {
  const auto cause_of = [&](const Angles& beyond) {
    if (const auto place = known.blocked(beyond))
      return setting.scene->body()[known.witness(*place).piece].cause;
    return cause_at(setting, at, beyond, memory);
  };
  const double middle = setting.range.widest().beta, away = best.beta - middle;
  Cause cause = Cause::none;
  if (best.alpha - kJustBelow >= setting.range.alpha_lo)
    cause = cause_of({best.alpha - kJustBelow, best.beta});
  else
    for (double share = kJustBeside; cause == Cause::none && away != 0 && share < 1; share *= 4)
      cause = cause_of({best.alpha, best.beta - share * away});
  return cause == Cause::none ? Cause::bound : cause;
}

Cause cause_at(const Setting& setting, const CcPoint& at, const Angles& angles, Scene::Memory& memory) {
  const cl::Pose there = pose(at, angles, setting.scene->mill());
  const Cause cause = setting.scene->cause(there, memory);
  if (cause != Cause::none) return cause;
  return setting.limits->within(there) ? Cause::none : Cause::limit;
}

Scene::FirstFree first_allowed(const Setting& setting, const CcPoint& at, double beta, double from,
                               Scene::Memory& memory) {
  Scene::FirstFree free = first_in_scene(setting, at, beta, from, memory);
  if (setting.limits->unlimited()) return free;
  for (int turn = 0; free.found && turn < kMostTurns; ++turn) {
    const double kept = first_within(setting, at, beta, free.alpha, setting.range.alpha_hi);
    if (kept == free.alpha) return free;
    if (kept > setting.range.alpha_hi) return {setting.range.alpha_hi, false, std::nullopt, Cause::limit};
    const Scene::FirstFree next = first_in_scene(setting, at, beta, kept, memory);
    if (next.found && next.alpha == kept) return {kept, true, std::nullopt, Cause::limit};
    free = next;
  }
  free.found = false;
  return free;
}

Angles CSpaceMap::node(int i, int j) const {
  const auto at = [](double lo, double hi, int k, int count) {
    return k == count - 1 ? hi : lo + k * (hi - lo) / (count - 1);
  };
  return {at(range.alpha_lo, range.alpha_hi, i, tilts), at(range.beta_lo, range.beta_hi, j, yaws)};
}

CSpaceMap make_map(const Setting& setting, const CcPoint& at, int tilts, int yaws, Scene::Memory& memory) {
  CSpaceMap map{setting.range, tilts, yaws, {}};
  map.cells.reserve(static_cast<std::size_t>(tilts) * static_cast<std::size_t>(yaws));
  for (int j = 0; j < yaws; ++j)
    for (int i = 0; i < tilts; ++i) map.cells.push_back(cause_at(setting, at, map.node(i, j), memory));
  return map;
}

double Goal::tilt_of(const CcPoint& at, double value_wanted, double beta, double lo, double hi) const {
  if (value(at, {hi, beta}) >= value_wanted) return hi;
  if (!(value(at, {lo, beta}) >= value_wanted)) return lo;
  while (hi - lo > kGoalTilt) {
    const double middle = (lo + hi) / 2;
    (value(at, {middle, beta}) >= value_wanted ? lo : hi) = middle;
  }
  return hi;
}

double RadiusGoal::tilt_of(const CcPoint&, double value_wanted, double beta, double lo, double hi) const {
  const double corner = mill_->kind == model::MillKind::flat ? 0 : mill_->corner_radius;
  if (value_wanted <= corner) return hi;
  const auto tilt = contour_tilt(value_wanted, beta, *mill_);
  return tilt ? std::clamp(*tilt, lo, hi) : hi;
}

double RadiusGoal::value(const CcPoint&, const Angles& angles) const {
  return effective_radius(angles, *mill_);
}

}  // namespace burin::orient
