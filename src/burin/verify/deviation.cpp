// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "burin/base/parallel.h"
#include "burin/geom/point_tools.h"
#include "burin/verify/deviation_search.h"
#include "burin/verify/mill_walk.h"
#include "burin/verify/sample_tile.h"

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

// Neighbouring samples that share one walk through the index.
constexpr std::size_t kTile = 64;
// Tiles between two reports of progress.
constexpr std::size_t kTilesAtOnce = 4096;
// Between the samples so much is left to find, in resolutions.
constexpr double kGap = 2;
// Tiles with the worst samples, steps of the search in one of them and in one of the others, and in all of
// those together that need more.
constexpr std::size_t kFirst = 32;
constexpr std::size_t kStepsFirst = 3'000;
constexpr std::size_t kStepsTile = 50;
constexpr std::size_t kStepsLeft = 100'000;
// A histogram shows so many of the samples within its ends (the rest is in its outermost bins), and is never
// narrower than this to either side, mm.
constexpr double kUsual = 0.995;
constexpr double kNarrowest = 1e-4;

/// Samples that look the same way and lie near each other follow each other.
std::vector<std::uint32_t> neighbourly_order(const std::vector<SurfaceSample>& samples) {
  geom::Box3 box;
  for (const SurfaceSample& s : samples) box.add(s.p);
  const Vec3 size = box.hi - box.lo;
  constexpr double kCells = 1 << 20;
  const double scale = (kCells - 1) / std::max({size.x, size.y, size.z, std::numeric_limits<double>::min()});
  // Every third bit.
  const auto spread = [](std::uint64_t x) {
    x = (x | x << 32) & 0x1f00000000ffffULL;
    x = (x | x << 16) & 0x1f0000ff0000ffULL;
    x = (x | x << 8) & 0x100f00f00f00f00fULL;
    x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
    return (x | x << 2) & 0x1249249249249249ULL;
  };
  const auto key = [&](const SurfaceSample& s) {
    const Vec3 d = scale * (s.p - box.lo), a{std::abs(s.n.x), std::abs(s.n.y), std::abs(s.n.z)};
    const std::size_t main = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const std::uint64_t side = 2 * main + (component(s.n, main) < 0 ? 1 : 0);
    return side << 60 | spread(static_cast<std::uint64_t>(d.x)) << 2 |
           spread(static_cast<std::uint64_t>(d.y)) << 1 | spread(static_cast<std::uint64_t>(d.z));
  };
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i) keys[i] = {key(samples[i]), i};
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order(samples.size());
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].second;
  return order;
}

Error range(const std::string& what) {
  return {ErrorCode::range, what, {}};
}
Error geometry(const std::string& what) {
  return {ErrorCode::geometry, what, {}};
}

Result<void> validate(const geom::Mesh& mesh, const SampledSurface& surface) {
  if (surface.cells.size() != surface.samples.size())
    return geometry("the samples do not know their cells (sample_surface makes them)");
  if (!surface.normals.empty() && surface.normals.size() != mesh.vertices.size())
    return geometry("the samples are of another mesh");
  for (std::size_t i = 0; i < surface.samples.size(); ++i) {
    const SurfaceSample& s = surface.samples[i];
    if (!is_finite(s.p) || !is_finite(s.n) || !std::isfinite(s.area_mm2))
      return geometry("sample " + std::to_string(i) + " is not finite");
    if (surface.cells[i].triangle >= mesh.triangles.size())
      return geometry("sample " + std::to_string(i) + " is of a triangle that the mesh does not have");
  }
  if (surface.samples.size() >= Moment::kNone) return range("too many samples (4,000,000,000 at most)");
  return {};
}

Result<void> validate(const CheckedPath& path, const DeviationOptions& options) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (!positive(options.reach_mm) || !positive(options.resolution_mm))
    return range("reach and resolution must be positive");
  if (!(std::isfinite(options.tolerance_mm) && options.tolerance_mm >= 0))
    return range("the tolerance must not be negative");
  if (path.piece_count() >= Moment::kNone) return range("too many pieces of motion (4,000,000,000 at most)");
  return verify::validate(path);
}

