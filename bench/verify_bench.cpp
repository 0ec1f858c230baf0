// SPDX-License-Identifier: Apache-2.0
// Deviation of a wavy 100 mm part from five-axis passes with turning axes: 100,000 moves against 1,000,000
// samples on two threads, and growth with moves and with samples. Counters: bound, cells.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "burin/verify/deviation.h"

namespace {

using namespace burin;
using geom::Point3;
using geom::Vec3;

constexpr double kSize = 100;
double height(double x, double y) {
  return 3 * std::sin(0.06 * x) * std::cos(0.05 * y);
}
Vec3 normal(double x, double y) {
  return unit(Vec3{-0.18 * std::cos(0.06 * x) * std::cos(0.05 * y),
                   0.15 * std::sin(0.06 * x) * std::sin(0.05 * y), 1});
}

geom::Mesh wavy(std::uint32_t n) {
  geom::Mesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) {
      const double x = kSize * i / n, y = kSize * j / n;
      mesh.vertices.push_back({x, y, height(x, y)});
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + n + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

/// Rows in x, to and fro, steps and rows equally far apart; leaning by an angle that changes on the way.
verify::CheckedPath rows_over(const verify::CheckedMill& mill, double moves) {
  const int rows = static_cast<int>(std::lround(std::sqrt(moves)));
  verify::ToolPath tool{mill, 1, {}, {}};
  std::uint32_t move = 0;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < rows; ++i) {
      const double x = kSize * (j % 2 ? rows - 1 - i : i) / (rows - 1), y = kSize * j / (rows - 1);
      const Vec3 n = normal(x, y), ahead = unit(Vec3{1, 0, 0} - n.x * n);
      const double lean = 0.1 * (1 + 0.3 * std::sin(0.1 * x + 0.2 * y));
      const Vec3 axis = std::cos(lean) * n + std::sin(lean) * ahead, side = unit(n - dot(n, axis) * axis);
      const double r = mill.corner_radius;
      const Point3 tip = Point3{x, y, height(x, y)} + (r * n + (mill.radius - r) * side - r * axis);
      if (i == 0 && j == 0) {
        tool.from = {tip, axis};
      } else {
        tool.pieces.push_back({{tip, axis}, move, false});
      }
      ++move;
    }
  verify::CheckedPath path{{tool}, {}, 0.0005};
  path.moves.resize(move);
  return path;
}

const verify::CheckedMill kMills[] = {{3, 3, 30, {{3, 30, 60, false}, {20, 60, 100, true}}},
                                      {8, 0, 30, {{8, 30, 60, false}, {20, 60, 100, true}}},
                                      {6, 1, 30, {{6, 30, 60, false}, {20, 60, 100, true}}}};

void deviation(benchmark::State& state) {
  const geom::Mesh mesh = wavy(200);
  verify::SampleOptions options;
  options.count = static_cast<std::size_t>(state.range(2));
  const auto surface = verify::sample_surface(mesh, {}, {}, options);
  const verify::CheckedPath path = rows_over(kMills[state.range(0)], static_cast<double>(state.range(1)));
  double bound = 0;
  for (auto _ : state) {
    const auto report = verify::measure_deviation(mesh, *surface, path, {.threads = 2});
    bound = report ? report->bound_mm : -1;
  }
  state.counters["bound_mm"] = bound;
  state.counters["cells"] = static_cast<double>(surface->samples.size());
}
// Mill (0 ball, 1 flat, 2 bull), moves, samples.
BENCHMARK(deviation)
    ->Name("verify/deviation")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(1)
    ->Args({0, 100'000, 1'000'000})
    ->Args({1, 100'000, 1'000'000})
    ->Args({2, 100'000, 1'000'000})
    ->Args({0, 10'000, 100'000})
    ->Args({0, 100'000, 100'000})
    ->Args({0, 10'000, 1'000'000});

}  // namespace
