// SPDX-License-Identifier: Apache-2.0
// Whole plans on random parts against a check that knows only the mesh, the tool and the legs: the tool is
// set at dense times of the joint-linear motion and every point of a dense sample of the part is measured.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>

#include "burin/plan/rotary/rotary.h"

namespace burin::rotary {
namespace {

using geom::kPi;
using geom::Point2;
using geom::Point3;
using geom::Vec3;

constexpr double kDegree = kPi / 180;

// --- parts

geom::ArcSpline polygon(const std::vector<Point2>& p) {
  geom::ArcSpline s;
  s.closed = true;
  for (std::size_t i = 0; i < p.size(); ++i)
    s.segments.push_back(geom::make_line(p[i], p[(i + 1) % p.size()]));
  return s;
}
Point2 polar(double r, double a) {
  return {r * std::cos(a), r * std::sin(a)};
}
/// A disc with slots: `half` wide at the mouth, `wide` at the bottom (an undercut when larger).
geom::ArcSpline slotted(double radius, int slots, double half, double wide, double floor) {
  geom::ArcSpline s;
  s.closed = true;
  const double mouth = std::asin(half / radius);
  for (int k = 0; k < slots; ++k) {
    const double a = 2 * kPi * k / slots, c = std::cos(a), d = std::sin(a);
    const auto at = [&](double x, double y) { return Point2{x * c - y * d, x * d + y * c}; };
    const double edge = std::sqrt(radius * radius - half * half), middle = (edge + floor) / 2;
    std::vector<Point2> p{at(edge, -half)};
    if (wide > half) {
      p.push_back(at(middle, -half));
      p.push_back(at(middle, -wide));
    }
    p.push_back(at(floor, -wide));
    p.push_back(at(floor, wide));
    if (wide > half) {
      p.push_back(at(middle, wide));
      p.push_back(at(middle, half));
    }
    p.push_back(at(edge, half));
    for (std::size_t i = 0; i + 1 < p.size(); ++i) s.segments.push_back(geom::make_line(p[i], p[i + 1]));
    const Point2 next = polar(radius, a + 2 * kPi / slots - mouth);
    s.segments.push_back(geom::make_arc(p.back(), next, {0, 0}, true));
  }
  // The chain closes to the last bit.
  for (std::size_t i = 0; i < s.segments.size(); ++i)
    s.segments[i].b = s.segments[(i + 1) % s.segments.size()].a;
  return s;
}

struct Case {
  SweptSection swept;
  model::BallTool tool;
};
Case random_case(std::mt19937& random) {
  std::uniform_real_distribution<double> u(0, 1);
  Case c;
  const int kind = static_cast<int>(random() % 4);
  if (kind == 0) {
    std::vector<Point2> p;
    const int n = 3 + static_cast<int>(random() % 5);
    for (int i = 0; i < n; ++i) p.push_back(polar(7 + 5 * u(random), 2 * kPi * (i + 0.5 * u(random)) / n));
    c.swept.section = polygon(p);
  } else if (kind == 1) {
    std::vector<Point2> p;
    const int n = 8;
    for (int i = 0; i < n; ++i) p.push_back(polar((i % 2 == 0 ? 10 : 6) + u(random), 2 * kPi * i / n));
    c.swept.section = polygon(p);
  } else {
    const double half = 1.5 + u(random);
    c.swept.section = slotted(10, 1 + static_cast<int>(random() % 3), half,
                              kind == 2 ? half : half + 1.5 * u(random), 4.5 + 2 * u(random));
  }
  const double length = 6 + 4 * u(random);
  c.swept.stations = {{0, 0}, {length, (u(random) - 0.5) * 1.5}};
  c.tool.radius = 1 + 0.6 * u(random);
  c.tool.shank_radius = c.tool.radius * (0.7 + 0.4 * u(random));
  c.tool.shank_length = 7 + 10 * u(random);
  c.tool.holder = {{3 + 3 * u(random), 8}, {6, 20}};
  return c;
}

// --- the check

std::vector<Point3> dense_points(const geom::Mesh& mesh, double spacing) {
  std::vector<Point3> out = mesh.vertices;
  for (const auto& t : mesh.triangles) {
    const Point3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const double size = std::max(geom::distance(a, b), std::max(geom::distance(b, c), geom::distance(a, c)));
    const int n = std::min(40, 1 + static_cast<int>(size / spacing));
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        out.push_back(a + (static_cast<double>(i) / n) * (b - a) + (static_cast<double>(j) / n) * (c - a));
  }
  std::sort(out.begin(), out.end(), [](const Point3& a, const Point3& b) { return a.x < b.x; });
  return out;
}

/// How deep a point at height h above the ball's centre and this far from the tool's axis stands in the tool.
double depth_in(const model::BallTool& tool, double h, double across) {
  double deep = tool.radius - std::sqrt(h * h + across * across);
  deep = std::max(deep, std::min(h, tool.shank_radius - across));
  double from = tool.shank_length;
  for (const auto& piece : tool.holder) {
    deep = std::max(deep, std::min({h - from, from + piece.height - h, piece.radius - across}));
    from += piece.height;
  }
  return deep;
}

double deepest(const std::vector<Point3>& points, const model::BallTool& tool, const Point3& tip,
               double theta) {
  double widest = std::max(tool.radius, tool.shank_radius);
  for (const auto& piece : tool.holder) widest = std::max(widest, piece.radius);
  const Vec3 axis{0, std::sin(theta), std::cos(theta)};
  const Point3 center = tip + tool.radius * axis;
  double deep = -1e300;
  auto it = std::lower_bound(points.begin(), points.end(), center.x - widest,
                             [](const Point3& p, double x) { return p.x < x; });
  for (; it != points.end() && it->x <= center.x + widest; ++it) {
    const Vec3 d = *it - center;
    const double h = dot(d, axis);
    deep = std::max(deep, depth_in(tool, h, norm(d - h * axis)));
  }
  return deep;
}

Point3 rolled(Point3 p, double a) {
  return {p.x, p.y * std::cos(a) - p.z * std::sin(a), p.y * std::sin(a) + p.z * std::cos(a)};
}

/// Deepest gouge over the legs with the joints running linearly: at the ends of every move and at random
/// times in it, the dearer the part the fewer.
double gouge(const RotaryPlan& plan, const geom::Mesh& mesh, const model::BallTool& tool) {
  const auto points = dense_points(mesh, 0.5);
  std::size_t moves = 0;
  for (const Leg& leg : plan.legs) moves += leg.poses.size();
  constexpr double kBudget = 1e7;  // measured points
  const double each = kBudget / (static_cast<double>(points.size()) * static_cast<double>(moves + 1));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(0, 1);
  double worst = -1e300;
  for (const Leg& leg : plan.legs) {
    for (std::size_t i = 1; i < leg.poses.size(); ++i) {
      const AxisPose &a = leg.poses[i - 1], &b = leg.poses[i];
      const Point3 from = rolled(tip_of(a, tool.radius), a.theta),
                   to = rolled(tip_of(b, tool.radius), b.theta);
      for (double left = each; left > 0; left -= 1) {
        if (left < 1 && u(random) > left) break;
        const double t = u(random), theta = a.theta + t * (b.theta - a.theta);
        worst = std::max(worst, deepest(points, tool, rolled(lerp(from, to, t), -theta), theta));
      }
    }
  }
  return worst;
}

/// What is left at the contact points that were asked for: how far the cuts (densely sampled) keep the ball
/// from them.
double left_over(const RotaryPlan& plan, const Part& part, const model::BallTool& tool,
                 const RotaryOptions& options) {
  PatternOptions pattern;
  pattern.pattern = options.pattern;
  pattern.ball_radius = tool.radius;
  pattern.scallop = options.scallop;
  pattern.side_step = options.side_step;
  pattern.density_mm = 1e-3;
  Diagnostics ignored;
  const auto paths = make_paths(part, pattern, ignored);
  std::vector<Point3> centers;
  for (const Leg& leg : plan.legs) {
    if (leg.kind != LegKind::cut) continue;
    for (std::size_t i = 0; i < leg.poses.size(); ++i) {
      centers.push_back(leg.poses[i].center);
      if (i == 0) continue;
      const AxisPose &a = leg.poses[i - 1], &b = leg.poses[i];
      const Point3 from = rolled(a.center, a.theta), to = rolled(b.center, b.theta);
      const int n = 1 + static_cast<int>((geom::distance(from, to) + 12 * std::abs(a.theta - b.theta)) / 0.1);
      for (int k = 1; k < n; ++k) {
        const double t = static_cast<double>(k) / n;
        centers.push_back(rolled(lerp(from, to, t), -(a.theta + t * (b.theta - a.theta))));
      }
    }
  }
  std::sort(centers.begin(), centers.end(), [](const Point3& a, const Point3& b) { return a.x < b.x; });
  double worst = 0;
  for (const ContactPath& path : paths->paths) {
    for (std::size_t i = 0; i < path.points.size(); i += 7) {
      const Point3 p = path.points[i].p;
      double best = 1e300;
      const auto at = std::lower_bound(centers.begin(), centers.end(), p.x,
                                       [](const Point3& c, double x) { return c.x < x; });
      for (auto it = at; it != centers.end() && it->x - p.x < best; ++it)
        best = std::min(best, geom::distance(*it, p));
      for (auto it = at; it != centers.begin() && p.x - (it - 1)->x < best; --it)
        best = std::min(best, geom::distance(*(it - 1), p));
      worst = std::max(worst, best - tool.radius);
    }
  }
  return worst;
}

void expect_joined(const RotaryPlan& plan) {
  for (std::size_t i = 0; i < plan.legs.size(); ++i) {
    const Leg& leg = plan.legs[i];
    ASSERT_FALSE(leg.poses.empty());
    if (leg.kind == LegKind::cut) {
      ASSERT_EQ(leg.points.size(), leg.poses.size());
    }
    if (i == 0) continue;
    EXPECT_LT(geom::distance(plan.legs[i - 1].poses.back().center, leg.poses.front().center), 1e-9) << i;
    EXPECT_NEAR(plan.legs[i - 1].poses.back().theta, leg.poses.front().theta, 1e-9) << i;
  }
}

void say(const RotaryPlan& p, double seconds) {
  std::printf(
      "  %zu points %zu cl %zu unreachable %zu tai %zu broken, %zu legs, gouge %.5f ssi %.5f excess %.4f, "
      "cut "
      "%.0f link %.0f rapid %.0f mm, turn %.1f, reversals %zu, %.2f s\n",
      p.points.size(), p.counts.cl_points, p.counts.unreachable, p.counts.tai, p.counts.broken, p.legs.size(),
      p.quality.gouge_max_mm, p.quality.ssi_max_mm, p.quality.excess_max_mm, p.lengths_mm.cut,
      p.lengths_mm.link, p.lengths_mm.rapid, p.quality.axis_turn_total, p.counts.axis_reversals, seconds);
  std::fflush(stdout);
}

Result<RotaryPlan> timed(const Part& part, const model::BallTool& tool, const RotaryOptions& options,
                         Diagnostics& diagnostics) {
  const auto begin = std::chrono::steady_clock::now();
  auto result = plan(part, tool, options, diagnostics);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (result) say(*result, seconds);
  return result;
}

TEST(Plan, RandomPartsAreNotGouged) {
  std::mt19937 random(7);
#ifdef NDEBUG
  constexpr int kRounds = 12;
#else
  constexpr int kRounds = 4;  // the check is slow without optimisation
#endif
  int planned = 0, cut = 0;
  for (int round = 0; round < kRounds; ++round) {
    const Case c = random_case(random);
    auto part = make_swept(c.swept, {});
    ASSERT_TRUE(part) << round << " " << part.error().to_string();
    RotaryOptions options;
    options.tolerance_mm = 0.02;
    options.side_step = 2.5;
    options.pattern = round % 3 == 2 ? Pattern::lines : round % 3 == 1 ? Pattern::spiral : Pattern::rings;
    if (options.pattern == Pattern::lines) options.side_step = 4;
    if (round % 4 == 3) options.theta_min = -190 * kDegree, options.theta_max = 190 * kDegree;
    Diagnostics diagnostics;
    const auto result = timed(*part, c.tool, options, diagnostics);
    if (!result) {
      std::printf("  %s\n", result.error().to_string().c_str());
      continue;
    }
    ++planned;
    cut += result->counts.cl_points > 10;
    expect_joined(*result);
    EXPECT_LE(gouge(*result, part->mesh, c.tool), options.tolerance_mm + 1e-6) << round;
    // Samples 0.1 mm apart stand up to (0.05 mm)^2 / (2 R) further away; a step may leave moved places, too.
    EXPECT_LE(left_over(*result, *part, c.tool, options),
              result->quality.excess_max_mm + options.tolerance_mm)
        << round;
    EXPECT_LE(result->quality.gouge_max_mm, options.tolerance_mm + 1e-9);
    EXPECT_EQ(result->counts.unreachable > 0, diagnostics.count("unreachable") > 0);
    for (const Leg& leg : result->legs)
      for (const AxisPose& p : leg.poses) {
        EXPECT_GE(p.theta, options.theta_min);
        EXPECT_LE(p.theta, options.theta_max);
      }
  }
  EXPECT_GE(planned, kRounds - 2);
  EXPECT_GE(cut, kRounds - 2);
}

// --- single properties

/// A round bar of radius 10, 4 mm long, and a ball of 1 mm.
struct Bar {
  SweptSection swept;
  model::BallTool tool{1, 1, 40, {{8, 20}}};
  RotaryOptions options;

