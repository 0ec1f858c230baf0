// SPDX-License-Identifier: Apache-2.0
// Random rotational parts through the whole of burin rotary: plan, CL, joints, NC read back. What the machine
// would do is checked by verify/motion_check against points of the design itself. BURIN_CASES=200 runs more
// parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>

#include "burin/base/text.h"
#include "burin/job/rotary_job.h"
#include "burin/nc/program.h"
#include "burin/plan/rotary/rotary_cases.h"
#include "burin/post/emit.h"

namespace burin::job {
namespace {

using geom::kPi;
using geom::Point2;
using geom::Point3;
namespace cases = rotary::cases;

/// Of the tolerance: by what the check's straight pieces leave the motion.
constexpr double kMotionShare = 0.02;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double in(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(engine_()) / 4294967296.0; }
  int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }

 private:
  std::mt19937 engine_;
};

/// Slots about a disc, wider at the bottom than at the mouth when `wide` is above `half`.
geom::ArcSpline slotted(double radius, int slots, double half, double wide, double floor) {
  std::vector<cases::Corner> corners;
  for (int k = 0; k < slots; ++k) {
    const double a = 2 * kPi * k / slots, c = std::cos(a), s = std::sin(a);
    const auto add = [&](double x, double y) { corners.push_back({{x * c - y * s, x * s + y * c}, 0}); };
    const double middle = 0.5 * (radius + floor);
    add(radius, -half);
    if (wide > half) add(middle, -half), add(middle, -wide);
    add(floor, -wide), add(floor, wide);
    if (wide > half) add(middle, wide), add(middle, half);
    add(radius, half);
    // The disc between the slots.
    const double mouth = std::atan2(half, radius);
    for (int i = 1; i < 4; ++i) {
      const double at = a + mouth + (2 * kPi / slots - 2 * mouth) * i / 4;
      corners.push_back({{radius * std::cos(at), radius * std::sin(at)}, 0});
    }
  }
  return cases::rounded(corners);
}

geom::ArcSpline random_section(Random& r) {
  switch (r.below(7)) {
    case 0:
      return cases::ellipse(r.in(8, 14), r.in(5, 8));
    case 1:
      return cases::cam(r.in(7, 12), r.in(2, 4), r.in(3, 7));
    case 2:
      return cases::keyway(r.in(9, 14), r.in(2, 6), r.in(2, 4));
    case 3:
      return cases::cutter(4 + r.below(5), r.in(14, 20), r.in(8, 11), r.in(0.5, 2));
    case 4:
      return slotted(r.in(11, 15), 2 + r.below(3), r.in(1, 2.5), r.in(2.6, 4), r.in(6, 8));
    case 5: {  // teeth that lean over their gaps
      std::vector<Point2> corners;
      const int teeth = 4 + r.below(4);
      const double lean = geom::radians(r.in(4, 14)), gap = geom::radians(r.in(3, 10));
      for (int k = 0; k < teeth; ++k) {
        const double a = 2 * kPi * k / teeth;
        corners.push_back(cases::polar(16, a));
        corners.push_back(cases::polar(10, a - lean));
        corners.push_back(cases::polar(16, a + 2 * kPi / teeth - gap));
      }
      return cases::polygon(corners);
    }
    default: {
      std::vector<cases::Corner> corners;
      const int n = 4 + r.below(6);
      for (int i = 0; i < n; ++i)
        corners.push_back({cases::polar(r.in(8, 16), 2 * kPi * (i + r.in(0, 0.5)) / n),
                           r.below(2) == 0 ? 0.0 : r.in(0.2, 0.8)});
      return cases::rounded(corners);
    }
  }
}

rotary::SweptSection random_swept(Random& r) {
  rotary::SweptSection swept{random_section(r), {{0, 0}}};
  const double length = r.in(2, 5);
  if (r.below(3) == 0) swept.stations.push_back({r.in(0.3, 0.7) * length, r.in(-0.3, 0.3)});
  swept.stations.push_back({length, r.below(3) == 0 ? 0.0 : r.in(-0.5, 0.5)});
  return swept;
}

model::BallTool random_tool(Random& r) {
  model::BallTool tool;
  tool.radius = r.in(0.8, 3);
  const int kind = r.below(4);
  tool.shank_radius = tool.radius * (kind == 0 ? r.in(0.6, 0.95) : kind == 1 ? r.in(1.05, 1.5) : 1.0);
  tool.shank_length = r.in(8, 30);
  if (r.below(4) != 0) tool.holder = {{r.in(5, 15), r.in(10, 30)}};
  return tool;
}

struct Outcome {
  rotary::Part part;
  model::BallTool tool;
  rotary::RotaryOptions options;
  rotary::RotaryPlan plan;
  cl::Program cl;
  kinematics::JointPath joints;
};

