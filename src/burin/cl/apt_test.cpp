// SPDX-License-Identifier: Apache-2.0
#include "burin/cl/apt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace burin::cl {
namespace {

using geom::Point3;
using geom::Vec3;

Program read(std::string_view text, Diagnostics* diagnostics = nullptr) {
  Diagnostics own;
  auto program = read_apt(text, {.file_name = "a.cl"}, diagnostics ? *diagnostics : own);
  EXPECT_TRUE(program) << program.error().to_string();
  return program ? *program : Program{};
}

Program random_program(std::mt19937_64& engine) {
  const auto in = [&](double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine);
  };
  const auto point = [&] { return Point3{in(-2000, 2000), in(-2000, 2000), in(-2000, 2000)}; };
  const auto axis = [&] {
    return in(0, 1) < 0.5 ? Vec3{0, 0, 1} : unit(Vec3{in(-1, 1), in(-1, 1), in(-1, 1)});
  };
  Program p;
  p.name = "part 7";
  if (in(0, 1) < 0.5) p.from = Pose{point(), axis()};
  for (int i = 0; i < 60; ++i) {
    switch (static_cast<int>(in(0, 12))) {
      case 0:
        p.add(Rapid{{point(), axis()}});
        break;
      case 1:
        p.add(Arc{point(), axis(), in(0.001, 1e4), {point(), axis()}});
        break;
      case 2:
        p.add(FeedRate{in(0.1, 1e5)});
        break;
      case 3:
        p.add(in(0, 1) < 0.5
                  ? Spindle{}
                  : Spindle{in(0, 1) < 0.5 ? Rotation::clockwise : Rotation::counter_clockwise, in(0, 3e4)});
        break;
      case 4:
        p.add(in(0, 1) < 0.5 ? Beam{} : Beam{true, in(0, 5000)});
        break;
      case 5:
        p.add(Dwell{in(0, 100)});
        break;
      case 6:
        p.add(ToolChange{static_cast<int>(in(0, 99)), in(0, 1) < 0.5 ? 0 : in(0, 50), in(0, 5)});
        break;
      case 7:
        p.add(Coolant{in(0, 1) < 0.5});
        break;
      case 8:
        p.add(Comment{"  costs $5,\t$$ and /more "});
        break;
      case 9:
        p.add(Unknown{"INTOL/0.01,0.02"});
        break;
      default:
        p.add(Feed{{point(), axis()}});
        break;
    }
  }
  return p;
}

void expect_near(const Pose& a, const Pose& b) {
  EXPECT_LE(distance(a.tip, b.tip), 1e-6);
  EXPECT_LE(norm(a.axis - b.axis), 1e-9);
}

TEST(Apt, RoundTrip) {
  std::mt19937_64 engine(31);
  for (int i = 0; i < 300; ++i) {
    const Program p = random_program(engine);
    const std::string text = write_apt(p);
    const Program q = read(text);
    EXPECT_EQ(q.name, p.name);
    ASSERT_EQ(q.from.has_value(), p.from.has_value());
    if (p.from) expect_near(*p.from, *q.from);
    ASSERT_EQ(q.records.size(), p.records.size());
    for (std::size_t k = 0; k < p.records.size(); ++k) {
      ASSERT_EQ(p.records[k].index(), q.records[k].index()) << text;
      if (const Pose* pose = pose_of(p.records[k])) expect_near(*pose, *pose_of(q.records[k]));
      if (const auto* a = std::get_if<Arc>(&p.records[k])) {
        const auto& b = std::get<Arc>(q.records[k]);
        EXPECT_LE(distance(a->center, b.center), 1e-6);
        EXPECT_LE(norm(a->normal - b.normal), 1e-9);
        EXPECT_NEAR(a->radius, b.radius, 1e-6);
      } else if (const auto* f = std::get_if<FeedRate>(&p.records[k])) {
        EXPECT_NEAR(f->mm_min, std::get<FeedRate>(q.records[k]).mm_min, 1e-6);
      } else if (const auto* t = std::get_if<ToolChange>(&p.records[k])) {
        const auto& u = std::get<ToolChange>(q.records[k]);
        EXPECT_EQ(t->number, u.number);
        EXPECT_NEAR(t->diameter, u.diameter, 1e-6);
        EXPECT_NEAR(t->corner_radius, u.corner_radius, 1e-6);
      } else if (const auto* c = std::get_if<Comment>(&p.records[k])) {
        EXPECT_EQ(*c, std::get<Comment>(q.records[k]));
      } else if (const auto* n = std::get_if<Unknown>(&p.records[k])) {
        EXPECT_EQ(*n, std::get<Unknown>(q.records[k]));
      } else if (const auto* s = std::get_if<Spindle>(&p.records[k])) {
        EXPECT_EQ(s->rotation, std::get<Spindle>(q.records[k]).rotation);
        EXPECT_NEAR(s->rpm, std::get<Spindle>(q.records[k]).rpm, 1e-6);
      } else if (const auto* m = std::get_if<Beam>(&p.records[k])) {
        EXPECT_EQ(m->on, std::get<Beam>(q.records[k]).on);
        EXPECT_NEAR(m->power_w, std::get<Beam>(q.records[k]).power_w, 1e-6);
      }
    }
    EXPECT_EQ(write_apt(q), text);  // and from then on byte for byte
  }
}

