// SPDX-License-Identifier: Apache-2.0
// What is written is read back the same; what is written differently is read the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include "burin/base/file.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/nc/surface_program.h"

namespace burin::nc {
namespace {

using geom::Direction;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  int integer(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(engine_); }
  double number(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(engine_); }
  bool chance(double p) { return number(0, 1) < p; }
  std::mt19937& engine() { return engine_; }

 private:
  std::mt19937 engine_;
};

std::vector<double> knots(Random& random, int count, int degree) {
  if (random.chance(0.3)) return geom::clamped_uniform_knots(count, degree);
  const double scale = std::pow(10.0, random.integer(-9, 5)),
               at = random.chance(0.5) ? 0 : random.number(-1, 1);
  std::vector<double> inner;
  for (int i = 0; i < count - degree - 1; ++i) inner.push_back(random.integer(1, 9) / 10.0);
  std::sort(inner.begin(), inner.end());
  for (std::size_t i = static_cast<std::size_t>(degree); i < inner.size(); ++i)  // too often the same
    if (inner[i] <= inner[i - static_cast<std::size_t>(degree)])
      inner[i] = inner[i - static_cast<std::size_t>(degree)] + random.number(0.01, 0.09);
  std::sort(inner.begin(), inner.end());
  std::vector<double> all(static_cast<std::size_t>(degree + 1), 0.0);
  all.insert(all.end(), inner.begin(), inner.end());
  const double end = std::max(1.0, inner.empty() ? 1.0 : inner.back() + 0.1);
  all.insert(all.end(), static_cast<std::size_t>(degree + 1), end);
  for (double& t : all) t = scale * (t + at);
  return all;
}

SurfaceBlock random_block(Random& random) {
  SurfaceBlock block;
  geom::NurbsSurface& s = block.surface;
  s.degree_u = random.integer(1, 5);
  s.degree_v = random.integer(1, 5);
  s.count_u = s.degree_u + random.integer(1, 5);
  s.count_v = s.degree_v + random.integer(1, 5);
  s.knots_u = knots(random, s.count_u, s.degree_u);
  s.knots_v = knots(random, s.count_v, s.degree_v);
  const int weights = random.integer(0, 3);  // none, one for all, ordinary, far apart
  const double all = random.number(0.1, 9), size = std::pow(10.0, random.integer(-2, 3));
  for (int j = 0; j < s.count_v; ++j)
    for (int i = 0; i < s.count_u; ++i) {
      const double w = weights == 0   ? 1
                       : weights == 1 ? all
                       : weights == 2 ? random.number(0.3, 3)
                                      : std::pow(10.0, random.number(-5, 5));
      const geom::Point3 p{size * i, size * j, random.chance(0.3) ? 0.0 : size * random.number(-1, 1)};
      s.points.push_back(geom::homogeneous(p, w));
    }
  if (random.chance(0.2)) s.at(1, 0) = s.at(0, 0);  // a point twice in a row
  for (int n = random.chance(0.3) ? random.integer(1, 2) : 0; n > 0; --n) {
    TrimLoop loop;
    const geom::Interval u = s.domain(Direction::u), v = s.domain(Direction::v);
    for (int k = random.integer(3, 9); k > 0; --k)
      loop.points.push_back(
          {u.lo + random.number(0, 1) * u.length(), v.lo + random.number(0, 1) * v.length()});
    block.trims.push_back(loop);
  }
  return block;
}

double part(double t, geom::Interval domain) {
  return (t - domain.lo) / domain.length();
}

/// The same surface within half a decimal of what is written, parameters in parts of the domain.
void expect_same(const SurfaceBlock& a, const SurfaceBlock& b, int decimals) {
  const auto &s = a.surface, &t = b.surface;
  ASSERT_EQ(s.degree_u, t.degree_u);
  ASSERT_EQ(s.degree_v, t.degree_v);
  ASSERT_EQ(s.count_u, t.count_u);
  ASSERT_EQ(s.count_v, t.count_v);
  const double half = 0.5 * std::pow(10.0, -decimals) * (1 + 1e-6) + 1e-12;
  const double factor = t.points[0].w / s.points[0].w;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const geom::Vec3 off = project(s.points[i]) - project(t.points[i]);
    EXPECT_LE(std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}), half);
    EXPECT_NEAR(t.points[i].w / (factor * s.points[i].w), 1, 2e-8);
  }
  for (Direction d : {Direction::u, Direction::v})
    for (std::size_t i = 0; i < s.knots(d).size(); ++i)
      EXPECT_NEAR(part(s.knots(d)[i], s.domain(d)), part(t.knots(d)[i], t.domain(d)), 1e-10);
  ASSERT_EQ(a.trims.size(), b.trims.size());
  for (std::size_t k = 0; k < a.trims.size(); ++k) {
    ASSERT_EQ(a.trims[k].points.size(), b.trims[k].points.size());
    for (std::size_t i = 0; i < a.trims[k].points.size(); ++i) {
      const geom::Point2 p = a.trims[k].points[i], q = b.trims[k].points[i];
      EXPECT_NEAR(part(p.x, s.domain(Direction::u)), part(q.x, t.domain(Direction::u)), 1e-10);
      EXPECT_NEAR(part(p.y, s.domain(Direction::v)), part(q.y, t.domain(Direction::v)), 1e-10);
    }
  }
}

