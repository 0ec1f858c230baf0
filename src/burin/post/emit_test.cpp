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
    // Huge circles would measure only how many lines a control without large radii needs.
    if (norm(size) < 2000 && radius * std::min(sweep, 2.0) < 4000) return arc;
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
  return " arc of radius " + format_shortest(arc->radius) + " sweep " +
         format_shortest(cl::arc_sweep(from, *arc)) + " rise " +
         format_shortest(dot(arc->to.tip - from, arc->normal));
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
    // The nearest place by angle and, on a helix, by height (a steep one turns hardly while it climbs); the
    // ends besides.
    const Vec3 out = from - arc->center, flat = out - dot(out, arc->normal) * arc->normal;
    const Vec3 to_p = p - (from - flat);
    double angle = std::atan2(dot(cross(flat, to_p), arc->normal), dot(flat, to_p));
    if (angle < 0) angle += 2 * kPi;
    const double rise = dot(arc->to.tip - from, arc->normal);
    const double by_height =
        std::abs(rise) > 1e-3 ? std::clamp(dot(p - from, arc->normal) / rise, 0.0, 1.0) : 0.0;
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
          ASSERT_LE(off(record, *at, p), 2.4 * unit) << "record " << i << describe(record, *at) << "\n"
                                                     << nc.text;
        }
      }
      read_at = cl::pose_of(read)->tip;
    }
    ASSERT_TRUE(read_at);
    // The end is always the rounded end, whether the move vanished or not.
    EXPECT_LE(std::abs(read_at->x - pose->tip.x), 0.5001 * unit + cl::kSamePoint_mm);
    EXPECT_LE(std::abs(read_at->y - pose->tip.y), 0.5001 * unit + cl::kSamePoint_mm);
    EXPECT_LE(std::abs(read_at->z - pose->tip.z), 0.5001 * unit + cl::kSamePoint_mm);
    // A wrong way round, or a circle out of nothing, shows in the length.
    if (at) {
      const double pieces_slack = 2.0 * static_cast<double>(pieces[i].size());
      ASSERT_NEAR(read_length, length, (10 + pieces_slack) * unit + 1e-9 * length)
          << "record " << i << describe(record, *at) << "\n"
          << nc.text;
    }
    at = pose->tip;
  }
  EXPECT_NEAR(state.dwell, wanted.dwell, 0.02);
  EXPECT_EQ(state.beam.on, false);  // the footer
}

class EveryDialect : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Emit, EveryDialect, testing::Values("linuxcnc", "grbl", "fanuc"),
                         [](const auto& test_case) { return std::string(test_case.param); });

TEST_P(EveryDialect, ReadsBackAsTheProgramInThePlane) {
  Random random(11);
  const Dialect d = dialect(GetParam());
  for (int i = 0; i < 250 && !HasFatalFailure(); ++i) {
    const cl::Program program = random_program(random, false, true);
    const NcText nc = emitted(program, d);
    expect_same(program, nc, read_back(nc.text, true), d);
  }
}

TEST_P(EveryDialect, ReadsBackAsTheProgramInSpace) {
  Random random(12);
  const Dialect d = dialect(GetParam());
  for (int i = 0; i < 250 && !HasFatalFailure(); ++i) {
    const cl::Program program = random_program(random, true, false);
    const NcText nc = emitted(program, d, true);
    expect_same(program, nc, read_back(nc.text, false), d);
  }
}

// --- a model of GRBL 1.1 (gcode.c, motion_control.c): single precision, error 33, and the sweep it runs
// --------------

struct GrblModel {
  float x = 0, y = 0;
  int motion = 0;

