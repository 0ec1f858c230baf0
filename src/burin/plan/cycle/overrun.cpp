// SPDX-License-Identifier: Apache-2.0
// Where paths meet the edge of the surface at a slant, what stands on the edge between two of them is reached
// by one from inside and by the other only from beyond its end: it is cut by letting the paths run over the
// edge up to the foot of that place.
#include <algorithm>
#include <cmath>

#include "burin/plan/cycle/passes.h"

namespace burin::cycle {
namespace {

/// The highest place on the edge between a path and those after it.
struct EdgeRidge {
  double height = 0;
  double foot = 0;           ///< on the path
  std::vector<double> feet;  ///< on those after it
  std::size_t lowest = 0;    ///< which of them leaves least there
};

/// What the ball on its way leaves over a place, and where it stands then.
double left_over(const Sheet& sheet, const Contact& q, const NearestCentre& path, double& foot) {
  NearestCentre::Place at = path.find(q.s + (sheet.radius() + sheet.stock()) * q.n);
  double h = height_over(sheet, q, at.c);
  // The centre nearest to the point of the ball that counts, not to the one above the place.
  constexpr int kRounds = 3;
  for (int i = 0; i < kRounds && h < kNoOverlap; ++i) {
    at = path.find(q.s + (h + sheet.stock()) * q.n);
    h = height_over(sheet, q, at.c);
  }
  foot = at.s;
  return h;
}

// `lo`, `hi`: where the path and the next one meet the edge.
EdgeRidge ridge_on_edge(const Sheet& sheet, double edge, double lo, double hi, const NearestCentre& path,
                        const std::vector<const NearestCentre*>& after) {
  EdgeRidge r;
  r.feet.resize(after.size());
  constexpr int kHalvings = 14;
  for (int i = 0; i < kHalvings; ++i) {
    const double w = 0.5 * (lo + hi);
    const Contact q = sheet.contact(edge, w);
    const double ha = left_over(sheet, q, path, r.foot);
    double hb = kNoOverlap;
    for (std::size_t k = 0; k < after.size(); ++k) {
      const double h = left_over(sheet, q, *after[k], r.feet[k]);
      if (h < hb) hb = h, r.lowest = k;
    }
    r.height = std::min(ha, hb);
    (ha < hb ? lo : hi) = w;
  }
  return r;
}

}  // namespace

void run_over_edges(const Sheet& sheet, const PassTask& task, Passes& r) {
  if (task.inner_t == task.t) return;
  std::vector<Before> centres;
  centres.reserve(r.passes.size());
  for (Pass& p : r.passes) {
    p.kept = p.inner = task.inner_t;
    centres.emplace_back(p, sheet.radius());
  }
  for (const bool first : {true, false}) {
    const double edge = first ? task.inner_t.lo : task.inner_t.hi;
    if (edge == (first ? task.t.lo : task.t.hi)) continue;
    // A little beyond the foot: the path must not end right there.
    const auto keep = [&](Pass& p, double foot) {
      constexpr double kMore = 0.05;
      const double to = foot + kMore * (foot - edge);
      (first ? p.kept->lo : p.kept->hi) = first ? std::min(p.kept->lo, to) : std::max(p.kept->hi, to);
    };
    std::size_t before = r.passes.size();
    for (std::size_t i = 0; i < r.passes.size(); ++i) {
      if (!r.passes[i].covers(edge)) continue;
      if (before < i) {
        // A path that ends at the border beyond the edge is followed by the border itself.
        const std::size_t border = r.passes.size() - 1;
        std::vector<const NearestCentre*> after{&centres[i].centres(edge)};
        if (border != i) after.push_back(&centres[border].centres(edge));
        const EdgeRidge ridge = ridge_on_edge(sheet, edge, r.passes[before].w_at(edge),
                                              r.passes[i].w_at(edge), centres[before].centres(edge), after);
        keep(r.passes[before], ridge.foot);
        keep(r.passes[ridge.lowest == 0 ? i : border], ridge.feet[ridge.lowest]);
        PairFigures& f = r.pairs[i - 1];
        // Next to a valley no ball gets everywhere.
        const bool valley = r.passes[before].valley || r.passes[i].valley;
        if (!valley && f.scallop_min != kNoOverlap && ridge.height < kNoOverlap)
          f.scallop_max = std::max(f.scallop_max, ridge.height);
      }
      before = i;
    }
  }
}

}  // namespace burin::cycle