const kinematics::Kinematics& machine() {
  static const kinematics::Kinematics k = *kinematics::Kinematics::make(*model::find_machine("xyza"));
  return k;
}

/// With tool and options given. Nothing when the part or the tool is refused for a reason.
std::optional<Outcome> plan_of(const rotary::SweptSection& swept, Outcome out) {
  rotary::PartOptions part_options;
  part_options.deflection_mm = kMeshShare * out.options.tolerance_mm;
  auto part = rotary::make_swept(swept, part_options);
  if (!part) return {};  // a section that crosses itself
  out.part = std::move(*part);
  Diagnostics diagnostics;
  auto plan = rotary::plan(out.part, out.tool, out.options, diagnostics);
  if (!plan) {
    EXPECT_TRUE(plan.error().code == ErrorCode::geometry) << plan.error().to_string();
    return {};
  }
  out.plan = std::move(*plan);
  out.cl = rotary::to_cl(out.plan, out.tool, out.options, "random");
  kinematics::JointPathOptions joints;
  joints.joint_linear = true;
  auto path = kinematics::make_joint_path(machine(), out.cl, joints);
  EXPECT_TRUE(path.ok()) << path.error().to_string();
  if (!path) return {};
  out.joints = std::move(*path);
  return out;
}

std::optional<Outcome> planned(unsigned seed) {
  Random r(seed);
  Outcome out;
  const rotary::SweptSection swept = random_swept(r);
  out.tool = random_tool(r);
  out.options.pattern = static_cast<rotary::Pattern>(r.below(3));
  out.options.scallop = r.in(0.05, 0.3);
  out.options.tolerance_mm = r.below(3) == 0 ? 0.03 : 0.01;
  return plan_of(swept, std::move(out));
}

/// What is left standing is said: within a ball's reach of a point that was moved, or is unreachable.
void expect_listed(const Outcome& out, const RotaryCheck& check) {
  // Cusps are those along normals; points see a few per cent more beside edges.
  const double fine = 1.05 * out.options.scallop + 2 * out.options.tolerance_mm + check.bound_mm;
  std::size_t unlisted = 0;
  for (std::size_t i = 0; i < check.design.samples.size(); ++i) {
    const verify::DesignSample& s = check.design.samples[i];
    if (!s.machined || check.report.deviation_mm[i] <= fine) continue;
    bool listed = false;
    for (const rotary::RotaryPoint& p : out.plan.points) {
      if (p.place.state == rotary::State::ok) continue;
      listed = listed || geom::distance(p.place.center, s.p) <
                             out.tool.radius + check.report.deviation_mm[i] + 2 * out.tool.radius;
      if (listed) break;
    }
    unlisted += listed ? 0 : 1;
    if (!listed && unlisted == 1)
      ADD_FAILURE() << "left standing and not said: " << check.report.deviation_mm[i] << " mm (scallop "
                    << out.options.scallop << ", pattern " << static_cast<int>(out.options.pattern) << ") at "
                    << s.p.x << " " << s.p.y << " " << s.p.z;
  }
}

std::vector<verify::CheckedMove> moves_of(const Outcome& out) {
  std::vector<verify::CheckedMove> moves;
  for (const kinematics::JointMove& move : out.joints.moves) moves.push_back({move.to, !move.rapid});
  return moves;
}

std::vector<verify::CheckedMove> moves_of_nc(const Outcome& out) {
  Diagnostics diagnostics;
  auto nc =
      post::emit_joints(out.cl, machine(), out.joints, *post::find_dialect("linuxcnc"), {}, diagnostics);
  EXPECT_TRUE(nc.ok()) << nc.error().to_string();
  nc::InterpretOptions options;
  options.machine = &machine();
  auto back = nc::interpret_joints(nc->text, options, diagnostics);
  EXPECT_TRUE(back.ok()) << back.error().to_string();
  std::vector<verify::CheckedMove> moves;
  std::size_t motion = 0;
  for (const cl::Record& record : back->program.records)
    if (cl::is_motion(record))
      moves.push_back({back->joints[motion++], !std::holds_alternative<cl::Rapid>(record)});
  return moves;
}

void expect_consistent(const Outcome& out) {
  for (const rotary::RotaryPoint& p : out.plan.points) {
    // (An unreachable point may have angles: then no way led there.)
    if (p.place.state == rotary::State::unreachable) continue;
    // Angles that were held while others moved are kept to 1e-9: at the end of an interval that may be
    // outside.
    ASSERT_LE(std::abs(rotary::nearest(p.reachable, p.theta) - p.theta), 1e-6)
        << "path " << p.path << " point " << p.index;
    const Point3 touch = p.place.contact.p + out.tool.radius * p.place.contact.n;
    ASSERT_LT(geom::distance(touch, p.place.center), 1e-3);
  }
  for (const rotary::Leg& leg : out.plan.legs)
    for (const std::size_t i : leg.points)
      ASSERT_NE(out.plan.points[i].place.state, rotary::State::unreachable);
}

