// SPDX-License-Identifier: Apache-2.0
// Properties of the whole surface job on random surfaces: program text -> join -> plan -> CL, NC, setpoints,
// measured by code that shares nothing with the planner, and read back.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "burin/cl/apt.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/modify.h"
#include "burin/geom/surface/tessellate.h"
#include "burin/job/cycle_job.h"
#include "burin/nc/program.h"
#include "burin/post/emit.h"
#include "burin/servo/measure.h"
#include "burin/verify/scallop.h"
#include "burin/verify/sweep.h"
#include "verify_support.h"

namespace burin {
namespace {

using geom::NurbsSurface;
using geom::Point3;
using geom::Vec3;

/// Bicubic, bent gently enough for a ball of radius 3: bumps of a few tenths over 40 x 30 mm.
NurbsSurface bumpy(std::mt19937& random, double height = 1.5) {
  std::uniform_real_distribution<double> number(-1, 1);
  NurbsSurface s;
  s.degree_u = s.degree_v = 3;
  s.count_u = 7;
  s.count_v = 6;
  s.knots_u = geom::clamped_uniform_knots(7, 3);
  s.knots_v = geom::clamped_uniform_knots(6, 3);
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 7; ++i)
      s.points.push_back(
          geom::homogeneous({40.0 * i / 6, 30.0 * j / 5, height * number(random) + 4 * std::sin(0.5 * i)},
                            1 + 0.2 * number(random)));
  return s;
}

nc::SurfaceBlock block(int number, NurbsSurface surface) {
  nc::SurfaceBlock b;
  b.number = number;
  b.surface = std::move(surface);
  b.tool_diameter = 6;
  b.feed = 1500;
  b.scallop = 0.02;
  return b;
}

std::string program(const std::vector<nc::SurfaceBlock>& blocks, nc::PathMethod method, double safety = 30) {
  nc::SurfaceWriteOptions options;
  options.name = "random";
  options.method = method;
  options.tool_diameter = 6;
  options.scallop = 0.02;
  options.feed = 1500;
  options.safety_z = safety;
  options.decimals = 9;
  auto text = nc::write_surface_program(blocks, options);
  EXPECT_TRUE(text.ok()) << text.error().to_string();
  return text.ok() ? *text : "";
}

job::CycleJob make(const std::string& text, job::CycleOptions options = {}) {
  Diagnostics diagnostics;
  options.file_name = "random.nc";
  auto job = job::make_cycle_job(text, options, diagnostics, nullptr);
  EXPECT_TRUE(job.ok()) << (job.ok() ? "" : job.error().to_string());
  return job.ok() ? *std::move(job) : job::CycleJob{};
}

/// Tips of every pass of one surface, dense enough that chords stand for the path.
std::vector<verify::TipPass> tips_of(const job::CycleRun& run, int surface) {
  std::map<int, verify::TipPass> passes;
  for (const cycle::Motion& m : run.plan.motions) {
    // Paths with what they run over the edges of the surface.
    if (m.pass < 0 || m.surface != surface) continue;
    std::vector<Point3> tips{m.path.start()};
    for (std::size_t i = 0; i + 1 < m.path.nodes.size(); ++i) {
      // Chords of 0.06 mm leave a bend of radius 3 by 1.5e-4 mm.
      const int chords = 1 + int(geom::piece_length(m.path, i) / 0.06);
      for (int k = 1; k <= chords; ++k) tips.push_back(geom::evaluate_piece(m.path, i, double(k) / chords).p);
    }
    passes[m.pass].stretches.push_back(std::move(tips));
  }
  std::vector<verify::TipPass> out;
  for (auto& [number, pass] : passes) out.push_back(std::move(pass));
  return out;
}

bool reversed_normal(const NurbsSurface& s) {
  const geom::Interval u = s.domain(geom::Direction::u), v = s.domain(geom::Direction::v);
  return geom::normal(s, 0.5 * (u.lo + u.hi), 0.5 * (v.lo + v.hi)).z < 0;
}

/// What verify says of the CL data: a ball of radius 3 under a holder, on all surfaces of the program.
void expect_verified(const job::CycleJob& job, double excess_mm) {
  const job::CycleOptions defaults;
  verified::Design design;
  for (const job::CycleSurfaces& joined : job.surfaces)
    for (const auto& patch : joined.composite.surfaces) {
      auto triangles = geom::tessellate(patch.surface, false, {}, {0.0005, 0, 2'000'000});
      ASSERT_TRUE(triangles.ok()) << triangles.error().to_string();
      if (reversed_normal(patch.surface))
        for (auto& t : triangles->mesh.triangles) std::swap(t[1], t[2]);
      const auto first = static_cast<std::uint32_t>(design.mesh.vertices.size());
      for (const Point3& v : triangles->mesh.vertices) design.mesh.vertices.push_back(v);
      for (const auto& t : triangles->mesh.triangles)
        design.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      design.deflection_mm = std::max(design.deflection_mm, triangles->deflection_mm);
    }
  // Where the tool stands before the program is the operator's affair (the job says 0, 0, 0).
  cl::Program program = job.cl;
  program.from.reset();
  const verified::Says says =
      verified::say(design, verified::path_of(program, {3, 3, 15, {{20, 15, 60, true}}}), 1);
  verified::expect_clean(says, defaults.tolerance_mm, excess_mm);
}

TEST(CycleJob, ScallopIsWhatWasAskedFor) {
  std::mt19937 random(20);
  for (int i = 0; i < 6; ++i) {
    const auto method = i % 2 ? nc::PathMethod::iso_scallop : nc::PathMethod::iso_parametric;
    const job::CycleJob job = make(program({block(10, bumpy(random))}, method));
    ASSERT_EQ(job.runs.size(), 1u);
    if (job.lifted > 0) continue;  // bent tighter than the ball: heights follow the lift
    const NurbsSurface& s = job.surfaces[0].composite.surfaces[0].surface;
    const verify::ScallopReport report = measure_scallop(
        s, tips_of(job.runs[0], 0), {.radius_mm = 3, .normal_reversed = reversed_normal(s), .spacing_mm = 2});
    EXPECT_LE(report.scallop_max_mm, method == nc::PathMethod::iso_scallop ? 0.02 * 1.02 : 0.02 * (1 + 1e-6))
        << i;
    if (method == nc::PathMethod::iso_scallop) {
      EXPECT_GE(report.scallop_min_mm, 0.02 * 0.98) << i;
    }
    EXPECT_LT(report.gouge_max_mm, 1e-3);
    EXPECT_GT(report.ridges.size(), 10u);
    if (i < 2) expect_verified(job, 0.02 * 1.02 + job.fit_deviation_mm);
  }
}

/// A flat parallelogram 20 mm long and 12 mm wide whose ends stand at `slant` (tangent) to its sides.
NurbsSurface sheared(double slant) {
  NurbsSurface s;
  s.degree_u = s.degree_v = 1;
  s.count_u = s.count_v = 2;
  s.knots_u = s.knots_v = {0, 0, 1, 1};
  for (const double y : {0.0, 12.0})
    for (const double x : {0.0, 20.0}) s.points.push_back(geom::homogeneous({x + slant * y, y, 5}, 1));
  return s;
}

TEST(CycleJob, ScallopOnEdgesThatPathsMeetAtASlant) {
  for (const double slant : {0.3, -1.0, 2.5}) {
    job::CycleOptions options;
    options.along = cycle::Along::u;
    const NurbsSurface s = sheared(slant);
    const job::CycleJob job = make(program({block(10, s)}, nc::PathMethod::iso_scallop), options);
    ASSERT_EQ(job.runs.size(), 1u);
    const verify::ScallopReport report =
        measure_scallop(s, tips_of(job.runs[0], 0), {.radius_mm = 3, .spacing_mm = 0.3});
    EXPECT_LE(report.scallop_max_mm, 0.02 * 1.02) << slant;
    // About the acute corners of the others fronts turn, and what ends at the border is cut by its path too.
    if (slant < 1 && slant > -1) {
      EXPECT_GE(report.scallop_min_mm, 0.02 * 0.98) << slant;
    }
    // What the paths run over the edges by is less than half a step square to them.
    const double ends = 0.5 * std::sqrt(8 * 3 * 0.02) * std::sqrt(1 + slant * slant);
    for (const cycle::Motion& m : job.runs[0].plan.motions) {
      if (m.kind != cycle::MotionKind::cut) continue;
      for (const geom::QuinticNode& n : m.path.nodes) {
        const double x = n.p.x - slant * n.p.y;
        EXPECT_TRUE(x > -ends && x < 20 + ends) << x;
      }
      // The parameters stay on the surface.
      for (const geom::QuinticNode& n : m.uv.nodes) EXPECT_TRUE(n.p.x >= 0 && n.p.x <= 1) << n.p.x;
    }
  }
}

/// Two patches over 15 x 10 mm each that meet in a crease along x at y = 0; the curve across the paths
/// changes from there on, another way on either side. `slope`: fall of both sides away from the crease.
std::vector<NurbsSurface> creased(double slope) {
  std::vector<NurbsSurface> out;
  for (const double side : {-1.0, 1.0}) {
    NurbsSurface s;
    s.degree_u = s.degree_v = 3;
    s.count_u = s.count_v = 4;
    s.knots_u = s.knots_v = {0, 0, 0, 0, 1, 1, 1, 1};
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const double y = side < 0 ? -10 + 10.0 * j / 3 : 10.0 * j / 3, away = std::abs(y) / 10;
        // Control values of (x - 7.5)^2.
        const double square = i == 0 || i == 3 ? 56.25 : -18.75;
        const double bend = 0.01 + (side < 0 ? 0.015 : -0.02) * away * away;
        s.points.push_back(geom::homogeneous({5.0 * i, y, 5 - bend * square - slope * std::abs(y)}, 1));
      }
    out.push_back(std::move(s));
  }
  return out;
}

