// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/strip_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "burin/base/parallel.h"
#include "burin/geom/point_tools.h"
#include "burin/geom/surface/closest.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/verify/mill_search.h"
#include "burin/verify/swept_tool.h"

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

// Places on the line between two passes at which the height is taken, and golden sections about the highest
// of them: the ridge is an edge, found to 2e-4 of the side step.
constexpr int kAcross = 16;
constexpr int kNarrow = 12;
constexpr double kFoot = 1e-6;  // mm: of closest points
// The next pass is abreast when the way to it is square to the path within this (cosine).
constexpr double kSquare = 0.05;

/// A station and its neighbour on the next pass.
struct Crossing {
  std::size_t pass = 0;
  Point3 from, to;
  bool square = false;
};
struct Height {
  double mm = 0;
  Point3 at;
};
struct Crossed {
  Height highest, lowest;
  std::size_t samples = 0;
};

std::vector<Stretch> stretches_of(const std::vector<StripPass>& passes) {
  std::vector<Stretch> stretches;
  for (const StripPass& pass : passes)
    for (const auto& run : pass.runs)
      for (std::size_t i = 0; i + 1 < run.size(); ++i)
        stretches.push_back(Stretch::between(run[i].pose, run[i + 1].pose));
  return stretches;
}

/// The nearest place of a pass, nothing to cross to when it has no length.
void cross_to(const StripPass& pass, Vec3 along, Crossing& c) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t r = 0; r < pass.runs.size(); ++r)
    for (std::size_t i = 0; i + 1 < pass.runs[r].size(); ++i) {
      const Point3 p = nearest_on_segment(c.from, pass.runs[r][i].contact, pass.runs[r][i + 1].contact);
      const double far = distance(p, c.from);
      if (far >= least) continue;
      least = far;
      c.to = p;
      c.square = std::abs(dot(p - c.from, along)) <= kSquare * far;
    }
}

std::vector<Crossing> crossings(const std::vector<StripPass>& passes, std::size_t most) {
  std::size_t all = 0;
  for (const StripPass& pass : passes)
    for (const auto& run : pass.runs) all += run.size();
  const std::size_t every = std::max<std::size_t>(1, (all + most - 1) / std::max<std::size_t>(1, most));
  std::vector<Crossing> out;
  for (std::size_t p = 0; p + 1 < passes.size(); ++p) {
    const bool any = std::any_of(passes[p + 1].runs.begin(), passes[p + 1].runs.end(),
                                 [](const auto& run) { return run.size() > 1; });
    for (std::size_t r = 0; any && r < passes[p].runs.size(); ++r) {
      const auto& run = passes[p].runs[r];
      for (std::size_t i = 0; i + 1 < run.size(); i += every) {
        Crossing c{p, run[i].contact, {}, false};
        cross_to(passes[p + 1], unit(run[i + 1].contact - run[i].contact), c);
        out.push_back(c);
      }
    }
  }
  return out;
}

class Across {
 public:
  Across(const geom::NurbsSurface& surface, const SweptTool& swept, const StripOptions& options)
      : surface_(surface), evaluator_(surface), finder_(surface), swept_(swept), options_(options) {}

  Crossed along(const Crossing& c) {
    crossed_ = {
        {-std::numeric_limits<double>::infinity(), {}}, {std::numeric_limits<double>::infinity(), {}}, 0};
    const geom::SurfacePoint a = finder_.find(c.from, kFoot), b = finder_.find(c.to, kFoot);
    const auto at = [&](double x) { return height(a.u + x * (b.u - a.u), a.v + x * (b.v - a.v)); };
    int best = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (int k = 0; k <= kAcross; ++k) {
      const double h = at(double(k) / kAcross);
      if (h > most) most = h, best = k;
    }
    double lo = std::max(0, best - 1) / double(kAcross), hi = std::min(kAcross, best + 1) / double(kAcross);
    constexpr double kGolden = 0.6180339887498949;
    double x1 = hi - kGolden * (hi - lo), x2 = lo + kGolden * (hi - lo);
    double h1 = at(x1), h2 = at(x2);
    for (int k = 0; k < kNarrow; ++k) {
      if (h1 > h2) {
        hi = x2, x2 = x1, h2 = h1;
        h1 = at(x1 = hi - kGolden * (hi - lo));
      } else {
        lo = x1, x1 = x2, h1 = h2;
        h2 = at(x2 = lo + kGolden * (hi - lo));
      }
    }
    return crossed_;
  }

