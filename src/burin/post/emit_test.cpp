// SPDX-License-Identifier: Apache-2.0
// Properties of the way out and back: what a control (our own reader, and a model of GRBL's) makes of the
// text is the program within the decimals.
#include "burin/post/emit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <sstream>

#include "burin/base/text.h"
#include "burin/nc/program.h"

namespace burin::post {
namespace {

using geom::kPi;
using geom::Point3;
using geom::Vec3;

Dialect dialect(const std::string& name) {
  auto found = find_dialect(name);
  EXPECT_TRUE(found) << found.error().to_string();
  return *found;
}

double unit_of(const Dialect& d) {
  return std::pow(10.0, -d.decimals);
}

NcText emitted(const cl::Program& program, const Dialect& d, bool z = false) {
  Diagnostics diagnostics;
  auto nc = emit(program, d, {.write_z = z}, diagnostics);
  EXPECT_TRUE(nc) << nc.error().to_string();
  return nc ? *nc : NcText{};
}

cl::Program read_back(const std::string& text, bool beam, double watts_per_s = 1) {
  Diagnostics diagnostics;
  auto program =
      nc::interpret(text, {.file_name = "out.nc", .beam = beam, .watts_per_s = watts_per_s}, diagnostics);
  EXPECT_TRUE(program) << program.error().to_string() << "\n" << text;
  return program ? *program : cl::Program{};
}

// --- random programs
// ----------------------------------------------------------------------------------------------

struct Random {
  std::mt19937_64 engine;
  explicit Random(std::uint64_t seed) : engine(seed) {}
  double in(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(engine); }
  double log_in(double lo, double hi) { return std::exp(in(std::log(lo), std::log(hi))); }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine); }
};

double random_sweep(Random& r) {
  switch (r.below(6)) {
    case 0:
      return r.log_in(1e-7, 1e-2);  // hardly an arc
    case 1:
      return 2 * kPi - r.log_in(1e-9, 1e-2);  // nearly a circle
    case 2:
      return 2 * kPi;
    case 3:
      return kPi;
    default:
      return r.in(0.01, 2 * kPi - 0.01);
  }
}

Vec3 rotated(Vec3 v, Vec3 n, double angle) {
  return std::cos(angle) * v + std::sin(angle) * cross(n, v) + (1 - std::cos(angle)) * dot(n, v) * n;
}

/// An arc from `start` of any size, also ones no grid can hold.
cl::Arc random_arc(Random& r, const Point3& start, bool space) {
  while (true) {
    const int axis = space ? r.below(3) : 2;
    const double sign = r.below(2) ? 1 : -1;
    const Vec3 normal = axis == 0 ? Vec3{sign, 0, 0} : axis == 1 ? Vec3{0, sign, 0} : Vec3{0, 0, sign};
    const Vec3 side = axis == 0 ? Vec3{0, 1, 0} : axis == 1 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
    const double radius = r.log_in(1e-4, 3e4), sweep = random_sweep(r);
    const Vec3 out = radius * rotated(side, normal, r.in(0, 2 * kPi));
    cl::Arc arc{.center = start - out, .normal = normal, .radius = radius};
    arc.to.tip = sweep == 2 * kPi ? start : arc.center + rotated(out, normal, sweep);
    if (space && r.below(2)) arc.to.tip = arc.to.tip + r.in(-5, 5) * normal;
    const Vec3 size = arc.to.tip - Point3{};
    if (norm(size) < 2000) return arc;
  }
}

cl::Program random_program(Random& r, bool space, bool beam) {
  cl::Program p;
  p.name = "random";
  Point3 at{r.in(-100, 100), r.in(-100, 100), space ? r.in(-50, 50) : 0.0};
  p.add(cl::Rapid{{at}});
  p.add(cl::FeedRate{r.in(1, 20000)});
  for (int i = 0; i < 30; ++i) {
    const auto near = [&](double size) {
      return Point3{at.x + r.in(-size, size), at.y + r.in(-size, size),
                    space ? at.z + r.in(-size, size) : at.z};
    };
    switch (r.below(9)) {
      case 0:
        p.add(cl::Rapid{{at = near(200)}});
        break;
      case 1:
        p.add(cl::Feed{{at = near(50)}});
        break;
      case 2:
        p.add(cl::Feed{{at = near(r.log_in(1e-6, 1e-2))}});
        break;
      case 3:
        p.add(cl::FeedRate{r.in(1, 20000)});
        break;
      case 4:
        if (beam) {
          p.add(r.below(2) ? cl::Beam{true, r.in(1, 3000)} : cl::Beam{});
        } else {
          p.add(r.below(2)
                    ? cl::Spindle{r.below(2) ? cl::Rotation::clockwise : cl::Rotation::counter_clockwise,
                                  r.in(1, 30000)}
                    : cl::Spindle{});
        }
        break;
      case 5:
        p.add(cl::Dwell{r.in(0, 10)});
        break;
      default: {
        const cl::Arc arc = random_arc(r, at, space);
        at = arc.to.tip;
        p.add(arc);
      }
    }
  }
  return p;
}