TEST(CycleJob, ScallopOfPathsAcrossAConvexCrease) {
  for (const double degrees : {20.0, 30.0, 40.0}) {
    const std::vector<NurbsSurface> two = creased(std::tan(0.5 * degrees * geom::kPi / 180));
    job::CycleOptions options;
    options.along = cycle::Along::v;
    const job::CycleJob job =
        make(program({block(10, two[0]), block(20, two[1])}, nc::PathMethod::iso_scallop), options);
    ASSERT_EQ(job.runs.size(), 1u);
    ASSERT_EQ(job.surfaces_out, 1u);
    EXPECT_EQ(job.lifted, 0u);
    for (const cycle::PassFigures& f : job.runs[0].plan.figures) EXPECT_LE(f.scallop_max, 0.02 * 1.02);
    const NurbsSurface& s = job.surfaces[0].composite.surfaces[0].surface;
    const verify::ScallopReport report =
        measure_scallop(s, tips_of(job.runs[0], 0),
                        {.radius_mm = 3, .normal_reversed = reversed_normal(s), .spacing_mm = 0.5});
    EXPECT_LE(report.scallop_max_mm, 0.02 * 1.02) << degrees;
    // The crease itself included.
    EXPECT_GE(report.scallop_min_mm, 0.02 * 0.95) << degrees;
    EXPECT_LT(report.gouge_max_mm, 1e-3);
  }
}

