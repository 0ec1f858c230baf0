// SPDX-License-Identifier: Apache-2.0
// Profiles from drawings: closed forms, the exact offset sampled independently, and what must not change when
// the same part is drawn differently.
#include "burin/plan/laser/profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "burin/geom/curve/letter_k.h"
#include "burin/plan/laser/drawing_fixture.h"

namespace burin::laser {
namespace {

using fixture::Dice;
using fixture::Sketch;
using geom::Curve2;
using geom::kPi;
using geom::Point2;
using geom::Vec2;

struct Made {
  std::optional<Profile> profile;
  std::string error;
  Diagnostics notes;

  const Profile* operator->() const { return &*profile; }
  double area(std::size_t i) const { return geom::signed_area(profile->paths[i].spline); }
};

LaserOptions offset_by(double d) {
  LaserOptions o;
  o.offset_mm = d;
  return o;
}

Made make(const io::Drawing& drawing, const LaserOptions& options) {
  Made made;
  auto contours = join_contours(drawing, options, made.notes);
  if (!contours) {
    made.error = contours.error().to_string();
    return made;
  }
  auto profile = make_profile(*contours, drawing, options, made.notes);
  if (profile) {
    made.profile = std::move(*profile);
  } else {
    made.error = profile.error().to_string();
  }
  return made;
}
Made make(const Sketch& sketch, const LaserOptions& options) {
  return make(sketch.drawing, options);
}

std::string listed(const Diagnostics& notes) {
  std::string text;
  for (const Warning& w : notes.warnings()) text += w.code + ": " + w.message + "\n";
  return text;
}

double grown_square(double side, double d) {
  return side * side + 4 * side * d + kPi * d * d;
}

#define REQUIRE_PROFILE(made) ASSERT_TRUE((made).profile) << (made).error << "\n" << listed((made).notes)

// --- roles, sides, areas
// ------------------------------------------------------------------------------------------

TEST(Profile, PlateWithHoleAndIsland) {
  Sketch s;
  s.rectangle(-5, -5, 5, 5).rectangle(-20, -20, 20, 20).circle({0, 0}, 10).circle({0, 0}, 2);
  const double d = 0.3;
  const Made m = make(s, offset_by(d));
  REQUIRE_PROFILE(m);
  EXPECT_FALSE(m.notes.anything_left_out()) << listed(m.notes);
  ASSERT_EQ(m->outlines.size(), 4u);
  ASSERT_EQ(m->paths.size(), 4u);
  const Role roles[] = {Role::outer, Role::outer, Role::hole, Role::hole};
  const int depths[] = {2, 0, 1, 3};
  const double areas[] = {grown_square(10, d), grown_square(40, d), -kPi * (10 - d) * (10 - d),
                          -kPi * (2 - d) * (2 - d)};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(m->paths[i].contour, i);
    EXPECT_EQ(m->paths[i].role, roles[i]);
    EXPECT_EQ(m->paths[i].depth, depths[i]);
    EXPECT_EQ(m->outlines[i].role, roles[i]);
    EXPECT_EQ(m->outlines[i].depth, depths[i]);
    EXPECT_NEAR(m.area(i), areas[i], 1e-6);
    EXPECT_EQ(geom::signed_area(m->outlines[i].spline) > 0, roles[i] == Role::outer);
  }
  EXPECT_EQ(m->g1_breaks, 0);
  EXPECT_LE(m->max_deviation_mm, 1e-6);
}

TEST(Profile, SidesAndSigns) {
  Sketch s;
  s.rectangle(0, 0, 40, 40).rectangle(10, 10, 30, 30);
  const double d = 0.5;
  const auto inner = [&](double side) { return (side - 2 * d) * (side - 2 * d); };
  const auto check = [&](Side side, double offset, double first, double second) {
    LaserOptions o = offset_by(offset);
    o.side = side;
    const Made m = make(s, o);
    REQUIRE_PROFILE(m);
    ASSERT_EQ(m->paths.size(), 2u);
    EXPECT_NEAR(std::abs(m.area(0)), first, 1e-6);
    EXPECT_NEAR(std::abs(m.area(1)), second, 1e-6);
    EXPECT_FALSE(m.notes.anything_left_out()) << listed(m.notes);
  };
  check(Side::automatic, d, grown_square(40, d), inner(20));
  check(Side::automatic, -d, inner(40), grown_square(20, d));
  check(Side::outside, d, grown_square(40, d), grown_square(20, d));
  check(Side::outside, -d, inner(40), inner(20));
  check(Side::inside, d, inner(40), inner(20));
  check(Side::inside, -d, grown_square(40, d), grown_square(20, d));
  check(Side::on, d, 1600, 400);
  check(Side::automatic, 0, 1600, 400);
}

TEST(Profile, EngravedAndOpenLinesStayWhereTheyAreAndNestNothing) {
  Sketch s;
  s.rectangle(0, 0, 40, 40, "MARK")
      .rectangle(5, 5, 35, 35)
      .chain({{10, 10}, {20, 10}, {20, 20}})
      .circle({25, 25}, 3, "MARK");
  LaserOptions o = offset_by(0.5);
  o.layers["MARK"] = Treatment::engrave;
  const Made m = make(s, o);
  REQUIRE_PROFILE(m);
  ASSERT_EQ(m->paths.size(), 4u);
  EXPECT_EQ(m->paths[0].role, Role::engrave);
  EXPECT_NEAR(std::abs(m.area(0)), 1600, 1e-9);
  EXPECT_EQ(m->paths[1].role, Role::outer);
  EXPECT_EQ(m->paths[1].depth, 0);
  EXPECT_NEAR(m.area(1), grown_square(30, 0.5), 1e-6);
  EXPECT_EQ(m->paths[2].role, Role::open);
  EXPECT_NEAR(geom::length_of(m->paths[2].spline), 20, 1e-9);
  EXPECT_NEAR(std::abs(m.area(3)), 9 * kPi, 1e-9);
}

// --- what does not fit
// --------------------------------------------------------------------------------------------

TEST(Profile, ContoursThatVanish) {
  Sketch s;
  s.rectangle(0, 0, 40, 40).circle({10, 10}, 0.29).circle({30, 30}, 0.31);
  const Made m = make(s, offset_by(0.3));
  REQUIRE_PROFILE(m);
  EXPECT_EQ(m->paths.size(), 2u);
  ASSERT_EQ(m.notes.count("contour_vanished"), 1u) << listed(m.notes);
  EXPECT_TRUE(m.notes.anything_left_out());
  for (const Warning& w : m.notes.warnings()) {
    if (w.code != "contour_vanished") continue;
    EXPECT_EQ(w.where.entity, "SHAPE 2");
    ASSERT_TRUE(w.position_mm);
    EXPECT_NEAR(std::hypot((*w.position_mm)[0] - 10, (*w.position_mm)[1] - 10), 0.29, 1e-9);
  }

  const Made small = make(Sketch().rectangle(0, 0, 0.5, 40), offset_by(-0.3));
  EXPECT_FALSE(small.profile);
  EXPECT_NE(small.error.find("nothing left to cut"), std::string::npos);
  EXPECT_EQ(small.notes.count("contour_vanished"), 1u);

  // A hole of exactly the width of the beam has no room left either.
  const Made exact = make(Sketch().rectangle(0, 0, 40, 40).rectangle(10, 10, 10.5, 20), offset_by(0.25));
  REQUIRE_PROFILE(exact);
  EXPECT_EQ(exact->paths.size(), 1u);
  EXPECT_EQ(exact.notes.count("contour_vanished"), 1u);
}

TEST(Profile, HolesNearerThanTheBeamMerge) {
  const double d = 0.3;
  const auto with_gap = [&](double gap, const LaserOptions& o) {
    // The region grows into the holes, so it is the holes' paths that come apart; parts grow into each other.
    return make(Sketch().rectangle(0, 0, 10, 10).rectangle(10 + gap, 0, 20, 10), o);
  };
  const Made apart = with_gap(2 * d + 0.01, offset_by(d));
  REQUIRE_PROFILE(apart);
  EXPECT_EQ(apart->paths.size(), 2u);
  EXPECT_FALSE(apart.notes.anything_left_out()) << listed(apart.notes);
  const Made near = with_gap(0.4, offset_by(d));
  REQUIRE_PROFILE(near);
  EXPECT_EQ(near->paths.size(), 1u);
  EXPECT_EQ(near.notes.count("contours_merged"), 1u) << listed(near.notes);
  EXPECT_TRUE(near.notes.anything_left_out());
  // Two grown squares less what they share: the lens-ended strip between them, by integration.
  double area = 0;
  const int n = 400000;
  for (int i = 0; i < n; ++i) {
    const double x = -1 + 22.0 * (i + 0.5) / n;
    const auto height = [&](double x0, double x1) {
      const double out = std::max({x0 - x, x - x1, 0.0});
      return out >= d ? 0.0 : 10 + 2 * std::sqrt(d * d - out * out);
    };
    area += std::max(height(0, 10), height(10.4, 20)) * 22.0 / n;
  }
  EXPECT_NEAR(near.area(0), area, 1e-3);

  // A web between two holes, on the wrong side of the beam.
  Sketch web;
  web.rectangle(0, 0, 40, 20).rectangle(5, 5, 19.8, 15).rectangle(20.2, 5, 35, 15);
  const Made lost = make(web, offset_by(-d));
  REQUIRE_PROFILE(lost);
  EXPECT_EQ(lost->paths.size(), 2u);
  EXPECT_EQ(lost.notes.count("contours_merged"), 1u);
  const Made kept = make(web, offset_by(d));
  REQUIRE_PROFILE(kept);
  EXPECT_EQ(kept->paths.size(), 3u);
  EXPECT_EQ(kept.notes.count("contours_merged"), 0u);
}

TEST(Profile, NotchNarrowerThanTheBeam) {
  // A slit 0.4 wide and 5 deep under a beam of 0.6: its bottom stays 5 mm away from where the beam passes,
  // less what the arcs of the beam reach in: sqrt(d^2 - (w/2)^2) above the mouth, distance to the bottom's
  // middle.
  Sketch s;
  s.polygon({{0, 0}, {20, 0}, {20, 10}, {10.2, 10}, {10.2, 5}, {9.8, 5}, {9.8, 10}, {0, 10}});
  const double d = 0.3;
  const Made m = make(s, offset_by(d));
  REQUIRE_PROFILE(m);
  EXPECT_EQ(m->paths.size(), 1u);
  ASSERT_EQ(m.notes.count("loop_removed"), 1u) << listed(m.notes);
  const double excess = 5 + std::sqrt(d * d - 0.2 * 0.2) - d;
  char figure[32];
  std::snprintf(figure, sizeof figure, "%.4f mm", excess);
  for (const Warning& w : m.notes.warnings()) {
    if (w.code != "loop_removed") continue;
    EXPECT_NE(w.message.find(figure), std::string::npos) << w.message << " expected " << figure;
    EXPECT_EQ(w.where.entity, "SHAPE 1");
    ASSERT_TRUE(w.position_mm);
    EXPECT_NEAR((*w.position_mm)[0], 10, 1e-6);
    EXPECT_NEAR((*w.position_mm)[1], 5, 1e-6);
  }
  EXPECT_TRUE(m.notes.anything_left_out());
}

TEST(Profile, NotchOfACurveIsReportedAsThatOfLines) {
  // A smooth slit in a closed spline, 0.3 wide: the walls are cut nowhere, but they are the same piece as the
  // rest.
  const std::vector<Point2> p{{0, 0},    {10, -2},   {20, 0},     {22, 5}, {20, 10},   {12, 10.5},
                              {10.2, 9}, {10.15, 7}, {10.1, 5.2}, {10, 5}, {9.9, 5.2}, {9.85, 7},
                              {9.8, 9},  {8, 10.5},  {0, 10},     {-2, 5}};
  const Made m = make(Sketch().add({fixture::smooth_ring(p)}, true), offset_by(0.3));
  REQUIRE_PROFILE(m);
  EXPECT_EQ(m->paths.size(), 1u);
  EXPECT_EQ(m.notes.count("loop_removed"), 1u) << listed(m.notes);
}

TEST(Profile, InnerCornersAreNoLoss) {
  // Every inner corner keeps d (1/sin(a/2) - 1) of material: known to everyone who cuts with a round beam.
  Sketch s;
  s.polygon({{0, 0}, {20, 0}, {20, 20}, {10, 20}, {10, 10}, {0, 10}}).rectangle(2, 2, 6, 6);
  const Made m = make(s, offset_by(0.3));
  REQUIRE_PROFILE(m);
  EXPECT_FALSE(m.notes.anything_left_out()) << listed(m.notes);
  Sketch k;
  for (const geom::Nurbs2& c : geom::letter_k()) k.add({c}, false);
  const Made letter = make(k, offset_by(0.28));
  REQUIRE_PROFILE(letter);
  EXPECT_FALSE(letter.notes.anything_left_out()) << listed(letter.notes);
  EXPECT_EQ(letter->paths.size(), 1u);
  EXPECT_EQ(letter->g1_breaks, 0);
}

// --- contours that cross
// ------------------------------------------------------------------------------------------

TEST(Crossings, DeepOnesAreLeftOutWithTheirPosition) {
  Sketch s;
  s.rectangle(0, 0, 10, 10).rectangle(5, 5, 15, 15).rectangle(30, 0, 40, 10);
  const Made m = make(s, offset_by(0.2));
  REQUIRE_PROFILE(m);
  EXPECT_EQ(m->paths.size(), 1u);
  EXPECT_EQ(m->paths[0].contour, 2u);
  ASSERT_EQ(m.notes.count("contours_cross"), 1u) << listed(m.notes);
  for (const Warning& w : m.notes.warnings()) {
    if (w.code != "contours_cross") continue;
    ASSERT_TRUE(w.position_mm);
    const double x = (*w.position_mm)[0], y = (*w.position_mm)[1];
    EXPECT_TRUE((std::abs(x - 10) < 1e-6 && std::abs(y - 5) < 1e-6) ||
                (std::abs(x - 5) < 1e-6 && std::abs(y - 10) < 1e-6))
        << x << " " << y;
    EXPECT_NE(w.message.find("SHAPE 2"), std::string::npos);
  }
  const Made none = make(Sketch().rectangle(0, 0, 10, 10).rectangle(5, 5, 15, 15), offset_by(0.2));
  EXPECT_FALSE(none.profile);
  LaserOptions on = offset_by(0.2);
  on.side = Side::on;
  const Made as_drawn = make(s, on);
  REQUIRE_PROFILE(as_drawn);
  EXPECT_EQ(as_drawn->paths.size(), 3u);
}

TEST(Crossings, HolesInWhatIsLeftOutStayHoles) {
  Sketch s;
  s.rectangle(0, 0, 40, 30).rectangle(35, 5, 50, 15).circle({10, 10}, 3).circle({20, 20}, 5);
  s.circle({20, 20}, 2).rectangle(60, 0, 80, 20).circle({70, 10}, 4);
  const Made m = make(s, offset_by(0.2));
  REQUIRE_PROFILE(m);
  ASSERT_EQ(m->paths.size(), 5u) << listed(m.notes);
  EXPECT_NEAR(std::abs(m.area(0)), kPi * 2.8 * 2.8, 1e-6);
  EXPECT_NEAR(std::abs(m.area(1)), kPi * 4.8 * 4.8, 1e-6);
  EXPECT_NEAR(std::abs(m.area(2)), kPi * 2.2 * 2.2, 1e-6);  // the disk in the hole
  EXPECT_NEAR(std::abs(m.area(3)), grown_square(20, 0.2), 1e-6);
  EXPECT_NEAR(std::abs(m.area(4)), kPi * 3.8 * 3.8, 1e-6);
  EXPECT_EQ(m->paths[0].role, Role::hole);
  EXPECT_EQ(m->paths[2].role, Role::outer);
}

TEST(Crossings, FigureEight) {
  const std::vector<Point2> eight{{0, 0}, {10, 10}, {10, 0}, {0, 10}};
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<Point2> p(eight);
    std::rotate(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(k), p.end());
    const Made m = make(Sketch().polygon(p).rectangle(30, 0, 40, 10), offset_by(0.2));
    REQUIRE_PROFILE(m);
    EXPECT_EQ(m->paths.size(), 1u);
    ASSERT_EQ(m.notes.count("self_crossing"), 1u) << listed(m.notes);
    for (const Warning& w : m.notes.warnings()) {
      if (w.code != "self_crossing") continue;
      ASSERT_TRUE(w.position_mm);
      EXPECT_NEAR((*w.position_mm)[0], 5, 1e-6);
      EXPECT_NEAR((*w.position_mm)[1], 5, 1e-6);
    }
  }
  // A loop turning the same way: winding 2 in the middle. Also of curves.
  const Made loop =
      make(Sketch().polygon({{0, 0}, {10, 0}, {10, 6}, {4, 6}, {4, -3}, {0, -3}}), offset_by(0.1));
  EXPECT_FALSE(loop.profile);
  EXPECT_EQ(loop.notes.count("self_crossing"), 1u) << listed(loop.notes);
  const Made curve =
      make(Sketch().add({fixture::smooth_ring({{0, 0}, {10, 10}, {15, 5}, {10, 0}, {0, 10}, {-5, 5}})}, true),
           offset_by(0.1));
  EXPECT_FALSE(curve.profile);
  EXPECT_EQ(curve.notes.count("self_crossing"), 1u) << listed(curve.notes);
}