TEST(RotaryJob, RandomPartsAreCutWithoutGouge) {
  const char* asked = std::getenv("BURIN_CASES");
  const int cases = asked ? static_cast<int>(parse_double(asked).value_or(0)) : 12;
  const char* first = std::getenv("BURIN_FIRST");
  const int start = first ? static_cast<int>(parse_double(first).value_or(0)) : 0;
  int done = 0, moved = 0, unreachable = 0;
  double worst = 0;  // share of the tolerance
  for (int seed = start; seed < start + cases; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    auto out = planned(static_cast<unsigned>(seed));
    if (!out) continue;
    ++done;
    expect_consistent(*out);
    for (const bool by_nc : {false, true}) {
      const RotaryCheck check =
          check_rotary_moves(out->part, out->tool, by_nc ? moves_of_nc(*out) : moves_of(*out), machine(),
                             out->options.tolerance_mm);
      // Half a decimal of X, Y and Z; of A at the part's radius.
      const double rounding = by_nc ? 0.5e-4 * (1.8 + geom::radians(out->part.radius_max)) : 0;
      // Samples are of the section itself: what is measured on them is there, but for the check's own pieces
      // of motion. (What lies between samples is bounded by check.bound_mm.)
      const double allowed = (1 + kMotionShare) * out->options.tolerance_mm + rounding;
      const auto say = [&](const verify::Finding& f, const char* what) {
        EXPECT_LE(f.mm, allowed) << what << (by_nc ? " by NC" : "") << " at " << f.at.x << " " << f.at.y
                                 << " " << f.at.z << " in move " << f.move;
      };
      say(check.report.ball, "ball");
      say(check.report.shank, "shank");
      say(check.report.holder, "holder");
      worst = std::max(worst, (check.report.gouge_max_mm() - rounding) / out->options.tolerance_mm);
      if (!by_nc) expect_listed(*out, check);
    }
    moved += out->plan.counts.moved > 0;
    unreachable += out->plan.counts.unreachable > 0;
    if (asked)
      std::printf("seed %d: %zu points, gouge so far %.3f of the tolerance\n", seed, out->plan.points.size(),
                  worst);
  }
  RecordProperty("worst_share_of_tolerance", std::to_string(worst));
  std::printf(
      "%d parts, %d with places the ball had to leave, %d with unreachable ones, deepest %.3f of the "
      "tolerance\n",
      done, moved, unreachable, worst);
  EXPECT_GE(done, cases / 2);
}

/// Rings that no end is near are planned as one: they are the same, turned and moved, and gouge as little.
TEST(RotaryJob, InnerRingsOfAUniformSweepAreTheSame) {
  Outcome asked;
  asked.tool.radius = asked.tool.shank_radius = 1;
  asked.tool.shank_length = 30;
  asked.options.side_step = 1.5;
  const double length = 8;
  const auto out = plan_of({cases::cutter(5, 8, 5, 0.5), {{0, 0}, {length, 0.8}}}, std::move(asked));
  ASSERT_TRUE(out);
  const RotaryCheck check =
      check_rotary_moves(out->part, out->tool, moves_of(*out), machine(), out->options.tolerance_mm);
  EXPECT_LE(check.report.gouge_max_mm(), (1 + kMotionShare) * out->options.tolerance_mm);
  // Every planned centre of one ring stands on every other.
  std::vector<std::vector<Point3>> rings;
  std::size_t path = std::numeric_limits<std::size_t>::max();
  for (const rotary::RotaryPoint& p : out->plan.points) {
    const double turn = -out->part.swept->turn_at(length * p.place.contact.w), w = p.place.contact.w;
    if (length * w < 2 || length * (1 - w) < 2) continue;
    if (p.path != path) rings.emplace_back();
    path = p.path;
    const Point3 c = p.place.center;
    rings.back().push_back({c.x - length * w, c.y * std::cos(turn) - c.z * std::sin(turn),
                            c.y * std::sin(turn) + c.z * std::cos(turn)});
  }
  ASSERT_GE(rings.size(), 3U);
  for (const auto& ring : rings) {
    std::size_t same = 0;
    for (const Point3 p : ring)
      same += std::any_of(rings[0].begin(), rings[0].end(),
                          [&](Point3 q) { return geom::distance(p, q) < 1e-9; });
    // (The motion's proofs add points of their own.)
    EXPECT_GT(10 * same, 8 * std::min(ring.size(), rings[0].size()));
  }
}

}  // namespace
}  // namespace burin::job
