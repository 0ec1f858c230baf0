// SPDX-License-Identifier: Apache-2.0
// The check of a beam against its outlines: plates with round holes and slots, cut right and cut 0.05 mm too
// close. Growth with the number of segments; a clean program is the usual case.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "burin/verify/beam_check.h"

namespace burin::verify {
namespace {

using geom::Point2;
using geom::Segment;

constexpr double kKerf = 0.2, kPitch = 6, kRound = 2;

/// A slot of two lines and two half circles, or a circle; r: of its ends.
std::vector<Segment> opening(Point2 c, double r, double length) {
  const Point2 a{c.x - length / 2, c.y}, b{c.x + length / 2, c.y};
  std::vector<Segment> s{geom::make_arc({b.x, b.y + r}, {b.x, b.y - r}, b, false),
                         geom::make_arc({a.x, a.y - r}, {a.x, a.y + r}, a, false)};
  if (length > 0) {
    s.insert(s.begin() + 1, geom::make_line({b.x, b.y - r}, {a.x, a.y - r}));
    s.push_back(geom::make_line({a.x, a.y + r}, {b.x, b.y + r}));
  }
  return s;
}

struct Job {
  std::vector<Outline> outlines;
  cl::Program program;
  std::size_t segments = 0;

  void cut(const std::vector<Segment>& way) {
    const auto pose = [](Point2 p) { return cl::Pose{geom::at_z(p, 0), {0, 0, 1}}; };
    program.add(cl::Rapid{pose(way.front().a)});
    program.add(cl::Beam{true, 1});
    for (const Segment& s : way) {
      if (s.is_line())
        program.add(cl::Feed{pose(s.b)});
      else
        program.add(cl::Arc{
            geom::at_z(s.center, 0), {0, 0, s.radius > 0 ? 1.0 : -1.0}, std::abs(s.radius), pose(s.b)});
    }
    program.add(cl::Beam{});
  }
};

/// About `segments` of them; the beam runs `off` mm too near to the part.
Job plate(std::size_t segments, double off) {
  Job job;
  const auto n = static_cast<int>(std::sqrt(static_cast<double>(segments) / 3));
  const double size = kPitch * (n + 1), r = kKerf / 2 - off;
  const auto frame = [&](double g) {
    const Point2 lo{-g, -g}, hi{size + g, size + g};
    return std::vector<Segment>{geom::make_line(lo, {hi.x, lo.y}), geom::make_line({hi.x, lo.y}, hi),
                                geom::make_line(hi, {lo.x, hi.y}), geom::make_line({lo.x, hi.y}, lo)};
  };
  job.outlines.push_back({frame(0), true});
  job.cut(frame(r));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const Point2 c{kPitch * (i + 1), kPitch * (j + 1)};
      const double radius = kRound / (1 + 0.01 * (i % 7)), length = (i + j) % 2 == 0 ? 0 : 1;
      job.outlines.push_back({opening(c, radius, length), true});
      job.cut(opening(c, radius - r, length));
      job.segments += job.outlines.back().segments.size();
    }
  }
  return job;
}

void check(benchmark::State& state, double off) {
  const Job job = plate(static_cast<std::size_t>(state.range(0)), off);
  BeamCheckOptions options;
  options.kerf_mm = kKerf;
  options.threads = 0;
  for (auto _ : state) {
    const auto report = check_beam(job.outlines, job.program, options);
    if (!report || std::abs(report->gouge.mm - off) > report->bound_mm) {
      state.SkipWithError("the check is wrong");
      return;
    }
    state.counters["bound_um"] = 1e3 * report->bound_mm;
    state.counters["places"] = static_cast<double>(report->places.size());
  }
  state.counters["segments"] = static_cast<double>(job.segments);
  state.SetComplexityN(static_cast<benchmark::IterationCount>(job.segments));
}

void beam_clean(benchmark::State& state) {
  check(state, 0);
}
void beam_too_close(benchmark::State& state) {
  check(state, 0.05);
}
BENCHMARK(beam_clean)
    ->Arg(1'000)
    ->Arg(10'000)
    ->Arg(100'000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Complexity();
BENCHMARK(beam_too_close)
    ->Arg(1'000)
    ->Arg(10'000)
    ->Arg(100'000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Complexity();

}  // namespace
}  // namespace burin::verify
