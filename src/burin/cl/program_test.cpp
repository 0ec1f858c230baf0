// SPDX-License-Identifier: Apache-2.0
#include "burin/cl/program.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace burin::cl {
namespace {

using geom::kPi;

Program start() {
  Program p;
  p.add(Rapid{{{10, 0, 0}}});
  p.add(FeedRate{100});
  return p;
}

TEST(Program, TotalsAreTheClosedForms) {
  Program p = start();
  p.add(Arc{{0, 0, 0}, {0, 0, 1}, 10, {{0, 10, 0}}});    // quarter
  p.add(Arc{{0, 0, 0}, {0, 0, -1}, 10, {{-10, 0, 0}}});  // three quarters, the other way
  p.add(Arc{{0, 0, 0}, {0, 0, 1}, 10, {{-10, 0, 0}}});   // full
  p.add(Arc{{0, 0, 0}, {0, 0, 1}, 10, {{-10, 0, 5}}});   // full, rising
  p.add(Feed{{{-10, 3, 9}}});
  p.add(Rapid{{{0, 3, 9}}});
  p.add(Dwell{2});
  const Totals t = totals(p);
  const double expected = 5 * kPi + 15 * kPi + 20 * kPi + std::hypot(20 * kPi, 5) + 5;
  EXPECT_NEAR(t.feed_mm, expected, 1e-9);
  EXPECT_NEAR(t.rapid_mm, 10, 1e-12);
  EXPECT_EQ(t.dwell_s, 2);
  EXPECT_EQ(t.moves, 7u);
  EXPECT_EQ(p.move_count(), t.moves);
  EXPECT_TRUE(validate(p));
}

TEST(Program, SweepOfEveryAngle) {
  for (int degree = 1; degree <= 360; ++degree) {
    for (double sense : {1.0, -1.0}) {
      const double a = sense * geom::radians(degree);
      const Arc arc{{1, 2, 3}, {0, 0, sense}, 5, {{1 + 5 * std::cos(a), 2 + 5 * std::sin(a), 3}}};
      EXPECT_NEAR(arc_sweep({6, 2, 3}, arc), geom::radians(degree), 1e-12);
    }
  }
}

TEST(Program, ValidateNamesTheRecord) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const struct {
    Record record;
    ErrorCode code;
  } cases[] = {
      {Feed{{{nan, 0, 0}}}, ErrorCode::range},
      {Feed{{{0, 0, 0}, {0, 0, 1.01}}}, ErrorCode::range},
      {Rapid{{{0, 0, 0}, {0, 0, 0}}}, ErrorCode::range},
      {Arc{{0, 0, 0}, {0, 0, 1}, 9.99, {{0, 10, 0}}}, ErrorCode::geometry},
      {Arc{{0, 0, 0}, {0, 0, 1}, 10, {{0, 10.01, 0}}}, ErrorCode::geometry},
      {Arc{{0, 0, 1}, {0, 0, 1}, 10, {{0, 10, 0}}}, ErrorCode::geometry},
      {Arc{{0, 0, 0}, {0, 0, 1}, -10, {{0, 10, 0}}}, ErrorCode::range},
      {Arc{{0, 0, 0}, {0, 0, 2}, 10, {{0, 10, 0}}}, ErrorCode::range},
      {FeedRate{0}, ErrorCode::range},
      {FeedRate{nan}, ErrorCode::range},
      {Dwell{-1}, ErrorCode::range},
      {Beam{true, -1}, ErrorCode::range},
      {Spindle{Rotation::clockwise, nan}, ErrorCode::range},
      {ToolChange{-1}, ErrorCode::range},
      {Comment{"a\nb"}, ErrorCode::range},
  };
  for (const auto& c : cases) {
    Program p = start();
    p.add(c.record);
    const auto ok = validate(p);
    ASSERT_FALSE(ok);
    EXPECT_EQ(ok.error().code, c.code) << ok.error().message;
    EXPECT_NE(ok.error().message.find("record 2"), std::string::npos) << ok.error().message;
    if (is_motion(c.record)) {
      EXPECT_NE(ok.error().message.find("move 1"), std::string::npos);
    }
  }
}

TEST(Program, AFeedMoveNeedsAFeedAndAnArcAStart) {
  Program p;
  p.add(Feed{{{1, 0, 0}}});
  EXPECT_FALSE(validate(p));
  Program q;
  q.add(FeedRate{1});
  q.add(Arc{{0, 0, 0}, {0, 0, 1}, 10, {{0, 10, 0}}});
  EXPECT_FALSE(validate(q));
  q.from = Pose{{10, 0, 0}};
  EXPECT_TRUE(validate(q));
  EXPECT_NEAR(totals(q).feed_mm, 5 * kPi, 1e-12);
  q.source.pop_back();
  EXPECT_FALSE(validate(q));
}

}  // namespace
}  // namespace burin::cl
