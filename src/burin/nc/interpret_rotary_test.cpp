// SPDX-License-Identifier: Apache-2.0
// Rotary words and inverse time: joints and poses as a machine of the catalogue makes them.
#include <gtest/gtest.h>

#include <cmath>

#include "burin/nc/program.h"

namespace burin::nc {
namespace {

class Rotary : public testing::Test {
 protected:
  Rotary() : machine_(*kinematics::Kinematics::make(*model::find_machine("xyza"))) {
    options_.file_name = "a.ngc";
    options_.machine = &machine_;
  }
  Result<JointProgram> read(const std::string& text) {
    Diagnostics diagnostics;
    return interpret_joints(text, options_, diagnostics);
  }
  kinematics::Kinematics machine_;
  InterpretOptions options_;
};

TEST_F(Rotary, PosesAreInThePartFrame) {
  const auto read_back = read("G21 G90 G93\nG0 X1 Y0 Z30 A90\nG1 Z20 F60\nG91 G1 A-45 F30\n");
  ASSERT_TRUE(read_back.ok()) << read_back.error().to_string();
  ASSERT_EQ(read_back->joints.size(), 3u);
  EXPECT_NEAR(read_back->joints[2].rotary[0], geom::kPi / 4, 1e-15);
  std::vector<cl::Pose> poses;
  std::vector<double> feeds;
  for (const cl::Record& record : read_back->program.records) {
    if (const cl::Pose* pose = cl::pose_of(record)) poses.push_back(*pose);
    if (const auto* feed = std::get_if<cl::FeedRate>(&record)) feeds.push_back(feed->mm_min);
  }
  ASSERT_EQ(poses.size(), 3u);
  // A turns the part: with A at 90 degrees the tool comes from the part's +Y.
  EXPECT_NEAR(geom::distance(poses[0].tip, {1, 30, 0}), 0, 1e-12);
  EXPECT_NEAR(norm(poses[0].axis - geom::Vec3{0, 1, 0}), 0, 1e-12);
  const double c = std::sqrt(0.5);
  EXPECT_NEAR(geom::distance(poses[2].tip, {1, 20 * c, 20 * c}), 0, 1e-12);
  // 10 mm in a minute's sixtieth; an eighth of a turn at 20 mm in a thirtieth.
  ASSERT_EQ(feeds.size(), 2u);
  EXPECT_NEAR(feeds[0], 600, 1e-9);
  EXPECT_NEAR(feeds[1], 20 * geom::kPi / 4 * 30, 1e-3);
}

TEST_F(Rotary, SaysWhereThePlaceIsNotKnown) {
  const auto moves = read("G21 G90 G0 A90\nX1 Y2\nZ5\nG1 Z1 F100\nG28 G91 Z0\nG90 G0 X7\nG0 Z9\n");
  ASSERT_TRUE(moves.ok()) << moves.error().to_string();
  EXPECT_EQ(moves->unknown, (std::vector<bool>{true, true, false, false, true, false}));
  options_.machine = nullptr;
  const auto tips = read("G21 G90 G0 X1 Y2\nG0 Z3\n");
  ASSERT_TRUE(tips.ok()) << tips.error().to_string();
  EXPECT_EQ(tips->unknown, (std::vector<bool>{true, false}));
  EXPECT_EQ(tips->joints[1].linear, (std::array<double, 3>{1, 2, 3}));
}

TEST_F(Rotary, RefusesWithLineAndColumn) {
  const struct {
    const char* text;
    int line, column;
    ErrorCode code;
  } cases[] = {
      {"G93\nG1 X1", 2, 1, ErrorCode::syntax},                               // no F
      {"G93\nG1 X1 F0", 2, 7, ErrorCode::range},                             //
      {"G94 F100 G1 X1\nG93 G1 X2 F5\nG94 G1 X3", 3, 5, ErrorCode::syntax},  // F of the other mode is gone
      {"G0 B5", 1, 4, ErrorCode::unsupported},                               // the machine has no B
      {"G0 A999999999", 1, 4, ErrorCode::range},
      {"G0 A45\nF100 G2 X2 I1", 2, 6, ErrorCode::unsupported},  // an arc on a turned part
  };
  for (const auto& c : cases) {
    const auto result = read(c.text);
    ASSERT_FALSE(result.ok()) << c.text;
    EXPECT_EQ(result.error().code, c.code) << result.error().to_string();
    EXPECT_EQ(result.error().where.line, c.line) << result.error().to_string();
    EXPECT_EQ(result.error().where.column, c.column) << result.error().to_string();
  }
}

TEST_F(Rotary, InverseTimeWithoutRotaryAxes) {
  options_.machine = nullptr;
  Diagnostics diagnostics;
  const auto program = interpret("G93 G0 X0\nG1 X10 F6\nG2 X20 I5 F2\n", options_, diagnostics);
  ASSERT_TRUE(program.ok()) << program.error().to_string();
  std::vector<double> feeds;
  for (const cl::Record& record : program->records)
    if (const auto* feed = std::get_if<cl::FeedRate>(&record)) feeds.push_back(feed->mm_min);
  ASSERT_EQ(feeds.size(), 2u);
  EXPECT_NEAR(feeds[0], 60, 1e-12);
  EXPECT_NEAR(feeds[1], 2 * 5 * geom::kPi, 1e-9);
}

}  // namespace
}  // namespace burin::nc