 private:
  double height(double u, double v) {
    const geom::SurfaceDerivatives d = evaluator_.derivatives(u, v);
    Vec3 n = geom::normal(d);
    if (n == Vec3{}) n = geom::normal(surface_, u, v);  // a pole
    if (!(norm(n) > 0.5)) return 0;                     // no area around: nothing stands there
    if (options_.normal_reversed) n = -n;
    SampleLine line{d.p, n, options_.window_mm, options_.resolution_mm, options_.window_mm};
    swept_.lower(line);
    const double h = line.best;
    ++crossed_.samples;
    if (h > crossed_.highest.mm) crossed_.highest = {h, d.p};
    if (h < crossed_.lowest.mm) crossed_.lowest = {h, d.p};
    return h;
  }

  const geom::NurbsSurface& surface_;
  geom::SurfaceEvaluator evaluator_;
  geom::ClosestPointFinder finder_;
  const SweptTool& swept_;
  const StripOptions& options_;
  Crossed crossed_;
};

Result<void> validate(const std::vector<StripPass>& passes, const StripOptions& options) {
  if (!(options.window_mm > 0 && std::isfinite(options.window_mm) && options.resolution_mm > 0 &&
        std::isfinite(options.resolution_mm)))
    return Error{ErrorCode::range, "window and resolution must be positive", {}};
  for (const StripPass& pass : passes)
    for (const auto& run : pass.runs)
      for (const StripStation& s : run)
        if (!is_finite(s.contact)) return Error{ErrorCode::geometry, "a contact point is not finite", {}};
  return {};
}

/// Tool and poses as check_mill takes them.
Result<void> validate(const std::vector<StripPass>& passes, const CheckedMill& tool) {
  if (auto ok = validate(tool); !ok) return ok.error();
  for (const StripPass& pass : passes)
    for (const auto& run : pass.runs)
      for (std::size_t i = 0; i < run.size(); ++i) {
        if (auto ok = validate_pose(run[i].pose, i); !ok) return ok.error();
        if (i == 0) continue;
        if (auto ok = validate_turn(run[i - 1].pose, run[i].pose, i); !ok) return ok.error();
      }
  return {};
}

}  // namespace

Result<StripReport> measure_strips(const geom::NurbsSurface& surface, const std::vector<StripPass>& passes,
                                   const CheckedMill& tool, const StripOptions& options) {
  if (auto ok = geom::validate(surface); !ok) return ok.error();
  if (auto ok = validate(passes, options); !ok) return ok.error();
  if (auto ok = validate(passes, tool); !ok) return ok.error();
  const std::vector<Crossing> all = crossings(passes, options.max_stations);
  const SweptTool swept({bodies_of(tool).front()}, stretches_of(passes));

  const unsigned threads = thread_count(options.threads);
  std::vector<Across> across;
  for (unsigned i = 0; i < threads; ++i) across.emplace_back(surface, swept, options);
  std::vector<Crossed> found(all.size());
  parallel_for(all.size(), threads,
               [&](std::size_t i, std::size_t worker) { found[i] = across[worker].along(all[i]); });

  StripReport report;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  report.ridges.assign(passes.empty() ? 0 : passes.size() - 1, {kNone, 0, {}});
  for (std::size_t i = 0; i < all.size(); ++i) {
    StripReport::Ridge& ridge = report.ridges[all[i].pass];
    const Crossed& c = found[i];
    if (all[i].square) ridge.min_mm = std::min(ridge.min_mm, c.highest.mm);
    if (c.highest.mm > ridge.max_mm) ridge.max_mm = c.highest.mm, ridge.max_at = c.highest.at;
    if (-c.lowest.mm > report.gouge_max_mm) report.gouge_max_mm = -c.lowest.mm, report.gouge_at = c.lowest.at;
    report.samples += c.samples;
    report.stations.push_back({all[i].pass, all[i].from, c.highest.mm, all[i].square});
  }
  report.scallop_min_mm = report.ridges.empty() ? 0 : kNone;
  for (const StripReport::Ridge& ridge : report.ridges) {
    report.scallop_min_mm = std::min(report.scallop_min_mm, ridge.min_mm);
    report.scallop_max_mm = std::max(report.scallop_max_mm, ridge.max_mm);
  }
  return report;
}

}  // namespace burin::verify
