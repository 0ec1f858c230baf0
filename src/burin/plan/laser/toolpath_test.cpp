// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/toolpath.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>

#include "burin/plan/laser/toolpath_fixture.h"

namespace burin::laser {
namespace {

using namespace fixture;

LaserOptions options_with(double offset) {
  LaserOptions o;
  o.offset_mm = offset;
  o.power_w = 1000;
  return o;
}

Toolpath plan(const Profile& profile, const LaserOptions& options, Diagnostics* diagnostics = nullptr) {
  Diagnostics own;
  auto t = make_toolpath(profile, options, diagnostics ? *diagnostics : own);
  EXPECT_TRUE(t.ok()) << (t.ok() ? "" : t.error().message);
  if (!t.ok()) return {};
  EXPECT_EQ(t->kind.size(), t->program.records.size());
  EXPECT_EQ(t->program.source.size(), t->program.records.size());
  EXPECT_TRUE(cl::validate(t->program, 1e-6).ok());
  return std::move(t).value();
}

/// Indices of paths in the order in which their cutting starts.
std::vector<std::uint32_t> cut_order(const Toolpath& t) {
  std::vector<std::uint32_t> order;
  for (const Step& s : walk(t)) {
    if (s.rapid) order.push_back(s.source);
  }
  return order;
}

bool contains(const CutPath& outer, const CutPath& inner) {
  return outer.spline.closed && outer.role != Role::engrave &&
         geom::winding_number(outer.spline, geom::point_on(inner.spline.segments[0], 0.37)) != 0;
}

TEST(Toolpath, InnerPathsComeFirstAndEveryPathOnceInEveryCopy) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Profile profile = random_profile(seed, 0.25);
    LaserOptions o = options_with(0.25);
    o.copies = {1 + static_cast<int>(seed % 3), 1 + static_cast<int>(seed % 2), 4.0};
    const Toolpath t = plan(profile, o);
    const auto order = cut_order(t);
    const std::size_t n = profile.paths.size();
    ASSERT_EQ(order.size(), n * static_cast<std::size_t>(o.copies.columns * o.copies.rows));
    ASSERT_EQ(std::vector<std::uint32_t>(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n)),
              t.order);
    for (std::size_t copy = 0; copy < order.size() / n; ++copy) {
      std::vector<std::size_t> at(n, n);
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_EQ(at[order[copy * n + i]], n) << "twice";
        at[order[copy * n + i]] = i;
      }
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
          if (i == j) continue;
          const CutPath &p = profile.paths[i], &q = profile.paths[j];
          if (p.role == Role::engrave && q.role != Role::engrave) {
            EXPECT_LT(at[i], at[j]);
          } else if (q.role != Role::engrave && contains(p, q)) {
            EXPECT_LT(at[j], at[i]) << "seed " << seed << ": " << j << " lies in " << i;
          }
        }
      }
    }
  }
}

TEST(Toolpath, WithoutLeadsInFileOrderThePathsAreReproducedBitByBit) {
  for (const Direction direction : {Direction::climb, Direction::conventional, Direction::automatic}) {
    const Profile profile = random_profile(7, 0.25);
    LaserOptions o = options_with(0.25);
    o.lead.kind = LeadKind::none;
    o.order = Order::file;
    o.direction = direction;
    const Toolpath t = plan(profile, o);
    std::vector<std::vector<Segment>> got(profile.paths.size());
    for (const Step& s : walk(t)) {
      if (!s.rapid) {
        EXPECT_TRUE(s.beam);
        got[s.source].push_back(s.segment);
      }
    }
    std::vector<std::uint32_t> file(profile.paths.size());
    for (std::uint32_t i = 0; i < file.size(); ++i) file[i] = i;
    EXPECT_EQ(t.order, file);
    for (std::size_t i = 0; i < got.size(); ++i) {
      const ArcSpline& path = profile.paths[i].spline;
      const ArcSpline back = geom::reversed(path);
      ASSERT_EQ(got[i].size(), path.segments.size());
      const bool same = got[i][0].b == path.segments[0].b && got[i][0].radius == path.segments[0].radius;
      for (std::size_t k = 0; k < got[i].size(); ++k) {
        const Segment& want = same ? path.segments[k] : back.segments[k];
        EXPECT_EQ(got[i][k].a, want.a);
        EXPECT_EQ(got[i][k].b, want.b);
        EXPECT_EQ(got[i][k].center, want.center);
        EXPECT_EQ(got[i][k].radius, want.radius);
      }
    }
  }
}