  /// What the control answers to one line: "" or the reason of an error. `sweep` of an arc.
  std::string run(const std::string& line, double& sweep) {
    if (line.size() > 80) return "line overflow";
    sweep = 0;
    if (line.find_first_of("?!~") != std::string::npos) return "real-time command in the stream";
    if (line[0] == '(') return "";
    std::map<char, float> words;
    std::istringstream in(line);
    for (std::string word; in >> word;) {
      if (word.find_first_of("eE") != std::string::npos) return "exponent";
      const float value = std::stof(word.substr(1));
      if (word[0] == 'G') {
        if (value <= 3) motion = static_cast<int>(value);
        if (value == 4) return "";
      } else {
        if (words.contains(word[0])) return "repeated word";
        words[word[0]] = value;
      }
    }
    const bool axes = words.contains('X') || words.contains('Y');
    const bool offsets = words.contains('I') || words.contains('J');
    const float to_x = words.contains('X') ? words['X'] : x, to_y = words.contains('Y') ? words['Y'] : y;
    if (motion >= 2 && (axes || offsets)) {
      if (!axes) return "no axis words in plane";
      if (!offsets) return "no offsets in plane";
      const float i = words['I'], j = words['J'];
      const float rx = to_x - x - i, ry = to_y - y - j;
      const float target_r = std::hypot(rx, ry), r = std::hypot(i, j), delta = std::abs(target_r - r);
      if (delta > 0.005f && (delta > 0.5f || delta > 0.001f * r)) return "error 33: invalid target";
      float angle = std::atan2(-i * ry + j * rx, -i * rx - j * ry);
      constexpr float kEpsilon = 5e-7f;
      constexpr auto kTurn = static_cast<float>(2 * kPi);
      if (motion == 2) {
        if (angle >= -kEpsilon) angle -= kTurn;
      } else if (angle <= kEpsilon) {
        angle += kTurn;
      }
      sweep = std::abs(angle);
    } else if (offsets) {
      return "unused words";
    }
    x = to_x;
    y = to_y;
    return "";
  }
};

TEST(Grbl, TheModelRejectsWhatTheControlRejects) {
  double sweep = 0;
  EXPECT_NE((GrblModel{0, 0, 1}.run("G2 X10 Y0 I5.1 J0", sweep)), "");  // 4.9 against 5.1
  EXPECT_NE((GrblModel{0, 0, 1}.run("G2 X1 Y0 I0.51 J0", sweep)), "");
  EXPECT_EQ((GrblModel{0, 0, 1}.run("G2 X10 Y0 I5 J0", sweep)), "");
  EXPECT_NEAR(sweep, kPi, 1e-5);
  EXPECT_NE((GrblModel{0, 0, 1}.run("G2 I5 J0", sweep)), "");
  EXPECT_EQ((GrblModel{0, 0, 1}.run("G3 X0 Y0 I5 J0", sweep)), "");
  EXPECT_NEAR(sweep, 2 * kPi, 1e-5);
}

TEST(Grbl, AcceptsEveryLineAndTurnsAsFarAsWeRead) {
  Random random(13);
  const Dialect d = dialect("grbl");
  std::size_t arcs = 0;
  for (int i = 0; i < 500; ++i) {
    const cl::Program program = random_program(random, false, true);
    const NcText nc = emitted(program, d);
    const cl::Program back = read_back(nc.text, true);
    std::map<std::uint32_t, std::pair<double, double>> sweeps;  // line -> sweep, radius
    Point3 at;
    for (std::size_t k = 0; k < back.records.size(); ++k) {
      if (const auto* arc = std::get_if<cl::Arc>(&back.records[k]))
        sweeps[back.source[k]] = {cl::arc_sweep(at, *arc), arc->radius};
      if (const cl::Pose* pose = cl::pose_of(back.records[k])) at = pose->tip;
    }
    GrblModel control;
    std::istringstream lines(nc.text);
    std::uint32_t number = 0;
    for (std::string line; std::getline(lines, line);) {
      double sweep = 0;
      ASSERT_EQ(control.run(line, sweep), "") << line << "\n" << nc.text;
      ++number;
      if (!sweeps.contains(number)) {
        ASSERT_EQ(sweep, 0) << line;
        continue;
      }
      ++arcs;
      const auto [ours, radius] = sweeps[number];
      // Floats place the ends of the arc within 0.004 mm at coordinates up to some 10,000 mm.
      ASSERT_LE(std::abs(sweep - ours) * radius, 0.01 + 1e-5 * radius) << line;
    }
  }
  EXPECT_GT(arcs, 2000u);
}

// --- single traps
// ---------------------------------------------------------------------------------------------------

cl::Program one_arc(const Point3& start, const cl::Arc& arc) {
  cl::Program p;
  p.add(cl::Rapid{{start}});
  p.add(cl::FeedRate{1000});
  p.add(arc);
  return p;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Emit, AShortArcThatRoundsToNothingIsNoCircle) {
  // 0.0004 mm of an arc of radius 10: start and end round to the same place.
  const double a = 4e-5;
  const Point3 start{10, 0, 0}, end{10 * std::cos(a), 10 * std::sin(a), 0};
  const NcText nc =
      emitted(one_arc(start, {.center = {0, 0, 0}, .radius = 10, .to = {end}}), dialect("grbl"));
  EXPECT_FALSE(has(nc.text, "G3") || has(nc.text, "G2 ")) << nc.text;
  EXPECT_EQ(nc.vanished, 1u);
}