TEST(Crossings, ShallowOnesAreRepaired) {
  // Side by side, 0.005 into each other.
  const double d = 0.25;
  const Made m = make(Sketch().rectangle(0, 0, 10, 10).rectangle(9.995, 2, 20, 8), offset_by(d));
  REQUIRE_PROFILE(m);
  EXPECT_EQ(m.notes.count("contours_cross"), 0u) << listed(m.notes);
  EXPECT_EQ(m.notes.count("crossing_repaired"), 1u) << listed(m.notes);
  EXPECT_EQ(m->paths.size(), 1u);
  EXPECT_EQ(m.notes.count("contours_merged"), 1u);
  // The union grown: 6 outer corners give a quarter of a disk, 2 inner ones count a square twice.
  EXPECT_NEAR(m.area(0), 160 + 60 * d + 1.5 * kPi * d * d - 2 * d * d, 1e-3);
  const Made deep = make(Sketch().rectangle(0, 0, 10, 10).rectangle(9.985, 2, 20, 8), offset_by(d));
  EXPECT_FALSE(deep.profile);
  EXPECT_EQ(deep.notes.count("contours_cross"), 1u) << listed(deep.notes);
}

TEST(Crossings, TouchingIsNotCrossing) {
  const auto clean = [](const Sketch& s, std::size_t paths, double d, const char* what) {
    SCOPED_TRACE(what);
    LaserOptions o = offset_by(d);
    const Made m = make(s, o);
    REQUIRE_PROFILE(m);
    EXPECT_EQ(
        m.notes.count("contours_cross") + m.notes.count("self_crossing") + m.notes.count("crossing_repaired"),
        0u)
        << listed(m.notes);
    EXPECT_EQ(m->paths.size(), paths);
  };
  // Kept at d = 0 all by themselves; merged when grown; apart when shrunk.
  Sketch vertex;
  vertex.rectangle(0, 0, 10, 10).rectangle(10, 10, 20, 20);
  clean(vertex, 2, 0, "a vertex");
  clean(vertex, 1, 0.2, "a vertex, grown");
  clean(vertex, 2, -0.2, "a vertex, shrunk");
  Sketch stretch;
  stretch.rectangle(0, 0, 10, 10).rectangle(12, 2, 20, 20).polygon({{10, 3}, {12, 3}, {12, 5}, {10, 5}});
  clean(stretch, 1, 0.2, "parts of sides, grown");
  Sketch inside;
  inside.rectangle(0, 0, 20, 20).polygon({{5, 0}, {10, 5}, {10, 10}, {5, 10}});
  clean(inside, 2, 0, "a hole whose corner touches the outline");
  Sketch arcs;
  arcs.circle({0, 0}, 5).circle({10, 0}, 5).circle({0, 0}, 2).circle({3, 0}, 1);
  clean(arcs, 4, 0, "tangent circles");
  // One contour that touches itself in a vertex.
  Sketch self;
  self.polygon({{0, 0}, {5, 5}, {10, 0}, {10, 10}, {5, 5}, {0, 10}});
  clean(self, 1, 0.2, "two triangles that share a vertex");
}