TEST(Toolpath, ClimbTurnsOuterPathsClockwiseAndHolesCounterClockwise) {
  const Profile profile = random_profile(3, 0.25);
  for (const Direction direction : {Direction::automatic, Direction::climb, Direction::conventional}) {
    LaserOptions o = options_with(0.25);
    o.lead.kind = LeadKind::none;
    o.direction = direction;
    const Toolpath t = plan(profile, o);
    std::vector<ArcSpline> got(profile.paths.size());
    for (const Step& s : walk(t)) {
      if (!s.rapid) got[s.source].segments.push_back(s.segment);
    }
    for (std::size_t i = 0; i < got.size(); ++i) {
      if (!profile.paths[i].spline.closed) continue;
      got[i].closed = true;
      const bool ccw = geom::signed_area(got[i]) > 0;
      EXPECT_EQ(ccw, (profile.paths[i].role == Role::hole) != (direction == Direction::conventional));
    }
  }
}

/// Every point of every lead and loop, sampled densely, against the outlines of all copies.
void expect_clear(const Profile& profile, const Toolpath& t, const LaserOptions& o, Vec2 pitch) {
  const double least = std::abs(o.offset_mm) - o.tolerance.path_mm;
  std::vector<geom::Box2> near;
  for (const Outline& outline : profile.outlines)
    near.push_back(geom::bounds_of(outline.spline).grown(least));
  for (const Step& s : walk(t)) {
    if (s.kind != MoveKind::lead && s.kind != MoveKind::corner) continue;
    for (int k = 0; k <= 40; ++k) {
      const Point2 p = geom::point_on(s.segment, k / 40.0);
      for (int i = 0; i < o.copies.columns; ++i) {
        for (int j = 0; j < o.copies.rows; ++j) {
          const Point2 q = p - Vec2{i * pitch.x, j * pitch.y};
          for (std::size_t n = 0; n < near.size(); ++n) {
            if (!near[n].contains(q)) continue;
            ASSERT_GE(geom::distance_to(profile.outlines[n].spline, q), least - 1e-9) << p.x << " " << p.y;
          }
        }
      }
    }
  }
}

Vec2 pitch_of(const Profile& profile, double gap) {
  geom::Box2 box;
  for (const CutPath& p : profile.paths) box.add(geom::bounds_of(p.spline));
  return {box.width() + gap, box.height() + gap};
}

TEST(Toolpath, LeadsKeepTheirDistanceFromAllOutlinesOfAllCopies) {
  for (unsigned seed = 1; seed <= 25; ++seed) {
    const Profile profile = random_profile(seed, 0.25);
    LaserOptions o = options_with(0.25);
    o.lead.kind = seed % 2 ? LeadKind::arc : LeadKind::line;
    o.lead.length_mm = 1.0 + seed % 7;
    o.lead.out_mm = seed % 3;
    o.order = seed % 4 ? Order::inner_first : Order::file;
    o.arcs = seed % 5 != 0;
    o.copies = {2, 2, static_cast<double>(seed % 3)};
    Diagnostics diagnostics;
    const Toolpath t = plan(profile, o, &diagnostics);
    expect_clear(profile, t, o, pitch_of(profile, o.copies.gap_mm));
    // Where nothing was reported, the lead has the length asked for.
    std::size_t leads = 0;
    for (const Step& s : walk(t)) leads += s.kind == MoveKind::lead;
    EXPECT_GT(leads, 0u);
    EXPECT_FALSE(diagnostics.anything_left_out());
  }
}

