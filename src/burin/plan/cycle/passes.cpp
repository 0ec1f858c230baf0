// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/cycle/passes.h"

#include <algorithm>
#include <cmath>

#include "burin/base/text.h"

namespace burin::cycle {

std::vector<double> samples_along(const Sheet& sheet, geom::Interval t, int count) {
  std::vector<double> cuts{t.lo};
  for (const geom::Knot& k : sheet.t_knots())
    if (k.value > t.lo && k.value < t.hi) cuts.push_back(k.value);
  cuts.push_back(t.hi);
  std::vector<double> out;
  // Long knot vectors: every span still counts, but no more than this many samples in all.
  constexpr std::size_t kMostSpans = 512;
  if (cuts.size() > kMostSpans) {
    cuts = {t.lo, t.hi};
    count = static_cast<int>(kMostSpans);
  }
  // Where there are more spans than samples were asked for, the knots are samples enough.
  const int least = cuts.size() > static_cast<std::size_t>(count) ? 1 : 3;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double share = (cuts[i + 1] - cuts[i]) / t.length();
    const int n = std::max(least, static_cast<int>(std::ceil(share * count)));
    for (int k = 0; k < n; ++k) out.push_back(cuts[i] + (cuts[i + 1] - cuts[i]) * k / n);
  }
  out.push_back(t.hi);
  return out;
}

bool collapsed(const Sheet& sheet, geom::Interval t, double w) {
  // As large as the errors of files: a border this short is a point for every tool.
  constexpr double kPoint = 1e-5;
  const Point3 first = sheet.point(t.lo, w);
  constexpr int kSamples = 16;
  for (int i = 1; i <= kSamples; ++i)
    if (distance(first, sheet.point(t.lo + t.length() * i / kSamples, w)) > kPoint) return false;
  return true;
}

double use_of_limits(const PassTask& task, const Cusp& c) {
  const double by_scallop = std::sqrt(std::max(0.0, c.height) / task.scallop);
  const double by_side = task.side_step ? c.side_step / *task.side_step : 0;
  const double by_fit = c.too_tight ? c.side_step / task.tight_step : 0;
  return std::max({by_scallop, by_side, by_fit});
}

double first_step(const Sheet& sheet, const PassTask& task, double t, double w) {
  const double d = std::sqrt(8 * sheet.radius() * task.scallop);
  const double limited = task.side_step ? std::min(d, *task.side_step) : d;
  const double speed = norm(sheet.contact(t, w).sw);
  const double most = 0.25 * task.w.length();
  return speed * most > limited ? limited / speed : most;
}

Pass constant_pass(const Sheet& sheet, const PassTask& task, double w) {
  Pass p;
  p.graphs.push_back(constant(task.t.lo, task.t.hi, w));
  p.track = build_track(sheet, p.graphs.front(), task.path_mm);
  return p;
}

bool too_long(const PassTask& task, Passes& passes, const Pass& pass) {
  for (const TrackPiece& p : pass.track)
    for (std::size_t k = 0; k + 1 < p.tip.nodes.size(); ++k)
      passes.length += distance(p.tip.nodes[k].p, p.tip.nodes[k + 1].p);
  passes.given_up = passes.length > task.most_length;
  return passes.given_up;
}

Error too_many_paths(const PassTask& task) {
  return {
      ErrorCode::range,
      "more than " + std::to_string(task.max_paths) +
          " paths would be needed (a larger scallop S or side step M, or a larger tool, would be accepted)",
      {}};
}

Error too_many_nodes() {
  return {ErrorCode::range,
          "the paths would need more than " + std::to_string(kMaxNodes) +
              " nodes (a larger scallop S or side step M would be accepted)",
          {}};
}

}  // namespace burin::cycle
