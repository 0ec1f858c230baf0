// SPDX-License-Identifier: Apache-2.0
#include "burin/model/machine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace burin::model {
namespace {

std::string axis_text(const std::string& letter, const std::string& kind, const std::string& side,
                      const std::string& direction, const std::string& more = "") {
  return "[[axes]]\nletter = \"" + letter + "\"\nkind = \"" + kind + "\"\nside = \"" + side +
         "\"\ndirection = " + direction + "\n" + more;
}
const std::string kX = axis_text("X", "linear", "head", "[1, 0, 0]");

TEST(Machine, PresetsOfTheSpecification) {
  const std::vector<std::string> names{"laser-xy",       "propeller-head-head", "xyz",           "xyza",
                                       "xyzac-trunnion", "xyzbc-head-table",    "xyzbc-trunnion"};
  EXPECT_EQ(machine_names(), names);
  const std::string letters[] = {"XY", "XYZCB", "XYZ", "AXYZ", "CAXYZ", "CXYZB", "CBXYZ"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto machine = find_machine(names[i]);
    ASSERT_TRUE(machine.ok()) << machine.error().to_string();
    EXPECT_EQ(machine->name, names[i]);
    std::string chain;
    for (const Axis& axis : machine->axes) {
      chain += axis.letter;
      EXPECT_NEAR(geom::norm(axis.direction), 1, 1e-15);
      EXPECT_EQ(axis.point, (geom::Point3{0, 0, 0}));
      EXPECT_GT(axis.speed, 0);
      EXPECT_GT(axis.acceleration, 0);
    }
    EXPECT_EQ(chain, letters[i]);
  }
}

TEST(Machine, LimitsAndPivotsOfThePresets) {
  const struct {
    const char* name;
    char letter;
    AxisSide side;
    double limit, pivot;
  } rows[] = {{"xyza", 'A', AxisSide::table, 99999, 0},
              {"xyzac-trunnion", 'A', AxisSide::table, 120, 0},
              {"xyzac-trunnion", 'C', AxisSide::table, 99999, 0},
              {"xyzbc-trunnion", 'B', AxisSide::table, 120, 0},
              {"xyzbc-head-table", 'B', AxisSide::head, 110, 150},
              {"xyzbc-head-table", 'C', AxisSide::table, 99999, 150},
              {"propeller-head-head", 'B', AxisSide::head, 100, 300},
              {"propeller-head-head", 'C', AxisSide::head, 99999, 300}};
  for (const auto& row : rows) {
    const auto machine = find_machine(row.name);
    ASSERT_TRUE(machine.ok());
    const Axis* axis = machine->axis(row.letter);
    ASSERT_NE(axis, nullptr);
    EXPECT_EQ(axis->kind, AxisKind::rotary);
    EXPECT_EQ(axis->side, row.side);
    EXPECT_EQ(axis->max, row.limit);
    EXPECT_EQ(axis->min, -row.limit);
    EXPECT_EQ(machine->pivot_length, row.pivot);
    EXPECT_EQ(machine->axis('U'), nullptr);
  }
}

TEST(Machine, TheExampleOfTheSpecification) {
  const auto machine = parse_machine(
      "name = \"mine\"\npivot_length = 0.0\n[[axes]]\nletter = \"C\"\nkind = \"rotary\"\nside = \"table\"\n"
      "direction = [0, 0, 2]\npoint = [0, 1, 0]\nmin = -90.0\nmax = 90\nspeed = 5000.0\nacceleration = "
      "500.0\n",
      "mine.toml");
  ASSERT_TRUE(machine.ok()) << machine.error().to_string();
  EXPECT_EQ(machine->axes[0].direction, (geom::Vec3{0, 0, 1}));
  EXPECT_EQ(machine->axes[0].point, (geom::Point3{0, 1, 0}));
  EXPECT_EQ(machine->axes[0].max, 90);
}

TEST(Machine, BadFilesAreRefusedWithPlaceAndRemedy) {
  const std::string name = "name = \"m\"\n";
  const struct {
    std::string text, message;
  } rows[] = {
      {name + "pivot_lenght = 1\n" + kX, "did you mean pivot_length?"},
      {name + axis_text("X", "linear", "head", "[1, 0, 0]", "sped = 1\n"), "did you mean speed?"},
      {"pivot_length = 0\n" + kX, "\"name\" is missing"},
      {name, "no axes"},
      {name + axis_text("Q", "linear", "head", "[1, 0, 0]"), "X, Y, Z, A, B, C"},
      {name + axis_text("X", "linaer", "head", "[1, 0, 0]"), "rotary, linear"},
      {name + axis_text("X", "rotary", "head", "[1, 0, 0]"), "X, Y, Z are linear"},
      {name + axis_text("X", "linear", "haed", "[1, 0, 0]"), "table, head"},
      {name + axis_text("X", "linear", "head", "[0, 0, 0]"), "no direction"},
      {name + axis_text("X", "linear", "head", "[1, 0]"), "three numbers"},
      {name + axis_text("X", "linear", "head", "[1, nan, 0]"), "three numbers"},
      {name + axis_text("X", "linear", "head", "[1, 0, 0]", "min = 5\nmax = 5\n"), "no travel"},
      {name + axis_text("X", "linear", "head", "[1, 0, 0]", "speed = -1\n"), "out of range"},
      {name + axis_text("X", "linear", "head", "[1, 0, 0]", "speed = inf\n"), "out of range"},
      {name + kX + kX, "stands twice"},
      {name + kX + axis_text("Y", "linear", "head", "[-1, 0, 0]"), "parallel"},
      {name + kX + axis_text("C", "rotary", "table", "[0, 0, 1]"), "from the workpiece outwards"},
      {name + "pivot_length = 10\n" + kX, "pivot_length without"},
      {name + axis_text("A", "rotary", "table", "[1,0,0]") + axis_text("B", "rotary", "table", "[0,1,0]") +
           axis_text("C", "rotary", "table", "[0,0,1]"),
       "at most two"},
      {name + "axes = 5\n", "not a list of tables"},
      {name + "axes = [1]\n", "no table"},
      {"name = \n", "TOML is wanted"},
      {"name = 5\n" + kX, "is not a text"},
  };
  for (const auto& row : rows) {
    const auto machine = parse_machine(row.text, "m.toml");
    ASSERT_FALSE(machine.ok()) << row.text;
    EXPECT_NE(machine.error().message.find(row.message), std::string::npos) << machine.error().to_string();
    EXPECT_EQ(machine.error().where.file, "m.toml");
    EXPECT_GT(machine.error().where.line, 0) << row.text;
  }
}

TEST(Machine, UnknownNamesAndFiles) {
  auto missing = find_machine("xyzz");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, ErrorCode::usage);
  EXPECT_NE(missing.error().message.find("did you mean xyz?"), std::string::npos);
  missing = find_machine("no/such/machine.toml");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, ErrorCode::io);
}

TEST(Machine, DamagedTextsNeverCrash) {
  std::mt19937_64 random(3);
  const std::string good =
      "name = \"m\"\n" + kX + axis_text("Y", "linear", "head", "[0, 1, 0]", "min = -5.0\n");
  ASSERT_TRUE(parse_machine(good, "m").ok());
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string text = good;
    for (int k = 0; k < 1 + i % 4; ++k) text[random() % text.size()] = static_cast<char>(random() % 256);
    refused += parse_machine(text, "m").ok() ? 0 : 1;
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace burin::model