TEST(Toolpath, LeadsArriveTangentiallyAndFromTheWaste) {
  Builder b;
  b.plate({0, 0}, {100, 100});
  b.round_hole({50, 50}, 20);
  for (const Direction direction : {Direction::climb, Direction::conventional}) {
    LaserOptions o = options_with(b.d);
    o.direction = direction;
    o.lead.out_mm = 1.5;
    const auto steps = walk(plan(b.profile, o));
    int seen = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (steps[i].kind != MoveKind::lead) continue;
      ++seen;
      const bool in = steps[i - 1].rapid;
      const Segment& lead = steps[i].segment;
      EXPECT_NEAR(geom::length_of(lead), in ? 2.0 : 1.5, 1e-9);
      const Vec2 t1 = in ? geom::end_tangent(lead) : geom::end_tangent(steps[i - 1].segment);
      const Vec2 t2 = in ? geom::start_tangent(steps[i + 1].segment) : geom::start_tangent(lead);
      EXPECT_NEAR(geom::norm(t1 - t2), 0, 1e-9);
      const Point2 far = in ? lead.a : lead.b;
      const bool in_plate = far.x > 0 && far.x < 100 && far.y > 0 && far.y < 100;
      const bool in_hole = geom::distance(far, {50, 50}) < 20;
      EXPECT_TRUE(!in_plate || in_hole);
    }
    EXPECT_EQ(seen, 4);
  }
}

TEST(Toolpath, SmallRoundHolesAreEnteredFromTheCentre) {
  Builder b;
  b.round_hole({5, 5}, 1.25);  // beam circle of 1 mm: pi / 2 to the middle
  LaserOptions o = options_with(b.d);
  Diagnostics diagnostics;
  const Toolpath t = plan(b.profile, o, &diagnostics);
  ASSERT_EQ(t.pierces.size(), 1u);
  EXPECT_NEAR(geom::distance(t.pierces[0], {5, 5}), 0, 1e-9);
  EXPECT_NEAR(t.lead_mm, geom::kPi / 2, 1e-9);
  EXPECT_TRUE(diagnostics.empty());
}

TEST(Toolpath, WithoutRoomTheBeamPiercesOnThePathAndSaysSo) {
  // A slot exactly as wide as the kerf allows: its path is a sliver 2 um wide.
  Builder b;
  b.d = 0.25;
  b.rect_hole({0, 0}, {10, 0.502});
  LaserOptions o = options_with(0.25);
  o.tolerance.path_mm = 1e-4;
  Diagnostics diagnostics;
  const Toolpath t = plan(b.profile, o, &diagnostics);
  EXPECT_EQ(diagnostics.count("no_lead"), 1u);
  EXPECT_EQ(t.lead_mm, 0);
  EXPECT_FALSE(diagnostics.anything_left_out());
  ASSERT_TRUE(diagnostics.warnings()[0].position_mm.has_value());
}

TEST(Toolpath, LeadsAreShortenedBetweenNeighbours) {
  Builder b;
  b.plate({0, 0}, {20, 20});
  b.plate({22, -10}, {42, 30});
  b.plate({-22, -10}, {-2, 30});
  b.plate({-1, 22}, {21, 42});
  b.plate({-1, -22}, {21, -2});
  LaserOptions o = options_with(b.d);
  o.lead.length_mm = 8;
  Diagnostics diagnostics;
  const Toolpath t = plan(b.profile, o, &diagnostics);
  EXPECT_GE(diagnostics.count("lead_shortened"), 1u);
  EXPECT_EQ(diagnostics.count("no_lead"), 0u);
  expect_clear(b.profile, t, o, {});
}

TEST(Toolpath, OnTheLineLeadsDoNotCrossTheOutlineAgain) {
  Builder b;
  b.d = 0;
  b.plate({0, 0}, {40, 30});
  b.round_hole({20, 15}, 4);
  b.rect_hole({2, 2}, {3, 28});
  LaserOptions o = options_with(0);
  o.side = Side::on;
  const auto steps = walk(plan(b.profile, o));
  int seen = 0;
  for (const Step& s : steps) {
    if (s.kind != MoveKind::lead) continue;
    ++seen;
    for (int k = 0; k <= 50; ++k) {
      EXPECT_GT(distance_to_outlines(b.profile, geom::point_on(s.segment, 0.9 * k / 50)), 1e-4);
    }
    // Outside the plate or in a hole.
    const Point2 p = s.a();
    const bool plate = p.x > 0 && p.x < 40 && p.y > 0 && p.y < 30;
    const bool hole = geom::distance(p, {20, 15}) < 4 || (p.x > 2 && p.x < 3);
    EXPECT_TRUE(!plate || hole);
  }
  EXPECT_EQ(seen, 3);
}