  explicit Bar(double length = 4) {
    swept.section.closed = true;
    swept.section.segments = {geom::make_arc({10, 0}, {-10, 0}, {0, 0}, true),
                              geom::make_arc({-10, 0}, {10, 0}, {0, 0}, true)};
    swept.stations = {{0, 0}, {length, 0}};
    options.side_step = 1;
  }
  Result<RotaryPlan> run(Diagnostics& diagnostics) const {
    auto part = make_swept(swept, {});
    EXPECT_TRUE(part);
    return plan(*part, tool, options, diagnostics);
  }
};

TEST(Plan, RoundBarTurnsOnAndOn) {
  const Bar bar;
  Diagnostics diagnostics;
  const auto result = bar.run(diagnostics);
  ASSERT_TRUE(result) << result.error().to_string();
  EXPECT_EQ(result->counts.axis_reversals, 0u);
  EXPECT_EQ(result->counts.unreachable, 0u);
  EXPECT_FALSE(diagnostics.anything_left_out());
  // One approach, one retract, links at the feed between the rings.
  EXPECT_EQ(result->lengths_mm.rapid > 0, true);
  double last = -1e9;
  std::size_t rings = 0;
  for (const Leg& leg : result->legs) {
    EXPECT_NE(leg.kind, LegKind::rapid);
    if (leg.kind != LegKind::cut) continue;
    ++rings;
    EXPECT_NEAR(std::abs(leg.poses.back().theta - leg.poses.front().theta), 2 * kPi, 0.1);
    EXPECT_GE(leg.poses.front().theta, last - 0.1);
    last = leg.poses.back().theta;
  }
  EXPECT_EQ(rings, 5u);
  EXPECT_NEAR(result->quality.axis_turn_total, 2 * kPi * 5, 0.5);
}

TEST(Plan, LimitsOfTheAxisAlternateTheRings) {
  Bar bar;
  bar.options.theta_min = -200 * kDegree;
  bar.options.theta_max = 200 * kDegree;
  Diagnostics diagnostics;
  const auto result = bar.run(diagnostics);
  ASSERT_TRUE(result);
  int direction = 0, rings = 0;
  for (const Leg& leg : result->legs) {
    for (const AxisPose& p : leg.poses) {
      EXPECT_GE(p.theta, bar.options.theta_min);
      EXPECT_LE(p.theta, bar.options.theta_max);
    }
    if (leg.kind != LegKind::cut || leg.poses.size() < 10) continue;
    const int now = leg.poses.back().theta > leg.poses.front().theta ? 1 : -1;
    if (std::abs(leg.poses.back().theta - leg.poses.front().theta) < 6) continue;
    if (direction != 0) {
      EXPECT_EQ(now, -direction);
    }
    direction = now;
    ++rings;
  }
  EXPECT_GE(rings, 4);
}

TEST(Plan, LegsBecomeClData) {
  const Bar bar;
  Diagnostics diagnostics;
  const auto result = bar.run(diagnostics);
  ASSERT_TRUE(result);
  const cl::Program program = to_cl(*result, bar.tool, bar.options, "BAR");
  ASSERT_TRUE(cl::validate(program));
  std::size_t poses = 1;
  for (const Leg& leg : result->legs) poses += leg.poses.size() - 1;
  EXPECT_EQ(program.move_count(), poses);
  std::size_t cut = 0;
  for (std::size_t i = 0; i < program.records.size(); ++i) {
    if (program.source[i] == cl::Program::kNoSource) continue;
    ++cut;
    const RotaryPoint& p = result->points[program.source[i]];
    const cl::Pose* pose = cl::pose_of(program.records[i]);
    ASSERT_NE(pose, nullptr);
    EXPECT_LT(geom::distance(pose->tip + bar.tool.radius * pose->axis, p.place.center), 1e-9);
  }
  // The first pose of a cut is the last one of the leg before.
  EXPECT_GT(cut, result->counts.cl_points - result->legs.size());
}

TEST(Plan, StockIsGoneThroughAtTheFeed) {
  Bar bar;
  bar.options.stock_radius = 15;
  Diagnostics diagnostics;
  const auto result = bar.run(diagnostics);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->legs.front().kind, LegKind::approach);
  EXPECT_EQ(result->legs.front().descent, 0u);
  const AxisPose top = result->legs.front().poses.front();
  const Point3 tip = rolled(tip_of(top, bar.tool.radius), top.theta);
  EXPECT_NEAR(tip.z, 15 + bar.options.safety_mm, 1e-9);
}

TEST(Plan, Refusals) {
  Diagnostics diagnostics;
  Bar bar;
  bar.tool.radius = bar.tool.shank_radius = 11;
  auto result = bar.run(diagnostics);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("smaller tool"), std::string::npos) << result.error().message;
  bar = Bar();
  bar.options.tolerance_mm = std::nan("");
  EXPECT_FALSE(bar.run(diagnostics));
  bar = Bar();
  bar.options.theta_max = bar.options.theta_min;
  EXPECT_FALSE(bar.run(diagnostics));
  bar = Bar();
  bar.tool.shank_length = std::nan("");
  EXPECT_FALSE(bar.run(diagnostics));
}

