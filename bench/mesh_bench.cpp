// SPDX-License-Identifier: Apache-2.0
// MeshIndex over meshes of 10,000 to 1,000,000 triangles: a side-milling cutter with deep flutes and sharp
// edges, 2 mm ball. The questions are those of finishing: centres near the surface.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "burin/geom/mesh/mesh_cases.h"
#include "burin/geom/mesh/mesh_index.h"

namespace {

using namespace burin::geom;

constexpr double kRadius = 2;

struct Place {
  Point3 contact;
  Vec3 normal;
  Point3 center() const { return contact + kRadius * normal; }
};

/// Contact points all over the mesh, in the order of paths: rings of neighbours.
std::vector<Place> places(const Mesh& mesh, std::size_t count) {
  std::vector<Place> out;
  const std::size_t start = mesh.triangles.size() / 3, step = mesh.triangles.size() / count / 2 | 1;
  for (std::size_t i = start; out.size() < count; i = (i + step) % mesh.triangles.size()) {
    const auto& t = mesh.triangles[i];
    const Point3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    out.push_back({lerp(lerp(a, b, 0.5), c, 0.4), unit(cross(b - a, c - a))});
  }
  return out;
}

Mesh cutter(const benchmark::State& state) {
  return cases::cutter(static_cast<std::uint32_t>(state.range(0)), 50, 20, 12, 12, 0.5);
}

void mesh_build(benchmark::State& state) {
  const Mesh mesh = cutter(state);
  for (auto _ : state) {
    const MeshIndex index(mesh);
    benchmark::DoNotOptimize(index.bounds());
  }
}

/// Does the ball that touches at a contact point gouge?
void mesh_nearest(benchmark::State& state) {
  const Mesh mesh = cutter(state);
  const MeshIndex index(mesh);
  const auto asked = places(mesh, 20'000);
  std::size_t i = 0, gouging = 0;
  for (auto _ : state) {
    const auto hit = index.nearest(asked[i].center(), kRadius * 1.01);
    if (hit && hit->distance < kRadius - 0.005) ++gouging;
    i = i + 1 < asked.size() ? i + 1 : 0;
  }
  state.counters["points_per_s"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["gouging"] = static_cast<double>(gouging) / static_cast<double>(state.iterations());
}

/// The place of the ball that touches without gouging, out along the normal.
void mesh_ball_out(benchmark::State& state) {
  const Mesh mesh = cutter(state);
  const MeshIndex index(mesh);
  const auto asked = places(mesh, 20'000);
  std::size_t i = 0, moved = 0;
  for (auto _ : state) {
    const auto t = index.ball_out(asked[i].center(), asked[i].normal, kRadius, 0.005, 100, 1e-4);
    if (t && *t > 0) ++moved;
    i = i + 1 < asked.size() ? i + 1 : 0;
  }
  state.counters["points_per_s"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["moved"] = static_cast<double>(moved) / static_cast<double>(state.iterations());
}

/// The same from inside of the part along the radius (drop cutter, from below): always has to move.
void mesh_ball_out_radial(benchmark::State& state) {
  const Mesh mesh = cutter(state);
  const MeshIndex index(mesh);
  const auto asked = places(mesh, 20'000);
  std::size_t i = 0;
  double sum = 0;
  for (auto _ : state) {
    const Point3 p = asked[i].contact;
    sum += index.ball_out(p, unit(Vec3{0, p.y, p.z}), kRadius, 0.005, 100, 1e-4).value_or(0);
    i = i + 1 < asked.size() ? i + 1 : 0;
  }
  benchmark::DoNotOptimize(sum);
  state.counters["points_per_s"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK(mesh_build)->Arg(10'000)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK(mesh_nearest)->Arg(10'000)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(mesh_ball_out)->Arg(10'000)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(mesh_ball_out_radial)->Arg(10'000)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);

}  // namespace