// --- what the reader found, set against the program
// -----------------------------------------------------------------

double length_of(const cl::Record& record, const Point3& from) {
  if (const auto* arc = std::get_if<cl::Arc>(&record)) return cl::arc_length(from, *arc);
  return distance(from, cl::pose_of(record)->tip);
}

Point3 point_on(const cl::Record& record, const Point3& from, double t) {
  const auto* arc = std::get_if<cl::Arc>(&record);
  const Point3 to = cl::pose_of(record)->tip;
  if (!arc) return from + t * (to - from);
  const Vec3 out = from - arc->center, flat = out - dot(out, arc->normal) * arc->normal;
  const Point3 hub = from - flat;
  const double rise = dot(to - from, arc->normal);
  return hub + rotated(flat, arc->normal, t * cl::arc_sweep(from, *arc)) + t * rise * arc->normal;
}

std::string describe(const cl::Record& record, const Point3& from) {
  const auto* arc = std::get_if<cl::Arc>(&record);
  if (!arc) return " line";
  return " arc of radius " + format_shortest(arc->radius) + " sweep " + format_shortest(cl::arc_sweep(from, *arc)) +
         " rise " + format_shortest(dot(arc->to.tip - from, arc->normal));
}

struct State {
  double feed = 0;
  cl::Beam beam;
  cl::Spindle spindle;
  double dwell = 0;
  void take(const cl::Record& record) {
    if (const auto* f = std::get_if<cl::FeedRate>(&record)) feed = f->mm_min;
    if (const auto* b = std::get_if<cl::Beam>(&record)) beam = *b;
    if (const auto* s = std::get_if<cl::Spindle>(&record)) spindle = *s;
    if (const auto* d = std::get_if<cl::Dwell>(&record)) dwell += d->seconds;
  }
};

/// The distance of a point from an arc or line, mm.
double off(const cl::Record& record, const Point3& from, const Point3& p) {
  double best = 1e300;
  if (const auto* arc = std::get_if<cl::Arc>(&record)) {
    // The nearest place by angle and, on a helix, by height (a steep one turns hardly while it climbs); the ends besides.
    const Vec3 out = from - arc->center, flat = out - dot(out, arc->normal) * arc->normal;
    const Vec3 to_p = p - (from - flat);
    double angle = std::atan2(dot(cross(flat, to_p), arc->normal), dot(flat, to_p));
    if (angle < 0) angle += 2 * kPi;
    const double rise = dot(arc->to.tip - from, arc->normal);
    const double by_height = std::abs(rise) > 1e-3 ? std::clamp(dot(p - from, arc->normal) / rise, 0.0, 1.0) : 0.0;
    for (double t : {0.0, 1.0, std::min(angle / cl::arc_sweep(from, *arc), 1.0), by_height})
      best = std::min(best, distance(p, point_on(record, from, t)));
    return best;
  }
  const Vec3 way = cl::pose_of(record)->tip - from;
  const double t = norm(way) > 0 ? std::clamp(dot(p - from, way) / dot(way, way), 0.0, 1.0) : 0.0;
  return distance(p, from + t * way);
}