class Measure {
 public:
  Measure(const geom::Mesh& mesh, const SampledSurface& surface, const CheckedPath& path,
          const DeviationOptions& options, ProgressSink* progress)
      : mesh_(mesh),
        surface_(surface),
        path_(path),
        options_(options),
        progress_(progress),
        inscribed_(mesh) {}

  Result<DeviationReport> run() {
    swept_ = swept_tools(path_);
    order_ = neighbourly_order(surface_.samples);
    report_.deviation_mm.resize(order_.size());
    moments_.resize(order_.size());
    tiles_.resize((order_.size() + kTile - 1) / kTile);
    std::vector<std::size_t> all(tiles_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    if (!each("deviation", all, [&](std::size_t t) { measure(t); })) return stopped();
    TileWorst worst;
    const auto collect = [&] {
      for (const TileWorst& w : tiles_) {
        if (w.gouge.mm > worst.gouge.mm) worst.gouge = w.gouge;
        if (w.excess.mm > worst.excess.mm) worst.excess = w.excess;
      }
    };
    collect();
    if (!search(worst, &TileWorst::gouge, "worst gouge") ||
        !search(worst, &TileWorst::excess, "worst excess"))
      return stopped();
    report_.gouge = worst.gouge;
    report_.excess = worst.excess;
    report_.bound_mm = options_.resolution_mm + path_.motion_mm;
    for (const TileWorst& w : tiles_)
      report_.bound_mm =
          std::max({report_.bound_mm, w.gouge_most - worst.gouge.mm, w.excess_most - worst.excess.mm});
    add_areas();
    return std::move(report_);
  }

 private:
  static Error stopped() { return {ErrorCode::usage, "stopped", {}}; }

  template <class Do>
  bool each(std::string_view stage, const std::vector<std::size_t>& tiles, Do&& what) {
    for (std::size_t first = 0; first < tiles.size(); first += kTilesAtOnce) {
      if (progress_ && !progress_->progress(stage, double(first) / double(tiles.size()))) return false;
      parallel_for(std::min(kTilesAtOnce, tiles.size() - first), thread_count(options_.threads),
                   [&](std::size_t t, std::size_t) { what(tiles[first + t]); });
    }
    return true;
  }
  const std::uint32_t* index(std::size_t t) const { return &order_[t * kTile]; }
  std::size_t count(std::size_t t) const { return std::min(kTile, order_.size() - t * kTile); }

  void measure(std::size_t t) {
    Tile tile(swept_, options_);
    const std::vector<SampleLine>& lines = tile.measure(surface_.samples, index(t), count(t));
    for (std::size_t i = 0; i < lines.size(); ++i) {
      SampleLine line = lines[i];
      line.best = -inscribed_.own(line.q, line.n, -line.best, options_.resolution_mm);
      const std::uint32_t at = index(t)[i];
      moments_[at] = line.at;
      report_.deviation_mm[at] =
          line.found() ? static_cast<float>(line.best) : std::numeric_limits<float>::quiet_NaN();
      if (!line.found()) continue;
      TileWorst& worst = tiles_[t];
      if (-line.best > worst.gouge.mm) worst.gouge = {-line.best, line.q, line.n, swept_.move_of(line.at)};
      if (surface_.samples[at].machined && line.best > worst.excess.mm)
        worst.excess = {line.best, line.q, line.n, swept_.move_of(line.at)};
    }
  }

  /// The worst between the samples. First in the tiles with the worst samples, so that the others need only
  /// be shown to have no more; those that need more steps than usual get what is left of them.
  bool search(TileWorst& worst, WorstDeviation TileWorst::*which, std::string_view stage) {
    const bool gouge = which == &TileWorst::gouge;
    std::vector<std::size_t> tiles(tiles_.size());
    std::iota(tiles.begin(), tiles.end(), std::size_t{0});
    std::stable_sort(tiles.begin(), tiles.end(), [&](std::size_t a, std::size_t b) {
      return (tiles_[a].*which).mm > (tiles_[b].*which).mm;
    });
    const std::size_t first = std::min(kFirst, tiles.size());
    std::vector<std::size_t> head(tiles.begin(), tiles.begin() + static_cast<std::ptrdiff_t>(first));
    std::vector<std::size_t> rest(tiles.begin() + static_cast<std::ptrdiff_t>(first), tiles.end());
    if (!round(head, worst, which, kStepsFirst, stage) || !round(rest, worst, which, kStepsTile, stage))
      return false;
    std::vector<std::size_t> open;
    for (const std::size_t t : tiles)
      if (gouge ? tiles_[t].gouge_open : tiles_[t].excess_open) open.push_back(t);
    if (open.empty() || open.size() * kStepsTile > kStepsLeft) return true;
    return round(open, worst, which, std::max(kStepsTile, std::min(kStepsFirst, kStepsLeft / open.size())),
                 stage);
  }
  bool round(const std::vector<std::size_t>& tiles, TileWorst& worst, WorstDeviation TileWorst::*which,
             std::size_t steps, std::string_view stage) {
    const TileWorst known = worst;
    const SearchLimits limits{kGap * options_.resolution_mm, path_.motion_mm, steps};
    const bool ok = each(stage, tiles, [&](std::size_t t) {
      TileSearch search(mesh_, surface_, swept_, inscribed_, options_);
      TileWorst& mine = tiles_[t];
      if (which == &TileWorst::gouge) {
        const TileWorst found = search.gouge(index(t), count(t), known, limits);
        mine.gouge = found.gouge, mine.gouge_most = found.gouge_most, mine.gouge_open = found.gouge_open;
      } else {
        const TileWorst found = search.excess(index(t), count(t), moments_, known, limits);
        mine.excess = found.excess, mine.excess_most = found.excess_most,
        mine.excess_open = found.excess_open;
      }
    });
    for (const std::size_t t : tiles)
      if ((tiles_[t].*which).mm > (worst.*which).mm) worst.*which = tiles_[t].*which;
    return ok;
  }

  void add_areas() {
    double excess = 0, reached = 0;
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const double area = surface_.samples[i].area_mm2, mm = report_.deviation_mm[i];
      if (mm < -options_.tolerance_mm) report_.gouge_area_mm2 += area;
      if (!surface_.samples[i].machined) continue;
      report_.area_mm2 += area;
      if (std::isnan(mm)) {
        report_.unmachined_area_mm2 += area;
        continue;
      }
      if (mm > options_.tolerance_mm) report_.excess_area_mm2 += area;
      reached += area;
      excess += area * std::max(0.0, mm);
    }
    report_.excess_mean_mm = reached > 0 ? excess / reached : 0;
  }