TEST(Apt, AnotherSystemsFile) {
  Diagnostics diagnostics;
  const Program p = read(
      "$$ made elsewhere\n"
      "PARTNO   BRACKET\n"
      "MULTAX/ON\n"
      "UNITS/INCHES\n"
      "MACHIN/MILL,1\n"
      "TLDATA/MILL,0.5\n"
      "LOAD/TOOL,3\n"
      "CUTTER / 0.5, 0.1, 0,0,0,0,0\n"
      "SPINDL/2000,RPM,CLW\n"
      "COOLNT/FLOOD\n"
      "FROM/0,0,1\n"
      "rapid\n"
      "GODLTA/0,0,-0.5\n"
      "FEDRAT/10.0\n"
      "GOTO/1.0,2.0, $ rest of the line is no part of it\n"
      "  3.0E-1,0,0.6,0.8 $$ comment\n"
      "FEDRAT/500,MMPM\n"
      "GOTO/2,2,0.3\n"
      "DELAY/1.5\n"
      "TLDATA/MILL,0.6\n"
      "END\n"
      "FINI\n",
      &diagnostics);
  EXPECT_EQ(p.name, "BRACKET");
  ASSERT_TRUE(p.from);
  EXPECT_NEAR(p.from->tip.z, 25.4, 1e-12);
  std::vector<Record> records;
  for (const Record& record : p.records)
    if (!std::holds_alternative<Unknown>(record)) records.push_back(record);
  ASSERT_EQ(records.size(), 9u);
  EXPECT_EQ(std::get<ToolChange>(records[0]), (ToolChange{3, 12.7, 2.54}));
  EXPECT_EQ(std::get<Spindle>(records[1]), (Spindle{Rotation::clockwise, 2000}));
  EXPECT_NEAR(std::get<Rapid>(records[3]).to.tip.z, 12.7, 1e-12);
  EXPECT_NEAR(std::get<FeedRate>(records[4]).mm_min, 254, 1e-9);
  EXPECT_NEAR(std::get<Feed>(records[5]).to.axis.y, 0.6, 1e-12);
  EXPECT_EQ(std::get<FeedRate>(records[6]).mm_min, 500);
  EXPECT_NEAR(std::get<Feed>(records[7]).to.axis.y, 0.6, 1e-12);  // the axis stays
  EXPECT_EQ(diagnostics.count("unknown_statement"), 2u);          // MACHIN and TLDATA, once each
  EXPECT_EQ(diagnostics.count("no_fini"), 0u);
  EXPECT_FALSE(diagnostics.anything_left_out());
}

TEST(Apt, RapidHoldsForOneMotionAndCircleForOneGoto) {
  const Program p = read(
      "FEDRAT/100\nRAPID\nGOTO/10,0,0\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,-1,10\nGOTO/0,-10,0\nGOTO/"
      "0,0,0\nFINI\n");
  ASSERT_EQ(p.records.size(), 5u);
  EXPECT_TRUE(std::holds_alternative<Rapid>(p.records[1]));
  EXPECT_TRUE(std::holds_alternative<Feed>(p.records[2]));
  EXPECT_EQ(std::get<Arc>(p.records[3]).normal.z, -1);
  EXPECT_TRUE(std::holds_alternative<Feed>(p.records[4]));
  EXPECT_EQ(p.source[3], 6u);
  EXPECT_TRUE(validate(p));
}

TEST(Apt, ATruncatedFileIsReported) {
  for (const char* text : {"GOTO/1,2,3\n", "GOTO/1,2,3\nGOTO/4,5,$\n", "GOTO/1,2,3\nCIRCLE/0,0,0,0,0,1,10\n",
                           "GOTO/1,2,3\nRAPID"}) {
    Diagnostics diagnostics;
    EXPECT_EQ(read(text, &diagnostics).move_count(), 1u) << text;
    EXPECT_EQ(diagnostics.count("no_fini"), 1u) << text;
  }
}

