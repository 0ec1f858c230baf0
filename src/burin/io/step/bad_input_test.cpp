// SPDX-License-Identifier: Apache-2.0
// Damaged files: an error or a sound part, never a crash.
#include <gtest/gtest.h>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>

#include <random>

#include "burin/io/step/read_step.h"
#include "burin/io/step/scan.h"
#include "burin/io/step/step_test_util.h"

namespace burin::io {
namespace {

Error error_of(const std::string& text) {
  ReadCadOptions options;
  options.file_name = "bad";
  Diagnostics diagnostics;
  const auto model = read_cad(text, options, diagnostics);
  EXPECT_FALSE(model) << text.substr(0, 60);
  if (model) return {};
  EXPECT_EQ(model.error().where.file, "bad");
  return model.error();
}

bool contains(const Error& error, const std::string& part) {
  return error.to_string().find(part) != std::string::npos;
}

const std::string kHead =
    "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('a','',(''),(''),'','','');\n"
    "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\n";
std::string with_data(const std::string& data) {
  return kHead + "DATA;\n" + data + "ENDSEC;\nEND-ISO-10303-21;\n";
}

std::string small_step() {
  std::mt19937 random(31);
  return *write_step({step::test::random_surface(random, 2, 3, 4, 5)}, "small");
}
std::string box_step() {
  return step::test::step_text(BRepPrimAPI_MakeBox(3, 4, 5).Shape());
}
std::string can_iges(bool brep) {
  return step::test::iges_text(BRepPrimAPI_MakeCylinder(3, 4).Shape(), brep);
}

TEST(BadInput, NotCadAtAll) {
  EXPECT_TRUE(contains(error_of(""), "is empty"));
  EXPECT_TRUE(contains(error_of(" \n\n"), "is empty"));
  EXPECT_TRUE(contains(error_of("solid cube\nfacet normal 0 0 1\n"), "neither STEP nor IGES"));
  EXPECT_TRUE(contains(error_of(std::string(100, '\0')), "neither STEP nor IGES"));
  EXPECT_EQ(error_of("\x1f\x8b\x08 gzip").code, ErrorCode::unsupported);
  EXPECT_EQ(error_of(std::string(72, ' ') + "C      1\n").code, ErrorCode::unsupported);
}

TEST(BadInput, StepThatStopsOrHoldsNothing) {
  EXPECT_TRUE(contains(error_of("ISO-10303-21;\n"), "ends in the middle"));
  EXPECT_TRUE(contains(error_of(kHead), "ends in the middle"));
  EXPECT_TRUE(contains(error_of(kHead + "END-ISO-10303-21;\n"), "no DATA section"));
  EXPECT_EQ(error_of(with_data("")).code, ErrorCode::geometry);
  EXPECT_EQ(error_of(with_data("#1=CARTESIAN_POINT('',(0.,0.,0.));\n")).code, ErrorCode::geometry);
}

TEST(BadInput, StepSaysTheLine) {
  const std::string before = "#1=CARTESIAN_POINT('',(0.,0.,0.));\n";  // line 8
  EXPECT_TRUE(
      contains(error_of(with_data(before + "#1=DIRECTION('',(0.,0.,1.));\n")), "bad:9: #1 is defined twice"));
  EXPECT_TRUE(
      contains(error_of(with_data(before + "#2=AXIS1_PLACEMENT('',#1,#77);\n")), "bad:9: refers to #77"));
  EXPECT_TRUE(
      contains(error_of(with_data(before + "#2=DIRECTION('',(0.,1.E999,1.));\n")), "bad:9: \"1.E999\""));
  EXPECT_TRUE(contains(error_of(with_data(before + "#2=DIRECTION('',(0.,1.2.3,1.));\n")), "bad:9:"));
  EXPECT_TRUE(contains(error_of(with_data("#2=DIRECTION('',(0.,1.,1.);\n")), "bad:8: a parenthesis"));
  EXPECT_TRUE(contains(error_of(with_data("#2=DIRECTION('(0.,1.,1.);\n")), "bad:8: the text"));
  EXPECT_TRUE(contains(error_of(with_data("#2=DIRECTION(''\x01,(0.,1.,1.));\n")), "bad:8: has a byte 0x01"));
  EXPECT_TRUE(contains(error_of(with_data("/* never closed")), "bad:8: the comment"));
  EXPECT_TRUE(contains(error_of(with_data("#99999999999=DIRECTION('',(0.,1.,1.));\n")), "bad:8:"));
}

TEST(BadInput, CirclesAndTowersOfReferences) {
  EXPECT_TRUE(contains(error_of(with_data("#1=CURVE_REPLICA('',#1,$);\n")), "bad:8: #1 refers to itself"));
  EXPECT_TRUE(contains(error_of(with_data("#1=TRIMMED_CURVE('',#2,(),(),.T.,.PARAMETER.);\n"
                                          "#2=TRIMMED_CURVE('',#1,(),(),.T.,.PARAMETER.);\n")),
                       "refers to itself"));
  std::string tower;
  for (int i = 1; i < 3000; ++i)
    tower += "#" + std::to_string(i) + "=CURVE_REPLICA('',#" + std::to_string(i + 1) + ",$);\n";
  EXPECT_TRUE(contains(error_of(with_data(tower + "#3000=DIRECTION('',(0.,0.));\n")), "chain of more than"));
  EXPECT_TRUE(contains(error_of(with_data("#1=A(" + std::string(100000, '(') + ");\n")), "nested deeper"));
}

TEST(BadInput, EveryPrefixOfAStepFileIsRefused) {
  const std::string text = small_step();
  const std::size_t end = text.find("END-ISO-10303-21") + 16;
  std::mt19937 random(32);
  for (int i = 0; i < 60; ++i) EXPECT_EQ(error_of(text.substr(0, random() % end)).code, ErrorCode::syntax);
}

TEST(BadInput, EveryPrefixOfAnIgesFileIsRefused) {
  for (const bool brep : {false, true}) {
    const std::string text = can_iges(brep);
    const std::size_t end = text.find_last_not_of("\r\n") - 48;  // inside of the counts of the T line
    std::mt19937 random(33);
    for (int i = 0; i < 60; ++i) EXPECT_EQ(error_of(text.substr(0, random() % end)).code, ErrorCode::syntax);
  }
}

/// The IGES text with one value of the parameter data of entity `type` exchanged; columns stay.
std::string with_value(std::string text, const std::string& type, int index, const std::string& value) {
  std::size_t line = 0;
  while (!(text[line + 72] == 'P' && text.compare(line, type.size(), type) == 0))
    line = text.find('\n', line) + 1;
  std::size_t at = line;
  for (int i = 0; i < index; ++i) at = text.find(',', at) + 1;
  const std::size_t end = text.find(',', at);
  std::string row = text.substr(line, 64);
  row.replace(at - line, end - at, value);
  row.resize(64, ' ');
  return text.replace(line, 64, row);
}

TEST(BadInput, IgesCountsAreChecked) {
  std::mt19937 random(34);
  const auto patch = step::test::random_surface(random, 2, 2, 3, 3);
  Diagnostics diagnostics;
  // A surface 128 in IGES: what is read from STEP, written as IGES.
  ASSERT_TRUE(read_cad(can_iges(false), {}, diagnostics));
  const std::string good = can_iges(false);
  EXPECT_TRUE(contains(error_of(with_value(good, "102", 1, "999999999")), "declares counts"));
  EXPECT_TRUE(contains(error_of(with_value(good, "102", 1, "-5")), "a count that is none"));
  EXPECT_TRUE(contains(error_of(with_value(good, "144", 3, "123456789")), "declares counts"));
  EXPECT_TRUE(contains(error_of(with_value(good, "102", 0, "126")), "bad:"));
}

TEST(BadInput, IgesLinesAreChecked) {
  const std::string good = can_iges(true);
  std::string text = good;
  text[72] = 'X';
  EXPECT_EQ(error_of(text).code, ErrorCode::syntax);
  text = good;
  text.erase(text.find('\n') * 2 + 2, 81);  // one line of G
  EXPECT_TRUE(contains(error_of(text), "bad:"));
  text = good;
  text.erase(200, 20);
  EXPECT_TRUE(contains(error_of(text), "bad:3: a line of 60 characters (IGES lines have 80)"))
      << error_of(text).to_string();
}

/// Whatever is read from a damaged file must be sound.
void expect_sound(const CadModel& model) {
  for (const CadFace& face : model.faces) {
    EXPECT_TRUE(geom::validate(face.surface));
    EXPECT_FALSE(face.box.empty());
    EXPECT_EQ(face.trimmed, !face.loops.empty());
    const geom::Interval u = face.surface.domain(geom::Direction::u),
                         v = face.surface.domain(geom::Direction::v);
    for (const TrimLoop& loop : face.loops) {
      EXPECT_GE(loop.points.size(), 3u);
      for (const geom::Point2 p : loop.points)
        EXPECT_TRUE(u.lo <= p.x && p.x <= u.hi && v.lo <= p.y && p.y <= v.hi);
    }
  }
}

std::string mutated(std::string text, std::mt19937& random) {
  const auto place = [&] { return random() % text.size(); };
  for (auto n = 1 + random() % 3; n > 0; --n) {
    std::size_t at = place();
    switch (random() % 5) {
      case 0:
        text[at] = static_cast<char>(random() % 256);
        break;
      case 1:  // another digit: the structure stays, the values go wrong
      case 2:
        at = text.find_first_of("0123456789", at);
        if (at != std::string::npos) text[at] = static_cast<char>('0' + random() % 10);
        break;
      case 3:
        text.erase(at, random() % 40);
        break;
      default:
        std::swap(text[at], text[place()]);
    }
    if (text.empty()) return text;
  }
  return text;
}

TEST(BadInput, TwoHundredMutations) {
  const std::string parts[] = {small_step(), box_step(), can_iges(false), can_iges(true)};
  std::mt19937 random(35);
  int read = 0;
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    Diagnostics diagnostics;
    const auto model = read_cad(mutated(parts[i % 4], random), {}, diagnostics);
    if (!model) {
      EXPECT_FALSE(model.error().message.empty());
      continue;
    }
    ++read;
    expect_sound(*model);
  }
  EXPECT_GT(read, 20);  // else the mutations only tested the scan
}

TEST(BadInput, HugeCoordinatesCostTheFaceOnly) {
  std::mt19937 random(36);
  const auto fine = step::test::random_surface(random, 2, 2, 3, 3);
  auto far = fine;
  for (auto& p : far.points) p = homogeneous(project(p) + geom::Vec3{9e6, 0, 0}, p.w);
  std::string text = *write_step({fine, far}, "far");
  int moved = 0;
  for (std::size_t at = text.find("E+06"); at != std::string::npos; at = text.find("E+06", at + 4)) {
    text[at + 3] = '8';
    ++moved;
  }
  ASSERT_GE(moved, 9);
  Diagnostics diagnostics;
  const auto model = read_cad(text, {}, diagnostics);
  ASSERT_TRUE(model) << model.error().to_string();
  EXPECT_EQ(model->faces.size(), 1u);
  ASSERT_EQ(diagnostics.count("face_left_out"), 1u);
  EXPECT_NE(diagnostics.warnings()[0].message.find("10 km"), std::string::npos) << diagnostics.warnings()[0].message;
  EXPECT_FALSE(diagnostics.warnings()[0].where.entity.empty());
}

}  // namespace
}  // namespace burin::io