void expect_same(const cl::Program& program, const NcText& nc, const cl::Program& back, const Dialect& d) {
  const double unit = unit_of(d);
  // Motions that were read, by the record they came from.
  std::map<std::size_t, std::vector<std::size_t>> pieces;
  std::vector<State> state_at(back.records.size());
  State state;
  for (std::size_t i = 0; i < back.records.size(); ++i) {
    state.take(back.records[i]);
    state_at[i] = state;
    if (!cl::is_motion(back.records[i])) continue;
    const std::uint32_t record = nc.line_to_record.at(back.source[i] - 1);
    ASSERT_NE(record, NcText::kNoRecord);
    pieces[record].push_back(i);
  }
  State wanted;
  std::optional<Point3> at, read_at;
  for (std::size_t i = 0; i < program.records.size(); ++i) {
    const cl::Record& record = program.records[i];
    wanted.take(record);
    const cl::Pose* pose = cl::pose_of(record);
    if (!pose) continue;
    const double length = at ? length_of(record, *at) : 0;
    double read_length = 0;
    for (const std::size_t piece : pieces[i]) {
      const cl::Record& read = back.records[piece];
      ASSERT_EQ(std::holds_alternative<cl::Rapid>(record), std::holds_alternative<cl::Rapid>(read));
      if (!std::holds_alternative<cl::Rapid>(record)) {
        EXPECT_NEAR(state_at[piece].feed, wanted.feed, 0.5001 * std::pow(10.0, -d.feed_decimals));
      }
      EXPECT_EQ(state_at[piece].beam.on, wanted.beam.on);
      EXPECT_NEAR(state_at[piece].beam.power_w, wanted.beam.power_w,
                  0.5001 * std::pow(10.0, -d.power_decimals));
      EXPECT_EQ(state_at[piece].spindle.rotation, wanted.spindle.rotation);
      EXPECT_NEAR(state_at[piece].spindle.rpm, wanted.spindle.rpm,
                  0.5001 * std::pow(10.0, -d.power_decimals));
      if (read_at && at) {
        read_length += length_of(read, *read_at);
        for (double t : {0.0, 0.1, 0.25, 0.5, 0.6, 0.9, 1.0}) {
          const Point3 p = point_on(read, *read_at, t);
          // Ends round by 0.87 steps in space; 1.5 steps are what round_arc takes for the rest of an arc.
          ASSERT_LE(off(record, *at, p), 2.4 * unit) << "record " << i << describe(record, *at) << "\n" << nc.text;
        }
      }
      read_at = cl::pose_of(read)->tip;
    }
    ASSERT_TRUE(read_at);
    // The end is always the rounded end, whether the move vanished or not.
    EXPECT_LE(std::abs(read_at->x - pose->tip.x), 0.5001 * unit);
    EXPECT_LE(std::abs(read_at->y - pose->tip.y), 0.5001 * unit);
    EXPECT_LE(std::abs(read_at->z - pose->tip.z), 0.5001 * unit);
    // A wrong way round, or a circle out of nothing, shows in the length.
    if (at) {
      const double pieces_slack = 2.0 * static_cast<double>(pieces[i].size());
      ASSERT_NEAR(read_length, length, (10 + pieces_slack) * unit + 1e-9 * length) << "record " << i << describe(record, *at) << "\n"
                                                                                   << nc.text;
    }
    at = pose->tip;
  }
  EXPECT_NEAR(state.dwell, wanted.dwell, 0.02);
  EXPECT_EQ(state.beam.on, false);  // the footer
}

std::size_t g_split, g_lines, g_moves;
class EveryDialect : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Emit, EveryDialect, testing::Values("linuxcnc", "grbl", "fanuc"),
                         [](const auto& test_case) { return std::string(test_case.param); });

TEST_P(EveryDialect, ReadsBackAsTheProgramInThePlane) {
  Random random(11);
  const Dialect d = dialect(GetParam());
  for (int i = 0; i < 400 && !HasFatalFailure(); ++i) {
    const cl::Program program = random_program(random, false, true);
    const NcText nc = emitted(program, d);
    g_split+=nc.arcs_split; g_lines+=nc.arcs_as_lines; g_moves+=nc.moves;
    expect_same(program, nc, read_back(nc.text, true), d);
  }
  printf("%zu %zu %zu\n", g_split, g_lines, g_moves);
}

TEST_P(EveryDialect, ReadsBackAsTheProgramInSpace) {
  Random random(12);
  const Dialect d = dialect(GetParam());
  for (int i = 0; i < 400 && !HasFatalFailure(); ++i) {
    const cl::Program program = random_program(random, true, false);
    const NcText nc = emitted(program, d, true);
    expect_same(program, nc, read_back(nc.text, false), d);
  }
}

}  // namespace
}  // namespace burin::post