TEST(Apt, WordsThatChangeMotionAreLeftOut) {
  Diagnostics diagnostics;
  const Program p = read("CYCLE/DRILL,10\nGOTO/1,2,3\nFEDRAT/0.1,MMPR\nFINI\n", &diagnostics);
  EXPECT_TRUE(diagnostics.anything_left_out());
  EXPECT_EQ(std::get<Unknown>(p.records[0]).text, "CYCLE/DRILL,10");
  EXPECT_EQ(diagnostics.count("feed_per_revolution"), 1u);
}

TEST(Apt, ErrorsSayWhere) {
  const struct {
    const char* text;
    int line, column;
    ErrorCode code;
  } cases[] = {
      {"UNITS/MM\nGOTO/1,2", 2, 1, ErrorCode::syntax},
      {"GOTO/1,x,3", 1, 8, ErrorCode::syntax},
      {"GOTO/1,2,$\n  y", 2, 3, ErrorCode::syntax},
      {"GOTO/1,2,1e300", 1, 10, ErrorCode::range},
      {"GOTO/1,2,3,0,0,0", 1, 12, ErrorCode::range},
      {"CIRCLE/1,2,3", 1, 1, ErrorCode::syntax},
      {"CIRCLE/1,2,3,0,0,1,-5", 1, 20, ErrorCode::range},
      {"CIRCLE/1,2,3,0,0,1,5\nFINI", 2, 1, ErrorCode::syntax},
      {"GODLTA/1,2,3", 1, 1, ErrorCode::syntax},
      {"UNITS/FEET", 1, 1, ErrorCode::unsupported},
      {"FEDRAT/0", 1, 1, ErrorCode::range},
      {"BEAM/5", 1, 1, ErrorCode::syntax},
      {"LOADTL/1.5", 1, 8, ErrorCode::range},
      {"GOTO/1,2,3\x02", 1, 11, ErrorCode::syntax},
  };
  for (const auto& c : cases) {
    Diagnostics diagnostics;
    const auto p = read_apt(c.text, {.file_name = "a.cl"}, diagnostics);
    ASSERT_FALSE(p) << c.text;
    EXPECT_EQ(p.error().code, c.code) << p.error().to_string();
    EXPECT_EQ(p.error().where.file, "a.cl");
    EXPECT_EQ(p.error().where.line, c.line) << c.text;
    EXPECT_EQ(p.error().where.column, c.column) << c.text;
  }
  Diagnostics diagnostics;
  EXPECT_FALSE(read_apt("GOTO/1,2,3\nGOTO/1,2,3\n", {.file_name = "a.cl", .max_records = 1}, diagnostics));
}

TEST(ReadApt, TakesWhatOtherSystemsWrite) {
  Diagnostics diagnostics;
  const Program p = read(
      "TOOL PATH/CAVITY,TOOL,MILL_16\nTLDATA/MILL,16.0,0.8,75.0,0.0,0.0\nMSYS/0,0,0,1,0,0,0,1,0\n"
      "$$ centerline "
      "data\nPAINT/PATH\nLOAD/TOOL,1\nINTOL/0.03\nMULTAX/ON\nRAPID\nGOTO/10,0,5\nFEDRAT/MMPM,250\n"
      "CIRCLE/0,0,5,0,0,1,10,0.03,0.5,16,0.8\nGOTO/0,10,5\nEND-OF-PATH\nFINI\n",
      &diagnostics);
  ASSERT_EQ(p.move_count(), 2u);
  bool loaded = false;
  for (const Record& record : p.records) {
    if (const auto* tool = std::get_if<ToolChange>(&record)) loaded = *tool == ToolChange{1, 16, 0.8};
    if (const auto* arc = std::get_if<Arc>(&record)) {
      EXPECT_EQ(arc->radius, 10);
    }
  }
  EXPECT_TRUE(loaded);
  EXPECT_FALSE(diagnostics.anything_left_out());
  // An arc in words that are not carried out changes the motion: that is said.
  read("RAPID\nGOTO/0,0,0\nINDIRV/1,0,0\nTLON,GOFWD/(CIRCLE/0,5,0,5),ON,(LINE/0,5,0,5,5,0)\nFINI\n",
       &diagnostics);
  EXPECT_TRUE(diagnostics.anything_left_out());
}

}  // namespace
}  // namespace burin::cl