  const geom::Mesh& mesh_;
  const SampledSurface& surface_;
  const CheckedPath& path_;
  const DeviationOptions& options_;
  ProgressSink* progress_;
  Inscribed inscribed_;
  Swept swept_;
  std::vector<std::uint32_t> order_;
  std::vector<Moment> moments_;  // of the samples
  std::vector<TileWorst> tiles_;
  DeviationReport report_;
};

}  // namespace

Result<DeviationReport> measure_deviation(const geom::Mesh& mesh, const SampledSurface& surface,
                                          const CheckedPath& path, const DeviationOptions& options,
                                          ProgressSink* progress) {
  if (auto ok = validate(mesh, surface); !ok) return ok.error();
  if (auto ok = validate(path, options); !ok) return ok.error();
  return Measure(mesh, surface, path, options, progress).run();
}

Histogram histogram(const SampledSurface& surface, const DeviationReport& report, std::size_t bins) {
  Histogram h;
  if (bins == 0) return h;
  std::vector<float> sizes;
  for (const float mm : report.deviation_mm)
    if (!std::isnan(mm)) sizes.push_back(std::abs(mm));
  if (sizes.empty()) return h;
  const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(kUsual * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), at, sizes.end());
  const double most = std::max(static_cast<double>(*at), kNarrowest);
  h.step_mm = 2 * most / static_cast<double>(bins);
  h.from_mm = -most;
  h.area_mm2.assign(bins, 0);
  for (std::size_t i = 0; i < std::min(surface.samples.size(), report.deviation_mm.size()); ++i) {
    const double mm = report.deviation_mm[i];
    if (std::isnan(mm)) continue;
    const auto bin = static_cast<std::size_t>(std::clamp((mm + most) / h.step_mm, 0.0, double(bins - 1)));
    h.area_mm2[bin] += surface.samples[i].area_mm2;
  }
  return h;
}

}  // namespace burin::verify
