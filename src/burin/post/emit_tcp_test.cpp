// SPDX-License-Identifier: Apache-2.0
// CL data -> tip and rotary words -> our reader: the same poses within the decimals, the tip's feed.
#include "burin/post/emit_tcp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "burin/nc/program.h"

namespace burin::post {
namespace {

using geom::Vec3;
using kinematics::Kinematics;

Kinematics preset(const std::string& name) {
  return *Kinematics::make(*model::find_machine(name));
}

cl::Program random_program(unsigned seed) {
  std::mt19937 engine(seed);
  const auto in = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine()) / 4294967296.0;
  };
  cl::Program program;
  program.name = "random";
  program.add(cl::ToolChange{7, 50, 0});
  program.add(cl::Spindle{cl::Rotation::clockwise, 900});
  program.add(cl::FeedRate{700});
  double a = in(-2, 2), b = in(0.2, 0.8);
  const auto pose = [&](double z) {
    return cl::Pose{{in(-20, 20), in(-20, 20), z},
                    {std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b)}};
  };
  program.add(cl::Rapid{pose(60)});
  for (int i = 0; i < 25; ++i) {
    a += in(-0.2, 0.4), b = std::clamp(b + in(-0.1, 0.1), 0.2, 0.9);
    program.add(cl::Feed{pose(in(10, 30))});
    if (i == 12) program.add(cl::FeedRate{300});
  }
  program.add(cl::Rapid{pose(60)});
  return program;
}

kinematics::JointPath path_of(const Kinematics& machine, const cl::Program& program) {
  kinematics::JointPathOptions options;
  options.tool_centre = true;
  auto path = kinematics::make_joint_path(machine, program, options);
  EXPECT_TRUE(path.ok()) << path.error().to_string();
  return *path;
}

TEST(EmitTcp, ReadBackTheSamePosesAndFeeds) {
  for (const std::string name :
       {"xyzac-trunnion", "xyzbc-trunnion", "xyzbc-head-table", "propeller-head-head"}) {
    const Kinematics machine = preset(name);
    for (unsigned seed = 0; seed < 6; ++seed) {
      const cl::Program program = random_program(seed);
      const kinematics::JointPath path = path_of(machine, program);
      Diagnostics diagnostics;
      const auto nc = emit_tcp(program, machine, path, *find_dialect("fanuc"), {true}, diagnostics);
      ASSERT_TRUE(nc.ok()) << nc.error().to_string();
      EXPECT_NE(nc->text.find("G43.4 H7\n"), std::string::npos);
      EXPECT_NE(nc->text.find("\nG49\n"), std::string::npos);
      EXPECT_EQ(nc->text.find("G43 H"), std::string::npos);
      EXPECT_EQ(nc->text.find("G93"), std::string::npos);
      nc::InterpretOptions options;
      options.machine = &machine;
      const auto back = nc::interpret_joints(nc->text, options, diagnostics);
      ASSERT_TRUE(back.ok()) << back.error().to_string() << nc->text;
      // The first motion turns the axes before the control takes the tip over.
      ASSERT_EQ(back->joints.size() + nc->vanished, path.moves.size() + 1);
      if (nc->vanished > 0) continue;
      std::vector<cl::Pose> poses;
      std::vector<double> feeds;
      double feed = 0;
      for (const cl::Record& record : back->program.records) {
        if (const auto* rate = std::get_if<cl::FeedRate>(&record)) feed = rate->mm_min;
        if (const cl::Pose* pose = cl::pose_of(record)) poses.push_back(*pose), feeds.push_back(feed);
      }
      for (std::size_t i = 0; i < path.moves.size(); ++i) {
        const kinematics::JointMove& move = path.moves[i];
        const cl::Pose should = machine.forward(move.to);
        const Vec3 off = poses[i + 1].tip - should.tip;
        ASSERT_LT(std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}), 0.50001e-4) << name;
        ASSERT_LT(norm(poses[i + 1].axis - should.axis), 2e-6) << name;
        // Joints are those of the tip's place, whatever the control does with it.
        ASSERT_LT(geom::distance(machine.forward(back->joints[i + 1]).tip, poses[i + 1].tip), 1e-9);
        if (move.rapid || i == 0) continue;
        const double length = geom::distance(should.tip, machine.forward(path.moves[i - 1].to).tip);
        if (length < 0.05) continue;
        ASSERT_NEAR(feeds[i + 1] * move.minutes / length, 1, 0.002);
        ASSERT_LE(feeds[i + 1], 700 * 1.0001);
      }
    }
  }
}