TEST(Crossings, PartsThatFillEachOthersNotchesAreNotNested) {
  // The square shares two sides with the L and lies within its box; whatever vertex each starts at.
  const std::vector<Point2> ell{{0, 0}, {20, 0}, {20, 10}, {10, 10}, {10, 20}, {0, 20}};
  const std::vector<Point2> square{{10, 10}, {18, 10}, {18, 18}, {10, 18}};
  for (std::size_t k = 0; k < 4; ++k) {
    for (const bool flip : {false, true}) {
      std::vector<Point2> p(square);
      std::rotate(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(k), p.end());
      if (flip) std::reverse(p.begin(), p.end());
      for (const double angle : {0.0, 0.3, 1.7, 2.9, 4.4}) {
        const geom::Affine2 turn{std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle), 0, 0};
        // Every side an entity: what is drawn twice would be removed, so shapes stay whole.
        Sketch s;
        s.polygon(ell).polygon(p);
        for (io::Entity& e : s.drawing.entities) io::transform(e.paths, turn);
        LaserOptions o = offset_by(0);
        const Made m = make(s, o);
        REQUIRE_PROFILE(m);
        ASSERT_EQ(m->paths.size(), 2u) << listed(m.notes);
        for (const CutPath& path : m->paths) {
          EXPECT_EQ(path.depth, 0) << "start " << k << " angle " << angle;
          EXPECT_EQ(path.role, Role::outer);
        }
      }
    }
  }
}

