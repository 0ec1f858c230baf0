// SPDX-License-Identifier: Apache-2.0
// Offsetting beside Clipper (Debian's polyclipping 6.4, arcs tessellated at 0.01 mm as its users must) in the
// same run.
#include <benchmark/benchmark.h>

#include <cmath>
#include <polyclipping/clipper.hpp>

#include "burin/geom/curve/fit.h"
#include "burin/geom/curve/letter_k.h"
#include "burin/geom/curve/offset.h"
#include "burin/geom/curve/offset_cases.h"

namespace burin::geom {
namespace {

constexpr double kOffset = 0.28;
constexpr double kChord = 0.01;
constexpr double kUnits = 1e6;  // Clipper's integers per mm

/// The letter K as 118 arcs or a few more: the tolerance is halved until the fit needs that many.
cases::Region letter_k_region() {
  ArcSpline spline;
  spline.closed = true;
  for (double tolerance = 0.02; spline.segments.size() < 118; tolerance *= 0.8) {
    spline.segments.clear();
    for (const Nurbs2& curve : letter_k()) {
      const auto fit = fit_arc_spline(curve, {FitMethod::minimal, tolerance, kOffset, 1e-3});
      if (!fit) return {};
      spline.segments.insert(spline.segments.end(), fit->segments.begin(), fit->segments.end());
    }
  }
  return {spline};
}

const cases::Region& region_of(int which) {
  static const std::vector<cases::Region> regions = [] {
    std::vector<cases::Region> all;
    all.push_back(letter_k_region());
    all.push_back(cases::wavy_ring(10'000));
    all.push_back(cases::wavy_ring(100'000));
    all.push_back(cases::wavy_ring(1'000'000));
    all.push_back(cases::plate());
    return all;
  }();
  return regions[static_cast<std::size_t>(which)];
}

ClipperLib::Paths tessellated(const cases::Region& region) {
  ClipperLib::Paths paths;
  for (const ArcSpline& s : region) {
    ClipperLib::Path path;
    for (const Segment& g : s.segments) {
      int steps = 1;
      if (!g.is_line()) {
        const double r = std::abs(g.radius);
        const double most = 2 * std::acos(std::max(0.0, 1 - kChord / r));
        steps = std::max(1, static_cast<int>(std::ceil(std::abs(sweep_of(g)) / most)));
      }
      for (int i = 0; i < steps; ++i) {
        const Point2 p = point_on(g, i / double(steps));
        path.push_back({static_cast<ClipperLib::cInt>(std::llround(p.x * kUnits)),
                        static_cast<ClipperLib::cInt>(std::llround(p.y * kUnits))});
      }
    }
    paths.push_back(std::move(path));
  }
  return paths;
}

void name(benchmark::State& state) {
  static const char* const kNames[] = {"K of about 118 arcs", "ring 10,000", "ring 100,000", "ring 1,000,000",
                                       "plate of 400 holes"};
  state.SetLabel(kNames[state.range(0)]);
}

void burin_offset(benchmark::State& state) {
  const cases::Region& region = region_of(static_cast<int>(state.range(0)));
  std::size_t segments = 0;
  for (auto _ : state) {
    auto result = offset_region(region, state.range(1) != 0 ? kOffset : -kOffset);
    if (!result) {
      state.SkipWithError(result.error().message.c_str());
      return;
    }
    segments = 0;
    for (const ArcSpline& s : result->contours) segments += s.segments.size();
    benchmark::DoNotOptimize(result);
  }
  state.counters["segments"] = static_cast<double>(segments);
  name(state);
}

void clipper_offset(benchmark::State& state) {
  const ClipperLib::Paths paths = tessellated(region_of(static_cast<int>(state.range(0))));
  std::size_t vertices = 0;
  for (auto _ : state) {
    ClipperLib::ClipperOffset offset(2.0, kChord * kUnits);
    offset.AddPaths(paths, ClipperLib::jtRound, ClipperLib::etClosedPolygon);
    ClipperLib::Paths out;
    offset.Execute(out, (state.range(1) != 0 ? kOffset : -kOffset) * kUnits);
    vertices = 0;
    for (const auto& p : out) vertices += p.size();
    benchmark::DoNotOptimize(out);
  }
  state.counters["segments"] = static_cast<double>(vertices);
  name(state);
}

BENCHMARK(burin_offset)->ArgsProduct({{0, 1, 2, 3, 4}, {1, 0}})->Unit(benchmark::kMillisecond);
BENCHMARK(clipper_offset)->ArgsProduct({{0, 1, 2, 4}, {1, 0}})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace burin::geom