/// The highest place between the paths of the only surface, on lines across them; places that `leave_out`
/// names are not looked at. Sweeps the ball over the surface, as measure_scallop does.
double highest(const job::CycleJob& job, cycle::Along along, const std::function<bool(Point3)>& leave_out) {
  constexpr double kRadius = 3;
  constexpr int kLines = 12, kSamples = 1500;
  std::vector<verify::Sweep::Segment> segments;
  for (const verify::TipPass& pass : tips_of(job.runs[0], 0))
    for (const std::vector<Point3>& tips : pass.stretches)
      for (std::size_t i = 0; i + 1 < tips.size(); ++i)
        segments.push_back({{tips[i].x, tips[i].y, tips[i].z + kRadius},
                            {tips[i + 1].x, tips[i + 1].y, tips[i + 1].z + kRadius}});
  const verify::Sweep sweep(std::move(segments), kRadius);
  const NurbsSurface& s = job.surfaces[0].composite.surfaces[0].surface;
  const double side = reversed_normal(s) ? -1 : 1;
  const geom::Interval u = s.domain(geom::Direction::u), v = s.domain(geom::Direction::v);
  geom::SurfaceEvaluator evaluator(s);
  double most = 0;
  for (int i = 0; i <= kLines; ++i) {
    const auto at = [&](double x) {
      double a = double(i) / kLines, b = x;
      if (along == cycle::Along::v) std::swap(a, b);
      const geom::SurfaceDerivatives d = evaluator.derivatives(u.lo + a * u.length(), v.lo + b * v.length());
      if (leave_out(d.p)) return 0.0;
      return sweep.entry(d.p, side * geom::normal(d), -2 * kRadius, 2 * kRadius, 0).value_or(2 * kRadius);
    };
    for (int k = 0; k <= kSamples; ++k) most = std::max(most, at(double(k) / kSamples));
  }
  return most;
}