TEST(Toolpath, ANegativeOffsetTurnsWasteAndPartRound) {
  Profile profile;
  profile.outlines.push_back({rectangle({0, 0}, {20, 20}, true), Role::outer, 0, 0});
  profile.paths.push_back({rectangle({0.5, 0.5}, {19.5, 19.5}, true), Role::outer, 0, 0});
  LaserOptions o = options_with(-0.5);
  const Toolpath t = plan(profile, o);
  ASSERT_EQ(t.pierces.size(), 1u);
  const Point2 p = t.pierces[0];
  EXPECT_TRUE(p.x > 0.5 && p.x < 19.5 && p.y > 0.5 && p.y < 19.5);
}

TEST(Toolpath, TotalsAreTheSumsOverTheMoves) {
  for (const auto kind : {Corners::round, Corners::loop, Corners::slow, Corners::power}) {
    const Profile profile = random_profile(11, 0.25);
    LaserOptions o = options_with(0.25);
    o.corners.kind = kind;
    o.overcut_mm = 1;
    o.micro_joints.per_contour = 2;
    const Toolpath t = plan(profile, o);
    double cut = 0, rapid = 0, lead = 0, pierces = 0;
    bool first = true;
    for (const Step& s : walk(t)) {
      const double length = geom::length_of(s.segment);
      if (s.kind == MoveKind::rapid) {
        if (!first) rapid += length;
        first = false;
        EXPECT_FALSE(s.beam);
      } else {
        (s.kind == MoveKind::lead ? lead : cut) += length;
        EXPECT_TRUE(s.beam);
      }
    }
    bool on = false;
    for (const auto& r : t.program.records) {
      if (const auto* beam = std::get_if<cl::Beam>(&r)) {
        pierces += beam->on && !on;
        on = beam->on;
      }
    }
    EXPECT_FALSE(on);
    EXPECT_NEAR(t.cut_mm, cut, 1e-9 * cut);
    EXPECT_NEAR(t.rapid_mm, rapid, 1e-9 * rapid);
    EXPECT_NEAR(t.lead_mm, lead, 1e-9 * (1 + lead));
    EXPECT_EQ(static_cast<double>(t.pierces.size()), pierces);
    EXPECT_EQ(t.machining_s, estimate_time(t.program, o.motion, o.feed_mm_min));
  }
}

TEST(Toolpath, MovesJoinAndAreDeterministic) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Profile profile = random_profile(seed, 0.25);
    LaserOptions o = options_with(0.25);
    o.corners.kind = seed % 2 ? Corners::loop : Corners::slow;
    o.micro_joints.per_contour = static_cast<int>(seed % 3);
    o.overcut_mm = 0.7;
    o.lead.out_mm = 1;
    const Toolpath t = plan(profile, o), again = plan(profile, o);
    EXPECT_EQ(t.program.records, again.program.records);
    for (const Step& s : walk(t)) {
      if (s.segment.is_line()) continue;
      const double r = std::abs(s.segment.radius);
      EXPECT_NEAR(geom::distance(s.a(), s.segment.center), r, 1e-9 * (1 + r));
      EXPECT_NEAR(geom::distance(s.b(), s.segment.center), r, 1e-9 * (1 + r));
      EXPECT_GT(geom::length_of(s.segment), 0);
    }
  }
}

// --- corners
// --------------------------------------------------------------------------------------------------

