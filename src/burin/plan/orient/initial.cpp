// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/initial.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace burin::orient {
namespace {

// Steps along the curve: allowed stretches shorter than one may be passed over.
constexpr int kCurveSteps = 32;
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

/// What stands in the way at one pose, `known` first; learn: it is added to that.
Cause hindrance(const Setting& setting, const CcPoint& at, const Angles& angles, bool learn,
                Relaxation& known, Scene::Memory& memory) {
  const Scene& scene = *setting.scene;
  if (const auto place = known.blocked(angles)) return scene.body()[known.witness(*place).piece].cause;
  const cl::Pose there = pose(at, angles, scene.mill());
  if (!learn) {
    if (const auto blocker = scene.blocker(there, memory)) return scene.body()[blocker->piece].cause;
    return setting.limits->within(there) ? Cause::none : Cause::limit;
  }
  const double beta = angles.alpha > kNoTilt ? angles.beta : 0;
  const Scene::FirstFree here = scene.first_free(at, beta, angles.alpha, angles.alpha, memory);
  if (!here.found) {
    if (here.witness) known.add(*here.witness);
    return here.cause;
  }
  return setting.limits->within(there) ? Cause::none : Cause::limit;
}

/// The first allowed place of the curve: steps from its start, which is forbidden, then bisection. What is
/// known already spares tests but has no say in the result.
Initial first_on(const StartCurve& curve, const Setting& setting, const CcPoint& at, Relaxation& known,
                 Scene::Memory& memory, CauseCount& causes) {
  Initial found;
  double out = 0, in = 0;
  for (int k = 1; k <= kCurveSteps && !found.found; ++k) {
    in = static_cast<double>(k) / kCurveSteps;
    const Cause there = hindrance(setting, at, curve.at(in), true, known, memory);
    found.found = there == Cause::none;
    if (found.found) break;
    found.cause = there;
    causes.add(there);
    out = in;
  }
  if (!found.found) return found;
  while (in - out > kCurveTolerance) {
    const double middle = (in + out) / 2;
    const Cause there = hindrance(setting, at, curve.at(middle), false, known, memory);
    if (there == Cause::none) {
      in = middle;
    } else {
      out = middle;
      found.cause = there;
    }
  }
  found.angles = curve.at(in);
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
    const Relaxation::Reach reach = known.blocked_from(beta, range.alpha_lo, range.alpha_hi);
    if (reach.covered) continue;
    const Scene::FirstFree free = first_allowed(setting, at, beta, reach.alpha, memory);
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
  const Cause at_corner = hindrance(setting, at, corner, true, known, memory);
  if (at_corner == Cause::none) return {true, true, corner, Cause::bound};
  causes.add(at_corner);
  // The farther end of the yaws first.
  const bool low_first = corner.beta - range.beta_lo >= range.beta_hi - corner.beta;
  const std::array<double, 2> ends{low_first ? range.beta_lo : range.beta_hi,
                                   low_first ? range.beta_hi : range.beta_lo};
  for (const double end : ends) {
    if (&end != ends.data() && (end == corner.beta || end == ends[0])) continue;
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