void expect_fit_for_controls(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 120u) << line;
    if (line.starts_with('(')) continue;
    for (char c : line)
      EXPECT_TRUE(std::isupper(c) || std::isdigit(c) || c == '.' || c == '-' || c == ' ' || c == '%') << line;
    EXPECT_EQ(line.find('E') == std::string::npos, !line.starts_with("G106.2")) << line;
  }
}

SurfaceProgram read(const std::string& text, bool strict = true) {
  Diagnostics diagnostics;
  auto program = read_surface_program(text, {.file_name = "a.nc", .strict = strict}, diagnostics);
  EXPECT_TRUE(program) << program.error().to_string() << '\n' << text;
  return program ? *std::move(program) : SurfaceProgram{};
}

TEST(SurfaceWrite, WhatIsWrittenIsReadBack) {
  for (unsigned seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::vector<SurfaceBlock> blocks;
    for (int n = random.integer(1, 4); n > 0; --n) blocks.push_back(random_block(random));
    if (random.chance(0.5))
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        blocks[i].stock = 0.25;
        blocks[i].number = 100 + 7 * static_cast<int>(i);
      }
    SurfaceWriteOptions options;
    options.name = "part (one)\n\x80";
    options.decimals = random.integer(3, 9);
    options.grouping = static_cast<geom::Grouping>(random.integer(1, 4));
    options.method = static_cast<PathMethod>(random.integer(1, 2));
    if (random.chance(0.5)) options.side_step = 0.125;
    const auto text = write_surface_program(blocks, options);
    ASSERT_TRUE(text) << text.error().message;
    expect_fit_for_controls(*text);
    const SurfaceProgram program = read(*text);
    ASSERT_EQ(program.blocks.size(), blocks.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      expect_same(blocks[i], program.blocks[i], options.decimals);
      EXPECT_EQ(program.blocks[i].stock, blocks[i].stock);
      EXPECT_TRUE(!blocks[i].number || program.blocks[i].number == blocks[i].number);
    }
    const auto* group = std::get_if<MachineGroup>(&program.steps.back());
    ASSERT_TRUE(group);
    EXPECT_EQ(group->grouping, options.grouping);
    EXPECT_EQ(group->method, options.method);
    EXPECT_EQ(group->side_step, options.side_step);
    EXPECT_EQ(group->tool_diameter, options.tool_diameter);
    EXPECT_EQ(group->safety_z, options.safety_z);
    EXPECT_EQ(group->blocks.size(), blocks.size());
    // Written once more it is the same text: nothing creeps.
    if (options.decimals <= 7) {
      const auto again = write_surface_program(program.blocks, options);
      ASSERT_TRUE(again);
      EXPECT_TRUE(*again == *text);
    }
  }
}

TEST(SurfaceWrite, LeavesOutWhatStays) {
  SurfaceBlock block;
  block.surface = {1, 1, 2, 2, {0, 0, 1, 1}, {0, 0, 1, 1}, {}};
  for (double y : {0.0, 8.0})
    for (double x : {0.0, 10.0}) block.surface.points.push_back(geom::homogeneous({x, y, 1}, 3));
  const auto text = write_surface_program({block}, {});
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("N10 G06.23 U2 V2 P2 Q2\nX0.Y0.Z1.W1.\nX10.\nX0.Y8.\nX10.\nG80\n"), std::string::npos)
      << *text;
}