TEST(Corners, LoopsKeepTheCornerSharpAndStayInTheWaste) {
  for (const Direction direction : {Direction::climb, Direction::conventional}) {
    Builder b;
    b.convex({{0, 0}, {30, 0}, {40, 25}, {5, 20}});
    b.convex({{60, 0}, {90, 5}, {70, 40}});
    LaserOptions o = options_with(b.d);
    o.corners.kind = Corners::loop;
    o.direction = direction;
    Diagnostics diagnostics;
    const Toolpath t = plan(b.profile, o, &diagnostics);
    EXPECT_TRUE(diagnostics.empty());
    expect_clear(b.profile, t, o, {});
    int arcs = 0;
    const auto steps = walk(t);
    for (std::size_t i = 1; i < steps.size(); ++i) {
      const Segment& s = steps[i].segment;
      EXPECT_EQ(steps[i].feed, 1000);
      if (!steps[i].rapid && !steps[i - 1].rapid) {  // smooth everywhere: that is what loops are for
        const Vec2 u = geom::end_tangent(steps[i - 1].segment), v = geom::start_tangent(s);
        EXPECT_NEAR(geom::cross(u, v), 0, 1e-9);
        EXPECT_GT(geom::dot(u, v), 0);
      }
      if (steps[i].kind != MoveKind::corner || s.is_line()) continue;
      ++arcs;
      EXPECT_GT(std::abs(geom::sweep_of(s)), geom::kPi);
      // Both legs pass through the point where the tangents meet.
      const Segment &over = steps[i - 1].segment, &back = steps[i + 1].segment;
      const Vec2 u = geom::unit(over.b - over.a), v = geom::unit(back.b - back.a);
      const double f = geom::cross(back.a - over.a, v) / geom::cross(u, v);
      const Point2 q = over.a + f * u;
      EXPECT_GT(f, 0);
      EXPECT_LT(f, geom::length_of(over));
      // The overshoot and the radius are at most the size asked for, and the larger one is exactly that.
      const double overshoot = geom::length_of(over) - f;
      EXPECT_NEAR(std::max(overshoot, std::abs(s.radius)), o.corners.loop_mm, 1e-9);
      EXPECT_GT(distance_to_outlines(b.profile, q), b.d);
    }
    EXPECT_EQ(arcs, 7);
  }
}

TEST(Corners, WithoutRoomForTheLoopTheCornerIsSlowAndReported) {
  Builder b;
  b.plate({0, 0}, {20, 20});
  b.rect_hole({5, 5}, {15, 15});  // corners of holes: the loop would be in the part
  LaserOptions o = options_with(b.d);
  o.corners.kind = Corners::loop;
  Diagnostics diagnostics;
  const Toolpath t = plan(b.profile, o, &diagnostics);
  EXPECT_EQ(diagnostics.count("corner_slowed"), 1u);
  double slow = 0;
  for (const Step& s : walk(t)) {
    if (s.feed == 500 && s.kind == MoveKind::corner) slow += geom::length_of(s.segment);
  }
  EXPECT_NEAR(slow, 4 * 2 * o.corners.slow_mm, 1e-9);
}

TEST(Corners, SlowZonesHaveTheLengthAskedFor) {
  Builder b;
  b.plate({0, 0}, {40, 40});
  for (const Corners kind : {Corners::slow, Corners::power}) {
    LaserOptions o = options_with(b.d);
    o.corners.kind = kind;
    o.corners.slow_factor = 0.25;
    o.corners.slow_mm = 1.5;
    const Toolpath t = plan(b.profile, o);
    double slow = 0, fast = 0;
    for (const Step& s : walk(t)) {
      if (s.rapid || s.kind == MoveKind::lead) continue;
      EXPECT_EQ(s.kind == MoveKind::corner, s.feed == 250);
      EXPECT_EQ(s.power, s.feed == 250 && kind == Corners::power ? 250 : 1000);
      (s.feed == 250 ? slow : fast) += geom::length_of(s.segment);
    }
    EXPECT_NEAR(slow, 4 * (3.0 + b.d * geom::kPi / 2), 1e-9);
    EXPECT_NEAR(slow + fast, geom::length_of(b.profile.paths[0].spline), 1e-9);
    EXPECT_EQ(t.pierces.size(), 1u);
  }
}