TEST(Crossings, NeedlesAndSlivers) {
  // A needle 0.004 wide that pokes 3 mm through the neighbour's side: deep, however thin.
  Sketch needle;
  needle.polygon({{0, 0}, {10, 0}, {10, 4.998}, {14, 5}, {10, 5.002}, {10, 10}, {0, 10}})
      .rectangle(11, 0, 20, 10);
  const Made m = make(needle, offset_by(0.1));
  EXPECT_EQ(m.notes.count("contours_cross"), 1u) << listed(m.notes);
  // Two sides of one contour 0.004 into each other along 10 mm: no area to speak of on either side.
  const std::vector<Point2> sliver{{0, 0},      {10, 0},     {10, 4.998}, {2, 4.998}, {2, 5.002},
                                   {2, 5.0021}, {10, 4.994}, {10, 10},    {0, 10}};
  const Made self = make(Sketch().polygon(sliver), offset_by(0.1));
  REQUIRE_PROFILE(self);
  EXPECT_EQ(self.notes.count("self_crossing"), 0u) << listed(self.notes);
  EXPECT_EQ(self->paths.size(), 1u);
  EXPECT_NEAR(self.area(0), grown_square(10, 0.1), 0.1);
}

TEST(Crossings, LoopsAtCornersSmallerThanTheTolerance) {
  // The sides of a square run past each other, so that a small loop turns the other way; down to first and
  // last vertices that differ by a millionth. The beam must go around the corner as if there were none.
  const double d = 0.3;
  for (const double e : {0.004, 1e-4, 1e-6}) {
    const std::vector<std::vector<Point2>> shapes{
        {{0, 0}, {10 + e, 0}, {10 + e, -e}, {10, -e}, {10, 10}, {0, 10}},
        {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {e, -e}},
        {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {-e, e}},
        {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {e, e}},
        {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {-e, -e}}};
    for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
      for (const bool backwards : {false, true}) {
        SCOPED_TRACE("shape " + std::to_string(shape) + ", size " + std::to_string(e));
        std::vector<Point2> p = shapes[shape];
        if (backwards) std::reverse(p.begin(), p.end());
        for (const double offset : {d, -d}) {
          const Made m = make(Sketch().polygon(p), offset_by(offset));
          REQUIRE_PROFILE(m);
          EXPECT_EQ(m.notes.count("self_crossing"), 0u) << listed(m.notes);
          EXPECT_FALSE(m.notes.anything_left_out()) << listed(m.notes);
          ASSERT_EQ(m->paths.size(), 1u);
          EXPECT_NEAR(m.area(0), offset > 0 ? grown_square(10, d) : (10 - 2 * d) * (10 - 2 * d), 50 * e);
        }
      }
    }
  }
}

