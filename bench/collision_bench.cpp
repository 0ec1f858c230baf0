// SPDX-License-Identifier: Apache-2.0
// Collisions of a ball end with shank and holder along a wavy face: clear, on the surface with the cutter as
// a rapid would be, and with everything deep inside. Moves and triangles vary by themselves for the growth.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>

#include "burin/verify/collisions.h"
#include "burin/verify/mill_cases.h"

namespace {

using namespace burin;
using namespace burin::verify;
using geom::Point3;
using geom::Vec3;

constexpr double kRadius = 5, kSize = 200;

double height(double x, double y) {
  return 6 * std::sin(0.05 * x) * std::cos(0.04 * y);
}
Vec3 normal(double x, double y) {
  return unit(Vec3{-0.3 * std::cos(0.05 * x) * std::cos(0.04 * y),
                   0.24 * std::sin(0.05 * x) * std::sin(0.04 * y), 1});
}

geom::Mesh face(int triangles) {
  const int n = static_cast<int>(std::lround(std::sqrt(0.5 * triangles)));
  return cases::grid(n, n, [](double u, double v) {
    const double x = kSize * (u - 0.5), y = kSize * (v - 0.5);
    return Point3{x, y, height(x, y)};
  });
}

/// To and fro over the face, the axis leaning this way and that; `lower`: along the axis, into the face.
CheckedPath passes(int moves, double lower, bool rapid) {
  const int rows = static_cast<int>(std::sqrt(0.1 * moves)), columns = moves / rows;
  std::vector<cl::Pose> poses;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double x = 0.9 * kSize * (double(j % 2 ? columns - 1 - i : i) / columns - 0.5),
                   y = 0.9 * kSize * (double(j) / rows - 0.5);
      const Vec3 n = normal(x, y), axis = unit(n + Vec3{0.2 * std::sin(0.01 * x), 0.1, 0});
      poses.push_back({Point3{x, y, height(x, y)} + kRadius * n - (kRadius + lower) * axis, axis});
    }
  return cases::path_of({kRadius, kRadius, 20, {{kRadius, 20, 60, false}, {25, 60, 120, true}}}, poses,
                        std::vector<bool>(poses.size(), rapid));
}

void collisions(benchmark::State& state, double lower, bool rapid) {
  const geom::Mesh mesh = face(static_cast<int>(state.range(0)));
  const CheckedPath path = passes(static_cast<int>(state.range(1)), lower, rapid);
  CollisionReport report;
  for (auto _ : state) report = *find_collisions(mesh, {}, path, {});
  state.counters["collisions"] = static_cast<double>(report.count);
  state.counters["bound_um"] = 1000 * report.bound_mm;
}

void sizes(benchmark::internal::Benchmark* b) {
  b->Unit(benchmark::kMillisecond);
  b->Args({1'000'000, 100'000})->Args({100'000, 100'000})->Args({1'000'000, 10'000});
}
BENCHMARK_CAPTURE(collisions, clear, 0, false)->Apply(sizes);
BENCHMARK_CAPTURE(collisions, rapid_on_the_face, 0, true)->Apply(sizes);
BENCHMARK_CAPTURE(collisions, holder_deep_inside, 90, false)->Apply(sizes);

}  // namespace
