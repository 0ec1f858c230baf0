// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/initial.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace burin::orient {
namespace {

// Steps along the curve: allowed stretches shorter than one may be passed over where the machine's limits or
// a single place of the part block both sides.
constexpr int kCurveSteps = 64;
// Places met along one curve before it is given up.
constexpr int kMostPlaces = 200;
// Yaws of the enumeration, over the whole range.
constexpr int kEnumeratedYaws = 61;

class CauseCount {
 public:
  void add(Cause cause) { ++counts_[static_cast<std::size_t>(cause)]; }
  Cause most() const {
    const auto best = std::max_element(counts_.begin(), counts_.end());
    return *best > 0 ? static_cast<Cause>(best - counts_.begin()) : Cause::none;
  }

 private:
  std::array<int, 5> counts_{};
};

/// The end of what `blocked(s)` says from s on: steps, then bisection; above 1: it holds up to the end.
template <class Blocked>
double end_of(double s, const Blocked& blocked) {
  double in = s, out = s;
  do {
    if (out >= 1) return 2;
    in = out;
    out = std::min(1.0, out + 1.0 / kCurveSteps);
  } while (blocked(out));
  while (out - in > kCurveTolerance) {
    const double middle = (in + out) / 2;
    (blocked(middle) ? in : out) = middle;
  }
  return out;
}

/// What stands in the way at one pose, `known` first.
struct Hindrance {
  Cause cause = Cause::none;
  std::optional<std::size_t> place;  ///< index into the relaxation
};
Hindrance hindrance(const Setting& setting, const CcPoint& at, const Angles& angles, Relaxation& known,
                    Scene::Memory& memory) {
  const Scene& scene = *setting.scene;
  if (const auto place = known.blocked(angles))
    return {scene.body()[known.witness(*place).piece].cause, place};
  const double beta = angles.alpha > kNoTilt ? angles.beta : 0;
  const Scene::FirstFree here = scene.first_free(at, beta, angles.alpha, angles.alpha, memory);
  if (!here.found) {
    if (here.witness && known.add(*here.witness) && known.blocks(known.size() - 1, angles))
      return {here.cause, known.size() - 1};
    return {here.cause, std::nullopt};
  }
  return {setting.limits->within(pose(at, angles, scene.mill())) ? Cause::none : Cause::limit, std::nullopt};
}

/// The first allowed place of the curve. Jumps from end to end of what one place of the part blocks, so no
/// allowed stretch is passed over that its own blockers leave open for a step.
Initial first_on(const StartCurve& curve, const Setting& setting, const CcPoint& at, Relaxation& known,
                 Scene::Memory& memory, CauseCount& causes) {
  double s = 0;
  Initial found;
  for (int places = 0; places < kMostPlaces && s <= 1; ++places) {
    const Angles angles = curve.at(s);
    const Hindrance there = hindrance(setting, at, angles, known, memory);
    if (there.cause == Cause::none) {
      found.found = true;
      found.angles = angles;
      return found;
    }
    causes.add(there.cause);
    found.cause = there.cause;
    if (there.place)
      s = end_of(s, [&](double x) { return known.blocks(*there.place, curve.at(x)); });
    else if (there.cause == Cause::limit)
      s = end_of(
          s, [&](double x) { return !setting.limits->within(pose(at, curve.at(x), setting.scene->mill())); });
    else
      s += 1.0 / kCurveSteps;
  }
  return found;
}

/// The paper's enumeration: whether there is anything at all. Yaws outwards from that of the corner.
Initial enumerated(const Setting& setting, const CcPoint& at, Relaxation& known, Scene::Memory& memory,
                   CauseCount& causes) {
  const AngleRange& range = setting.range;
  const double middle = range.widest().beta, step = (range.beta_hi - range.beta_lo) / (kEnumeratedYaws - 1);
  for (int k = 0; k <= 2 * kEnumeratedYaws; ++k) {
    const double beta = middle + (k % 2 == 0 ? 1 : -1) * ((k + 1) / 2) * step;
    if (beta < range.beta_lo || beta > range.beta_hi || (k > 0 && step <= 0)) continue;
    const double from = known.first_tilt(beta, range.alpha_lo, range.alpha_hi);
    if (from > range.alpha_hi) continue;
    const Scene::FirstFree free = first_allowed(setting, at, beta, from, memory);
    if (free.witness) known.add(*free.witness);
    if (free.found) return {true, false, {free.alpha, beta}, free.cause};
    causes.add(free.cause);
  }
  return {};
}

}  // namespace

StartCurve::StartCurve(const AngleRange& range, double end_yaw)
    : start_(range.widest()), corner_{range.alpha_hi, start_.beta}, end_{range.alpha_hi, end_yaw} {}

Angles StartCurve::at(double s) const {
  const double w = std::sqrt(0.5);  // of the middle control point: an ellipse
  const double b0 = (1 - s) * (1 - s), b1 = 2 * w * s * (1 - s), b2 = s * s, sum = b0 + b1 + b2;
  // As differences from the start: both angles then stay within their ranges to rounding.
  return {std::min(start_.alpha + (corner_.alpha - start_.alpha) * ((b1 + b2) / sum), corner_.alpha),
          s >= 1 ? end_.beta : start_.beta + (end_.beta - start_.beta) * (b2 / sum)};
}

Initial initial_solution(const Setting& setting, const CcPoint& at, Relaxation& known,
                         Scene::Memory& memory) {
  const AngleRange& range = setting.range;
  const Angles corner = range.widest();
  CauseCount causes;
  const Hindrance there = hindrance(setting, at, corner, known, memory);
  if (there.cause == Cause::none) return {true, true, corner, Cause::bound};
  // The farther end of the yaws first.
  const bool low_first = corner.beta - range.beta_lo >= range.beta_hi - corner.beta;
  const std::array<double, 2> ends{low_first ? range.beta_lo : range.beta_hi,
                                   low_first ? range.beta_hi : range.beta_lo};
  for (const double end : ends) {
    if (end == corner.beta && end != ends[0]) continue;
    const Initial found = first_on(StartCurve(range, end), setting, at, known, memory, causes);
    if (found.found) return found;
  }
  Initial found = enumerated(setting, at, known, memory, causes);
  if (!found.found) found.cause = causes.most();
  return found;
}

Optimum find_initial(const Setting& setting, const Goal& goal, const CcPoint& at, Scene::Memory& memory) {
  const std::uint64_t before = memory.tests;
  Relaxation known(*setting.scene, at);
  const Initial initial = initial_solution(setting, at, known, memory);
  Optimum result;
  result.found = result.initial_found = initial.found;
  result.cause = initial.cause;
  if (initial.found) {
    result.angles = result.initial = initial.angles;
    result.value = result.initial_value = goal.value(at, initial.angles);
  }
  result.tests = static_cast<std::uint32_t>(memory.tests - before);
  return result;
}

}  // namespace burin::orient