/// Whether a polygon with vertices in general position crosses itself: brute force.
bool crosses_itself(const std::vector<Point2>& p) {
  const std::size_t n = p.size();
  const auto side = [](Point2 a, Point2 b, Point2 c) { return geom::cross(b - a, c - a) > 0; };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j + 1 == n) continue;
      const Point2 a = p[i], b = p[i + 1], c = p[j], d = p[(j + 1) % n];
      if (side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)) return true;
    }
  }
  return false;
}

TEST(Crossings, RandomPolygonsAgainstBruteForce) {
  int crossing = 0, simple = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Dice dice(seed);
    std::vector<Point2> p = fixture::star(dice, {0, 0}, 10, 40, 5 + dice.below(20));
    for (int swaps = dice.below(3); swaps > 0; --swaps)
      std::swap(p[static_cast<std::size_t>(dice.below(static_cast<int>(p.size())))],
                p[static_cast<std::size_t>(dice.below(static_cast<int>(p.size())))]);
    LaserOptions o = offset_by(1e-3);
    o.tolerance.path_mm = 1e-4;  // so that next to no random crossing is shallow
    const Made m = make(Sketch().polygon(p), o);
    const bool crosses = crosses_itself(p);
    (crosses ? crossing : simple) += 1;
    EXPECT_EQ(m.notes.count("self_crossing"), crosses ? 1u : 0u) << "seed " << seed << "\n"
                                                                 << listed(m.notes);
  }
  EXPECT_GT(crossing, 50);
  EXPECT_GT(simple, 50);
}

