// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "burin/base/parallel.h"
#include "burin/geom/point_tools.h"
#include "burin/verify/swept_tool.h"

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

// Neighbouring samples that share one walk through the index.
constexpr std::size_t kTile = 64;
// Tiles between two reports of progress.
constexpr std::size_t kTilesAtOnce = 4096;
// A histogram shows so many of the samples within its ends (the rest is in its outermost bins), and is never
// narrower than this to either side, mm.
constexpr double kUsual = 0.995;
constexpr double kNarrowest = 1e-4;

/// The tools as the index has them, and whose move a stretch is.
struct Swept {
  std::vector<SweptTool> tools;
  std::vector<std::uint32_t> path;  ///< by tool: index into CheckedPath::tools
};
Swept swept_tools(const CheckedPath& path) {
  Swept swept;
  for (std::uint32_t k = 0; k < path.tools.size(); ++k) {
    const ToolPath& tool = path.tools[k];
    if (tool.pieces.empty()) continue;
    std::vector<Stretch> stretches;
    stretches.reserve(tool.pieces.size());
    const cl::Pose* from = &tool.from;
    for (const PathPiece& piece : tool.pieces) {
      stretches.push_back(Stretch::between(*from, piece.to));
      from = &piece.to;
    }
    swept.tools.emplace_back(bodies_of(tool.tool), std::move(stretches),
                             static_cast<std::uint32_t>(swept.tools.size()));
    swept.path.push_back(k);
  }
  return swept;
}

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

/// Lowest entries of the samples of a tile: the first one and those that the stretch of their neighbour says
/// nothing about walk through the index alone; what could be lower for the others is gathered once.
class Tile {
 public:
  Tile(const Swept& swept, const DeviationOptions& options) : swept_(swept), options_(options) {}

  const std::vector<SampleLine>& measure(const std::vector<SurfaceSample>& samples,
                                         const std::uint32_t* index, std::size_t count) {
    lines_.clear();
    open_.clear();
    const SampleLine* hint = nullptr;
    lines_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const SurfaceSample& s = samples[index[i]];
      lines_.push_back({s.p, s.n, options_.reach_mm, options_.resolution_mm, options_.reach_mm});
      SampleLine& line = lines_.back();
      if (hint) swept_.tools[hint->tool].lower(line, swept_.tools[hint->tool].candidate(hint->stretch, 0));
      if (line.found()) {
        open_.push_back(i);
      } else {
        for (const SweptTool& tool : swept_.tools) tool.lower(line);
      }
      if (line.found()) hint = &line;
    }
    if (!open_.empty()) finish();
    return lines_;
  }

 private:
  void finish() {
    const BoxExtent extent = around(open_);
    const double touch = lines_.front().touch();
    for (const SweptTool& tool : swept_.tools)
      for (std::size_t b = 0; b < tool.bodies(); ++b)
        tool.gather(b, extent, extent, touch, [&](const Candidate& c) {
          for (const std::size_t i : open_) tool.lower(lines_[i], c);
        });
  }
  /// From the samples to where their lines are entered so far.
  BoxExtent around(const std::vector<std::size_t>& which) const {
    Vec3 sum;
    for (const std::size_t i : which) sum = sum + lines_[i].n;
    const Vec3 n = norm(sum) > 0 ? unit(sum) : lines_[which[0]].n;
    const Vec3 any = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const std::array<Vec3, 3> axes{unit(cross(n, any)), cross(n, unit(cross(n, any))), n};
    const Point3 origin = lines_[which[0]].q;
    geom::Box3 box;
    for (const std::size_t i : which) {
      const SampleLine& line = lines_[i];
      for (const double h : {0.0, std::max(0.0, line.best)}) {
        const Vec3 d = line.q + h * line.n - origin;
        box.add(Point3{dot(d, axes[0]), dot(d, axes[1]), dot(d, axes[2])});
      }
    }
    const Point3 m = lerp(box.lo, box.hi, 0.5);
    const Vec3 half = 0.5 * (box.hi - box.lo);
    return {origin + (m.x * axes[0] + m.y * axes[1] + m.z * axes[2]),
            norm(half),
            {n, half.z, -half.z},
            {half.x * axes[0], half.y * axes[1], half.z * axes[2]}};
  }

  const Swept& swept_;
  const DeviationOptions& options_;
  std::vector<SampleLine> lines_;
  std::vector<std::size_t> open_;
};

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
  if (surface.samples.size() >= SampleLine::kNone) return range("too many samples (4,000,000,000 at most)");
  return {};
}

Result<void> validate(const CheckedPath& path, const DeviationOptions& options) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (!positive(options.reach_mm) || !positive(options.resolution_mm))
    return range("reach and resolution must be positive");
  if (!(std::isfinite(options.tolerance_mm) && options.tolerance_mm >= 0))
    return range("the tolerance must not be negative");
  if (auto ok = validate(path); !ok) return ok.error();
  for (const ToolPath& tool : path.tools)
    if (tool.pieces.size() >= SampleLine::kNone)
      return range("too many pieces of motion (4,000,000,000 at most)");
  return {};
}

class Measure {
 public:
  Measure(const geom::Mesh& mesh, const SampledSurface& surface, const CheckedPath& path,
          const DeviationOptions& options, ProgressSink* progress)
      : mesh_(mesh), surface_(surface), path_(path), options_(options), progress_(progress) {}

  Result<DeviationReport> run() {
    swept_ = swept_tools(path_);
    order_ = neighbourly_order(surface_.samples);
    report_.deviation_mm.resize(order_.size());
    const std::size_t tiles = (order_.size() + kTile - 1) / kTile;
    worst_.resize(tiles);
    const unsigned threads = thread_count(options_.threads);
    for (std::size_t first = 0; first < tiles; first += kTilesAtOnce) {
      if (progress_ && !progress_->progress("deviation", double(first) / double(tiles)))
        return Error{ErrorCode::usage, "stopped", {}};
      parallel_for(std::min(kTilesAtOnce, tiles - first), threads,
                   [&](std::size_t t, std::size_t) { tile(first + t); });
    }
    for (const Worst& w : worst_) {
      if (w.gouge.mm > report_.gouge.mm) report_.gouge = w.gouge;
      if (w.excess.mm > report_.excess.mm) report_.excess = w.excess;
    }
    add_areas();
    report_.bound_mm = options_.reach_mm;
    return std::move(report_);
  }

 private:
  struct Worst {
    WorstDeviation gouge, excess;
  };

  void tile(std::size_t t) {
    const std::size_t first = t * kTile, count = std::min(kTile, order_.size() - first);
    Tile tile(swept_, options_);
    const std::vector<SampleLine>& lines = tile.measure(surface_.samples, &order_[first], count);
    for (std::size_t i = 0; i < count; ++i) {
      const SampleLine& line = lines[i];
      const std::uint32_t at = order_[first + i];
      report_.deviation_mm[at] =
          line.found() ? static_cast<float>(line.best) : std::numeric_limits<float>::quiet_NaN();
      if (!line.found()) continue;
      if (-line.best > worst_[t].gouge.mm) worst_[t].gouge = worst(line, -line.best);
      if (surface_.samples[at].machined && line.best > worst_[t].excess.mm)
        worst_[t].excess = worst(line, line.best);
    }
  }
  WorstDeviation worst(const SampleLine& line, double mm) const {
    const ToolPath& tool = path_.tools[swept_.path[line.tool]];
    return {mm, line.q, line.n, tool.pieces[swept_.tools[line.tool].original(line.stretch)].move};
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
  Swept swept_;
  std::vector<std::uint32_t> order_;
  std::vector<Worst> worst_;
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
