// SPDX-License-Identifier: Apache-2.0
// Damaged and hostile files: refused with the line, never a crash, a hang or memory without bound.
#include <gtest/gtest.h>

#include <cmath>

#include "burin/io/dxf/dxf_text.h"

namespace {

using namespace burin;                // NOLINT(google-build-using-namespace)
using namespace burin::io;            // NOLINT(google-build-using-namespace)
using namespace burin::io::dxf_text;  // NOLINT(google-build-using-namespace)

void expect_syntax(const std::string& text, const std::string& says, int line) {
  const Error error = refuse(text);
  EXPECT_EQ(error.code, ErrorCode::syntax) << text.substr(0, 60);
  EXPECT_NE(error.message.find(says), std::string::npos) << error.message;
  EXPECT_EQ(error.where.file, "t.dxf");
  EXPECT_EQ(error.where.line, line) << error.message;
}

TEST(ReadDxfBad, WhatIsNoAsciiDxf) {
  expect_syntax("", "empty", 1);
  expect_syntax(" \r\n\n", "empty", 1);
  expect_syntax(std::string("AutoCAD Binary DXF\r\n\x1a\0\0\0SECTION", 30), "binary DXF", 1);
  expect_syntax(std::string("AC1027\0\0\0\0", 10), "DWG", 1);
  expect_syntax(std::string("\xFF\xFE"
                            "0\0\n\0",
                            6),
                "UTF-16", 1);
  expect_syntax("<svg xmlns='x'/>\n<g/>\n", "not a DXF", 1);
  expect_syntax("0\nLINE\n0\nEOF\n", "not a DXF", 1);
  expect_syntax(std::string("0\nSECTION\n2\nENTI\0TIES\n", 22), "NUL", 4);
}

TEST(ReadDxfBad, Structure) {
  expect_syntax("0\nSECTION\n2\nENTITIES\n0\nENDSEC\n", "EOF", 6);
  expect_syntax("0\nSECTION\n2\nENTITIES\n0\nEOF\n", "section", 5);
  expect_syntax("0\nSECTION\n0\nENDSEC\n0\nEOF\n", "no name", 3);
  expect_syntax("0\nSECTION\n2\nHEADER\n0\nSECTION\n2\nENTITIES\n0\nENDSEC\n0\nEOF\n", "ENDSEC", 5);
  expect_syntax("0\nSECTION\n2\nENTITIES\nx\nLINE\n0\nENDSEC\n0\nEOF\n", "group code", 5);
  expect_syntax("0\nSECTION\n2\nENTITIES\n99999\nLINE\n0\nENDSEC\n0\nEOF\n", "group code", 5);
  expect_syntax("0\nSECTION\n2\nENTITIES\n0\nENDSEC\n0\nLINE\n0\nEOF\n", "outside", 7);
  expect_syntax(file("0 VERTEX|10 0|20 0"), "POLYLINE", 5);
  Parts parts{"", "", "0 BLOCK|2 A|10 0|20 0|0 BLOCK|2 B|0 ENDBLK", ""};
  expect_syntax(file(parts), "ENDBLK", 13);
  parts.blocks = "0 BLOCK|2 A|10 0|20 0";
  expect_syntax(file(parts), "ENDBLK", 13);
  parts.blocks = "0 LINE|10 0|20 0|11 1|21 1";
  expect_syntax(file(parts), "between blocks", 5);
}

TEST(ReadDxfBad, Numbers) {
  for (const char* value : {"abc", "", "nan", "inf", "1e400", "1e16", "1,5", "1.5.2", "0x10", "1 2"}) {
    expect_syntax(file(std::string("0 LINE|10 0|20 ") + value + "|11 1|21 1"), "number", 10);
  }
  expect_syntax(file("0 LWPOLYLINE|70 1.5|10 0|20 0"), "integer", 8);
  expect_syntax(file("0 LWPOLYLINE|70 99999999999|10 0|20 0"), "integer", 8);
  // The same in an entity that nobody reads, or in a section without drawing data, is none of our business.
  EXPECT_TRUE(read(file("0 TEXT|10 abc|40 1e400")).entities.empty());
  EXPECT_TRUE(read(section("OBJECTS", "0 DICTIONARY|40 xyz") + file("")).entities.empty());
}

TEST(ReadDxfBad, TruncatedAtEveryByte) {
  Parts parts;
  parts.header = "9 $INSUNITS|70 4";
  parts.tables = layer_table("0 LAYER|2 Cut|70 0|62 1");
  parts.blocks = "0 BLOCK|2 B|70 0|10 0|20 0|0 CIRCLE|10 0|20 0|40 2|0 ENDBLK";
  parts.entities =
      "0 LINE|8 Cut|10 0|20 0|11 1|21 1|0 INSERT|2 B|10 5|20 5|41 2|0 POLYLINE|66 1|70 1|0 VERTEX|10 0|20 "
      "0|42 1|"
      "0 VERTEX|10 4|20 0|0 SEQEND|0 SPLINE|71 2|72 6|73 3|40 0|40 0|40 0|40 1|40 1|40 1|10 0|20 0|10 1|20 "
      "1|10 2|20 0";
  const std::string text = file(parts);
  ASSERT_EQ(read(text).entities.size(), 4u);
  const std::size_t eof = text.rfind("EOF");
  for (std::size_t length = 0; length < text.size(); ++length) {
    Diagnostics diagnostics;
    const auto drawing = try_read(std::string_view(text).substr(0, length), diagnostics);
    if (length >= eof + 3) {
      EXPECT_TRUE(drawing.ok());
      continue;
    }
    ASSERT_FALSE(drawing.ok()) << length;
    EXPECT_EQ(drawing.error().code, ErrorCode::syntax);
    EXPECT_GT(drawing.error().where.line, 0);
  }
}

TEST(ReadDxfBad, EveryByteChangedIsAnErrorOrADrawingOfValidCurves) {
  const std::string text = file(
      "0 LWPOLYLINE|90 2|70 1|10 0|20 0|42 1|10 4|20 0|0 SPLINE|70 8|71 1|72 4|73 2|40 0|40 0|40 1|40 1|10 "
      "0|20 0|10 1|"
      "20 1|0 ELLIPSE|10 0|20 0|11 5|21 0|40 .5|41 0|42 3");
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (const char c : {'\0', '\n', '-', '9', 'e', ' ', '\xFF'}) {
      std::string changed = text;
      changed[i] = c;
      Diagnostics diagnostics;
      const auto drawing = try_read(changed, diagnostics);
      if (!drawing) continue;
      for (const Entity& entity : drawing->entities) {
        for (const Path& path : entity.paths) {
          for (const auto& curve : path.curves) EXPECT_TRUE(geom::validate(curve)) << i << " " << int{c};
        }
      }
    }
  }
}

