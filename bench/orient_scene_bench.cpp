// SPDX-License-Identifier: Apache-2.0
// Interference of a face mill (cutter, shank, holder) with a blade and its neighbours, beside a collision
// library (orient_scene_fcl_bench.cpp) and a ray tracer (orient_scene_embree_bench.cpp). Argument: triangles.
#include <benchmark/benchmark.h>

#include "orient_scene_bench_cases.h"

namespace {

using namespace burin::orient;

/// Asks the scene with a memory that begins empty.
auto fresh(const Scene& scene) {
  return [&scene, memory = Scene::Memory{}](const burin::cl::Pose& pose) mutable {
    return scene.blocker(pose, memory).has_value();
  };
}

/// One pose a contact point: nothing that one pose learns helps the next.
void burin_poses(benchmark::State& state) {
  const auto& c = bench::the_case(static_cast<int>(state.range(0)));
  const Scene scene(c.mesh, bench::tool(), bench::body());
  bench::measure_poses(state, c, [&] { return fresh(scene); });
}
BENCHMARK(burin_poses)->Arg(10'000)->Arg(100'352)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void burin_map(benchmark::State& state) {
  const auto& c = bench::the_case(static_cast<int>(state.range(0)));
  const Scene scene(c.mesh, bench::tool(), bench::body());
  bench::measure_maps(state, c, [&] { return fresh(scene); });
}
BENCHMARK(burin_map)->Arg(100'352)->Unit(benchmark::kMillisecond);

/// The first free tilt at a contact point and yaw.
void burin_firstfree(benchmark::State& state) {
  const auto& c = bench::the_case(static_cast<int>(state.range(0)));
  const Scene scene(c.mesh, bench::tool(), bench::body());
  std::size_t found = 0;
  const AngleRange range = bench::range();
  for (auto _ : state) {
    Scene::Memory memory;
    found = 0;
    double share = 0;
    for (const auto& at : c.contacts) {
      share = share + 0.618 - (share + 0.618 >= 1 ? 1 : 0);
      const double beta = range.beta_lo + share * (range.beta_hi - range.beta_lo);
      found += scene.first_free(at, beta, range.alpha_lo, range.alpha_hi, memory).found;
    }
    benchmark::DoNotOptimize(found);
  }
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(c.contacts.size());
  bench::rate(state, static_cast<double>(c.contacts.size()));
}
BENCHMARK(burin_firstfree)->Arg(10'000)->Arg(100'352)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void scene_build(benchmark::State& state) {
  const auto& c = bench::the_case(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(Scene(c.mesh, bench::tool(), bench::body()));
}
BENCHMARK(scene_build)->Arg(100'352)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
