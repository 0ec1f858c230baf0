// SPDX-License-Identifier: Apache-2.0
// What burin and its peers evaluate: bicubic rational surfaces with knots that are not uniform and weights
// from 0.5 to 2, and lists of places.
#pragma once

#include <benchmark/benchmark.h>

#include <vector>

#include "burin/geom/surface/surface_cases.h"

namespace burin::geom::bench {

/// Places of one run. A path of 2048 steps crosses each of the 47 x 47 pieces of the large surface in
/// about 43.
inline constexpr int kPlaces = 4096;
/// Results are written to a buffer of this many sets, again and again: a planner uses them at once.
inline constexpr int kBlock = 256;

/// `count`: 6 or 50 control points each way.
inline const NurbsSurface& surface(int count) {
  static const NurbsSurface small = cases::random_surface(11, {.count_u = 6, .count_v = 6});
  static const NurbsSurface large = cases::random_surface(12, {.count_u = 50, .count_v = 50});
  return count == 6 ? small : large;
}

enum class Order {
  sequential,  ///< along u and back, v rising all the time
  random,
  iso,  ///< along u and back, v fixed
};

inline std::vector<Point2> places(int count, Order order) {
  const Interval u = surface(count).domain(Direction::u), v = surface(count).domain(Direction::v);
  cases::Random r(13);
  std::vector<Point2> uv;
  for (int i = 0; i < kPlaces; ++i) {
    const int half = kPlaces / 2;
    const double f = i < half ? (i + 0.5) / half : (kPlaces - i - 0.5) / half;
    const double g = order == Order::iso ? 0.37 : 0.3 + 0.1 * i / kPlaces;
    if (order == Order::random) {
      const double a = r.between(u.lo, u.hi);
      uv.push_back({a, r.between(v.lo, v.hi)});
    } else {
      uv.push_back({u.lo + f * u.length(), v.lo + g * v.length()});
    }
  }
  return uv;
}

inline void report(benchmark::State& state) {
  state.SetLabel(state.range(0) == 6 ? "6x6" : "50x50");
  state.counters["million_per_s"] =
      benchmark::Counter(kPlaces * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace burin::geom::bench
