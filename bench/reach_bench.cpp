// SPDX-License-Identifier: Apache-2.0
// All tool axis angles of a place of the ball at once, beside a collision library that looks at one angle
// (reach_fcl_bench.cpp). Arguments: triangles, tool (0: long shank, 1: short).
#include <benchmark/benchmark.h>

#include "burin/plan/rotary/reach.h"
#include "reach_bench_cases.h"

namespace {

using namespace burin::rotary;

void burin_reach(benchmark::State& state) {
  const auto& c = bench::the_case(static_cast<int>(state.range(0)));
  const ReachIndex index(c.mesh, state.range(1) == 0 ? bench::tool() : bench::short_tool());
  std::size_t intervals = 0, closed = 0;
  for (auto _ : state) {
    intervals = closed = 0;
    for (const auto& center : c.centers) {
      const AngleSet set = index.reachable(center);
      intervals += set.size();
      closed += set.empty();
    }
    benchmark::DoNotOptimize(intervals);
  }
  const auto n = static_cast<double>(c.centers.size());
  state.SetLabel(state.range(1) == 0 ? "all angles" : "all angles, short shank");
  state.counters["intervals"] = static_cast<double>(intervals) / n;
  state.counters["closed"] = static_cast<double>(closed) / n;
  state.counters["million_per_s"] =
      benchmark::Counter(n * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(burin_reach)->ArgsProduct({{10'000, 100'000, 1'000'000}, {0, 1}})->Unit(benchmark::kMillisecond);

void reach_build(benchmark::State& state) {
  const auto& c = bench::the_case(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(ReachIndex(c.mesh, bench::tool()));
}
BENCHMARK(reach_build)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