TEST(SurfaceWrite, RefusesWhatCannotBeRead) {
  Random random(1);
  SurfaceBlock block = random_block(random);
  const auto code = [&](const std::vector<SurfaceBlock>& blocks, SurfaceWriteOptions options = {}) {
    const auto text = write_surface_program(blocks, options);
    EXPECT_FALSE(text);
    return text ? ErrorCode::internal : text.error().code;
  };
  EXPECT_EQ(code({}), ErrorCode::usage);
  EXPECT_EQ(code({block}, {.tool_diameter = 0}), ErrorCode::usage);
  EXPECT_EQ(code({block}, {.scallop = 4}), ErrorCode::usage);
  EXPECT_EQ(code({block}, {.feed = -1}), ErrorCode::usage);
  EXPECT_EQ(code({block}, {.safety_z = std::nan("")}), ErrorCode::usage);
  EXPECT_EQ(code({block}, {.decimals = 12}), ErrorCode::usage);
  SurfaceBlock other = block;
  other.stock = 1;
  EXPECT_EQ(code({block, other}), ErrorCode::usage);
  other = block;
  other.surface.points.pop_back();
  EXPECT_EQ(code({other}), ErrorCode::geometry);
  other = block;
  other.surface.points[0] = geom::homogeneous({1e9, 0, 0}, 1);
  EXPECT_EQ(code({other}), ErrorCode::range);
  other.surface = {1, 1, 3, 2, {0, 0, 1e-14, 1, 1}, {0, 0, 1, 1}, {}};
  for (int i = 0; i < 6; ++i)
    other.surface.points.push_back(geom::homogeneous({i % 3 * 1.0, i / 3 * 1.0, 0}, 1));
  EXPECT_EQ(code({other}), ErrorCode::range);
}

// --- the same program in other clothes

std::string transformed(const std::string& text, Random& random) {
  std::string out;
  std::istringstream lines(text);
  const std::string end = random.chance(0.3) ? "\r\n" : random.chance(0.3) ? "\r" : "\n";
  for (std::string line; std::getline(lines, line);) {
    if (random.chance(0.1)) out += end;
    if (random.chance(0.1)) out += "( between )" + end;
    if (random.chance(0.05)) out += "  ;" + end;
    const bool words = !line.empty() && std::isupper(line[0]);
    if (!words) {
      out += line + end;
      continue;
    }
    const std::string note =
        line.find_first_of("(;") == std::string::npos ? "" : line.substr(line.find_first_of("(;"));
    std::vector<std::string> tokens;
    for (char c : line.substr(0, line.find_first_of("(;"))) {
      if (std::isupper(c)) tokens.emplace_back();
      if (c != ' ') tokens.back() += c;
    }
    std::shuffle(tokens.begin(), tokens.end(), random.engine());
    for (std::string token : tokens) {
      if (random.chance(0.3)) token[0] = static_cast<char>(std::tolower(token[0]));
      if (random.chance(0.2)) token.insert(1, " ");
      if (random.chance(0.2) && token.find('.') != std::string::npos) token += "00";
      if (random.chance(0.1) && token[1] != '-' && token[1] != ' ') token.insert(1, "+");
      out += token + (random.chance(0.5) ? " " : random.chance(0.2) ? "\t" : "");
    }
    out += note.empty() && random.chance(0.2) ? ";" : note;
    out += end;
  }
  return out;
}

/// Without comments and lines.
std::vector<Step> essence(const SurfaceProgram& program) {
  std::vector<Step> steps;
  for (Step step : program.steps) {
    if (auto* plain = std::get_if<Plain>(&step); plain && std::holds_alternative<cl::Comment>(plain->record))
      continue;
    std::visit([](auto& one) { one.line = 0; }, step);
    steps.push_back(std::move(step));
  }
  return steps;
}

bool same(const Step& a, const Step& b) {
  if (a.index() != b.index()) return false;
  if (const auto* p = std::get_if<Plain>(&a)) {
    const auto& q = std::get<Plain>(b);
    return p->record == q.record && p->feed == q.feed;
  }
  if (const auto* p = std::get_if<CurveMove>(&a)) return p->curve == std::get<CurveMove>(b).curve;
  const auto &p = std::get<MachineGroup>(a), &q = std::get<MachineGroup>(b);
  return p.blocks == q.blocks && p.join == q.join && p.grouping == q.grouping && p.method == q.method &&
         p.tool_diameter == q.tool_diameter && p.stock == q.stock && p.feed == q.feed &&
         p.scallop == q.scallop && p.side_step == q.side_step && p.safety_z == q.safety_z &&
         p.displacement == q.displacement && p.repeat == q.repeat && p.start == q.start;
}