TEST(Crossings, RandomPairsAgainstBruteForce) {
  int crossing = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Dice dice(seed + 1000);
    const auto p = fixture::star(dice, {0, 0}, 15, 30, 4 + dice.below(12));
    const auto q = fixture::star(dice, {dice.in(-60, 60), dice.in(-20, 20)}, 3, 20, 4 + dice.below(12));
    bool crosses = false;
    const auto side = [](Point2 a, Point2 b, Point2 c) { return geom::cross(b - a, c - a) > 0; };
    for (std::size_t i = 0; i < p.size(); ++i) {
      for (std::size_t j = 0; j < q.size(); ++j) {
        const Point2 a = p[i], b = p[(i + 1) % p.size()], c = q[j], d = q[(j + 1) % q.size()];
        crosses = crosses || (side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b));
      }
    }
    crossing += crosses;
    LaserOptions o = offset_by(1e-3);
    o.tolerance.path_mm = 1e-4;
    const Made m = make(Sketch().polygon(p).polygon(q), o);
    EXPECT_EQ(m.notes.count("contours_cross"), crosses ? 1u : 0u) << "seed " << seed << "\n"
                                                                  << listed(m.notes);
  }
  EXPECT_GT(crossing, 50);
  EXPECT_LT(crossing, 250);
}

// --- joints
// -------------------------------------------------------------------------------------------------------

TEST(Joints, GapsAreClosedWithoutBendingWhatWasDrawn) {
  // A ring of 359 degrees closed by a line 0.005 too short: pulling the arc's ends together would move its
  // far side by a hundred times the gap.
  const double r = 50, half = geom::radians(0.5);
  const Point2 a{r * std::cos(half), r * std::sin(half)}, b{r * std::cos(half), -r * std::sin(half)};
  for (const Point2 shift : {Point2{0, 0.005}, Point2{0.005, 0}, Point2{-0.003, -0.004}}) {
    Sketch s;
    s.add({geom::Arc2{{0, 0}, r, half, 2 * kPi - 2 * half}}, false);
    s.add({geom::Line2{{b.x + shift.x, b.y + shift.y}, {a.x, a.y}}}, false);
    const Made m = make(s, offset_by(0));
    REQUIRE_PROFILE(m);
    ASSERT_EQ(m->paths.size(), 1u);
    EXPECT_EQ(m.notes.count("ends_joined"), 1u);
    double worst = 0;
    for (const geom::Segment& seg : m->paths[0].spline.segments) {
      for (int i = 0; i <= 50; ++i) {
        const Point2 p = geom::point_on(seg, i / 50.0);
        if (p.x < 0.9 * r) worst = std::max(worst, std::abs(std::hypot(p.x, p.y) - r));
      }
    }
    EXPECT_LE(worst, 0.005);
    EXPECT_NEAR(std::abs(m.area(0)), kPi * r * r, 0.01 * 2 * kPi * r);
  }
}

TEST(Joints, GapsDoNotBreakSmoothPieces) {
  // Splines whose ends are 0.006 apart: the curve stays G1 and near itself.
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Dice dice(seed);
    Sketch s;
    const auto ring = fixture::star(dice, {0, 0}, 10, 14, 5);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
      const double turn = dice.in(0, 2 * kPi);
      const Vec2 gap{0.006 * std::cos(turn), 0.006 * std::sin(turn)};
      const Point2 m1 = geom::lerp(a, b, 0.3) + 0.1 * geom::left(b - a),
                   m2 = geom::lerp(a, b, 0.7) - 0.1 * geom::left(b - a);
      s.add({geom::Nurbs2{3, {0, 0, 0, 0, 1, 1, 1, 1}, {a + gap, m1, m2, b}, {1, 1, 1, 1}}}, false);
    }
    for (const double d : {0.0, 0.25}) {
      const Made m = make(s, offset_by(d));
      REQUIRE_PROFILE(m);
      ASSERT_EQ(m->paths.size(), 1u);
      EXPECT_EQ(m.notes.count("ends_joined"), 1u) << listed(m.notes);
      EXPECT_EQ(m->g1_breaks, 0) << "seed " << seed << " d " << d;
    }
  }
}

TEST(Joints, WideGapsAreBridged) {
  LaserOptions o = offset_by(0.2);
  o.tolerance.join_mm = 0.5;
  Sketch s;
  s.add({geom::Line2{{0, 0}, {10, 0}}}, false).add({geom::Line2{{10.3, 0.2}, {10.3, 10}}}, false);
  s.add({geom::Line2{{10, 10}, {0, 10}}}, false).add({geom::Line2{{0, 10}, {0, 0}}}, false);
  const Made m = make(s, o);
  REQUIRE_PROFILE(m);
  ASSERT_EQ(m->paths.size(), 1u);
  EXPECT_EQ(m->paths[0].role, Role::outer);
  EXPECT_EQ(m->g1_breaks, 0);
  EXPECT_NEAR(m.area(0), grown_square(10, 0.2), 4);
}

