// SPDX-License-Identifier: Apache-2.0
// Planning time, and the time of each tick. A tick is deterministic: what the system adds (interrupts, other
// programs) hits another tick in every pass over the same plan, what the code needs comes back. So besides
// the plain maximum the largest of each tick's smallest time over all passes is reported (repeated_max_ns).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <vector>

#include "burin/servo/interpolator.h"
#include "burin/servo/plan.h"

namespace {

using burin::geom::Point3;
using burin::geom::QuinticPath;
using burin::geom::Vec3;
using namespace burin::servo;

/// Zigzag over a wavy surface, joined by half circles: `passes` of 50 mm, a node every `step` mm.
std::vector<Stretch> wavy_zigzag(int passes, double step) {
  const double length = 50, side = 4, height = 2, k = 2 * burin::geom::kPi / 25;
  std::vector<Stretch> out;
  for (int i = 0; i < passes; ++i) {
    const double dir = i % 2 ? -1 : 1, x0 = i % 2 ? length : 0, y = side * i;
    QuinticPath path;
    const int n = static_cast<int>(length / step);
    for (int j = 0; j <= n; ++j) {
      const double t = length * j / n, x = x0 + dir * t;
      path.nodes.push_back({t,
                            {x, y, height * (1 - std::cos(k * x))},
                            {dir, 0, dir * height * k * std::sin(k * x)},
                            {0, 0, height * k * k * std::cos(k * x)}});
    }
    const Point3 end = path.end();
    out.push_back({std::move(path), {}, 3000, 0, i});
    if (i + 1 < passes)
      out.push_back(
          {burin::geom::arc(end, {end.x, y + side / 2, 0}, {0, 0, dir}, burin::geom::kPi, 0), {}, 3000});
  }
  return out;
}

Plan planned(const std::vector<Stretch>& stretches) {
  burin::Diagnostics diagnostics;
  auto made = plan(stretches, {}, diagnostics);
  return made ? *std::move(made) : Plan{};
}

void plan_path(benchmark::State& state) {
  const double step = static_cast<double>(state.range(1)) * 1e-3;
  const auto stretches = wavy_zigzag(static_cast<int>(state.range(0)), step);
  std::size_t setpoints = 0, pieces = 0;
  for (auto _ : state) {
    const Plan made = planned(stretches);
    setpoints = made.setpoints;
    pieces = made.pieces.size();
    benchmark::DoNotOptimize(made.duration_s);
  }
  state.counters["setpoints"] = static_cast<double>(setpoints);
  state.counters["pieces"] = static_cast<double>(pieces);
  state.counters["s_per_100k"] =
      benchmark::Counter(static_cast<double>(setpoints) * 1e-5,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(plan_path)->Args({75, 500})->Args({75, 50})->Unit(benchmark::kMillisecond);

/// Times in ns of every tick, over and over, without the time that reading the clock takes by itself.
void tick_times(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t kPeriods = 10'000'000;
  const Plan made = planned(wavy_zigzag(75, static_cast<double>(state.range(0)) * 1e-3));
  const std::size_t n = made.setpoints;
  std::vector<std::uint32_t> times(kPeriods), least(n, UINT32_MAX);
  const auto ns = [](Clock::time_point a, Clock::time_point b) {
    return static_cast<std::uint32_t>(std::min<std::int64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(b - a).count(), UINT32_MAX));
  };
  std::uint32_t clock_ns = UINT32_MAX;
  for (int i = 0; i < 1000; ++i) {
    const auto a = Clock::now(), b = Clock::now();
    clock_ns = std::min(clock_ns, ns(a, b));
  }
  Interpolator interpolator(made);
  for (auto _ : state) {
    Setpoint s;
    std::size_t tick = 0;
    for (std::size_t i = 0; i < kPeriods; ++i) {
      const auto a = Clock::now();
      interpolator.tick(s);
      const auto b = Clock::now();
      benchmark::DoNotOptimize(s);
      times[i] = ns(a, b) - std::min(clock_ns, ns(a, b));
      least[tick] = std::min(least[tick], times[i]);
      if (++tick == n) interpolator.restart(), tick = 0;
    }
  }
  state.counters["above_5us"] =
      static_cast<double>(std::count_if(times.begin(), times.end(), [](auto t) { return t > 5000; }));
  std::sort(times.begin(), times.end());
  state.counters["median_ns"] = times[kPeriods / 2];
  state.counters["p999_ns"] = times[kPeriods - kPeriods / 1000];
  state.counters["max_ns"] = times.back();
  state.counters["repeated_max_ns"] = *std::max_element(least.begin(), least.end());
  state.counters["setpoints"] = static_cast<double>(n);
}
BENCHMARK(tick_times)->Arg(500)->Arg(50)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