TEST(Corners, SlowZonesAtTheStartOfThePathGoRoundIt) {
  Builder b;
  b.d = 0;
  b.plate({0, 0}, {40, 40});
  LaserOptions o = options_with(0);
  o.corners.kind = Corners::slow;
  o.order = Order::file;
  o.lead.kind = LeadKind::none;
  double slow = 0;
  for (const Step& s : walk(plan(b.profile, o)))
    slow += !s.rapid && s.feed == 500 ? geom::length_of(s.segment) : 0;
  EXPECT_NEAR(slow, 8, 1e-9);
}

TEST(Corners, BluntCornersAreLeftAlone) {
  Builder b;
  std::vector<Point2> p;
  for (int i = 0; i < 24; ++i) {  // turns by 15 degrees
    p.push_back({20 * std::cos(i * geom::kPi / 12), 20 * std::sin(i * geom::kPi / 12)});
  }
  b.convex(p);
  for (const Corners kind : {Corners::loop, Corners::slow, Corners::power}) {
    LaserOptions o = options_with(b.d);
    o.corners.kind = kind;
    for (const Step& s : walk(plan(b.profile, o))) EXPECT_NE(s.kind, MoveKind::corner);
    o.corners.angle_deg = 14;
    int corners = 0;
    for (const Step& s : walk(plan(b.profile, o))) corners += s.kind == MoveKind::corner;
    EXPECT_GT(corners, 0);
  }
}

// --- micro-joints, overcut, chords
// ------------------------------------------------------------------------------

TEST(MicroJoints, LeaveTheWidthAskedForBetweenTheKerfs) {
  for (const int count : {1, 2, 3, 5}) {
    for (const Corners kind : {Corners::round, Corners::slow, Corners::loop}) {
      Builder b;
      b.plate({0, 0}, {40, 30});
      b.disk({80, 20}, 15);
      LaserOptions o = options_with(b.d);
      o.micro_joints = {count, 0.4};
      o.corners.kind = kind;
      o.overcut_mm = 0.5;
      Diagnostics diagnostics;
      const auto steps = walk(plan(b.profile, o, &diagnostics));
      EXPECT_TRUE(diagnostics.empty());
      int gaps = 0;
      double gap = 0;
      for (const Step& s : steps) {
        if (!s.rapid && !s.beam) {
          gap += geom::length_of(s.segment);
          EXPECT_EQ(s.kind, MoveKind::rapid);
        } else if (gap > 0) {
          EXPECT_NEAR(gap - 2 * b.d, 0.4, 1e-9);
          gap = 0;
          ++gaps;
        }
      }
      EXPECT_EQ(gaps, 2 * count);
      // Straight ones keep away from the corners of the plate.
      for (const Step& s : steps) {
        if (s.rapid || s.beam || s.source != 0) continue;
        EXPECT_TRUE(s.segment.is_line());
      }
    }
  }
}

TEST(MicroJoints, AreLeftOutOfHolesThatAreTooSmall) {
  Builder b;
  b.round_hole({0, 0}, 0.5);
  LaserOptions o = options_with(b.d);
  o.micro_joints = {3, 0.3};
  Diagnostics diagnostics;
  const Toolpath t = plan(b.profile, o, &diagnostics);
  EXPECT_EQ(diagnostics.count("no_micro_joint"), 1u);
  EXPECT_EQ(t.pierces.size(), 1u);
}

TEST(Overcut, GoesOnAlongThePathItself) {
  Builder b;
  b.plate({0, 0}, {40, 30});
  b.round_hole({20, 15}, 3);
  LaserOptions o = options_with(b.d);
  o.overcut_mm = 2.5;
  double over = 0;
  for (const Step& s : walk(plan(b.profile, o))) {
    if (s.kind != MoveKind::overcut) continue;
    over += geom::length_of(s.segment);
    EXPECT_TRUE(s.beam);
    for (const double f : {0.0, 0.5, 1.0}) {
      EXPECT_NEAR(geom::distance_to(b.profile.paths[s.source].spline, geom::point_on(s.segment, f)), 0, 1e-9);
    }
  }
  EXPECT_NEAR(over, 5, 1e-9);
}