TEST(ReadDxfBad, CountsThatLie) {
  Diagnostics diagnostics;
  const Drawing drawing =
      read(file("0 LWPOLYLINE|5 A|90 2000000000|42 5|70 0|10 0|20 0|10 1|20 0|"
                "0 LWPOLYLINE|5 B|90 -7|10 0|20 0|10 1|20 0|0 LWPOLYLINE|5 C|10 0|20 0|10 1|20 0|10 2|20 0|"
                "0 SPLINE|5 D|71 1|72 2000000000|73 -1|74 5|40 0|40 0|40 1|40 1|10 0|20 0|10 1|20 1"),
           diagnostics);
  ASSERT_EQ(drawing.entities.size(), 4u);
  EXPECT_EQ(drawing.entities[0].paths[0].curves.size(), 1u);
  EXPECT_EQ(drawing.entities[2].paths[0].curves.size(), 2u);
  EXPECT_GE(diagnostics.count("count_mismatch"), 2u);
  EXPECT_EQ(diagnostics.warnings()[0].where.entity, "LWPOLYLINE A");
  EXPECT_FALSE(diagnostics.anything_left_out());
}

// --- blocks

TEST(ReadDxfBad, BlocksThatContainThemselvesAreRefused) {
  Parts parts;
  parts.blocks =
      "0 BLOCK|2 A|10 0|20 0|0 INSERT|5 A1|2 B|10 0|20 0|0 ENDBLK|0 BLOCK|2 B|10 0|20 0|0 INSERT|5 B1|2 a|10 "
      "0|20 0|0 ENDBLK";
  parts.entities = "0 LINE|10 0|20 0|11 1|21 1";
  EXPECT_EQ(read(file(parts)).entities.size(), 1u);  // harmless while nobody inserts it
  parts.entities = "0 INSERT|5 2F|2 A|10 0|20 0";
  const Error error = refuse(file(parts));
  EXPECT_EQ(error.code, ErrorCode::syntax);
  EXPECT_NE(error.message.find("contains itself"), std::string::npos);
  EXPECT_GT(error.where.line, 0);
}

std::string chain(int depth, const std::string& array) {
  Parts parts;
  for (int i = 0; i < depth; ++i) {
    parts.blocks += "0 BLOCK|2 B" + std::to_string(i) + "|10 0|20 0|";
    if (i + 1 < depth) parts.blocks += "0 INSERT|2 B" + std::to_string(i + 1) + "|10 0|20 0" + array + "|";
    parts.blocks += "0 ENDBLK|";
  }
  parts.blocks.pop_back();
  parts.entities = "0 INSERT|2 B0|10 0|20 0" + array;
  return file(parts);
}

TEST(ReadDxfBad, DepthIsLimited) {
  ReadOptions options;
  options.max_depth = 10;
  EXPECT_TRUE(read(chain(10, ""), options).entities.empty());
  const Error error = refuse(chain(11, ""), options);
  EXPECT_EQ(error.code, ErrorCode::range);
  EXPECT_NE(error.message.find("nested deeper than 10"), std::string::npos);
  EXPECT_EQ(refuse(chain(70, "")).code, ErrorCode::range);  // the default of 64
}

