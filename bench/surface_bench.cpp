// SPDX-License-Identifier: Apache-2.0
// Evaluation of surfaces beside SISL (s1421, s1424 with the spans of the call before as hints). OpenCASCADE
// is in surface_occt_bench.cpp. Every run evaluates kPlaces places.
#include <sisl.h>

#include "burin/geom/surface/closest.h"
#include "burin/geom/surface/evaluate.h"
#include "surface_bench_cases.h"

namespace burin::geom::bench {
namespace {

int count_of(const benchmark::State& state) {
  return static_cast<int>(state.range(0));
}

// burin: lists of places

void burin_points(benchmark::State& state, Order order) {
  SurfaceEvaluator e(surface(count_of(state)));
  const std::vector<Point2> uv = places(count_of(state), order);
  std::vector<Point3> out(kBlock);
  for (auto _ : state) {
    for (int i = 0; i < kPlaces; i += kBlock) {
      e.points(std::span(uv).subspan(static_cast<std::size_t>(i), kBlock), out);
      benchmark::DoNotOptimize(out.data());
      benchmark::ClobberMemory();
    }
  }
  report(state);
}

void burin_derivatives(benchmark::State& state, Order order) {
  SurfaceEvaluator e(surface(count_of(state)));
  const std::vector<Point2> uv = places(count_of(state), order);
  std::vector<SurfaceDerivatives> out(kBlock);
  for (auto _ : state) {
    for (int i = 0; i < kPlaces; i += kBlock) {
      e.derivatives(std::span(uv).subspan(static_cast<std::size_t>(i), kBlock), out);
      benchmark::DoNotOptimize(out.data());
      benchmark::ClobberMemory();
    }
  }
  report(state);
}

void burin_iso_derivatives(benchmark::State& state) {
  SurfaceEvaluator e(surface(count_of(state)));
  const std::vector<Point2> uv = places(count_of(state), Order::iso);
  std::vector<double> u;
  for (const Point2 q : uv) u.push_back(q.x);
  std::vector<SurfaceDerivatives> out(kBlock);
  for (auto _ : state) {
    for (int i = 0; i < kPlaces; i += kBlock) {
      e.iso_derivatives(Direction::u, uv[0].y, std::span(u).subspan(static_cast<std::size_t>(i), kBlock),
                        out);
      benchmark::DoNotOptimize(out.data());
      benchmark::ClobberMemory();
    }
  }
  report(state);
}

// burin: one call a place, as the peers are called

void burin_point_calls(benchmark::State& state, Order order) {
  SurfaceEvaluator e(surface(count_of(state)));
  const std::vector<Point2> uv = places(count_of(state), order);
  for (auto _ : state) {
    for (const Point2 q : uv) benchmark::DoNotOptimize(e.point(q.x, q.y));
  }
  report(state);
}

void burin_derivative_calls(benchmark::State& state, Order order) {
  SurfaceEvaluator e(surface(count_of(state)));
  const std::vector<Point2> uv = places(count_of(state), order);
  for (auto _ : state) {
    for (const Point2 q : uv) benchmark::DoNotOptimize(e.derivatives(q.x, q.y));
  }
  report(state);
}

// SISL

class SislSurface {
 public:
  explicit SislSurface(const NurbsSurface& s) : knots_u_(s.knots_u), knots_v_(s.knots_v) {
    for (const HPoint& h : s.points) net_.insert(net_.end(), {h.x, h.y, h.z, h.w});
    constexpr int kRational = 2, kCopy = 1;
    surface_ = newSurf(s.count_u, s.count_v, s.degree_u + 1, s.degree_v + 1, knots_u_.data(), knots_v_.data(),
                       net_.data(), kRational, 3, kCopy);
  }
  ~SislSurface() { freeSurf(surface_); }
  SislSurface(const SislSurface&) = delete;
  SislSurface& operator=(const SislSurface&) = delete;
  SISLSurf* get() const { return surface_; }

 private:
  std::vector<double> knots_u_, knots_v_, net_;
  SISLSurf* surface_ = nullptr;
};

void sisl(benchmark::State& state, Order order, int derivatives) {
  const SislSurface s(surface(count_of(state)));
  const std::vector<Point2> uv = places(count_of(state), order);
  int left_u = 0, left_v = 0, status = 0;
  double out[18] = {}, normal[3] = {};
  for (auto _ : state) {
    for (const Point2 q : uv) {
      double at[2] = {q.x, q.y};
      if (derivatives == 0) {
        s1424(s.get(), 0, 0, at, &left_u, &left_v, out, &status);
      } else {
        s1421(s.get(), derivatives, at, &left_u, &left_v, out, normal, &status);
      }
      benchmark::DoNotOptimize(out);
      benchmark::ClobberMemory();
    }
  }
  const Point2 last = uv.back();
  const Point3 p = point(surface(count_of(state)), last.x, last.y);
  if (status < 0 || distance(p, {out[0], out[1], out[2]}) > 1e-9) state.SkipWithError("another point");
  report(state);
}

void register_all() {
  const auto add = [](const char* name, auto run) {
    benchmark::RegisterBenchmark(name, run)->Arg(6)->Arg(50);
  };
  using State = benchmark::State;
  add("burin_surface_points_sequential", [](State& s) { burin_points(s, Order::sequential); });
  add("sisl_surface_points_sequential", [](State& s) { sisl(s, Order::sequential, 0); });
  add("burin_surface_derivatives_random", [](State& s) { burin_derivatives(s, Order::random); });
  add("sisl_surface_derivatives_random", [](State& s) { sisl(s, Order::random, 2); });
  add("burin_surface_derivatives_sequential", [](State& s) { burin_derivatives(s, Order::sequential); });
  add("sisl_surface_derivatives_sequential", [](State& s) { sisl(s, Order::sequential, 2); });
  add("burin_surface_derivatives_iso", [](State& s) { burin_iso_derivatives(s); });
  add("sisl_surface_derivatives_iso", [](State& s) { sisl(s, Order::iso, 2); });
  add("burin_surface_point_calls_sequential", [](State& s) { burin_point_calls(s, Order::sequential); });
  add("burin_surface_derivative_calls_random", [](State& s) { burin_derivative_calls(s, Order::random); });
  add("burin_surface_derivative_calls_sequential",
      [](State& s) { burin_derivative_calls(s, Order::sequential); });
}
const bool registered = (register_all(), true);

}  // namespace
}  // namespace burin::geom::bench