TEST(CycleJob, ScallopAlongAConvexCrease) {
  for (const double degrees : {3.0, 30.0, 90.0}) {
    const std::vector<NurbsSurface> two = creased(std::tan(0.5 * degrees * geom::kPi / 180));
    job::CycleOptions options;
    options.along = cycle::Along::u;
    const job::CycleJob job =
        make(program({block(10, two[0]), block(20, two[1])}, nc::PathMethod::iso_scallop), options);
    ASSERT_EQ(job.surfaces_out, 1u);
    EXPECT_EQ(job.lifted, 0u);
    // The ball on one side and on the other: two paths along the crease at most, and two steps that are
    // narrower.
    for (const cycle::PassFigures& f : job.runs[0].plan.figures) {
      EXPECT_LE(f.scallop_max, 0.02 * 1.02);
      if (!f.last) {
        EXPECT_GE(f.scallop_min, 0.02 * 0.98);
      }
    }
    EXPECT_LE(highest(job, cycle::Along::u, [](Point3) { return false; }), 0.02 * 1.02) << degrees;
  }
}

TEST(CycleJob, ScallopInAndNextToAValley) {
  for (const cycle::Along along : {cycle::Along::u, cycle::Along::v})
    for (const double degrees : {3.0, 30.0, 90.0}) {
      const double half = 0.5 * degrees * geom::kPi / 180;
      const std::vector<NurbsSurface> two = creased(-std::tan(half));
      job::CycleOptions options;
      options.along = along;
      const job::CycleJob job =
          make(program({block(10, two[0]), block(20, two[1])}, nc::PathMethod::iso_scallop), options);
      ASSERT_EQ(job.surfaces_out, 1u);
      for (const cycle::PassFigures& f : job.runs[0].plan.figures) {
        EXPECT_LE(f.scallop_max, 0.02 * 1.02);
        if (!f.last) {
          EXPECT_GE(f.scallop_min, 0.02 * 0.98) << degrees;
        }
      }
      // Nearer to the valley no ball of this radius touches a flank; curved flanks move the place a little.
      const double fillet = 3 * std::sin(half) + 0.05 + 0.1 * std::sin(half) * 9;
      EXPECT_LE(highest(job, along, [&](Point3 p) { return std::abs(p.y) < fillet; }), 0.02 * 1.02)
          << degrees;
      // Nothing runs to and fro: little more than passes at the step of a plane.
      const double area = 15 * 20 / std::cos(half), step = std::sqrt(8 * 3 * 0.02);
      EXPECT_LT(job.cut_mm, 1.35 * area / step) << degrees;
      // A ball rests in the valley, R (1 / cos - 1) above it, where the middle of the crease is (7.5,
      // 0, 5.1875).
      double lowest = 1e9;
      for (const verify::TipPass& pass : tips_of(job.runs[0], 0))
        for (const auto& tips : pass.stretches)
          for (const Point3 p : tips)
            if (std::hypot(p.x - 7.5, p.y) < 0.5) lowest = std::min(lowest, p.z);
      EXPECT_NEAR(lowest, 5 + 3 * (1 / std::cos(half) - 1), 0.05) << degrees;
    }
}

