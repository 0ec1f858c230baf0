// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "burin/nc/codes.h"
#include "burin/nc/program.h"

namespace burin::nc {
namespace {

std::vector<Block> lexed(std::string_view text) {
  auto blocks = lex(text, {.file_name = "a.nc"});
  EXPECT_TRUE(blocks) << blocks.error().to_string();
  return blocks ? *blocks : std::vector<Block>{};
}

TEST(Lexer, WordsNumbersAndComments) {
  const auto blocks = lexed("%\nO0001(TEST)\nN10 g1x-.5 Y 1 2.5 ( a ) F1.; rest (of it\n\n/N20G106.2\n");
  ASSERT_EQ(blocks.size(), 4u);
  EXPECT_TRUE(blocks[0].percent);
  EXPECT_EQ(blocks[1].comment, "TEST");
  const Block& b = blocks[2];
  EXPECT_EQ(b.line, 3);
  EXPECT_EQ(b.number, 10);
  ASSERT_EQ(b.words.size(), 4u);
  EXPECT_EQ(b.find('X')->value, -0.5);
  EXPECT_EQ(b.find('Y')->value, 12.5);
  EXPECT_EQ(b.find('Y')->column, 12);
  EXPECT_TRUE(b.find('F')->has_point);
  EXPECT_FALSE(b.find('G')->has_point);
  EXPECT_EQ(b.find('Z'), nullptr);
  EXPECT_EQ(b.comment, "a rest (of it");
  EXPECT_TRUE(blocks[3].skip);
  EXPECT_EQ(blocks[3].line, 5);
  EXPECT_EQ(blocks[3].words[0].code(), 10620);
}

TEST(Lexer, ASemicolonEndsTheBlockAsInThePapersListings) {
  const auto blocks = lexed("N10 G06.23 U3 V3;\r\nN20 X50. Y0. Z10. W1.;\r\n");
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[0].words[0].code(), 623);
  EXPECT_EQ(blocks[1].words.size(), 4u);
  EXPECT_EQ(blocks[1].comment, "");
}

TEST(Lexer, CodesAreHundredths) {
  const auto code = [](double value) { return Word{.letter = 'G', .value = value}.code(); };
  EXPECT_EQ(code(0), 0);
  EXPECT_EQ(code(6.23), 623);
  EXPECT_EQ(code(59.3), 5930);
  EXPECT_EQ(code(-1), -1);
  EXPECT_EQ(code(1.005), -1);
  EXPECT_EQ(code(1e9), -1);
  EXPECT_EQ(code_name('G', 623), "G6.23");
  EXPECT_EQ(code_name('G', 605), "G6.05");
  EXPECT_EQ(code_name('G', 10620), "G106.2");
  EXPECT_EQ(code_name('M', 3000), "M30");
}

TEST(Lexer, ErrorsSayWhere) {
  const struct {
    const char* text;
    int line, column;
    ErrorCode code;
  } cases[] = {
      {"G1 X", 1, 4, ErrorCode::syntax},
      {"\nG1 X--1", 2, 4, ErrorCode::syntax},
      {"G1 X1 2", 0, 0, ErrorCode::syntax},  // 12: blanks inside a number
      {"G1 (open", 1, 4, ErrorCode::syntax},
      {"12 G1", 1, 1, ErrorCode::syntax},
      {"G1 X1\x01", 1, 6, ErrorCode::syntax},
      {"G1 @5", 1, 4, ErrorCode::syntax},
      {"N1 N2", 1, 4, ErrorCode::syntax},
      {"N-1", 1, 1, ErrorCode::range},
      {"G1 X1.2.3", 1, 8, ErrorCode::syntax},
      {"#1=5", 1, 1, ErrorCode::unsupported},
      {"G1 X[1+2]", 1, 5, ErrorCode::unsupported},
      {"o100 sub", 1, 1, ErrorCode::unsupported},
      {"o<name> call", 1, 1, ErrorCode::unsupported},
      {"IF [1] GOTO 5", 1, 1, ErrorCode::unsupported},
      {"0 BEGIN PGM 12 MM", 1, 1, ErrorCode::unsupported},
      {"G1 X1,R2", 1, 6, ErrorCode::unsupported},
  };
  for (const auto& c : cases) {
    const auto blocks = lex(c.text, {.file_name = "a.nc"});
    ASSERT_EQ(blocks.ok(), c.line == 0) << c.text;
    if (blocks) continue;
    EXPECT_EQ(blocks.error().code, c.code) << c.text << ": " << blocks.error().message;
    EXPECT_EQ(blocks.error().where.line, c.line) << c.text;
    EXPECT_EQ(blocks.error().where.column, c.column) << c.text;
    EXPECT_NE(blocks.error().message.find('('), std::string::npos) << "says what would be accepted";
  }
}

TEST(Lexer, LimitsHold) {
  const auto blocks = lex("G1\nG1\nG1\n", {.max_blocks = 2});
  ASSERT_FALSE(blocks);
  EXPECT_EQ(blocks.error().code, ErrorCode::range);
  EXPECT_FALSE(lex("X" + std::string(1000, '1'), {}));
}

TEST(Lexer, NoiseNeverFailsBadly) {
  std::mt19937 random(1);
  const std::string alphabet = "GXYZNM0123456789.-+ ()%;/\n\r\t#[]OIJ\x80\x01";
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    for (int k = 0; k < 30; ++k) text += alphabet[random() % alphabet.size()];
    const auto blocks = lex(text, {});
    if (!blocks) {
      EXPECT_GE(blocks.error().where.line, 1);
      EXPECT_GE(blocks.error().where.column, 1);
    }
  }
}

}  // namespace
}  // namespace burin::nc
