// SPDX-License-Identifier: Apache-2.0
// CL data -> joints -> NC -> our reader: the same poses within the decimals, the feed of the tip on the part.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "burin/nc/program.h"
#include "burin/post/emit.h"

namespace burin::post {
namespace {

using geom::Vec3;
using kinematics::Kinematics;

Kinematics preset(const std::string& name) {
  return *Kinematics::make(*model::find_machine(name));
}

Vec3 axis_of(const std::string& machine, double a, double b) {
  if (machine == "xyza") return {0, std::sin(a), std::cos(a)};
  return {std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b)};
}

cl::Program random_program(const std::string& machine, unsigned seed) {
  std::mt19937 engine(seed);
  const auto in = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine()) / 4294967296.0;
  };
  cl::Program program;
  program.name = "random";
  program.add(cl::ToolChange{3, 4, 2});
  program.add(cl::Spindle{cl::Rotation::clockwise, 12000});
  program.add(cl::FeedRate{700});
  double a = in(-2, 2), b = in(0.2, 0.8);
  program.add(cl::Rapid{{{in(-20, 20), in(-20, 20), 50}, axis_of(machine, a, b)}});
  for (int i = 0; i < 30; ++i) {
    a += in(-0.2, 0.4), b = std::clamp(b + in(-0.1, 0.1), 0.2, 0.9);
    program.add(cl::Feed{{{in(-20, 20), in(-20, 20), in(10, 30)}, axis_of(machine, a, b)}});
    if (i == 15) program.add(cl::Comment{"half way"});
  }
  return program;
}

const std::vector<std::string> kMachines{"xyza", "xyzac-trunnion", "xyzbc-head-table", "propeller-head-head"};

TEST(EmitJoints, ReadBackTheSamePosesAndTimes) {
  for (const std::string& name : kMachines) {
    const Kinematics machine = preset(name);
    for (const char* dialect_name : {"linuxcnc", "fanuc"}) {
      for (unsigned seed = 0; seed < 10; ++seed) {
        const cl::Program program = random_program(name, seed);
        const auto path = kinematics::make_joint_path(machine, program, {});
        ASSERT_TRUE(path.ok()) << path.error().to_string();
        const auto dialect = find_dialect(dialect_name);
        Diagnostics diagnostics;
        const auto nc = emit_joints(program, machine, *path, *dialect, {}, diagnostics);
        ASSERT_TRUE(nc.ok()) << nc.error().to_string();
        nc::InterpretOptions options;
        options.machine = &machine;
        const auto back = nc::interpret_joints(nc->text, options, diagnostics);
        ASSERT_TRUE(back.ok()) << back.error().to_string() << nc->text;
        ASSERT_EQ(back->joints.size() + nc->vanished, path->moves.size());
        if (nc->vanished > 0) continue;  // the moves no longer pair up
        std::vector<double> feeds;
        double feed = 0;
        for (const cl::Record& record : back->program.records) {
          if (const auto* rate = std::get_if<cl::FeedRate>(&record)) feed = rate->mm_min;
          if (cl::is_motion(record)) feeds.push_back(feed);
        }
        for (std::size_t i = 0; i < back->joints.size(); ++i) {
          for (std::size_t k = 0; k < 3; ++k)
            ASSERT_NEAR(back->joints[i].linear[k], path->moves[i].to.linear[k], 0.50001e-4);
          for (std::size_t k = 0; k < 2; ++k)
            ASSERT_NEAR(geom::degrees(back->joints[i].rotary[k] - path->moves[i].to.rotary[k]), 0,
                        0.50001e-4);
          if (i == 0) continue;
          const double length =
              kinematics::tip_motion(machine, path->moves[i - 1].to, path->moves[i].to).length;
          if (length < 0.05) continue;  // the decimals are more than a per cent of it
          ASSERT_NEAR(feeds[i] * path->moves[i].minutes / length, 1, 0.01);
          ASSERT_LT(feeds[i], 700 * 1.01);
        }
      }
    }
  }
}

// F of G94 makes the control take the same time for a block, as that control counts distance.
TEST(EmitJoints, PerMinuteFeedTakesTheSameTime) {
  const Kinematics machine = preset("xyza");
  const cl::Program program = random_program("xyza", 5);
  const auto path = kinematics::make_joint_path(machine, program, {});
  for (const char* dialect_name : {"linuxcnc", "fanuc"}) {
    const auto dialect = find_dialect(dialect_name);
    Diagnostics diagnostics;
    JointEmitOptions options;
    options.feed = FeedMode::per_minute;
    const auto nc = emit_joints(program, machine, *path, *dialect, options, diagnostics);
    ASSERT_TRUE(nc.ok());
    EXPECT_EQ(nc->text.find("G93"), std::string::npos);
    nc::LexOptions lex;
    const auto blocks = nc::lex(nc->text, lex);
    ASSERT_TRUE(blocks.ok());
    double at[4] = {}, f = 0;
    int code = 0;
    std::size_t move = 0;
    for (const nc::Block& block : *blocks) {
      double to[4] = {at[0], at[1], at[2], at[3]};
      bool moves = false;
      for (const nc::Word& word : block.words) {
        if (word.letter == 'G' && word.value <= 1) code = static_cast<int>(word.value);
        if (word.letter == 'F') f = word.value;
        for (int i = 0; i < 4; ++i)
          if (word.letter == "XYZA"[i]) to[i] = word.value, moves = true;
      }
      if (!moves) continue;
      const auto square = [&](int i) { return (to[i] - at[i]) * (to[i] - at[i]); };
      const double linear = square(0) + square(1) + square(2);
      const double counted = !dialect->feed_of_linear_only ? std::sqrt(linear + square(3))
                             : linear > 0                  ? std::sqrt(linear)
                                                           : std::sqrt(square(3));
      if (code == 1) {
        ASSERT_NEAR(counted / f / path->moves[move].minutes, 1, 1e-3) << dialect_name;
      }
      ++move;
      std::copy(to, to + 4, at);
    }
    EXPECT_EQ(move, path->moves.size());
  }
}

TEST(EmitJoints, SaysWhatTheDialectCannot) {
  const Kinematics machine = preset("xyza");
  const cl::Program program = random_program("xyza", 1);
  const auto path = kinematics::make_joint_path(machine, program, {});
  Diagnostics diagnostics;
  const auto grbl = emit_joints(program, machine, *path, *find_dialect("grbl"), {}, diagnostics);
  ASSERT_FALSE(grbl.ok());
  EXPECT_EQ(grbl.error().code, ErrorCode::unsupported);
}

}  // namespace
}  // namespace burin::post