TEST(SurfaceProgram, BlanksCommentsCaseOrderAndLineEndsDoNotMatter) {
  const std::string curve =
      "G21 G0 X1 Y2 Z3\nG06.2 P3 K0 X1 Y2 R1 F100\nK0 X3 R.5\nK0 Y4\nK2\nK2\nK2\nG1 X0\n";
  std::vector<std::string> texts = {curve};
  for (const char* name : {"keys/keys.nc", "clock/clock.nc", "table2/table2.nc"}) {
    const auto text = read_file(std::string(BURIN_SOURCE_DIR) + "/examples/" + name);
    ASSERT_TRUE(text);
    texts.push_back(*text);
  }
  for (const std::string& text : texts) {
    const SurfaceProgram want = read(text, false);
    for (unsigned seed = 0; seed < 30; ++seed) {
      SCOPED_TRACE(seed);
      Random random(seed);
      const SurfaceProgram got = read(transformed(text, random), false);
      ASSERT_EQ(got.blocks.size(), want.blocks.size());
      for (std::size_t i = 0; i < want.blocks.size(); ++i)
        EXPECT_EQ(got.blocks[i].surface, want.blocks[i].surface);
      const auto a = essence(want), b = essence(got);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(same(a[i], b[i])) << i;
    }
  }
}

// Inches are the same program: all lengths divided by 25.4.
TEST(SurfaceProgram, InchesAndMillimetresAgree) {
  Random random(3);
  const auto text = write_surface_program({random_block(random), random_block(random)}, {.decimals = 3});
  ASSERT_TRUE(text);
  std::istringstream lines(*text);
  std::string inches;
  for (std::string line; std::getline(lines, line);) {
    if (line == "G21 G90") line = "G20 G90";
    std::string out;
    for (std::size_t i = 0; i < line.size();) {
      const char letter = line[i];
      const bool length =
          std::string("XYZDFMSL").find(letter) != std::string::npos && line[0] != '(' && line != "M30";
      const bool height = letter == 'W' && line.starts_with("G106.2");
      std::size_t end = i + 1;
      while (end < line.size() && !std::isupper(line[end]) && line[end] != ' ') ++end;
      if (length || height) {
        std::ostringstream value;
        value.precision(17);
        value << std::fixed << std::stod(line.substr(i + 1, end - i - 1)) / 25.4;
        out += letter + value.str();
      } else {
        out += line.substr(i, end - i);
      }
      i = end;
    }
    inches += out + '\n';
  }
  const SurfaceProgram a = read(*text), b = read(inches);
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (std::size_t i = 0; i < a.blocks.size(); ++i) expect_same(a.blocks[i], b.blocks[i], 9);
  const auto &g = std::get<MachineGroup>(a.steps.back()), &h = std::get<MachineGroup>(b.steps.back());
  EXPECT_NEAR(g.safety_z, h.safety_z, 1e-9);
  EXPECT_NEAR(g.tool_diameter, h.tool_diameter, 1e-9);
  EXPECT_NEAR(g.scallop, h.scallop, 1e-9);
  EXPECT_NEAR(g.feed, h.feed, 1e-9);
}

TEST(SurfaceProgram, NoiseNeverFailsBadly) {
  const auto clock = read_file(std::string(BURIN_SOURCE_DIR) + "/examples/keys/keys.nc");
  ASSERT_TRUE(clock);
  const std::string alphabet = "GXYZNMUVPQDLFSWKRIE0123456789.- ()%;/\n";
  int refused = 0;
  for (unsigned seed = 0; seed < 3000; ++seed) {
    Random random(seed);
    std::string text = *clock;
    for (int k = random.integer(1, 3); k > 0; --k) {
      const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1));
      if (random.chance(0.5))
        text[at] =
            alphabet[static_cast<std::size_t>(random.integer(0, static_cast<int>(alphabet.size()) - 1))];
      else
        text.erase(at, static_cast<std::size_t>(random.integer(1, 30)));
    }
    Diagnostics diagnostics;
    const auto program = read_surface_program(text, {}, diagnostics);
    if (program) {
      for (const SurfaceBlock& block : program->blocks) EXPECT_TRUE(geom::validate(block.surface));
      continue;
    }
    ++refused;
    EXPECT_GE(program.error().where.line, 1);
    EXPECT_GE(program.error().where.column, 1);
  }
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace burin::nc
