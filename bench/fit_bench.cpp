// SPDX-License-Identifier: Apache-2.0
// Arc fitting: the letter K (arcs and lines of its 13 curves at offset 0.28) and single cubics.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "burin/geom/curve/fit.h"
#include "burin/geom/curve/letter_k.h"

namespace {

using namespace burin::geom;

constexpr double kTolerances[] = {0.1, 0.01, 0.001};

/// Arguments: method, index of the tolerance, whether directions are free at the corners.
void burin_fit_letter_k(benchmark::State& state) {
  const std::vector<Nurbs2> k = letter_k();
  FitOptions options;
  options.method = state.range(0) == 0 ? FitMethod::minimal : FitMethod::bisect;
  options.tolerance_mm = kTolerances[state.range(1)];
  options.offset_mm = 0.28;
  std::vector<double> turn;
  for (std::size_t i = 0; i < k.size(); ++i) {
    const Vec2 a = tangent_at(Curve2(k[(i + k.size() - 1) % k.size()]), 1), b = tangent_at(Curve2(k[i]), 0);
    turn.push_back(state.range(2) == 0 ? 0 : std::abs(std::atan2(cross(a, b), dot(a, b))));
  }
  double segments = 0, deviation = 0;
  for (auto _ : state) {
    segments = deviation = 0;
    for (std::size_t i = 0; i < k.size(); ++i) {
      options.start_freedom_rad = corner_freedom(turn[i]);
      options.end_freedom_rad = corner_freedom(turn[(i + 1) % k.size()]);
      const auto fit = fit_arc_spline(k[i], options);
      if (!fit.ok()) return state.SkipWithError("not fitted");
      segments += static_cast<double>(fit->segments.size());
      deviation = std::max(deviation, fit->max_deviation_mm);
    }
  }
  state.counters["segments"] = segments;
  state.counters["bound_mm"] = deviation;
}
BENCHMARK(burin_fit_letter_k)
    ->ArgNames({"bisect", "tolerance", "free"})
    ->ArgsProduct({{0, 1}, {0, 1, 2}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

/// One cubic of about 11 mm: what drawings are full of.
void burin_fit_cubic(benchmark::State& state) {
  std::mt19937 random(13);
  const auto uniform = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(random()) / 4294967295.0;
  };
  std::vector<Nurbs2> curves;
  for (int i = 0; i < 64; ++i) {
    curves.push_back({3,
                      {0, 0, 0, 0, 1, 1, 1, 1},
                      {{0, 0},
                       {uniform(2, 5), uniform(-4, 4)},
                       {uniform(6, 9), uniform(-4, 4)},
                       {uniform(10, 12), uniform(-3, 3)}},
                      {1, 1, 1, 1}});
  }
  FitOptions options;
  options.method = state.range(0) == 0 ? FitMethod::minimal : FitMethod::bisect;
  options.tolerance_mm = kTolerances[state.range(1)];
  options.offset_mm = 0.28;
  std::size_t next = 0, segments = 0, fitted = 0;
  for (auto _ : state) {
    const auto fit = fit_arc_spline(curves[next++ % curves.size()], options);
    if (!fit.ok()) return state.SkipWithError("not fitted");
    segments += fit->segments.size();
    ++fitted;
  }
  state.counters["segments"] = static_cast<double>(segments) / static_cast<double>(fitted);
}
BENCHMARK(burin_fit_cubic)
    ->ArgNames({"bisect", "tolerance"})
    ->ArgsProduct({{0, 1}, {0, 1, 2}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