TEST(ReadDxfBad, ArraysOfArraysComeToAnEnd) {
  ReadOptions options;
  options.max_entities = 100000;
  const Error error = refuse(chain(12, "|70 1000|71 1000"), options);  // of empty blocks: nothing but visits
  EXPECT_EQ(error.code, ErrorCode::range);
  EXPECT_NE(error.message.find("100000"), std::string::npos);
}

TEST(ReadDxfBad, HeavyEntitiesInArraysComeToAnEnd) {
  Parts parts;
  parts.blocks = "0 BLOCK|2 B|10 0|20 0|0 LWPOLYLINE";
  for (int i = 0; i < 2000; ++i) parts.blocks += "|10 0|20 0";
  parts.blocks += "|0 ENDBLK";
  parts.entities = "0 INSERT|2 B|10 0|20 0|70 30|71 30";
  ReadOptions options;
  options.max_entities = 10000;
  EXPECT_EQ(refuse(file(parts), options).code, ErrorCode::range);
}

TEST(ReadDxfBad, InsertsOfNothing) {
  Parts parts;
  parts.blocks =
      "0 BLOCK|2 X|70 4|10 0|20 0|1 other.dwg|0 ENDBLK|0 BLOCK|2 Y|10 0|20 0|0 LINE|10 0|20 0|11 1|21 0|0 "
      "ENDBLK|"
      "0 BLOCK|2 y|10 0|20 0|0 ENDBLK";
  parts.entities =
      "0 INSERT|2 Nowhere|10 7|20 8|0 INSERT|2 X|10 0|20 0|0 INSERT|2 Y|41 0|10 0|20 0|0 INSERT|2 Y|10 0|20 "
      "0";
  Diagnostics diagnostics;
  const Drawing drawing = read(file(parts), diagnostics);
  EXPECT_EQ(drawing.entities.size(), 1u);
  EXPECT_EQ(diagnostics.count("unknown_block"), 1u);
  EXPECT_EQ(diagnostics.count("external_reference"), 1u);
  EXPECT_EQ(diagnostics.count("bad_geometry"), 1u);
  EXPECT_EQ(diagnostics.count("duplicate_block"), 1u);
  for (const Warning& warning : diagnostics.warnings()) {
    EXPECT_EQ(warning.severity, Severity::left_out);
    EXPECT_GT(warning.where.line, 0);
  }
}

TEST(ReadDxfBad, NamesHaveALength) {
  const std::string longest(1000, 'n'), longer(1001, 'n');
  EXPECT_EQ(read(file("0 LINE|8 " + longest + "|10 0|20 0|11 1|21 1")).entities.at(0).layer, longest);
  expect_syntax(file("0 LINE|8 " + longer + "|10 0|20 0|11 1|21 1"), "name", 8);
  expect_syntax(file("0 TEXT|8 " + longer), "name", 8);
  expect_syntax(file("0 INSERT|2 " + longer + "|10 0|20 0"), "name", 8);
}

TEST(ReadDxfBad, ColoursOutOfRange) {
  for (const char* color : {"-2147483648", "2147483647", "257", "-1"}) {
    Parts parts;
    parts.tables = layer_table(std::string("0 LAYER|2 A|70 0|62 ") + color);
    parts.entities =
        std::string("0 LINE|8 B|420 -2147483648|62 ") + color + "|10 0|20 0|11 1|21 1|0 LINE|8 A|10 0|11 1";
    EXPECT_GE(read(file(parts)).entities.size(), 1u);
  }
}

TEST(ReadDxfBad, DeepWaysAreAbbreviated) {
  Parts parts;
  for (int i = 0; i < 60; ++i) {
    const std::string own = std::to_string(i), next = std::to_string(i + 1);
    parts.blocks +=
        "0 BLOCK|2 B" + own + "|10 0|20 0|0 INSERT|5 F" + own + "|2 B" + next + "|10 0|20 0|0 ENDBLK|";
  }
  parts.blocks += "0 BLOCK|2 B60|10 0|20 0|0 LINE|5 FF|10 0|20 0|11 1|21 0|0 ENDBLK";
  parts.entities = "0 INSERT|5 2F|2 B0|10 0|20 0";
  const std::string id = read(file(parts)).entities.at(0).id;
  EXPECT_LT(id.size(), 250u);
  EXPECT_EQ(id.substr(0, 14), "INSERT 2F/.../") << id;
  EXPECT_EQ(id.substr(id.size() - 8), "/LINE FF") << id;
}

TEST(ReadDxfBad, ManyAlikeMessagesAreSummedUp) {
  std::string entities = "0 CIRCLE|10 0|20 0|40 0";
  for (int i = 1; i < 1500; ++i) entities += "|0 CIRCLE|10 0|20 0|40 0";
  Diagnostics diagnostics;
  EXPECT_TRUE(read(file(entities), diagnostics).entities.empty());
  EXPECT_EQ(diagnostics.count("zero_length"), 1001u);
  EXPECT_NE(diagnostics.warnings().back().message.find("500 more"), std::string::npos);
}

}  // namespace
