// SPDX-License-Identifier: Apache-2.0
// Structure: entities, names, layers, colours, units, what is ignored, text encodings.
#include "burin/io/dxf/read_dxf.h"

#include <gtest/gtest.h>

#include <locale>

#include "burin/io/dxf/dxf_text.h"

namespace {

using namespace burin;                // NOLINT(google-build-using-namespace)
using namespace burin::io;            // NOLINT(google-build-using-namespace)
using namespace burin::io::dxf_text;  // NOLINT(google-build-using-namespace)
using geom::Line2;
using geom::Point2;

const char* const kLine = "0 LINE|5 2F|8 Outline|10 1|20 2|11 4|21 6";

TEST(ReadDxf, TakesALineWithItsOrigin) {
  EXPECT_TRUE(dxf_supported());
  Diagnostics diagnostics;
  const Drawing drawing = read(file(kLine), diagnostics);
  ASSERT_EQ(drawing.entities.size(), 1u);
  const Entity& line = drawing.entities[0];
  EXPECT_EQ(line.kind, "LINE");
  EXPECT_EQ(line.id, "2F");
  EXPECT_EQ(line.name(), "LINE 2F");
  EXPECT_EQ(line.line, 5);
  EXPECT_EQ(line.layer, "Outline");
  EXPECT_FALSE(line.paths[0].closed);
  EXPECT_EQ(only_curve(drawing), geom::Curve2(Line2{{1, 2}, {4, 6}}));
  EXPECT_EQ(drawing.layers, std::vector<std::string>{"Outline"});
  EXPECT_TRUE(diagnostics.empty());
}

TEST(ReadDxf, KeepsEntitiesInFileOrder) {
  const Drawing drawing =
      read(file("0 CIRCLE|10 0|20 0|40 1|0 LINE|10 0|20 0|11 1|21 0|0 ARC|10 0|20 0|40 1|50 0|51 90|"
                "0 TEXT|1 hello|0 LINE|10 5|20 0|11 6|21 0"));
  ASSERT_EQ(drawing.entities.size(), 4u);
  EXPECT_EQ(drawing.entities[0].kind, "CIRCLE");
  EXPECT_EQ(drawing.entities[1].kind, "LINE");
  EXPECT_EQ(drawing.entities[2].kind, "ARC");
  EXPECT_EQ(drawing.entities[3].line, drawing.entities[2].line + 12 + 4);
  EXPECT_EQ(std::get<Line2>(only_curve(drawing, 3)).a, (Point2{5, 0}));
}

TEST(ReadDxf, LineEndsAndMarksDoNotMatter) {
  const std::string unix_text = file(std::string(kLine) + "|0 CIRCLE|10 1|20 1|40 3");
  std::string dos, mac;
  for (const char c : unix_text) {
    dos += c == '\n' ? "\r\n" : std::string(1, c);
    mac += c == '\n' ? '\r' : c;
  }
  const std::string with_tail = unix_text + "\n\x1a\n";
  for (const std::string& text :
       {dos, mac, "\xEF\xBB\xBF" + unix_text, with_tail, unix_text.substr(0, unix_text.size() - 1)}) {
    const Drawing drawing = read(text);
    ASSERT_EQ(drawing.entities.size(), 2u);
    EXPECT_EQ(drawing.entities[0].line, 5);
    EXPECT_EQ(only_curve(drawing), geom::Curve2(Line2{{1, 2}, {4, 6}}));
  }
}

TEST(ReadDxf, SkipsCommentsExtendedDataAndApplicationGroups) {
  // A comment that is just "dxflib" makes dxflib throw; lines over 1023 bytes make it hang.
  const std::string text =
      groups("999 dxflib") +
      file(
          "999 dxflib|0 LINE|5 A|102 {ACAD_REACTORS|330 1F|10 99|102 }|10 1|20 2|11 3|21 4|1001 ACAD|"
          "1000 " +
          std::string(5000, 'x') + "|1010 7|1020 7|0 MTEXT|1 " + std::string(3000, 'y') +
          "|101 Embedded Object|10 5|0 LINE|10 0|20 0|11 1|21 1");
  const Drawing drawing = read(text);
  ASSERT_EQ(drawing.entities.size(), 2u);
  EXPECT_EQ(only_curve(drawing), geom::Curve2(Line2{{1, 2}, {3, 4}}));
  EXPECT_EQ(drawing.ignored.at("MTEXT"), 1);
}

// --- units

double unit_of(const std::string& header, Units units = Units::from_file, std::string* reason = nullptr,
               Diagnostics* diagnostics = nullptr) {
  Parts parts{header, "", "", "0 LINE|10 1|20 0|11 2|21 0"};
  ReadOptions options;
  options.units = units;
  Diagnostics own;
  const Drawing drawing = read(file(parts), diagnostics != nullptr ? *diagnostics : own, options);
  if (reason != nullptr) *reason = drawing.units_reason;
  EXPECT_DOUBLE_EQ(std::get<Line2>(only_curve(drawing)).a.x, drawing.mm_per_unit);
  return drawing.mm_per_unit;
}

TEST(ReadDxfUnits, FollowsInsunits) {
  std::string reason;
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 1", Units::from_file, &reason), 25.4);
  EXPECT_EQ(reason, "$INSUNITS 1 (inch)");
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 2"), 304.8);
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 4", Units::from_file, &reason), 1.0);
  EXPECT_EQ(reason, "$INSUNITS 4 (mm)");
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 5"), 10.0);
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 6"), 1000.0);
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 8"), 25.4e-6);
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 9"), 0.0254);
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 13"), 0.001);
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 14"), 100.0);
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 21"), 1200000.0 / 3937.0);
}

TEST(ReadDxfUnits, AssumesMillimetres) {
  std::string reason;
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 0", Units::from_file, &reason), 1.0);
  EXPECT_NE(reason.find("mm assumed"), std::string::npos);
  EXPECT_DOUBLE_EQ(unit_of("", Units::from_file, &reason), 1.0);
  EXPECT_EQ(reason, "no units, mm assumed");
  Diagnostics diagnostics;
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 77", Units::from_file, &reason, &diagnostics), 1.0);
  EXPECT_EQ(diagnostics.count("units_assumed"), 1u);
  EXPECT_FALSE(diagnostics.anything_left_out());
}

TEST(ReadDxfUnits, OptionOverridesTheFile) {
  std::string reason;
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 6", Units::inch, &reason), 25.4);
  EXPECT_EQ(reason, "--units inch");
  EXPECT_DOUBLE_EQ(unit_of("9 $INSUNITS|70 1", Units::mm), 1.0);
}

// --- layers, visibility

TEST(ReadDxfLayers, FrozenOffAndDefpointsAreListed) {
  Parts parts;
  parts.tables = layer_table(
      "0 LAYER|2 Cold|70 1|62 3|0 LAYER|2 Dark|70 0|62 -3|0 LAYER|2 Cut|70 0|62 1|0 LAYER|2 Defpoints|70 "
      "0|62 7");
  parts.entities =
      "0 LINE|8 Cold|10 0|20 0|11 1|21 1|0 LINE|8 COLD|10 0|20 0|11 1|21 1|0 LINE|8 Dark|10 0|20 0|11 1|21 1|"
      "0 CIRCLE|8 DEFPOINTS|10 0|20 0|40 1|0 LINE|8 cut|10 0|20 0|11 1|21 1|0 LINE|60 1|8 Cut|10 0|20 0|11 "
      "1|21 1|"
      "0 LINE|67 1|8 Cut|10 0|20 0|11 1|21 1|0 LINE|8 Undeclared|10 0|20 0|11 1|21 1";
  Diagnostics diagnostics;
  const Drawing drawing = read(file(parts), diagnostics);
  const std::map<std::string, int> expected = {{"LINE on frozen layer Cold", 2},
                                               {"LINE on off layer Dark", 1},
                                               {"CIRCLE on layer Defpoints", 1},
                                               {"LINE invisible", 1},
                                               {"LINE in paper space", 1}};
  EXPECT_EQ(drawing.ignored, expected);
  EXPECT_EQ(diagnostics.count("ignored_hidden"), 5u);
  EXPECT_FALSE(diagnostics.anything_left_out());
  ASSERT_EQ(drawing.entities.size(), 2u);
  EXPECT_EQ(drawing.entities[0].layer, "Cut");  // as the table spells it
  EXPECT_EQ(drawing.entities[0].color, 0xFF0000u);
  EXPECT_EQ(drawing.entities[1].layer, "Undeclared");
  EXPECT_EQ(drawing.layers, (std::vector<std::string>{"Cold", "Cut", "Dark", "Defpoints", "Undeclared"}));
}

TEST(ReadDxfLayers, BlockMembersInheritLayerAndColour) {
  Parts parts;
  parts.tables = layer_table(
      "0 LAYER|2 Red|70 0|62 1|0 LAYER|2 Blue|70 0|62 5|0 LAYER|2 Ice|70 1|62 4|0 LAYER|2 Off|70 0|62 -2");
  parts.blocks =
      "0 BLOCK|2 Part|70 0|10 0|20 0|0 LINE|5 31|8 0|10 0|20 0|11 1|21 0|0 LINE|8 0|62 0|10 0|20 0|11 2|21 0|"
      "0 LINE|8 Blue|10 0|20 0|11 3|21 0|0 LINE|8 Blue|420 1193046|10 0|20 0|11 4|21 0|0 ENDBLK";
  parts.entities = "0 INSERT|5 2F|8 Red|62 3|2 PART|10 0|20 0";
  const Drawing drawing = read(file(parts));
  ASSERT_EQ(drawing.entities.size(), 4u);
  EXPECT_EQ(drawing.entities[0].layer, "Red");
  EXPECT_EQ(drawing.entities[0].color, 0xFF0000u);  // by layer, and layer 0 is the layer of the insertion
  EXPECT_EQ(drawing.entities[0].id, "INSERT 2F/LINE 31");
  EXPECT_EQ(drawing.entities[1].color, 0x00FF00u);  // by block
  EXPECT_EQ(drawing.entities[2].layer, "Blue");
  EXPECT_EQ(drawing.entities[2].color, 0x0000FFu);
  EXPECT_EQ(drawing.entities[3].color, 0x123456u);

  parts.entities = "0 INSERT|8 Ice|2 Part|10 0|20 0";  // frozen hides all
  EXPECT_EQ(read(file(parts)).ignored, (std::map<std::string, int>{{"INSERT on frozen layer Ice", 1}}));
  parts.entities = "0 INSERT|8 Off|2 Part|10 0|20 0";  // off hides what lies on it
  const Drawing off = read(file(parts));
  EXPECT_EQ(off.entities.size(), 2u);
  EXPECT_EQ(off.ignored, (std::map<std::string, int>{{"LINE on off layer Off", 2}}));
}

TEST(ReadDxf, ListsWhatHoldsNoOutlineOncePerKind) {
  Diagnostics diagnostics;
  const Drawing drawing = read(file("0 TEXT|1 a|0 TEXT|1 b|0 POINT|10 0|20 0|0 HATCH|2 SOLID|91 99999999|92 "
                                    "2|10 1|0 SOLID|10 0|20 0|0 3DFACE|10 0|"
                                    "0 DIMENSION|2 *D1|0 LEADER|76 2000000000|10 1|0 IMAGE|10 0|0 REGION|1 "
                                    "x|0 REGION|1 y|0 MYTHING|1 z"),
                               diagnostics);
  EXPECT_TRUE(drawing.entities.empty());
  EXPECT_EQ(drawing.ignored.at("TEXT"), 2);
  EXPECT_EQ(drawing.ignored.at("REGION"), 2);
  EXPECT_EQ(drawing.ignored.size(), 10u);
  EXPECT_EQ(diagnostics.count("ignored_entity"), 7u);
  EXPECT_EQ(diagnostics.count("unsupported_entity"), 3u);  // 3DFACE, REGION, MYTHING
  EXPECT_TRUE(diagnostics.anything_left_out());
}

// --- text

TEST(ReadDxfText, LayerNamesBecomeUtf8) {
  const auto layer_of = [](const std::string& header, const std::string& name) {
    Parts parts{header, "", "", "0 LINE|8 " + name + "|10 0|20 0|11 1|21 1"};
    return read(file(parts)).entities.at(0).layer;
  };
  const std::string expected = "Schl\xC3\xBCssel";
  EXPECT_EQ(layer_of("", expected), expected);
  EXPECT_EQ(layer_of("9 $DWGCODEPAGE|3 ANSI_1252", "Schl\xFCssel"), expected);
  EXPECT_EQ(layer_of("", "Schl\\U+00FCssel"), expected);
  EXPECT_EQ(layer_of("9 $DWGCODEPAGE|3 ANSI_932", "a\x88\x9F"), "a\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(layer_of("", "\\U+D800x"), "\xEF\xBF\xBDx");
  EXPECT_EQ(layer_of("", "\\U+00"), "\\U+00");
}

class CommaNumbers : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(ReadDxf, TheLocaleOfTheProgramDoesNotMatter) {
  const std::string text =
      file("0 LINE|10 1234.5625|20 -0.001|11 1e3|21 .5|0 CIRCLE|10 1|20 2|40 1234567.25");
  const Drawing plain = read(text);
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new CommaNumbers));
  const Drawing foreign = read(text);
  std::locale::global(before);
  EXPECT_EQ(only_curve(plain), geom::Curve2(Line2{{1234.5625, -0.001}, {1000, 0.5}}));
  ASSERT_EQ(foreign.entities.size(), 2u);
  EXPECT_EQ(only_curve(foreign, 0), only_curve(plain, 0));
  EXPECT_EQ(only_curve(foreign, 1), only_curve(plain, 1));
}

TEST(ReadDxf, PrintsNothing) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Diagnostics diagnostics;
  (void)try_read(file("0 LINE|10 0|20 0|11 1|21 1|0 HATCH|92 1|93 1|72 9|0 TEXT|1 x"), diagnostics);
  (void)try_read(file("0 LINE|10 x"), diagnostics);
  (void)try_read("rubbish", diagnostics);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
