// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "burin/base/diagnostics.h"
#include "burin/base/file.h"
#include "burin/base/result.h"
#include "burin/base/text.h"
#include "burin/base/utf8.h"

namespace burin {
namespace {

TEST(Where, SaysFileLineColumnOrEntity) {
  EXPECT_EQ((Where{.file = "a.nc", .line = 3, .column = 7}.to_string()), "a.nc:3:7");
  EXPECT_EQ((Where{.file = "a.dxf", .entity = "LINE 2F"}.to_string()), "a.dxf: LINE 2F");
  EXPECT_EQ(Where{}.to_string(), "");
  EXPECT_EQ((Error{ErrorCode::syntax, "no number (a decimal)", {.file = "a.nc", .line = 1}}.to_string()),
            "a.nc:1: no number (a decimal)");
}

TEST(Text, FormatFixed) {
  EXPECT_EQ(format_fixed(1.0, 4), "1");
  EXPECT_EQ(format_fixed(-0.00001, 4), "0");
  EXPECT_EQ(format_fixed(0.12345, 3), "0.123");
  EXPECT_EQ(format_fixed(100.0, 0), "100");
  EXPECT_EQ(format_fixed(-12.5000, 4), "-12.5");
}

TEST(Text, FormatFixedReadsBackWithinHalfADecimal) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> value(-1e5, 1e5);
  for (int i = 0; i < 20000; ++i) {
    const double v = value(random);
    for (int decimals : {3, 4, 6}) {
      const auto back = parse_double(format_fixed(v, decimals));
      ASSERT_TRUE(back);
      EXPECT_LE(std::abs(*back - v), 0.5000001 * std::pow(10.0, -decimals));
    }
    EXPECT_EQ(parse_double(format_shortest(v)), v);
  }
}

TEST(Text, ParseDoubleTakesNumbersOnly) {
  EXPECT_EQ(parse_double(" +1.5 "), 1.5);
  EXPECT_EQ(parse_double(".5"), 0.5);
  EXPECT_EQ(parse_double("2."), 2.0);
  EXPECT_EQ(parse_double("1e-400"), 0.0);
  for (const char* bad : {"", "abc", "1,5", "nan", "inf", "1e400", "+-1", "1 2", "0x10"}) {
    EXPECT_FALSE(parse_double(bad)) << bad;
  }
}

TEST(Text, NearestWord) {
  EXPECT_EQ(nearest_word("sidestep", {"side_step", "feed", "tolerance"}), "side_step");
  EXPECT_EQ(nearest_word("zzzz", {"side_step", "feed"}), "");
}

TEST(File, WriteReplacesWholeAndLeavesNothingOnFailure) {
  const std::string folder =
      std::filesystem::temp_directory_path() / ("burin-base-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::string path = folder + "/out.txt";
  ASSERT_TRUE(write_file(path, "one").ok());
  ASSERT_TRUE(write_file(path, "two").ok());
  EXPECT_EQ(read_file(path).value(), "two");
  EXPECT_FALSE(write_file(folder, "x").ok());
  EXPECT_FALSE(write_file(folder + "/none/out.txt", "x").ok());
  EXPECT_FALSE(read_file(folder).ok());
  EXPECT_FALSE(read_file(folder + "/none").ok());
  EXPECT_FALSE(read_file(path, 2).ok());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  std::filesystem::remove_all(folder);
}

/// The number that well-formed bytes of one character spell, by the table of the standard.
std::uint32_t spelled(const std::string& bytes) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  if (bytes.size() == 1) return at(0);
  std::uint32_t number = at(0) & (0x7Fu >> bytes.size());
  for (std::size_t i = 1; i < bytes.size(); ++i) number = number * 64 + (at(i) - 0x80u);
  return number;
}

TEST(Utf8, EveryCharacterIsSpelledOnce) {
  for (std::uint32_t c = 0; c <= 0x110000; c += c < 0x3000 || c > 0x10FF00 ? 1 : 7) {
    std::string bytes;
    append_utf8(bytes, c);
    const bool none = (c >= 0xD800 && c < 0xE000) || c > 0x10FFFF;
    ASSERT_EQ(spelled(bytes), none ? kReplacementCharacter : c);
    ASSERT_TRUE(is_utf8(bytes)) << c;
    ASSERT_FALSE(bytes.size() > 1 && is_utf8(bytes.substr(1))) << c;
    ASSERT_FALSE(bytes.size() > 1 && is_utf8(bytes.substr(0, bytes.size() - 1))) << c;
  }
}

TEST(Utf8, RefusesWhatIsNoCharacter) {
  for (int a = 0; a < 256; ++a) {
    for (int b = 0; b < 256; ++b) {
      const std::string bytes{static_cast<char>(a), static_cast<char>(b)};
      const bool two = a >= 0xC2 && a < 0xE0 && b >= 0x80 && b < 0xC0;
      ASSERT_EQ(is_utf8(bytes), two || (a < 0x80 && b < 0x80)) << a << " " << b;
    }
  }
  for (const char* bytes : {"\xE0\x9F\xBF", "\xED\xA0\x80", "\xF0\x8F\xBF\xBF", "\xF4\x90\x80\x80",
                            "\xF5\x80\x80\x80", "\xE2\x82", "a\xE2\x82z"})
    EXPECT_FALSE(is_utf8(bytes));
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(is_utf8("\xED\x9F\xBF\xEE\x80\x80\xF4\x8F\xBF\xBF"));
}

TEST(File, Sha256OfTheStandardsExamples) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Diagnostics, OnlyLeftOutChangesTheExitCode) {
  Diagnostics d;
  d.info("duplicate_removed", "a line drawn twice");
  EXPECT_FALSE(d.anything_left_out());
  d.left_out_at("open_chain", "ends apart", 1, 2);
  EXPECT_TRUE(d.anything_left_out());
  EXPECT_EQ(d.count("open_chain"), 1u);
}

TEST(Diagnostics, LocateNamesTheFileWhereAPlaceIsKnown) {
  Diagnostics d;
  d.info("a", "with entity", {.entity = "LINE 2F"});
  d.info("b", "with file", {.file = "other.dxf", .line = 3});
  d.info("c", "of the job");
  d.locate("part.dxf");
  EXPECT_EQ(d.warnings()[0].where.file, "part.dxf");
  EXPECT_EQ(d.warnings()[1].where.file, "other.dxf");
  EXPECT_EQ(d.warnings()[2].where.file, "");
}

}  // namespace
}  // namespace burin