TEST(Emit, ACircleButForAHairStaysACircle) {
  for (const char* name : {"grbl", "linuxcnc", "fanuc"}) {
    for (double gap : {1e-9, 1e-6, 1e-5, 5e-5, 1e-4, 1e-3}) {
      const double a = -gap;
      const Point3 start{10, 0.00049, 0}, center{0, 0.00049, 0};
      const Point3 end{10 * std::cos(a), center.y + 10 * std::sin(a), 0};
      const cl::Program program = one_arc(start, {.center = center, .radius = 10, .to = {end}});
      const cl::Program back = read_back(emitted(program, dialect(name)).text, false);
      EXPECT_NEAR(cl::totals(back).feed_mm, 20 * kPi, 0.02) << name << " " << gap;
    }
  }
}

TEST(Emit, FullCirclesKeepOneBlock) {
  Random random(14);
  for (const char* name : {"grbl", "linuxcnc"}) {
    int split = 0;
    for (int i = 0; i < 1000; ++i) {
      const double r = random.log_in(0.5, 200), a = random.in(0, 2 * kPi);
      const Point3 center{random.in(-100, 100), random.in(-100, 100), 0};
      const Point3 start{center.x + r * std::cos(a), center.y + r * std::sin(a), 0};
      const NcText nc =
          emitted(one_arc(start, {.center = center, .radius = r, .to = {start}}), dialect(name));
      split += nc.moves > 2 ? 1 : 0;
    }
    EXPECT_LE(split, 50) << name;
  }
}

TEST(Emit, ModalWordsAreNotRepeated) {
  cl::Program p;
  p.add(cl::Rapid{{{1, 2, 0}}});
  p.add(cl::FeedRate{1500});
  p.add(cl::Beam{true, 100});
  p.add(cl::Feed{{{5, 2, 0}}});
  p.add(cl::FeedRate{1500});
  p.add(cl::Feed{{{5, 7.5, 0}}});
  p.add(cl::Beam{true, 100});
  p.add(cl::Arc{{5, 8.5, 0}, {0, 0, 1}, 1, {{5, 9.5, 0}}});
  p.add(cl::Beam{});
  const std::string text = emitted(p, dialect("linuxcnc")).text;
  EXPECT_TRUE(has(text, "G00 X1 Y2\nM3 S100\nG01 X5 F1500\nY7.5\nG03 X5 Y9.5 I0 J1\nM5\n")) << text;
  const std::string fanuc = emitted(p, dialect("fanuc")).text;
  EXPECT_TRUE(has(fanuc, "G00 X1. Y2.\nM3 S100\nG01 X5. F1500.\nY7.5\nG03 X5. Y9.5 I0. J1.\nM5\n")) << fanuc;
  EXPECT_TRUE(fanuc.starts_with("%\nO0001\n")) << fanuc;
  EXPECT_TRUE(fanuc.ends_with("M30\n%\n"));
  EXPECT_TRUE(has(emitted(p, dialect("grbl")).text, "M4 S100\nG1 X5 F1500\n"));
}

TEST(Emit, ABeamOfUnknownPowerGoesOnWithoutS) {
  cl::Program p;
  p.add(cl::Rapid{{{1, 2, 0}}});
  p.add(cl::FeedRate{1500});
  for (const double x : {5.0, 9.0}) {
    p.add(cl::Beam{true, 0});
    p.add(cl::Feed{{{x, 2, 0}}});
    p.add(cl::Beam{});
  }
  for (const auto& [name, word] : {std::pair{"linuxcnc", "M3\n"}, {"fanuc", "M3\n"}, {"grbl", "M4\n"}}) {
    Diagnostics diagnostics;
    const auto nc = emit(p, dialect(name), {}, diagnostics);
    ASSERT_TRUE(nc.ok());
    EXPECT_TRUE(has(nc->text, word)) << nc->text;
    EXPECT_FALSE(has(nc->text, "S0"));
    EXPECT_EQ(diagnostics.count("no_power"), 1u);
  }
}

