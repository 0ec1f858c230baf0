// SPDX-License-Identifier: Apache-2.0
// The places of surface_bench.cpp by OpenCASCADE: GeomAdaptor_Surface, which keeps the current span. The only
// file with its headers.
#include <GeomAdaptor_Surface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>

#include "burin/geom/surface/evaluate.h"
#include "surface_bench_cases.h"

namespace burin::geom::bench {
namespace {

struct Knots {
  TColStd_Array1OfReal values;
  TColStd_Array1OfInteger times;
};
Knots knots_of(const std::vector<double>& knots) {
  std::vector<double> values;
  std::vector<int> times;
  for (const double k : knots) {
    if (values.empty() || values.back() != k) {
      values.push_back(k);
      times.push_back(0);
    }
    ++times.back();
  }
  const int n = static_cast<int>(values.size());
  Knots out{TColStd_Array1OfReal(1, n), TColStd_Array1OfInteger(1, n)};
  for (int i = 0; i < n; ++i) {
    out.values.SetValue(i + 1, values[static_cast<std::size_t>(i)]);
    out.times.SetValue(i + 1, times[static_cast<std::size_t>(i)]);
  }
  return out;
}

Handle(Geom_BSplineSurface) occt_surface(const NurbsSurface& s) {
  TColgp_Array2OfPnt poles(1, s.count_u, 1, s.count_v);
  TColStd_Array2OfReal weights(1, s.count_u, 1, s.count_v);
  for (int j = 0; j < s.count_v; ++j) {
    for (int i = 0; i < s.count_u; ++i) {
      const Point3 p = project(s.at(i, j));
      poles.SetValue(i + 1, j + 1, gp_Pnt(p.x, p.y, p.z));
      weights.SetValue(i + 1, j + 1, s.at(i, j).w);
    }
  }
  const Knots u = knots_of(s.knots_u), v = knots_of(s.knots_v);
  return new Geom_BSplineSurface(poles, weights, u.values, v.values, u.times, v.times, s.degree_u,
                                 s.degree_v);
}

void occt(benchmark::State& state, Order order, int derivatives) {
  const int count = static_cast<int>(state.range(0));
  const GeomAdaptor_Surface s(occt_surface(surface(count)));
  const std::vector<Point2> uv = places(count, order);
  gp_Pnt p;
  gp_Vec u, v, uu, vv, uvs;
  for (auto _ : state) {
    for (const Point2 q : uv) {
      if (derivatives == 0) {
        s.D0(q.x, q.y, p);
      } else {
        s.D2(q.x, q.y, p, u, v, uu, vv, uvs);
      }
      benchmark::DoNotOptimize(p);
      benchmark::ClobberMemory();
    }
  }
  const Point2 last = uv.back();
  if (distance(point(surface(count), last.x, last.y), {p.X(), p.Y(), p.Z()}) > 1e-9) {
    state.SkipWithError("another point");
  }
  report(state);
}

void register_all() {
  const auto add = [](const char* name, auto run) {
    benchmark::RegisterBenchmark(name, run)->Arg(6)->Arg(50);
  };
  using State = benchmark::State;
  add("occt_surface_points_sequential", [](State& s) { occt(s, Order::sequential, 0); });
  add("occt_surface_derivatives_random", [](State& s) { occt(s, Order::random, 2); });
  add("occt_surface_derivatives_sequential", [](State& s) { occt(s, Order::sequential, 2); });
  add("occt_surface_derivatives_iso", [](State& s) { occt(s, Order::iso, 2); });
}
const bool registered = (register_all(), true);

}  // namespace
}  // namespace burin::geom::bench
