// SPDX-License-Identifier: Apache-2.0
// What the interference of a face mill is measured on: a blade-like surface with bumps of 0.2 mm, 500 x 500
// mm, with part of the next blade above it and a hub beside it, as a mesh of about `triangles`; contact
// points all over the blade; poses there, every second one free. Cutter, shank and holder as three cylinders.
#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <random>

#include "burin/plan/orient/scene.h"

namespace burin::orient::bench {

inline model::Mill tool() {
  model::Mill m;
  m.kind = model::MillKind::flat;
  m.radius = 125;
  m.length = 60;
  m.holder = {{60, 120}, {90, 200}};
  return m;
}
inline std::vector<BodyPiece> body() {
  return tool_body(tool(), 0.01, 1);
}
inline AngleRange range() {
  return {geom::radians(1.5), geom::radians(20), geom::radians(-90), geom::radians(90)};
}

struct Case {
  geom::Mesh mesh;
  std::vector<CcPoint> contacts;
  std::vector<cl::Pose> poses;
};

/// Corners of a grid over [0, 1]^2, two triangles a cell.
template <class At>
void add_patch(geom::Mesh& mesh, int nu, int nv, At at) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size()),
             row = static_cast<std::uint32_t>(nu + 1);
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) mesh.vertices.push_back(at(double(i) / nu, double(j) / nv));
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(nv); ++j)
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(nu); ++i) {
      const std::uint32_t k = first + j * row + i;
      mesh.triangles.push_back({k, k + 1, k + row + 1});
      mesh.triangles.push_back({k, k + row + 1, k + row});
    }
}

inline double blade(double x, double y) {
  return x * y / 2500 + x * x / 6000 - y * y / 9000 + 0.2 * std::sin(x / 16) * std::cos(y / 19);
}

inline Case make_case(int triangles) {
  Case out;
  // Three quarters of the triangles on the blade.
  const int n = static_cast<int>(std::sqrt(0.75 * triangles / 2)), side = n / 3, hub = n / 2;
  add_patch(out.mesh, n, n, [](double u, double v) {
    const double x = 500 * u - 250, y = 500 * v - 250;
    return geom::Point3{x, y, blade(x, y)};
  });
  add_patch(out.mesh, n / 2, side, [](double u, double v) {
    const double x = 500 * u - 250, y = 120 + 200 * v;
    return geom::Point3{x, y, blade(x, y) + 170 + 0.25 * y};
  });
  add_patch(out.mesh, hub, side, [](double u, double v) {
    const double a = geom::kPi * (u - 0.5);
    return geom::Point3{-330 + 70 * std::cos(a), 500 * v - 250, 70 * std::sin(a) + 40};
  });
  const model::Mill mill = tool();
  const Scene scene(out.mesh, mill, body());
  Scene::Memory memory;
  std::mt19937 random(1);
  const auto between = [&](double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(random()) / 4294967296.0);
  };
  bool free = false;
  while (out.poses.size() < 4000) {
    const double x = between(-180, 180), y = between(-180, 180), h = 1e-4;
    CcPoint at;
    at.c = {x, y, blade(x, y)};
    at.n = geom::unit(
        {(blade(x - h, y) - blade(x + h, y)) / (2 * h), (blade(x, y - h) - blade(x, y + h)) / (2 * h), 1});
    at.f = geom::unit(cross(geom::Vec3{0, 1, 0}, at.n));
    for (int tries = 0; tries < 20; ++tries) {
      const Angles a{between(range().alpha_lo, range().alpha_hi), between(range().beta_lo, range().beta_hi)};
      const cl::Pose p = pose(at, a, mill);
      if (scene.blocker(p, memory).has_value() == free) continue;
      out.poses.push_back(p);
      out.contacts.push_back(at);
      free = !free;
      break;
    }
  }
  return out;
}

/// 90 tilts by 45 yaws.
inline std::vector<cl::Pose> map_poses(const CcPoint& at) {
  std::vector<cl::Pose> out;
  const AngleRange r = range();
  const model::Mill mill = tool();
  for (int j = 0; j < 45; ++j)
    for (int i = 0; i < 90; ++i)
      out.push_back(pose(
          at, {r.alpha_lo + (r.alpha_hi - r.alpha_lo) * i / 89, r.beta_lo + (r.beta_hi - r.beta_lo) * j / 44},
          mill));
  return out;
}

inline const Case& the_case(int triangles) {
  static std::map<int, Case> cases;
  auto it = cases.find(triangles);
  if (it == cases.end()) it = cases.emplace(triangles, make_case(triangles)).first;
  return it->second;
}

inline void rate(benchmark::State& state, double count) {
  state.counters["million_per_s"] =
      benchmark::Counter(count * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
}

/// The poses of the case; `begin()` gives what is asked of each in one round: meets(pose).
template <class Begin>
void measure_poses(benchmark::State& state, const Case& c, const Begin& begin) {
  std::size_t met = 0;
  for (auto _ : state) {
    auto meets = begin();
    met = 0;
    for (const auto& pose : c.poses) met += meets(pose);
    benchmark::DoNotOptimize(met);
  }
  state.counters["met"] = static_cast<double>(met) / static_cast<double>(c.poses.size());
  rate(state, static_cast<double>(c.poses.size()));
}

/// Maps of 90 tilts by 45 yaws, cell by cell, of one contact point after the other.
template <class Begin>
void measure_maps(benchmark::State& state, const Case& c, const Begin& begin) {
  std::size_t met = 0, next = 0;
  for (auto _ : state) {
    auto meets = begin();
    for (const auto& pose : map_poses(c.contacts[next])) met += meets(pose);
    benchmark::DoNotOptimize(met);
    next = (next + 97) % c.contacts.size();
  }
  rate(state, 90 * 45);
}

}  // namespace burin::orient::bench