TEST(CycleJob, CutPatchesGiveTheSamePathAsTheWhole) {
  std::mt19937 random(4);
  const NurbsSurface whole = bumpy(random);
  std::vector<nc::SurfaceBlock> blocks;
  int number = 10;
  for (const geom::Interval v : {geom::Interval{0, 0.4}, geom::Interval{0.4, 1}})
    for (const geom::Interval u : {geom::Interval{0, 0.3}, geom::Interval{0.3, 0.8}, geom::Interval{0.8, 1}})
      blocks.push_back(block(number += 10, geom::sub_surface(whole, u, v)));
  blocks[1].surface = geom::reversed(blocks[1].surface, geom::Direction::u);
  blocks[4].surface = geom::swapped(blocks[4].surface);
  std::swap(blocks[2].surface, blocks[5].surface);
  const job::CycleJob pieces = make(program(blocks, nc::PathMethod::iso_parametric));
  const job::CycleJob one = make(program({block(10, whole)}, nc::PathMethod::iso_parametric));
  ASSERT_EQ(pieces.surfaces_out, 1u);
  // The same surface up to where its parameters run: nearly the same number of passes and the same length
  // (the pieces' knots and so their steps of constant parameter are the same lines).
  EXPECT_NEAR(double(pieces.paths), double(one.paths), 1 + 0.02 * double(one.paths));
  EXPECT_NEAR(pieces.cut_mm, one.cut_mm, 0.03 * one.cut_mm);
}

TEST(CycleJob, MovesWithThePart) {
  std::mt19937 random(9);
  const NurbsSurface s = bumpy(random);
  const Vec3 by{100, -50, 8};
  const job::CycleJob a = make(program({block(10, s)}, nc::PathMethod::iso_scallop, 30));
  const job::CycleJob b =
      make(program({block(10, geom::translated(s, by))}, nc::PathMethod::iso_scallop, 38));
  ASSERT_EQ(a.paths, b.paths);
  EXPECT_NEAR(a.cut_mm, b.cut_mm, 1e-4 * a.cut_mm);
  const auto last_cut = [](const job::CycleJob& job) {
    Point3 p;
    for (const cycle::Motion& m : job.runs[0].plan.motions)
      if (m.kind == cycle::MotionKind::cut) p = m.path.end();
    return p;
  };
  EXPECT_LT(distance(last_cut(a) + by, last_cut(b)), 1e-5);
}

TEST(CycleJob, NcReadsBackAsTheSamePath) {
  std::mt19937 random(31);
  const job::CycleJob job = make(program({block(10, bumpy(random))}, nc::PathMethod::iso_parametric));
  Diagnostics diagnostics;
  ASSERT_TRUE(cl::validate(job.cl).ok()) << cl::validate(job.cl).error().to_string();
  for (const char* name : {"linuxcnc", "fanuc", "grbl"}) {
    const auto dialect = post::find_dialect(name);
    auto nc = post::emit(job.cl, *dialect, {.write_z = true}, diagnostics);
    ASSERT_TRUE(nc.ok()) << nc.error().to_string();
    auto back = nc::interpret(nc->text, {}, diagnostics);
    ASSERT_TRUE(back.ok()) << name << ": " << back.error().to_string();
    EXPECT_NEAR(cl::totals(*back).feed_mm, cl::totals(job.cl).feed_mm, 1e-3 * cl::totals(job.cl).feed_mm);
  }
  const auto text = cl::write_apt(job.cl);
  auto again = cl::read_apt(text, {}, diagnostics);
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(again->move_count(), job.cl.move_count());
}

TEST(CycleJob, StretchesFollowEachOther) {
  std::mt19937 random(12);
  const job::CycleJob job =
      make(program({block(10, bumpy(random)), block(20, geom::translated(bumpy(random), {60, 0, 0}))},
                   nc::PathMethod::iso_scallop));
  ASSERT_GT(job.stretches.size(), 10u);
  Point3 at = job.program.start;
  for (const servo::Stretch& s : job.stretches) {
    EXPECT_LT(distance(at, s.path.start()), 1e-9);
    at = s.path.end();
    // Rapids stay at or above the highest tip except straight down onto the safety height.
    if (s.feed_mm_min == 0) {
      EXPECT_GE(std::max(s.path.start().z, s.path.end().z), 29.999);
    }
  }
}

