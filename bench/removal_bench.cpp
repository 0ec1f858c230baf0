// SPDX-License-Identifier: Apache-2.0
// Material removal: moves x 10, resolution / 2. Arguments: moves, resolution in micrometres, threads.
#include <benchmark/benchmark.h>

#include "burin/geom/vec.h"
#include "burin/removal/removal.h"

namespace {

using namespace burin;
using geom::Point3;
using geom::Vec3;

/// A wavy surface over 100 x 100 mm, in zigzag by a ball of radius 3 whose axis swings by 20 degrees; below
/// it all of a pass before, 5 mm deep.
verify::CheckedPath five_axes(std::size_t moves) {
  verify::ToolPath tool;
  tool.tool = {3, 3, 20, {{2.9, 20, 50, false}, {15, 50, 80, true}}};
  const auto rows = static_cast<std::size_t>(std::sqrt(static_cast<double>(moves)));
  const std::size_t per_row = moves / rows;
  const auto pose = [&](std::size_t i) {
    const std::size_t row = i / per_row, in_row = i % per_row;
    const double v = static_cast<double>(row) / static_cast<double>(rows);
    double u = static_cast<double>(in_row) / static_cast<double>(per_row);
    if (row % 2 == 1) u = 1 - u;
    const double x = 100 * u, y = 100 * v, z = 44 + 2 * std::sin(6 * u) * std::cos(5 * v);
    const double tilt = 0.35 * std::sin(9 * u), side = 0.35 * std::cos(7 * v);
    return cl::Pose{{x, y, z}, unit(Vec3{tilt, side, 1})};
  };
  tool.from = pose(0);
  for (std::size_t i = 1; i < rows * per_row; ++i)
    tool.pieces.push_back({pose(i), static_cast<std::uint32_t>(i - 1), false});
  verify::CheckedPath path;
  path.moves.resize(tool.pieces.size());
  path.tools.push_back(std::move(tool));
  return path;
}
verify::CheckedPath three_axes(std::size_t moves) {
  verify::CheckedPath path = five_axes(moves);
  path.tools[0].from.axis = {0, 0, 1};
  for (auto& p : path.tools[0].pieces) p.to.axis = {0, 0, 1};
  return path;
}

void run(benchmark::State& state, const verify::CheckedPath& path, removal::Directions directions) {
  removal::RemovalOptions options;
  options.resolution_mm = static_cast<double>(state.range(1)) / 1000;
  options.threads = static_cast<unsigned>(state.range(2));
  options.directions = directions;
  const removal::BlockStock block{{0, 0, 0}, {100, 100, 50}};
  for (auto _ : state) {
    auto r = removal::remove_material(block, path, options);
    if (!r) return state.SkipWithError(r.error().message.c_str());
    state.counters["removed_mm3"] = r->removed_mm3();
    benchmark::DoNotOptimize(r);
  }
}
void removal_five_axes(benchmark::State& state) {
  run(state, five_axes(static_cast<std::size_t>(state.range(0))), removal::Directions::three);
}
void removal_three_axes(benchmark::State& state) {
  run(state, three_axes(static_cast<std::size_t>(state.range(0))), removal::Directions::one);
}
BENCHMARK(removal_five_axes)
    ->Args({10'000, 200, 2})
    ->Args({100'000, 200, 1})
    ->Args({100'000, 200, 2})
    ->Args({1'000'000, 200, 2})
    ->Args({100'000, 400, 2})
    ->Args({100'000, 100, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(removal_three_axes)
    ->Args({100'000, 200, 2})
    ->Args({100'000, 100, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
