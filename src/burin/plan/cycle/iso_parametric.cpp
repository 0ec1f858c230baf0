// SPDX-License-Identifier: Apache-2.0
// I1: paths of constant w, each as far from the one before as scallop and side step allow at the worst place.
#include <algorithm>
#include <cmath>

#include "burin/plan/cycle/passes.h"

namespace burin::cycle {
namespace {

// The step is accepted when its worst place uses this much of the limits. 0.9995 leaves 1e-3 of the height
// for what lies between the samples.
constexpr double kMost = 0.9995;
constexpr double kEnough = 0.985;
constexpr double kAim = 0.993;

/// The worst place between a path and the constant w.
struct Worst {
  double use = 0;
  PairFigures figures;
};

class Stepper {
 public:
  Stepper(const Sheet& sheet, const PassTask& task)
      : sheet_(sheet), task_(task), samples_(samples_along(sheet, task.t, kSamples)) {}

  const std::vector<double>& samples() const { return samples_; }

  Worst worst(const Before& before, double w) const {
    Worst r;
    r.figures.scallop_min = kNoOverlap;
    std::vector<double> use(samples_.size(), -1.0);
    const auto measure = [&](std::size_t i) {
      if (use[i] < 0) use[i] = at(before, samples_[i], w, r);
    };
    // A few places first; the others only where something near comes close to the worst.
    constexpr std::size_t kStride = 4;
    for (std::size_t i = 0; i < samples_.size(); i += kStride) measure(i);
    measure(samples_.size() - 1);
    const double coarse = r.use;
    for (std::size_t i = 0; i < samples_.size(); i += kStride) {
      const std::size_t next = std::min(i + kStride, samples_.size() - 1);
      if (std::max(use[i], use[next]) < 0.8 * coarse) continue;
      for (std::size_t k = i + 1; k < next; ++k) measure(k);
    }
    for (std::size_t i = 1; i + 1 < samples_.size(); ++i) {
      if (use[i - 1] < 0 || use[i] < 0 || use[i + 1] < 0) continue;
      if (use[i] >= use[i - 1] && use[i] >= use[i + 1] && use[i] > 0.97 * r.use) peak(before, w, use, i, r);
    }
    return r;
  }

 private:
  static constexpr int kSamples = 48;

  double at(const Before& before, double t, double w, Worst& r) const {
    const Cusp c = cusp(sheet_, before, t, w, 0.0, true);
    const double use = use_of_limits(task_, c);
    if (!c.too_tight) {
      r.figures.scallop_min = std::min(r.figures.scallop_min, c.height);
      r.figures.scallop_max = std::max(r.figures.scallop_max, c.height);
    }
    r.figures.side_step_max = std::max(r.figures.side_step_max, c.side_step);
    r.use = std::max(r.use, use);
    return use;
  }

  // The parabola through a sample that is larger than its neighbours has its top between them.
  void peak(const Before& before, double w, const std::vector<double>& use, std::size_t i, Worst& r) const {
    const double x0 = samples_[i - 1], x1 = samples_[i], x2 = samples_[i + 1];
    const double s01 = (use[i] - use[i - 1]) / (x1 - x0), s12 = (use[i + 1] - use[i]) / (x2 - x1);
    const double bend = (s12 - s01) / (x2 - x0);
    // Flat: rounding is larger than what could be found.
    if (!(bend < 0) || std::max(s01, -s12) * (x2 - x0) < 1e-4) return;
    const double top = 0.5 * (x0 + x1) - 0.5 * s01 / bend;
    if (top > x0 && top < x2) at(before, top, w, r);
  }

