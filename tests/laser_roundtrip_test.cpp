// SPDX-License-Identifier: Apache-2.0
// Across the seams on random drawings: plan -> CL -> APT text and back, plan -> NC of every dialect and back,
// and the cut that the control would make against the profile that was planned.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "burin/cl/apt.h"
#include "burin/job/verify_laser.h"
#include "burin/nc/program.h"
#include "burin/plan/laser/drawing_fixture.h"
#include "burin/plan/laser/laser.h"
#include "burin/plan/laser/toolpath_fixture.h"
#include "burin/post/emit.h"

namespace burin {
namespace {

using geom::Point2;
using geom::Segment;
using laser::LaserJob;
using laser::LaserOptions;
namespace fixture = laser::fixture;

constexpr std::uint64_t kParts = 30;

LaserOptions options_for(std::uint64_t seed) {
  fixture::Dice dice(seed + 77);
  LaserOptions o;
  o.offset_mm = dice.in(0.05, 0.4) * (dice.below(5) == 0 ? -1 : 1);
  o.feed_mm_min = 3000;
  o.power_w = 1500;
  o.corners.kind = static_cast<laser::Corners>(dice.below(4));
  o.lead.kind = static_cast<laser::LeadKind>(dice.below(3));
  o.lead.out_mm = dice.below(2) * 0.8;
  o.order = dice.below(2) == 0 ? laser::Order::file : laser::Order::inner_first;
  o.overcut_mm = dice.below(2) * 0.5;
  o.micro_joints.per_contour = dice.below(3);
  o.arcs = dice.below(4) != 0;
  if (dice.below(4) == 0) o.copies = {2, 2, 3.0};
  return o;
}

LaserOptions plain(std::uint64_t seed) {
  LaserOptions o = options_for(seed);
  o.corners.kind = laser::Corners::round;
  o.lead.kind = laser::LeadKind::none;
  o.lead.out_mm = 0;
  o.order = laser::Order::file;
  o.overcut_mm = 0;
  o.micro_joints.per_contour = 0;
  o.arcs = true;
  o.copies = {};
  return o;
}

LaserJob planned(std::uint64_t seed, const LaserOptions& o) {
  const fixture::Sketch s = fixture::random_part(seed, seed % 3 == 2);
  Diagnostics notes;
  auto job = laser::plan_laser(s.drawing, o, notes);
  EXPECT_TRUE(job) << job.error().to_string();
  return job ? std::move(*job) : LaserJob{};
}

double away(geom::Point3 a, geom::Point3 b) {
  return geom::distance(a, b);
}

/// Beam-on motions in the plane, cut where the beam goes off.
std::vector<std::vector<fixture::Step>> cuts(const cl::Program& program) {
  laser::Toolpath t;
  t.program = program;
  t.kind.assign(program.records.size(), laser::MoveKind::cut);
  std::vector<std::vector<fixture::Step>> all;
  bool open = false;
  for (const fixture::Step& s : fixture::walk(t)) {
    if (!s.beam || s.rapid) {
      open = false;
      continue;
    }
    if (!open) all.emplace_back();
    open = true;
    all.back().push_back(s);
  }
  return all;
}

/// As splines; a full circle in one motion becomes two arcs.
geom::ArcSpline spline_of(const std::vector<fixture::Step>& steps) {
  geom::ArcSpline out;
  for (const fixture::Step& step : steps) {
    const Segment& s = step.segment;
    if (s.is_line()) {
      if (!(s.a == s.b)) out.segments.push_back(s);
    } else if (geom::distance(s.a, s.b) < 1e-7) {
      const Point2 far = s.center + (s.center - s.a);
      out.segments.push_back(geom::make_arc(s.a, far, s.center, s.radius > 0));
      out.segments.push_back(geom::make_arc(far, s.b, s.center, s.radius > 0));
    } else {
      out.segments.push_back(s);
    }
  }
  return out;
}

/// The larger of how far each leaves the other, by samples.
double apart(const geom::ArcSpline& a, const geom::ArcSpline& b) {
  double worst = 0;
  for (int k = 0; k < 2; ++k) {
    for (const Segment& s : (k == 0 ? a : b).segments) {
      for (const double f : {0.0, 0.31, 0.5, 0.83, 1.0})
        worst = std::max(worst, geom::distance_to(k == 0 ? b : a, geom::point_on(s, f)));
    }
  }
  return worst;
}

TEST(LaserRoundTrip, PlansAreValidAndTheSameEveryTime) {
  for (std::uint64_t seed = 0; seed < kParts; ++seed) {
    SCOPED_TRACE(seed);
    const LaserJob a = planned(seed, options_for(seed)), b = planned(seed, options_for(seed));
    auto valid = cl::validate(a.toolpath.program);
    EXPECT_TRUE(valid) << valid.error().to_string();
    EXPECT_EQ(a.toolpath.program.records, b.toolpath.program.records);
    EXPECT_EQ(a.toolpath.program.source, b.toolpath.program.source);
    EXPECT_EQ(a.toolpath.machining_s, b.toolpath.machining_s);
    EXPECT_EQ(a.toolpath.kind.size(), a.toolpath.program.records.size());
  }
}

TEST(LaserRoundTrip, AptTextHoldsTheWholeProgram) {
  for (std::uint64_t seed = 0; seed < kParts; ++seed) {
    SCOPED_TRACE(seed);
    cl::Program p = planned(seed, options_for(seed)).toolpath.program;
    p.name = "PART " + std::to_string(seed);
    Diagnostics notes;
    auto back = cl::read_apt(cl::write_apt(p), {}, notes);
    ASSERT_TRUE(back) << back.error().to_string();
    EXPECT_TRUE(notes.empty()) << notes.warnings().front().message;
    EXPECT_EQ(back->name, p.name);
    ASSERT_EQ(back->records.size(), p.records.size());
    for (std::size_t i = 0; i < p.records.size(); ++i) {
      const cl::Record &x = p.records[i], &y = back->records[i];
      ASSERT_EQ(x.index(), y.index()) << "record " << i;
      if (const cl::Pose* pose = cl::pose_of(x)) {
        EXPECT_LE(away(pose->tip, cl::pose_of(y)->tip), 1e-6);
      }
      if (const auto* arc = std::get_if<cl::Arc>(&x)) {
        const auto& other = std::get<cl::Arc>(y);
        EXPECT_LE(away(arc->center, other.center), 1e-6);
        EXPECT_NEAR(arc->radius, other.radius, 1e-6);
        EXPECT_EQ(arc->normal.z > 0, other.normal.z > 0);
      }
      if (std::holds_alternative<cl::Beam>(x) || std::holds_alternative<cl::FeedRate>(x)) {
        EXPECT_TRUE(x == y) << "record " << i;
      }
    }
    EXPECT_TRUE(cl::validate(*back));
    EXPECT_EQ(cl::write_apt(*back), cl::write_apt(p));
  }
}

struct Read {
  post::NcText nc;
  cl::Program program;
};

Read through(const cl::Program& program, const post::Dialect& dialect) {
  Diagnostics notes;
  Read r;
  auto nc = post::emit(program, dialect, {}, notes);
  EXPECT_TRUE(nc) << nc.error().to_string();
  if (!nc) return r;
  r.nc = std::move(*nc);
  auto back = nc::interpret(r.nc.text, {.file_name = "out.ngc", .beam = true}, notes);
  EXPECT_TRUE(back) << back.error().to_string();
  if (back) r.program = std::move(*back);
  EXPECT_EQ(notes.warnings().size(), 0u) << notes.warnings().front().message;
  return r;
}

TEST(LaserRoundTrip, NcReadBackIsTheProgramWithinTheDecimals) {
  for (const std::string& name : post::dialect_names()) {
    const post::Dialect dialect = *post::find_dialect(name);
    const double unit = std::pow(10.0, -dialect.decimals);
    for (std::uint64_t seed = 0; seed < kParts; ++seed) {
      SCOPED_TRACE(name + " " + std::to_string(seed));
      const cl::Program program = planned(seed, options_for(seed)).toolpath.program;
      const Read r = through(program, dialect);
      const auto wanted = cuts(program), got = cuts(r.program);
      ASSERT_EQ(got.size(), wanted.size());
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        EXPECT_LE(apart(spline_of(wanted[i]), spline_of(got[i])), 2 * unit) << "cut " << i;
        EXPECT_NEAR(wanted[i].front().power, got[i].front().power, std::pow(10.0, -dialect.power_decimals));
        EXPECT_NEAR(wanted[i].front().feed, got[i].front().feed, std::pow(10.0, -dialect.feed_decimals));
        EXPECT_NEAR(wanted[i].back().feed, got[i].back().feed, std::pow(10.0, -dialect.feed_decimals));
      }
      if (r.nc.vanished + r.nc.arcs_split + r.nc.arcs_as_lines == 0) {
        EXPECT_EQ(r.program.move_count(), program.move_count());
      }
    }
  }
}

TEST(LaserRoundTrip, PlainNcHoldsExactlyThePathsOfTheProfile) {
  for (const std::string& name : post::dialect_names()) {
    const post::Dialect dialect = *post::find_dialect(name);
    const double unit = std::pow(10.0, -dialect.decimals);
    for (std::uint64_t seed = 0; seed < kParts; ++seed) {
      SCOPED_TRACE(name + " " + std::to_string(seed));
      const LaserJob job = planned(seed, plain(seed));
      const auto got = cuts(through(job.toolpath.program, dialect).program);
      ASSERT_EQ(got.size(), job.profile.paths.size());
      for (std::size_t i = 0; i < got.size(); ++i) {
        EXPECT_LE(apart(job.profile.paths[i].spline, spline_of(got[i])), 2 * unit) << "path " << i;
        EXPECT_LE(geom::distance(got[i].front().a(), got[i].back().b()), 1e-9)
            << "path " << i << " is not closed";
      }
    }
  }
}

/// What the whole is for: nowhere is the beam centre nearer to the drawn part than the offset, less the
/// tolerance and the decimals; measured on the outlines, not on anything the offset made.
TEST(LaserRoundTrip, TheCutIsAtTheOffsetFromTheOutlines) {
  for (std::uint64_t seed = 0; seed < kParts; ++seed) {
    SCOPED_TRACE(seed);
    const LaserOptions o = plain(seed);
    const LaserJob job = planned(seed, o);
    for (const auto& cut : cuts(through(job.toolpath.program, *post::find_dialect("grbl")).program)) {
      for (const Segment& s : spline_of(cut).segments) {
        for (const double f : {0.0, 0.2, 0.5, 0.7}) {
          EXPECT_NEAR(fixture::distance_to_outlines(job.profile, geom::point_on(s, f)), std::abs(o.offset_mm),
                      2e-3);
        }
      }
    }
  }
}

/// The end of it all: the part that the control would cut, held against the drawing by code that knows no
/// offset. Leads, loops, overcuts, chords and the decimals are in it.
TEST(LaserRoundTrip, ThePartIsWhatWasDrawn) {
  const std::vector<std::string> dialects = post::dialect_names();
  int clean = 0;
  for (std::uint64_t seed = 0; seed < kParts; ++seed) {
    SCOPED_TRACE(seed);
    LaserOptions o = options_for(seed);
    o.offset_mm = std::abs(o.offset_mm);
    o.copies = {};
    o.micro_joints.per_contour = 0;
    const fixture::Sketch sketch = fixture::random_part(seed, seed % 3 == 2);
    Diagnostics planning, reading;
    auto job = laser::plan_laser(sketch.drawing, o, planning);
    ASSERT_TRUE(job) << job.error().to_string();
    const post::Dialect dialect = *post::find_dialect(dialects[seed % dialects.size()]);
    const cl::Program program = through(job->toolpath.program, dialect).program;
    auto outlines = job::make_laser_outlines(sketch.drawing, {}, reading);
    ASSERT_TRUE(outlines) << outlines.error().to_string();
    verify::BeamCheckOptions checking;
    checking.kerf_mm = 2 * o.offset_mm;
    auto report = verify::check_beam(outlines->outlines, program, checking);
    ASSERT_TRUE(report) << report.error().to_string();
    EXPECT_LE(report->bound_mm, 0.001);
    // Leads may take the tolerance once more than the path (docs/laser-toolpath.md).
    const double unit = std::pow(10.0, -dialect.decimals);
    const double off = o.tolerance.path_mm + outlines->bound_mm + 2 * unit;
    const double leads = o.lead.kind == laser::LeadKind::none && o.corners.kind != laser::Corners::loop
                             ? 0
                             : o.tolerance.path_mm;
    EXPECT_LE(report->gouge.mm, off + leads);
    // Nothing is uncut but what the planner said it could not cut.
    const bool told = planning.anything_left_out();
    EXPECT_TRUE(told || report->uncut_mm == 0) << report->uncut_mm;
    if (planning.count("contour_vanished") + planning.count("contours_merged") > 0) {
      EXPECT_FALSE(report->uncut_outlines.empty());
    }
    if (!told) {
      EXPECT_LE(report->excess.mm, off);
      EXPECT_EQ(report->gouge_area_mm2 + report->excess_area_mm2, 0);
      ++clean;
    }
    // The beam on the wrong side takes a kerf, and leaves one.
    if (seed % 5 == 0 && !told) {
      o.offset_mm = -o.offset_mm;
      auto wrong = laser::plan_laser(sketch.drawing, o, planning);
      ASSERT_TRUE(wrong);
      auto bad = verify::check_beam(outlines->outlines, wrong->toolpath.program, checking);
      ASSERT_TRUE(bad);
      EXPECT_GT(bad->gouge.mm, checking.kerf_mm - 2 * off);
    }
  }
  EXPECT_GT(clean, static_cast<int>(kParts) / 3);
}

}  // namespace
}  // namespace burin