// A rest of the tip while the table turns: the feed counts degrees, and takes the table's time.
TEST(EmitTcp, TurnsInPlaceAtTheTablesSpeed) {
  const Kinematics machine = preset("xyzac-trunnion");
  cl::Program program;
  program.add(cl::FeedRate{600});
  program.add(cl::Rapid{{{10, 0, 0}, {0, 0, 1}}});
  program.add(cl::Feed{{{20, 0, 0}, unit(Vec3{0, -0.2, 1})}});
  program.add(cl::Feed{{{20, 0, 0}, unit(Vec3{0, -0.6, 1})}});
  program.add(cl::Feed{{{30, 0, 0}, unit(Vec3{0, -0.6, 1})}});
  const kinematics::JointPath path = path_of(machine, program);
  Diagnostics diagnostics;
  const auto nc = emit_tcp(program, machine, path, *find_dialect("fanuc"), {true}, diagnostics);
  ASSERT_TRUE(nc.ok());
  EXPECT_NE(nc->text.find("G43.4 H1\n"), std::string::npos);  // no tool was loaded
  EXPECT_NE(nc->text.find(" F5000."), std::string::npos) << nc->text;
  EXPECT_NE(nc->text.find("X30. F600."), std::string::npos) << nc->text;
}

TEST(EmitTcp, SaysWhatTheDialectOrMachineCannot) {
  const cl::Program program = random_program(1);
  const Kinematics machine = preset("xyzac-trunnion");
  Diagnostics diagnostics;
  for (const char* dialect : {"linuxcnc", "grbl"}) {
    const auto nc = emit_tcp(program, machine, {}, *find_dialect(dialect), {}, diagnostics);
    ASSERT_FALSE(nc.ok());
    EXPECT_EQ(nc.error().code, ErrorCode::unsupported);
    EXPECT_NE(nc.error().message.find("fanuc"), std::string::npos) << nc.error().message;
  }
  EXPECT_EQ(emit_tcp(program, preset("xyz"), {}, *find_dialect("fanuc"), {}, diagnostics).error().code,
            ErrorCode::unsupported);
  EXPECT_FALSE(parse_dialect("name = \"half\"\ntcp_on = \"G43.4 H{number}\"\n", "half.toml").ok());
}

TEST(EmitTcp, ReaderKnowsWhereTheTipIsWhenTheModeChanges) {
  const Kinematics machine = preset("xyzac-trunnion");
  nc::InterpretOptions options;
  options.machine = &machine;
  Diagnostics diagnostics;
  const auto back = nc::interpret_joints(
      "G21 G90 G0 X1 Y2 Z30 A30 C40\nG43.4 H1\nG1 X5 Y6 Z7 F100\nA10\nG49\nG0 Z50\n", options, diagnostics);
  ASSERT_TRUE(back.ok()) << back.error().to_string();
  ASSERT_EQ(back->joints.size(), 4u);
  const cl::Pose at = machine.forward(back->joints[1]);
  EXPECT_LT(geom::distance(at.tip, {5, 6, 7}), 1e-12);
  EXPECT_LT(geom::distance(machine.forward(back->joints[2]).tip, {5, 6, 7}), 1e-12);
  // After G49 X and Y are joints again and stand where they were.
  EXPECT_NEAR(back->joints[3].linear[0], back->joints[2].linear[0], 1e-12);
  EXPECT_NEAR(back->joints[3].linear[1], back->joints[2].linear[1], 1e-12);
  EXPECT_EQ(back->joints[3].linear[2], 50);

  options.machine = nullptr;
  const auto none = nc::interpret("G21 G0 X1\nG43.4 H1\n", options, diagnostics);
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().where.line, 2);
}

}  // namespace
}  // namespace burin::post
