// SPDX-License-Identifier: Apache-2.0
#include "burin/post/dialect.h"

#include <gtest/gtest.h>

namespace burin::post {
namespace {

TEST(Dialect, TheOnesThatComeWithBurin) {
  EXPECT_EQ(dialect_names(), (std::vector<std::string>{"fanuc", "grbl", "linuxcnc"}));
  for (const std::string& name : dialect_names()) {
    const auto dialect = find_dialect(name);
    ASSERT_TRUE(dialect) << dialect.error().to_string();
    EXPECT_EQ(dialect->name, name);
    EXPECT_FALSE(dialect->beam_on.empty());
    std::string header;
    for (const std::string& line : dialect->header) header += line + ' ';
    for (const char* word : {"G21", "G90", "G17", "G40", "G94"})
      EXPECT_NE(header.find(word), std::string::npos) << name;
  }
  EXPECT_EQ(find_dialect("linuxcnc")->decimals, 4);
  EXPECT_EQ(find_dialect("fanuc")->decimals, 4);
  EXPECT_EQ(find_dialect("grbl")->decimals, 3);
}

TEST(Dialect, AnUnknownNameNamesTheKnownOnes) {
  const auto dialect = find_dialect("siemens");
  ASSERT_FALSE(dialect);
  EXPECT_EQ(dialect.error().code, ErrorCode::usage);
  EXPECT_NE(dialect.error().message.find("fanuc, grbl, linuxcnc"), std::string::npos);
}

TEST(Dialect, FieldsAreRead) {
  const auto dialect = parse_dialect(
      "name = \"x\"\ndecimals = 2\npower_scale = 10\nheader = [\"G21\", \"({name})\"]\n"
      "require_point = true\nbeam_on = \"M10 E{power}\"\nbeam_off = \"M11\"\n",
      "x.toml");
  ASSERT_TRUE(dialect) << dialect.error().to_string();
  EXPECT_EQ(dialect->decimals, 2);
  EXPECT_EQ(dialect->power_scale, 10);
  EXPECT_EQ(dialect->header.size(), 2u);
  EXPECT_TRUE(dialect->require_point);
  EXPECT_EQ(dialect->beam_on, "M10 E{power}");
}

TEST(Dialect, ErrorsNameThePlaceAndWhatIsAccepted) {
  const struct {
    const char* text;
    int line;
    const char* says;
  } cases[] = {
      {"name = \"x\"\ndecimal = 3\n", 2, "decimals"},
      {"name = \"x\"\nbeam_onn = \"M3\"\n", 2, "beam_on"},
      {"name = \"x\"\ndecimals = 99\n", 2, "1 to 6"},
      {"name = \"x\"\ndecimals = \"3\"\n", 2, "integer"},
      {"name = \"x\"\nheader = \"G21\"\n", 2, "list"},
      {"name = \"x\"\nbeam_on = \"M3 S{watts}\"\nbeam_off = \"M5\"\n", 2, "{power}"},
      {"name = \"x\"\nbeam_on = \"M3 S{power\"\nbeam_off = \"M5\"\n", 2, "{power}"},
      {"name = \"x\"\narc_absolute_mm = -1.0\n", 2, "0 to 1"},
      {"name = \"x\"\nbeam_on = \"M3\"\n", 0, "both"},
      {"name = \"x\"\nheader = [\n", 2, "TOML"},
      {"decimals = 3\n", 0, "name"},
  };
  for (const auto& c : cases) {
    const auto dialect = parse_dialect(c.text, "x.toml");
    ASSERT_FALSE(dialect) << c.text;
    EXPECT_EQ(dialect.error().code, ErrorCode::syntax);
    EXPECT_EQ(dialect.error().where.file, "x.toml");
    EXPECT_EQ(dialect.error().where.line, c.line) << c.text;
    EXPECT_NE(dialect.error().message.find(c.says), std::string::npos) << dialect.error().to_string();
  }
}

}  // namespace
}  // namespace burin::post
