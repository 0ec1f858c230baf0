// SPDX-License-Identifier: Apache-2.0
// Contact points a second along a path, and maps, on about 100,000 triangles of a wavy, twisted blade
// (plan/orient/contact_cases.h): cutter and holder of two pieces. Counters: feasibility tests a point.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "burin/plan/orient/contact_cases.h"
#include "burin/plan/orient/cspace.h"

namespace {

using namespace burin::orient;

struct Blade {
  cases::Shape shape = shape_named("blade");
  burin::model::Mill mill = cases::mills()[1];
  Scene scene{cases::triangles(shape, 0.4), mill, tool_body(mill, 0.01, 1)};
  MachineLimits limits;
  AngleRange range{burin::geom::radians(1.5), burin::geom::radians(20), -burin::geom::kPi / 2,
                   burin::geom::kPi / 2};
  Setting setting{&scene, &limits, range};
  std::vector<CcPoint> path;

  Blade() {
    for (int k = 0; k < 200; ++k) path.push_back(cases::contact(shape, -10 + 0.1 * k, 2, 0));
  }
  static cases::Shape shape_named(const char* name) {
    const std::vector<cases::Shape> all = cases::shapes();
    for (const cases::Shape& shape : all)
      if (shape.name == name) return shape;
    return {};
  }
};
const Blade& blade() {
  static const Blade one;
  return one;
}

void count(benchmark::State& state, std::uint64_t tests) {
  const auto points = static_cast<double>(state.iterations()) * static_cast<double>(blade().path.size());
  state.SetItemsProcessed(static_cast<std::int64_t>(points));
  state.counters["tests_a_point"] = static_cast<double>(tests) / points;
}

void optimal(benchmark::State& state) {
  const RadiusGoal goal(blade().mill);
  std::uint64_t tests = 0;
  for (auto _ : state) {
    Experience experience;
    Scene::Memory memory;
    for (const CcPoint& at : blade().path)
      tests += find_optimal(blade().setting, goal, at, memory, experience).tests;
  }
  count(state, tests);
}
BENCHMARK(optimal)->Name("orient/optimal")->Unit(benchmark::kMillisecond);

void contour(benchmark::State& state) {
  std::uint64_t tests = 0;
  for (auto _ : state) {
    Scene::Memory memory;
    for (const CcPoint& at : blade().path) tests += find_by_contour(blade().setting, at, memory).tests;
  }
  count(state, tests);
}
BENCHMARK(contour)->Name("orient/contour")->Unit(benchmark::kMillisecond);

void map(benchmark::State& state) {
  Scene::Memory memory;
  for (auto _ : state)
    benchmark::DoNotOptimize(make_map(blade().setting, blade().path[100], 90, 45, memory).cells.data());
}
BENCHMARK(map)->Name("orient/map 90x45")->Unit(benchmark::kMillisecond);

}  // namespace