  const Sheet& sheet_;
  const PassTask& task_;
  std::vector<double> samples_;
};

struct Step {
  double w = 0;
  Worst worst;
};

// The largest step that keeps the limits: the use of them grows almost linearly with the step.
// Below `floor` it is not looked for: a place that no step satisfies must not cost a million paths.
Step next_step(const Stepper& stepper, const Before& before, const PassTask& task, double w, double guess,
               double floor) {
  constexpr int kIterations = 24;
  double ok = 0, bad = -1;  // steps known to keep the limits, known to break them
  Worst at_ok;
  double step = guess;
  const double room = task.w.hi - w;
  for (int i = 0; i < kIterations; ++i) {
    step = std::clamp(step, std::min(floor, room), room);
    const bool border = step >= room;
    const Worst found = stepper.worst(before, border ? task.w.hi : w + step);
    if (found.use <= kMost || step <= floor) {
      ok = step;
      at_ok = found;
      // Later tries are content with less.
      if (border || step <= floor || found.use >= (i < 6 ? kEnough : 0.9)) break;
    } else {
      bad = step;
    }
    double next = found.use > 0 ? std::clamp(step * kAim / found.use, 0.1 * step, 4 * step) : 4 * step;
    if (bad >= 0 && (next >= bad || next <= ok)) next = 0.5 * (ok + bad);
    if (bad < 0 && next <= ok) next = 2 * ok;
    step = next;
    if (bad >= 0 && bad - ok < 1e-3 * bad && ok > 0) break;
  }
  return {ok >= room ? task.w.hi : w + ok, at_ok};
}

double smallest_first_step(const Sheet& sheet, const PassTask& task, const std::vector<double>& samples,
                           double w) {
  double step = task.w.length();
  for (const double t : samples) step = std::min(step, first_step(sheet, task, t, w));
  return step;
}

double height_over_pole(const Sheet& sheet, const PassTask& task, double w, double pole_w) {
  double most = 0;
  for (const double t : samples_along(sheet, task.t, 16))
    most = std::max(most, height_at(sheet, t, pole_w, sheet.contact(t, w).c));
  return most;
}

}  // namespace

Result<Passes> iso_parametric(const Sheet& sheet, const PassTask& task) {
  Passes r;
  const Stepper stepper(sheet, task);
  const bool pole_lo = collapsed(sheet, task.t, task.w.lo), pole_hi = collapsed(sheet, task.t, task.w.hi);
  double w = task.w.lo;
  double guess = smallest_first_step(sheet, task, stepper.samples(), w);
  if (task.w.length() / guess > 4.0 * static_cast<double>(task.max_paths)) return too_many_paths(task);
  std::size_t nodes = 0;
  if (!pole_lo) r.passes.push_back(constant_pass(sheet, task, w));
  const double least = 1e-3 * task.w.length() / static_cast<double>(task.max_paths);
  while (w < task.w.hi) {
    const Before before = r.passes.empty() ? Before(task.t.lo, w) : Before(r.passes.back(), sheet.radius());
    // A sharp bend needs closer paths than a plane; sixteen times as many is the most that is tried.
    const double floor = smallest_first_step(sheet, task, stepper.samples(), w) / 16;
    Step s = next_step(stepper, before, task, w, guess, floor);
    if (!(s.w - w > least)) s.w = std::min(w + std::max(least, 1e-3 * guess), task.w.hi);
    const bool last = s.w >= task.w.hi;
    if (last && pole_hi) {
      if (!r.passes.empty() && height_over_pole(sheet, task, w, task.w.hi) <= kMost * kMost * task.scallop)
        break;
      s.w = 0.5 * (w + task.w.hi);
      s.worst = stepper.worst(before, s.w);
    }
    if (!r.passes.empty()) {
      s.worst.figures.last = last;
      s.worst.figures.side_step_binds =
          task.side_step && s.worst.figures.side_step_max > 0.9 * *task.side_step;
      r.pairs.push_back(s.worst.figures);
    }
    if (r.passes.size() >= task.max_paths) return too_many_paths(task);
    guess = std::max(s.w - w, least);
    w = s.w;
    r.passes.push_back(constant_pass(sheet, task, w));
    nodes += node_count(r.passes.back().track);
    if (nodes > kMaxNodes) return too_many_nodes();
    if (too_long(task, r, r.passes.back())) break;
  }
  return r;
}

}  // namespace burin::cycle
