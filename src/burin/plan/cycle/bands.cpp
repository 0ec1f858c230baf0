// SPDX-License-Identifier: Apache-2.0
// I2 on surfaces with creases along the paths. The normal jumps there, so that no side step leads across: a
// crease is the last path of what lies before it and the first of what lies behind. On a ridge the ball runs
// along it twice, on either side; in a valley once, where it touches both flanks.
#include <algorithm>
#include <cmath>

#include "burin/geom/surface/modify.h"
#include "burin/plan/cycle/passes.h"

namespace burin::cycle {
namespace {

using geom::Interval;

/// Where the ball touches both flanks of a valley: on the one before the crease and on the one behind.
struct Valley {
  Graph before, behind;
};

/// n . (a x b)
double triple(Vec3 n, Vec3 a, Vec3 b) {
  return dot(n, cross(a, b));
}

/// How far the ball turns about the crease at t: below 0 in a valley.
double turn(const Sheet& before, const Sheet& behind, double t, double crease) {
  const Contact l = before.contact(t, crease), r = behind.contact(t, crease);
  const Vec3 across = unit(unit(l.sw) + unit(r.sw));
  return dot(r.n - l.n, across);
}

/// The w on the sheet `a` where a ball at t touches the sheet `b` as well: Newton for C_a(t, wa) = C_b(tb,
/// wb).
std::optional<double> touching(const Sheet& a, const Sheet& b, double t, double crease) {
  double wa = crease, tb = t, wb = crease;
  constexpr int kIterations = 40;
  for (int i = 0; i < kIterations; ++i) {
    const Contact ca = a.contact(t, wa), cb = b.contact(tb, wb);
    const Vec3 f = cb.c - ca.c;
    constexpr double kConverged = 1e-9;
    if (norm(f) < kConverged * a.radius()) {
      const bool fits =
          wa > a.w_range().lo && wa < a.w_range().hi && wb > b.w_range().lo && wb < b.w_range().hi;
      return fits || wa == crease ? std::optional(wa) : std::nullopt;
    }
    // f = cw_a da - ct_b dt - cw_b dw by Cramer.
    const Vec3 x = ca.cw, y = -cb.ct, z = -cb.cw;
    const double det = triple(x, y, z);
    if (!(std::abs(det) > 1e-12 * norm(x) * norm(y) * norm(z))) return std::nullopt;
    wa = std::clamp(wa + triple(f, y, z) / det, a.w_range().lo, a.w_range().hi);
    tb = std::clamp(tb + triple(x, f, z) / det, b.t_range().lo, b.t_range().hi);
    wb = std::clamp(wb + triple(x, y, f) / det, b.w_range().lo, b.w_range().hi);
  }
  return std::nullopt;
}

/// The places of one flank. Where the ball would touch beyond the ends of the other one, the next place that
/// was found counts.
std::optional<Graph> flank(const Sheet& a, const Sheet& b, const std::vector<double>& places, double crease) {
  std::vector<std::optional<double>> found;
  for (const double t : places) found.push_back(touching(a, b, t, crease));
  const auto has = [](const std::optional<double>& w) { return w.has_value(); };
  const auto first = std::find_if(found.begin(), found.end(), has);
  const auto last = std::find_if(found.rbegin(), found.rend(), has).base();
  if (last - first < static_cast<std::ptrdiff_t>(found.size() / 2) || !std::all_of(first, last, has))
    return std::nullopt;
  std::fill(found.begin(), first, *first);
  std::fill(last, found.end(), *(last - 1));
  std::vector<double> w;
  for (const std::optional<double>& f : found) w.push_back(*f);
  return spline(places, w);
}

std::optional<Valley> valley_of(const Sheet& before, const Sheet& behind, Interval t, double crease) {
  // The curve where the offset surfaces meet is as smooth as they are.
  constexpr int kSamples = 96;
  const std::vector<double> places = samples_along(before, t, kSamples);
  for (const double x : places)
    if (turn(before, behind, x, crease) >= 0) return std::nullopt;
  std::optional<Graph> l = flank(before, behind, places, crease), r = flank(behind, before, places, crease);
  if (!l || !r) return std::nullopt;
  return Valley{std::move(*l), std::move(*r)};
}

/// One band between two creases (or borders).
struct Band {
  geom::NurbsSurface surface;
  Sheet sheet;
  PassTask task;
};

Band band_of(const geom::NurbsSurface& surface, const Sheet& sheet, const PassTask& task, Interval w) {
  const geom::Interval all = sheet.w_range();
  // Creases are borders of the band's surface; what was cut off by trimming is not.
  const Interval part{w.lo == task.w.lo ? all.lo : w.lo, w.hi == task.w.hi ? all.hi : w.hi};
  const bool u = sheet.along() == geom::Direction::u;
  const Interval t = sheet.t_range();
  geom::NurbsSurface cut = u ? geom::sub_surface(surface, t, part) : geom::sub_surface(surface, part, t);
  Sheet s(cut, sheet.along(), sheet.sign(), sheet.radius(), sheet.stock(), sheet.t_inner());
  PassTask k = task;
  k.w = w;
  return {std::move(cut), std::move(s), std::move(k)};
}

}  // namespace

Result<Passes> iso_scallop_between_creases(const geom::NurbsSurface& surface, const Sheet& sheet,
                                           const PassTask& task) {
  std::vector<double> cuts{task.w.lo};
  for (const double crease : sheet.w_creases())
    if (crease > task.w.lo && crease < task.w.hi) cuts.push_back(crease);
  cuts.push_back(task.w.hi);
  std::vector<Band> bands;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
    bands.push_back(band_of(surface, sheet, task, {cuts[i], cuts[i + 1]}));
  Passes all;
  std::size_t nodes = 0;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    PassTask& here = bands[i].task;
    const std::optional<Valley> valley =
        i + 1 < bands.size() ? valley_of(bands[i].sheet, bands[i + 1].sheet, task.t, cuts[i + 1])
                             : std::nullopt;
    if (valley) {
      here.border_hi = valley->before;
      bands[i + 1].task.border_lo = valley->behind;
    }
    here.most_length = task.most_length - all.length;
    Result<Passes> r = iso_scallop(bands[i].sheet, here);
    if (!r) return r;
    all.length += r->length;
    all.given_up = r->given_up;
    if (all.given_up) return all;
    if (r->passes.empty()) continue;
    for (const Pass& p : r->passes) nodes += node_count(p.track);
    if (nodes > kMaxNodes) return too_many_nodes();
    // The path in the valley is the last of one side and the first of the other.
    std::size_t first = 0;
    if (!all.passes.empty()) {
      if (here.border_lo) {
        first = 1;
      } else {
        PairFigures ridge;
        ridge.last = true;
        ridge.scallop_min = kNoOverlap;  // nothing stands between two balls that touch the same line
        all.pairs.push_back(ridge);
      }
    }
    for (std::size_t k = first; k < r->passes.size(); ++k) all.passes.push_back(std::move(r->passes[k]));
    for (const PairFigures& f : r->pairs) all.pairs.push_back(f);
    if (all.passes.size() > task.max_paths) return too_many_paths(task);
  }
  run_over_edges(sheet, task, all);
  return all;
}

}  // namespace burin::cycle
