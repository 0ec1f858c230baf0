// SPDX-License-Identifier: Apache-2.0
#include "burin/model/tool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace burin::model {
namespace {

BallTool good() {
  return {.radius = 2, .shank_radius = 2.5, .shank_length = 60, .holder = {{20, 50}, {30, 10}}};
}

void expect_range(const BallTool& tool, const std::string& what, const std::string& accepted) {
  const auto result = validate(tool);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::range);
  EXPECT_NE(result.error().message.find(what), std::string::npos) << result.error().message;
  EXPECT_NE(result.error().message.find("(" + accepted), std::string::npos) << result.error().message;
}

TEST(BallTool, WhatIsAccepted) {
  EXPECT_TRUE(validate(good()).ok());
  BallTool tool = good();
  tool.holder.clear();
  tool.shank_length = tool.radius;
  EXPECT_TRUE(validate(tool).ok());
}

TEST(BallTool, NumbersThatAreNoSizes) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, std::nan(""), inf, -inf, 1e5}) {
    BallTool tool = good();
    tool.radius = bad;
    expect_range(tool, "radius of the ball", "above 0, up to 10000");
    tool = good();
    tool.shank_radius = bad;
    expect_range(tool, "radius of the shank", "above 0");
    tool = good();
    tool.shank_length = bad;
    expect_range(tool, "length of the shank", "above 0");
    tool = good();
    tool.holder[1].radius = bad;
    expect_range(tool, "radius of piece 2", "above 0");
    tool = good();
    tool.holder[0].height = bad;
    expect_range(tool, "height of piece 1", "above 0");
  }
}

TEST(BallTool, TheHolderDoesNotBeginInTheBall) {
  BallTool tool = good();
  tool.shank_length = 1.5;
  expect_range(tool, "from the centre of the ball to the holder is 1.5 mm",
               "at least the radius of the ball, 2");
}

TEST(BallTool, HoldersHaveABound) {
  BallTool tool = good();
  tool.holder.assign(1001, {20, 1});
  const auto result = validate(tool);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().message.find("(up to 1000)"), std::string::npos);
}

}  // namespace
}  // namespace burin::model