// --- free curves against the exact offset
// -------------------------------------------------------------------------

/// The nearest point of a curve by sampling and golden section: independent of the fit.
class Ruler {
 public:
  explicit Ruler(std::vector<Curve2> curves) : curves_(std::move(curves)) {
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      for (int i = 0; i <= kSamples; ++i)
        samples_.push_back({c, i, geom::point_at(curves_[c], 1.0 * i / kSamples)});
    }
  }

  double distance(Point2 p) const {
    double best = 1e300;
    for (const Sample& s : samples_) best = std::min(best, geom::distance2(s.p, p));
    best = std::sqrt(best);
    double refined = best;
    for (const Sample& s : samples_) {
      // Half the spacing of the samples, generously.
      if (geom::distance(s.p, p) < best + 0.05) refined = std::min(refined, refine(s, p));
    }
    return refined;
  }

 private:
  struct Sample {
    std::size_t curve;
    int i;
    Point2 p;
  };
  static constexpr int kSamples = 1500;

  double refine(const Sample& s, Point2 p) const {
    double lo = std::max(0.0, (s.i - 1.0) / kSamples), hi = std::min(1.0, (s.i + 1.0) / kSamples);
    const auto at = [&](double t) { return geom::distance(geom::point_at(curves_[s.curve], t), p); };
    for (int k = 0; k < 40; ++k) {
      const double a = lo + 0.382 * (hi - lo), b = lo + 0.618 * (hi - lo);
      (at(a) < at(b) ? hi : lo) = at(a) < at(b) ? b : a;
    }
    return at(0.5 * (lo + hi));
  }

  std::vector<Curve2> curves_;
  std::vector<Sample> samples_;
};

struct FreeCase {
  std::string name;
  std::vector<Curve2> curves;
};

std::vector<FreeCase> free_cases() {
  std::vector<FreeCase> cases;
  cases.push_back({"ellipse", {geom::EllipseArc2{{3, 4}, {20, 5}, {-2, 8}, 0, 2 * kPi}}});
  cases.push_back({"ellipse, clockwise", {geom::EllipseArc2{{3, 4}, {12, 0}, {0, 6}, 1, -2 * kPi}}});
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    Dice dice(seed);
    cases.push_back({"ring " + std::to_string(seed),
                     {fixture::smooth_ring(fixture::star(dice, {0, 0}, 8, 16, 6 + static_cast<int>(seed)))}});
  }
  FreeCase k{"K", {}};
  for (const geom::Nurbs2& c : geom::letter_k()) k.curves.push_back(c);
  cases.push_back(k);
  return cases;
}

TEST(FreeCurves, PathsStayWithinTheCertifiedDistanceOfTheExactOffset) {
  for (const FreeCase& c : free_cases()) {
    const Ruler ruler(c.curves);
    Sketch s;
    for (const Curve2& curve : c.curves) s.add({curve}, c.curves.size() == 1);
    for (const double d : {0.28, -0.28, 0.0}) {
      for (const geom::FitMethod fit : {geom::FitMethod::minimal, geom::FitMethod::bisect}) {
        SCOPED_TRACE(c.name + ", offset " + std::to_string(d) +
                     (fit == geom::FitMethod::minimal ? "" : ", bisect"));
        LaserOptions o = offset_by(d);
        o.fit = fit;
        const Made m = make(s, o);
        REQUIRE_PROFILE(m);
        ASSERT_EQ(m->paths.size(), 1u);
        EXPECT_EQ(m->g1_breaks, 0);
        EXPECT_LE(m->max_deviation_mm, o.tolerance.path_mm);
        EXPECT_GT(m->max_deviation_mm, 0);
        EXPECT_GT(m->fitted_segments, 4u);
        double worst = 0;
        for (const geom::Segment& seg : m->paths[0].spline.segments) {
          for (const double f : {0.03, 0.25, 0.5, 0.75, 0.97})
            worst = std::max(worst, std::abs(ruler.distance(geom::point_on(seg, f)) - std::abs(d)));
        }
        EXPECT_LE(worst, m->max_deviation_mm + 1e-7);
        // And to the right side of the outline.
        const double area = std::abs(geom::signed_area(m->outlines[0].spline));
        if (d != 0) {
          EXPECT_EQ(m.area(0) > area, d > 0);
        }
      }
    }
  }
}

TEST(FreeCurves, NothingOfTheExactOffsetIsMissing) {
  // An ellipse bent nowhere tighter than d: all of its exact offset must have the path beside it.
  const geom::EllipseArc2 e{{0, 0}, {20, 0}, {0, 10}, 0, 2 * kPi};  // least radius 5
  for (const double d : {2.0, -2.0}) {
    LaserOptions o = offset_by(d);
    o.tolerance.path_mm = 0.003;
    const Made m = make(Sketch().add({e}, true), o);
    REQUIRE_PROFILE(m);
    for (int i = 0; i < 2000; ++i) {
      const double u = 2 * kPi * i / 2000;
      const Vec2 normal = geom::unit(Vec2{10 * std::cos(u), 20 * std::sin(u)});
      const Point2 p = Point2{20 * std::cos(u), 10 * std::sin(u)} + d * normal;
      EXPECT_LE(geom::distance_to(m->paths[0].spline, p), m->max_deviation_mm + 1e-9);
    }
  }
}

