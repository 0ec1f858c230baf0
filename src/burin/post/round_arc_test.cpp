// SPDX-License-Identifier: Apache-2.0
#include "burin/post/round_arc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "burin/post/words.h"

namespace burin::post {
namespace {

using geom::kPi;
using geom::Point2;
using geom::Vec2;

PlaneArc arc_of(Point2 center, double radius, double from, double sweep, bool clockwise) {
  const auto at = [&](double a) { return center + radius * Vec2{std::cos(a), std::sin(a)}; };
  PlaneArc arc{.center = center, .start = at(from), .clockwise = clockwise, .sweep = sweep};
  arc.end = sweep == 2 * kPi ? arc.start : at(from + (clockwise ? -sweep : sweep));
  return arc;
}

GridPoint grid_of(Point2 p, int decimals) {
  return {to_grid(p.x, decimals), to_grid(p.y, decimals)};
}

/// Every arc that goes out passes the control's check, turns the way it should, and all of them together turn
/// as far as the exact arc.
TEST(RoundArc, PiecesPassTheControlAndAddUp) {
  std::mt19937_64 engine(21);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::size_t arcs = 0;
  for (int i = 0; i < 15000; ++i) {
    const int decimals = i % 2 ? 3 : 4;
    const double unit = std::pow(10.0, -decimals);
    const double radius = std::exp(std::log(1e-4) + uniform(engine) * std::log(1e7));
    double sweep = 2 * kPi * uniform(engine);
    if (i % 5 == 0) sweep = std::pow(10, -8 * uniform(engine));
    if (i % 5 == 1) sweep = 2 * kPi - std::pow(10, -1 - 8 * uniform(engine));
    if (i % 25 == 2) sweep = 2 * kPi;
    const PlaneArc arc = arc_of({200 * uniform(engine) - 100, 200 * uniform(engine) - 100}, radius,
                                2 * kPi * uniform(engine), sweep, i % 3 == 0);
    const ArcGrid grid{.decimals = decimals, .min_radius_mm = 0.005, .max_radius_mm = 5000};
    const GridPoint start = grid_of(arc.start, decimals);
    const auto pieces = round_arc(arc, start, grid);
    ASSERT_TRUE(pieces);
    ASSERT_FALSE(pieces->empty());
    EXPECT_EQ(pieces->back().end, grid_of(arc.end, decimals));
    EXPECT_EQ(pieces->back().at, 1);
    GridPoint at = start;
    double done = 0;
    for (const ArcPiece& piece : *pieces) {
      ASSERT_GT(piece.at, done);
      const double part = (piece.at - done) * sweep;
      if (!piece.line) {
        ++arcs;
        const ControlRadii radii = control_radii(at, piece.end, piece.offset);
        ASSERT_LE(radii.difference * unit, std::max(0.005, 0.001 * radii.smaller * unit));
        ASSERT_NEAR(control_sweep(at, piece.end, piece.offset, arc.clockwise) * radii.smaller,
                    part * radii.smaller, 6.001);
        // A circle is only made of a circle.
        if (piece.end == at) {
          ASSERT_EQ(part, 2 * kPi);
        }
      }
      done = piece.at;
      at = piece.end;
    }
  }
  EXPECT_GT(arcs, 5000u);
}

TEST(RoundArc, SmallArcsAreLines) {
  const PlaneArc tiny = arc_of({0, 0}, 0.002, 0.3, 4, false);
  const auto tiny_pieces = round_arc(tiny, grid_of(tiny.start, 4), {.min_radius_mm = 0.005});
  ASSERT_TRUE(tiny_pieces);
  for (const ArcPiece& piece : *tiny_pieces) EXPECT_TRUE(piece.line);
  // Sagitta of 0.25 steps.
  const double sweep = std::sqrt(8 * 0.25e-4 / 100);
  const PlaneArc flat = arc_of({0, 0}, 100, 1, sweep, true);
  const auto pieces = round_arc(flat, grid_of(flat.start, 4), {});
  ASSERT_EQ(pieces->size(), 1u);
  EXPECT_TRUE(pieces->front().line);
}

TEST(RoundArc, LinesStayWithinHalfAStepOfALargeArc) {
  const PlaneArc large = arc_of({0, -20000}, 20000, kPi / 2 - 0.002, 0.004, false);
  const auto pieces = round_arc(large, grid_of(large.start, 3), {.decimals = 3, .max_radius_mm = 8000});
  ASSERT_TRUE(pieces);
  EXPECT_GT(pieces->size(), 4u);
  Point2 at = large.start;
  for (const ArcPiece& piece : *pieces) {
    EXPECT_TRUE(piece.line);
    const Point2 to{from_grid(piece.end.a, 3), from_grid(piece.end.b, 3)};
    EXPECT_LE(std::abs(distance(lerp(at, to, 0.5), large.center) - 20000), 0.0005 + 0.0008);
    at = to;
  }
}

TEST(RoundArc, GivesUpBeforeAMillionLines) {
  const PlaneArc huge = arc_of({0, 0}, 1e9, 0, 6, false);
  EXPECT_FALSE(round_arc(huge, {0, 0}, {.decimals = 6}));
}

TEST(RoundArc, RadiiOfAnotherSystemMayDiffer) {
  PlaneArc arc = arc_of({3, 4}, 25, 0.2, 3, false);
  arc.end = arc.center + 1.0004 * (arc.end - arc.center);
  const auto pieces = round_arc(arc, grid_of(arc.start, 4), {});
  ASSERT_TRUE(pieces);
  EXPECT_LE(pieces->size(), 4u);
}

TEST(Words, GridTextIsTheDecimal) {
  EXPECT_EQ(grid_text(0, 3, false), "0");
  EXPECT_EQ(grid_text(0, 3, true), "0.");
  EXPECT_EQ(grid_text(-5, 3, false), "-0.005");
  EXPECT_EQ(grid_text(12340, 3, false), "12.34");
  EXPECT_EQ(grid_text(-12000, 3, true), "-12.");
}

}  // namespace
}  // namespace burin::post