TEST(NoArcs, ChordsStayWithinTheTolerance) {
  const Profile profile = random_profile(5, 0.25);
  LaserOptions o = options_with(0.25);
  o.arcs = false;
  o.tolerance.path_mm = 0.02;
  for (const Step& s : walk(plan(profile, o))) {
    EXPECT_TRUE(s.segment.is_line());
    if (s.kind != MoveKind::cut) continue;
    for (int k = 0; k <= 10; ++k) {
      EXPECT_LE(geom::distance_to(profile.paths[s.source].spline, geom::point_on(s.segment, k / 10.0)),
                0.02 + 1e-9);
    }
  }
}

// --- engraving, errors, size
// ------------------------------------------------------------------------------------

TEST(Engraving, ComesFirstAtReducedPowerWithoutLeads) {
  Builder b;
  b.plate({0, 0}, {40, 30});
  b.engrave({{5, 5}, {20, 5}, {20, 10}});
  LaserOptions o = options_with(b.d);
  o.corners.kind = Corners::slow;
  const Toolpath t = plan(b.profile, o);
  EXPECT_EQ(t.order.front(), 1u);
  double length = 0;
  for (const Step& s : walk(t)) {
    if (s.source != 1 || s.rapid) continue;
    EXPECT_EQ(s.kind, MoveKind::engrave);
    EXPECT_EQ(s.power, 200);
    EXPECT_EQ(s.feed, 1000);
    length += geom::length_of(s.segment);
  }
  EXPECT_NEAR(length, 20, 1e-12);
}

TEST(Toolpath, ImpossibleValuesAreUsageErrors) {
  Builder b;
  b.plate({0, 0}, {40, 30});
  const auto code = [&](auto change) {
    LaserOptions o = options_with(b.d);
    change(o);
    Diagnostics d;
    const auto t = make_toolpath(b.profile, o, d);
    return t.ok() ? ErrorCode::internal : t.error().code;
  };
  const double nan = std::nan("");
  EXPECT_EQ(code([&](LaserOptions& o) { o.offset_mm = nan; }), ErrorCode::usage);
  EXPECT_EQ(code([&](LaserOptions& o) { o.feed_mm_min = 0; }), ErrorCode::usage);
  EXPECT_EQ(code([&](LaserOptions& o) { o.lead.length_mm = -1; }), ErrorCode::usage);
  EXPECT_EQ(code([&](LaserOptions& o) { o.copies.columns = 0; }), ErrorCode::usage);
  EXPECT_EQ(code([&](LaserOptions& o) { o.micro_joints.per_contour = -3; }), ErrorCode::usage);
  EXPECT_EQ(code([&](LaserOptions& o) { o.corners.slow_factor = 0; }), ErrorCode::usage);
  EXPECT_EQ(code([&](LaserOptions& o) { o.copies.columns = o.copies.rows = 100000; }), ErrorCode::range);
  b.profile.paths[0].spline.segments[0].a.x = nan;
  EXPECT_EQ(code([](LaserOptions&) {}), ErrorCode::geometry);
  b.profile.paths.clear();
  EXPECT_EQ(code([](LaserOptions&) {}), ErrorCode::geometry);
}

TEST(Toolpath, FiveThousandHolesAreQuick) {
  Builder b;
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 50; ++j) b.round_hole({5.0 + 10 * i, 5.0 + 10 * j}, 1 + (i * 7 + j * 3) % 3);
  }
  b.plate({0, 0}, {1000, 500});
  const auto start = std::chrono::steady_clock::now();
  const Toolpath t = plan(b.profile, options_with(b.d));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("seconds", std::to_string(seconds));
#ifdef NDEBUG
  EXPECT_LT(seconds, 2.0);
#endif
  EXPECT_EQ(t.order.back(), 5000u);
  // Holes 10 mm apart: no tour is shorter than about that for each.
  EXPECT_LT(t.rapid_mm, 5000 * 11.0);
}

}  // namespace
}  // namespace burin::laser