TEST(CycleJob, SetpointsKeepTheLimits) {
  std::mt19937 random(17);
  Diagnostics diagnostics;
  for (int i = 0; i < 3; ++i) {
    const job::CycleJob job = make(program({block(10, bumpy(random, 3.0))}, nc::PathMethod::iso_parametric));
    servo::Limits limits;
    limits.accel_mm_s2 = 1000.0 * (i + 1);
    auto plan = servo::plan(job.stretches, limits, diagnostics);
    ASSERT_TRUE(plan.ok()) << plan.error().to_string();
    const std::vector<servo::Setpoint> s = servo::run(*plan);
    const double t = limits.period_s;
    double accel = 0, jerk = 0;
    const auto axis = [&](std::size_t k, int a) { return a == 0 ? s[k].x : a == 1 ? s[k].y : s[k].z; };
    for (int a = 0; a < 3; ++a)
      for (std::size_t k = 3; k < s.size(); ++k) {
        accel = std::max(accel, std::abs(axis(k, a) - 2 * axis(k - 1, a) + axis(k - 2, a)) / (t * t));
        jerk =
            std::max(jerk, std::abs(axis(k, a) - 3 * axis(k - 1, a) + 3 * axis(k - 2, a) - axis(k - 3, a)) /
                               (t * t * t));
      }
    EXPECT_LE(accel, limits.accel_mm_s2 * (1 + 1e-9));
    EXPECT_LE(jerk,
              limits.jerk_mm_s3 * (1 + 1e-6) + 1);  // 1: rounding of coordinates near 100 mm, 8 eps / T^3
    EXPECT_LT(distance(Point3{s.back().x, s.back().y, s.back().z}, job.stretches.back().path.end()), 1e-9);
    const servo::Quality q = servo::measure(*plan, s);
    EXPECT_NEAR(q.accel_max_mm_s2, accel, 1e-6 * accel);
    EXPECT_NEAR(q.jerk_max_mm_s3, jerk, 1e-6 * jerk);
    EXPECT_LE(q.chord_error_max_mm, limits.chord_error_mm);
    EXPECT_LT(q.feed_fluctuation_max, 1e-4);
  }
}

TEST(CycleJob, RepeatsTakeTheirOwnWayThere) {
  const job::CycleJob job = make(
      "%\nG21;\nG90 G00 X-50. Y0. Z30.;\nG106.1 W25.;\nN10 G06.23 U2 V2 P2 Q2 D6. L0. F1200. S0.05;\n"
      "X0. Y0. Z0. W1.;\nX10. Y0. Z0. W1.;\nX0. Y5. Z0. W1.;\nX10. Y5. Z0. W1.;\n"
      "G91 X20.;\nX20.;\nG80;\nM30;\n%\n");
  ASSERT_EQ(job.runs.size(), 3u);
  for (const job::CycleRun& run : job.runs) {
    double rapid = 0;
    for (const cycle::Motion& m : run.plan.motions)
      if (m.kind == cycle::MotionKind::rapid) rapid += geom::length(m.path);
    EXPECT_NEAR(run.plan.rapid_mm, rapid, 1e-9);
  }
}

TEST(CycleJob, APartBeyondTheControlIsRefusedBeforeItIsPlanned) {
  std::mt19937 random(5);
  NurbsSurface far = bumpy(random);
  for (geom::HPoint& h : far.points) h.x += 1e6 * h.w;
  const std::string text = program({block(1, std::move(far))}, nc::PathMethod::iso_parametric);
  job::CycleOptions options;
  options.coordinate_limit_mm = 99999;
  Diagnostics diagnostics;
  const auto job = job::make_cycle_job(text, options, diagnostics, nullptr);
  ASSERT_FALSE(job.ok());
  EXPECT_EQ(job.error().code, ErrorCode::range);
  EXPECT_NE(job.error().message.find("99999"), std::string::npos) << job.error().message;
  // Without a limit it is planned.
  options.coordinate_limit_mm = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(job::make_cycle_job(text, options, diagnostics, nullptr).ok());
}

TEST(CycleJob, SameBytesEveryTime) {
  std::mt19937 random(2);
  const std::string mm = program({block(10, bumpy(random))}, nc::PathMethod::iso_parametric);
  const job::CycleJob a = make(mm), b = make(mm);
  EXPECT_EQ(cl::write_apt(a.cl), cl::write_apt(b.cl));
}

}  // namespace
}  // namespace burin