TEST(FreeCurves, WithoutArcsTheFitLeavesRoomForTheChords) {
  LaserOptions o = offset_by(0.3);
  o.arcs = false;
  const Made m = make(Sketch().ellipse({0, 0}, {20, 0}, {0, 10}), o);
  REQUIRE_PROFILE(m);
  EXPECT_LE(m->max_deviation_mm, 0.5 * o.tolerance.path_mm);
}

// --- the same part drawn differently
// ------------------------------------------------------------------------------

struct Summary {
  std::vector<std::pair<double, double>> area_length;
  std::vector<std::string> codes;
};

Summary summary(const Made& m) {
  Summary s;
  for (const CutPath& p : m->paths)
    s.area_length.emplace_back(geom::signed_area(p.spline), geom::length_of(p.spline));
  std::sort(s.area_length.begin(), s.area_length.end());
  for (const Warning& w : m.notes.warnings()) s.codes.push_back(w.code);
  std::sort(s.codes.begin(), s.codes.end());
  return s;
}

void expect_same(const Made& a, const Made& b, double near) {
  REQUIRE_PROFILE(a);
  REQUIRE_PROFILE(b);
  const Summary x = summary(a), y = summary(b);
  EXPECT_EQ(x.codes, y.codes) << listed(a.notes) << "---\n" << listed(b.notes);
  ASSERT_EQ(x.area_length.size(), y.area_length.size());
  for (std::size_t i = 0; i < x.area_length.size(); ++i) {
    EXPECT_NEAR(x.area_length[i].first, y.area_length[i].first,
                near * std::max(1.0, x.area_length[i].second));
    EXPECT_NEAR(x.area_length[i].second, y.area_length[i].second, 20 * near);
  }
}

io::Drawing reversed_drawing(io::Drawing d) {
  for (io::Entity& e : d.entities) {
    for (io::Path& p : e.paths) {
      std::reverse(p.curves.begin(), p.curves.end());
      for (Curve2& c : p.curves) c = geom::reversed(c);
    }
  }
  return d;
}

io::Drawing restarted(io::Drawing d, std::size_t by) {
  for (io::Entity& e : d.entities) {
    for (io::Path& p : e.paths) {
      if (p.closed)
        std::rotate(p.curves.begin(), p.curves.begin() + static_cast<std::ptrdiff_t>(by % p.curves.size()),
                    p.curves.end());
    }
  }
  return d;
}

TEST(Metamorphic, DrawnDifferentlyTheSamePart) {
  for (std::uint64_t seed = 0; seed < 25; ++seed) {
    const bool free_curves = seed % 5 == 4;
    const Sketch s = fixture::random_part(seed, free_curves);
    // Fits may differ within the tolerance when the curve is taken the other way round.
    const double near = free_curves ? 0.01 : 1e-6;
    for (const double d : {0.3, -0.3}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", offset " + std::to_string(d));
      const LaserOptions o = offset_by(d);
      const Made plain = make(s, o);
      {
        SCOPED_TRACE("reversed");
        expect_same(plain, make(reversed_drawing(s.drawing), o), near);
      }
      {
        SCOPED_TRACE("restarted");
        for (const std::size_t by : {1u, 2u, 5u}) expect_same(plain, make(restarted(s.drawing, by), o), near);
      }
      {
        SCOPED_TRACE("turned and moved");
        io::Drawing moved = s.drawing;
        const double a = 0.1 + static_cast<double>(seed);
        for (io::Entity& e : moved.entities)
          io::transform(e.paths, {std::cos(a), std::sin(a), -std::sin(a), std::cos(a), 812.3, -77.7});
        expect_same(plain, make(moved, o), near);
      }
      {
        SCOPED_TRACE("mirrored");
        io::Drawing mirrored = s.drawing;
        for (io::Entity& e : mirrored.entities) io::transform(e.paths, {-1, 0, 0, 1, 3, 4});
        expect_same(plain, make(mirrored, o), near);
      }
      {
        SCOPED_TRACE("shuffled");
        io::Drawing shuffled = s.drawing;
        Dice dice(seed);
        std::shuffle(shuffled.entities.begin(), shuffled.entities.end(), dice.engine);
        expect_same(plain, make(shuffled, o), near);
      }
    }
  }
}

TEST(Metamorphic, PiecesInAnyOrder) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Dice dice(seed);
    const auto outer = fixture::star(dice, {0, 0}, 20, 30, 12), hole = fixture::star(dice, {0, 0}, 5, 12, 7);
    Sketch whole, parts;
    whole.polygon(outer).polygon(hole);
    parts.pieces(outer).pieces(hole);
    std::shuffle(parts.drawing.entities.begin(), parts.drawing.entities.end(), dice.engine);
    expect_same(make(whole, offset_by(0.3)), make(parts, offset_by(0.3)), 1e-6);
  }
}

}  // namespace
}  // namespace burin::laser