/// The holder meets the part everywhere; the length that is named does.
TEST(Plan, HolderThatNeverFitsNamesALengthThatDoes) {
  Bar bar;
  // The bottom of a deep slot only: a bar with slots wide enough for the ball alone.
  bar.swept.section = slotted(10, 4, 9.9 * std::sin(kPi / 4) * 0.72, 9.9 * std::sin(kPi / 4) * 0.72, 6.2);
  bar.tool = {1, 1, 1.2, {{60, 20}}};
  Diagnostics diagnostics;
  auto result = bar.run(diagnostics);
  if (result) {
    // Some points are reached: they are cut, the others are said.
    EXPECT_GT(result->counts.unreachable, 0u);
    EXPECT_TRUE(diagnostics.anything_left_out());
    return;
  }
  const std::string& m = result.error().message;
  const auto at = m.find("shank_length of ");
  ASSERT_NE(at, std::string::npos) << m;
  bar.tool.shank_length = std::stod(m.substr(at + 16));
  result = bar.run(diagnostics);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->counts.unreachable, 0u);
}

TEST(Plan, SameEveryTime) {
  std::mt19937 random(11);
  const Case c = random_case(random);
  auto part = make_swept(c.swept, {});
  ASSERT_TRUE(part);
  RotaryOptions options;
  options.side_step = 2;
  Diagnostics diagnostics;
  const auto a = plan(*part, c.tool, options, diagnostics), b = plan(*part, c.tool, options, diagnostics);
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->legs.size(), b->legs.size());
  for (std::size_t i = 0; i < a->legs.size(); ++i) {
    ASSERT_EQ(a->legs[i].poses.size(), b->legs[i].poses.size());
    for (std::size_t k = 0; k < a->legs[i].poses.size(); ++k) {
      EXPECT_EQ(a->legs[i].poses[k].center, b->legs[i].poses[k].center);
      EXPECT_EQ(a->legs[i].poses[k].theta, b->legs[i].poses[k].theta);
    }
  }
}

}  // namespace
}  // namespace burin::rotary