TEST(Emit, TheLineMapNamesTheRecordOfEveryMotionLine) {
  Random random(15);
  const cl::Program program = random_program(random, false, true);
  const NcText nc = emitted(program, dialect("linuxcnc"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(nc.text.begin(), nc.text.end(), '\n')),
            nc.line_to_record.size());
  for (const std::uint32_t record : nc.line_to_record) {
    if (record != NcText::kNoRecord) {
      EXPECT_LT(record, program.records.size());
    }
  }
}

TEST(Emit, RefusesWhatAThreeAxisProgramCannotHold) {
  const auto refused = [](const cl::Record& record, ErrorCode code, bool z) {
    cl::Program p;
    p.add(cl::FeedRate{100});
    p.add(cl::Rapid{{{10, 0, 0}}});
    p.add(record);
    Diagnostics diagnostics;
    const auto nc = emit(p, dialect("linuxcnc"), {.write_z = z}, diagnostics);
    EXPECT_FALSE(nc);
    if (!nc) {
      EXPECT_EQ(nc.error().code, code) << nc.error().to_string();
    }
  };
  refused(cl::Feed{{{1, 1, 0}, {0, 0.6, 0.8}}}, ErrorCode::unsupported, true);
  refused(cl::Feed{{{1, 1, 1}}}, ErrorCode::unsupported, false);
  refused(cl::Feed{{{1e6, 1, 0}}}, ErrorCode::range, true);
  refused(cl::FeedRate{0.001}, ErrorCode::range, true);
  refused(cl::Arc{{0, 0, 0}, {0, 1, 0}, 10, {{-10, 0, 0}}}, ErrorCode::unsupported, false);
  refused(cl::Arc{{0, 0, 0}, {0, 0.6, 0.8}, 10, {{-10, 0, 0}}}, ErrorCode::unsupported, true);
  refused(cl::Arc{{0, 0, 0}, {0, 0, 1}, 9, {{-10, 0, 0}}}, ErrorCode::geometry, true);
}

TEST(Emit, CommentsCannotHarmTheControl) {
  cl::Program p;
  p.name = "a) M3 (b";
  p.add(cl::Comment{"what? stop! ~ (nested) \xc3\xbc " + std::string(300, 'x')});
  p.add(cl::Comment{"MSG, hello"});
  p.add(cl::Comment{"LOGOPEN,/etc/passwd"});
  p.add(cl::Rapid{{{1, 1, 0}}});
  for (const char* name : {"grbl", "linuxcnc", "fanuc"}) {
    const Dialect d = dialect(name);
    const std::string text = emitted(p, d).text;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(line.size(), d.line_limit);
      for (const char c : line)
        EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 && static_cast<unsigned char>(c) < 0x7f);
    }
    EXPECT_EQ(read_back(text, true).move_count(), 1u);
    EXPECT_FALSE(has(text, "(LOGOPEN") && d.name == "linuxcnc");
    EXPECT_FALSE(has(text, "!") && d.name == "grbl");
  }
}

TEST(Emit, TheToolLengthGoesWithTheFirstMoveAfterAToolChange) {
  cl::Program p;
  p.add(cl::ToolChange{3, 6, 0});
  p.add(cl::Spindle{cl::Rotation::clockwise, 5000});
  p.add(cl::Rapid{{{1, 2, 30}}});
  p.add(cl::Rapid{{{4, 2, 30}}});
  const std::string text = emitted(p, dialect("linuxcnc"), true).text;
  EXPECT_TRUE(has(text, "T3 M6\nM3 S5000\nG43 H3 G00 X1 Y2 Z30\nX4\n")) << text;
  Diagnostics diagnostics;
  ASSERT_TRUE(emit(p, dialect("grbl"), {.write_z = true}, diagnostics));
  EXPECT_TRUE(diagnostics.anything_left_out());
}

TEST(Emit, UnknownStatementsAreReportedOnceAWord) {
  cl::Program p;
  p.add(cl::Unknown{"INTOL/0.1"});
  p.add(cl::Unknown{"INTOL/0.2"});
  p.add(cl::Unknown{"STOP"});
  Diagnostics diagnostics;
  const auto nc = emit(p, dialect("linuxcnc"), {}, diagnostics);
  ASSERT_TRUE(nc);
  EXPECT_EQ(diagnostics.count("unknown_statement"), 1u);
  EXPECT_TRUE(has(nc->text, "\nM0\n"));
}

}  // namespace
}  // namespace burin::post
