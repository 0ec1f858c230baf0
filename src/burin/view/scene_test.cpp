// SPDX-License-Identifier: Apache-2.0
// Scene files read back by a decoder written from docs/viewer.md alone.
#include "burin/view/scene.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <limits>
#include <random>

#include "burin/geom/mesh/mesh_cases.h"
#include "burin/view/page_test_support.h"

namespace burin::view {
namespace {

using geom::kPi;
using geom::Point3;
using geom::Vec3;
using nlohmann::json;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct Decoded {
  json directory;
  std::string body;

  explicit Decoded(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 8), "BURINSC1");
    std::uint32_t size = 0;
    for (std::size_t k = 0; k < 4; ++k)
      size |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[8 + k])) << 8 * k;
    directory = json::parse(bytes.substr(12, size));
    body = bytes.substr(12 + size);
  }
  const json* chunk(const std::string& name) const {
    for (const json& c : directory["chunks"])
      if (c["name"] == name) return &c;
    return nullptr;
  }
  std::string inflated(const json& c) const {
    const std::string packed = body.substr(c["at"].get<std::size_t>(), c["bytes"].get<std::size_t>());
    std::string out;
    z_stream z{};
    EXPECT_EQ(inflateInit(&z), Z_OK);
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    z.avail_in = static_cast<uInt>(packed.size());
    std::vector<char> part(1 << 16);
    int state = Z_OK;
    while (state == Z_OK) {
      z.next_out = reinterpret_cast<Bytef*>(part.data());
      z.avail_out = static_cast<uInt>(part.size());
      state = inflate(&z, Z_NO_FLUSH);
      out.append(part.data(), part.size() - z.avail_out);
    }
    EXPECT_EQ(state, Z_STREAM_END);
    EXPECT_EQ(z.avail_in, 0u);
    inflateEnd(&z);
    return out;
  }
  /// Row by row.
  std::vector<double> numbers(const std::string& name) const {
    const json* found = chunk(name);
    EXPECT_NE(found, nullptr) << name;
    if (!found) return {};
    const json& c = *found;
    const std::size_t wide = c["components"], n = wide * c["count"].get<std::size_t>();
    const std::string raw = inflated(c);
    const auto byte = [&raw](std::size_t i) {
      return static_cast<std::uint32_t>(static_cast<unsigned char>(raw[i]));
    };
    std::vector<double> out;
    if (c["coding"] == "plain") {
      const std::size_t each = c["type"] == "u8" ? 1 : 2;
      EXPECT_EQ(raw.size(), n * each);
      for (std::size_t i = 0; i < n; ++i)
        out.push_back(each == 1 ? byte(i) : byte(2 * i) | byte(2 * i + 1) << 8);
      return out;
    }
    EXPECT_EQ(raw.size(), 4 * n);
    std::vector<std::uint32_t> last(wide, 0);
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t z = byte(i) | byte(n + i) << 8 | byte(2 * n + i) << 16 | byte(3 * n + i) << 24;
      last[i % wide] += (z >> 1) ^ (0u - (z & 1));
      const auto value = static_cast<std::int32_t>(last[i % wide]);
      const bool none = c.value("none", false) && value == 0x7fffffff;
      out.push_back(none ? NAN : c["offset"][i % wide].get<double>() + c["scale"].get<double>() * value);
    }
    return out;
  }
};

/// Everything a scene can hold, a little of each.
Scene full(std::size_t nodes = 50) {
  Scene s;
  s.title = "part </script> @SCENE@";
  s.operation = "verify";
  s.command_line = "burin view \xff";
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-80, 120);
  double time = 0;
  for (std::size_t i = 0; i < nodes; ++i) {
    s.path.point.push_back({place(random), place(random), place(random)});
    s.path.axis.push_back(geom::unit(Vec3{place(random), place(random), 100}));
    s.path.time_s.push_back(time += 0.01 * static_cast<double>(i % 3));
    s.path.kind.push_back(static_cast<WayKind>(i % 4));
    s.path.feed_mm_min.push_back(i % 4 == 0 ? 0 : 1234.56);
    s.path.move.push_back(static_cast<std::uint32_t>(i / 2));
    s.path.line.push_back(static_cast<std::uint32_t>(nodes - i));
    s.path.tool.push_back(i % 2);
    s.path.group.push_back(static_cast<std::uint16_t>(i % 300));
    s.path.rotary_deg.push_back({-720.12345 + static_cast<double>(i), 1e-5 * static_cast<double>(i)});
  }
  for (int i = 0; i < 300; ++i) s.groups.push_back("contour " + std::to_string(i));
  SceneSeries one{"speed", "mm/min", std::vector<float>(nodes, 3), false};
  one.value[0] = kNaN;
  one.value[1] = -2;
  s.series = {one, {"nothing", "", std::vector<float>(nodes, kNaN), true}};
  SceneMesh mesh{
      "design", MeshRole::design, geom::cases::sphere(20, 10, {5, 6, 7}, 30), {}, "deviation", "mm", 0.05};
  for (std::size_t i = 0; i < mesh.mesh.vertices.size(); ++i)
    mesh.value.push_back(i == 3 ? kNaN : 0.001f * static_cast<float>(i));
  s.meshes = {mesh, {"vice", MeshRole::obstacle, geom::cases::box({0, 0, 0}, {1, 2, 3}), {}, "", "", 0}};
  s.outlines = {{"outer", true, true, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0.f, kNaN, -0.5f}}};
  s.tools = {
      {1, "ball 6 mm", {{ToolPiece::Kind::cutter, 3, 0, 20, 3}, {ToolPiece::Kind::holder, 20, 20, 60, 0}}, 0},
      {2, "laser", {}, 0.3}};
  s.machine = SceneMachine{"trunnion", {{'A', true, {1, 0, 0}, {0, 0, -50}}, {'C', true, {0, 0, 1}, {}}}};
  removal::StockClock clock;
  clock.count = {2, 3, 2};
  clock.step_mm = 0.5;
  for (std::uint32_t i = 0; i < 12; ++i) clock.cut_at.push_back(i == 4 ? removal::StockClock::kNever : i);
  for (std::size_t i = 0; i < 36; ++i) clock.crossing.push_back(static_cast<std::uint8_t>(7 * i));
  s.stock = clock;
  s.cspaces = {{3,
                "path 0, point 3",
                0,
                10,
                -5,
                5,
                2,
                3,
                {0, 1, 0, 1, 0, 0},
                {1, kNaN, 3, kNaN, 5, 6},
                {5, 0},
                std::array{4.0, 1.0}}};
  s.causes = {"free", "gouge"};
  s.findings = {{SceneFinding::Level::fault, "gouge", "move 1", Point3{1, 2, 3}, 7u}, {}};
  s.figures = {{"deviation", "gouge", "0.05 mm"}};
  s.histograms = {{"deviation", "mm", -1, 0.5, {1, 2, 3, 4}, 0.01}};
  s.program_name = "a.nc";
  s.program_text = "G0 X1\nG1 X2\nM2";
  return s;
}

double step_of(const Decoded& d, const std::string& name) {
  return (*d.chunk(name))["scale"];
}

TEST(Scene, PathComesBackWithinItsSteps) {
  const Scene s = full();
  const auto bytes = scene_bytes(s);
  ASSERT_TRUE(bytes) << bytes.error().message;
  const Decoded d(*bytes);
  EXPECT_EQ(d.directory["nodes"], s.path.point.size());
  const auto point = d.numbers("path.point"), axis = d.numbers("path.axis"), time = d.numbers("path.time"),
             feed = d.numbers("path.feed"), rotary = d.numbers("path.rotary");
  const auto kind = d.numbers("path.kind"), move = d.numbers("path.move"), line = d.numbers("path.line"),
             tool = d.numbers("path.tool"), group = d.numbers("path.group");
  ASSERT_EQ(point.size(), 3 * s.path.point.size());
  EXPECT_EQ(step_of(d, "path.point"), SceneOptions{}.point_step_mm);
  for (std::size_t i = 0; i < s.path.point.size(); ++i) {
    const Point3 p{point[3 * i], point[3 * i + 1], point[3 * i + 2]};
    EXPECT_LE(distance(p, s.path.point[i]), 1e-4);
    const Vec3 a{axis[3 * i], axis[3 * i + 1], axis[3 * i + 2]};
    EXPECT_LE(norm(a - s.path.axis[i]), 3e-5);
    EXPECT_NEAR(time[i], s.path.time_s[i], 5.1e-5);
    EXPECT_NEAR(feed[i], s.path.feed_mm_min[i], 0.0051);
    EXPECT_NEAR(rotary[2 * i], s.path.rotary_deg[i][0], 5.1e-6);
    EXPECT_NEAR(rotary[2 * i + 1], s.path.rotary_deg[i][1], 5.1e-6);
    EXPECT_EQ(kind[i], static_cast<double>(s.path.kind[i]));
    EXPECT_EQ(move[i], s.path.move[i]);
    EXPECT_EQ(line[i], s.path.line[i]);
    EXPECT_EQ(tool[i], s.path.tool[i]);
    EXPECT_EQ(group[i], s.path.group[i]);
  }
}

void expect_values(const std::vector<double>& got, const std::vector<float>& wanted, double step) {
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    if (std::isnan(wanted[i])) {
      EXPECT_TRUE(std::isnan(got[i])) << i;
    } else {
      EXPECT_NEAR(got[i], wanted[i], step) << i;
    }
  }
}

TEST(Scene, ValuesAndTablesComeBack) {
  const Scene s = full();
  const Decoded d(*scene_bytes(s));
  expect_values(d.numbers("series.0"), s.series[0].value, 5.0 / 262144);
  expect_values(d.numbers("series.1"), s.series[1].value, 0);
  expect_values(d.numbers("mesh.0.value"), s.meshes[0].value, 1e-6);
  expect_values(d.numbers("outline.0.value"), s.outlines[0].value, 1e-5);
  expect_values(d.numbers("cspace.0.radius"), s.cspaces[0].radius_mm, 1e-4);
  EXPECT_EQ(d.numbers("cspace.0.cause"), (std::vector<double>{0, 1, 0, 1, 0, 0}));
  EXPECT_EQ(d.chunk("mesh.1.value"), nullptr);
  const auto index = d.numbers("mesh.0.index"), vertex = d.numbers("mesh.0.point"),
             cut = d.numbers("stock.cut"), crossing = d.numbers("stock.crossing");
  for (std::size_t i = 0; i < s.meshes[0].mesh.triangles.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(index[3 * i + c], s.meshes[0].mesh.triangles[i][c]);
  for (std::size_t i = 0; i < s.meshes[0].mesh.vertices.size(); ++i)
    EXPECT_LE(distance({vertex[3 * i], vertex[3 * i + 1], vertex[3 * i + 2]}, s.meshes[0].mesh.vertices[i]),
              1e-4);
  for (std::size_t i = 0; i < cut.size(); ++i) EXPECT_EQ(cut[i], i == 4 ? -1.0 : static_cast<double>(i));
  for (std::size_t i = 0; i < crossing.size(); ++i) EXPECT_EQ(crossing[i], s.stock->crossing[i]);
  EXPECT_EQ(d.inflated(*d.chunk("program.text")), s.program_text);
  EXPECT_EQ(d.directory["program"], (json{{"name", "a.nc"}, {"lines", 3}, {"cut", false}}));
  EXPECT_EQ(d.directory["stock"]["count"], (json{2, 3, 2}));
  EXPECT_EQ(d.directory["findings"][0]["node"], 7);
  EXPECT_TRUE(d.directory["findings"][1]["at"].is_null());
  EXPECT_EQ(d.directory["machine"]["axes"][0]["letter"], "A");
  EXPECT_EQ(d.directory["tools"][0]["pieces"][0]["corner"], 3);
  EXPECT_EQ(d.directory["cspaces"][0]["initial"], (json{4.0, 1.0}));
}

TEST(Scene, WhatIsMissingIsLeftOut) {
  Scene s = full();
  s.path.axis.clear();
  s.path.rotary_deg.clear();
  s.stock.reset();
  s.machine.reset();
  const Decoded d(*scene_bytes(s));
  EXPECT_EQ(d.chunk("path.axis"), nullptr);
  EXPECT_EQ(d.chunk("path.rotary"), nullptr);
  EXPECT_EQ(d.chunk("stock.cut"), nullptr);
  EXPECT_TRUE(d.directory["stock"].is_null());
  const auto empty = scene_bytes(Scene{});
  ASSERT_TRUE(empty) << empty.error().message;
  EXPECT_EQ(Decoded(*empty).directory["nodes"], 0);
}

TEST(Scene, LargeCoordinatesGetCoarserSteps) {
  Scene s = full(4);
  s.findings.clear();
  s.path.point = {{-3e9, 0, 0}, {4e9, 1, 2}, {0, 0, 0}, {5, 5, 5}};
  s.path.time_s = {0, 1, 2, 1e9};
  const Decoded d(*scene_bytes(s));
  const auto point = d.numbers("path.point"), time = d.numbers("path.time");
  const double step = step_of(d, "path.point");
  EXPECT_GT(step, 1e-4);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(point[3 * i], s.path.point[i].x, step);
  EXPECT_NEAR(time[3], 1e9, 1);
}

TEST(Scene, BadScenesAreRefused) {
  const auto refused = [](const auto& spoil, const std::string& about) {
    Scene s = full();
    spoil(s);
    const auto made = scene_bytes(s);
    ASSERT_FALSE(made) << about;
    EXPECT_EQ(made.error().code, ErrorCode::range);
    EXPECT_NE(made.error().message.find(about), std::string::npos) << made.error().message;
    EXPECT_NE(made.error().message.find('('), std::string::npos) << made.error().message;
  };
  refused([](Scene& s) { s.path.time_s.pop_back(); }, "time has 49 rows");
  refused([](Scene& s) { s.path.axis.pop_back(); }, "axis");
  refused([](Scene& s) { s.path.rotary_deg.pop_back(); }, "rotary");
  refused([](Scene& s) { s.path.point[3].y = NAN; }, "not finite");
  refused([](Scene& s) { s.path.point[3].y = 1e300; }, "not finite");
  refused([](Scene& s) { s.path.axis[3] = {0, 0, 2}; }, "length 1");
  refused([](Scene& s) { s.path.time_s[9] = -1; }, "goes back");
  refused([](Scene& s) { s.path.tool[2] = 2; }, "tool or group");
  refused([](Scene& s) { s.path.group[2] = 300; }, "tool or group");
  refused([](Scene& s) { s.path.kind[2] = static_cast<WayKind>(9); }, "kind");
  refused([](Scene& s) { s.machine.reset(); }, "without a machine");
  refused([](Scene& s) { s.series[0].value.pop_back(); }, "series");
  refused([](Scene& s) { s.series[0].value[4] = INFINITY; }, "series");
  refused([](Scene& s) { s.meshes[1].mesh.triangles[0][1] = 8; }, "vice");
  refused([](Scene& s) { s.meshes[0].value.pop_back(); }, "design");
  refused([](Scene& s) { s.meshes[0].mesh.vertices[0].x = INFINITY; }, "design");
  refused([](Scene& s) { s.outlines[0].value.pop_back(); }, "outer");
  refused([](Scene& s) { s.stock->count = {2, 3, 3}; }, "stock");
  refused([](Scene& s) { s.stock->count = {0xffffffffu, 0xffffffffu, 2}; }, "stock");
  refused([](Scene& s) { s.stock->step_mm = 0; }, "stock");
  refused([](Scene& s) { s.cspaces[0].cause.pop_back(); }, "C-space");
  refused([](Scene& s) { s.cspaces[0].cause[0] = 2; }, "C-space");
  refused([](Scene& s) { s.cspaces[0].node = 50; }, "C-space");
  refused([](Scene& s) { s.findings[0].node = 50; }, "gouge");
  refused([](Scene& s) { s.histograms[0].area[1] = NAN; }, "histogram");
  refused([](Scene& s) { s.tools[0].pieces[0].radius = NAN; }, "tool");
  Scene s = full();
  SceneOptions options;
  options.point_step_mm = 0;
  EXPECT_FALSE(scene_bytes(s, options));
}

TEST(Scene, ThinnedMeshesKeepTheWorstValues) {
  Scene s = full();
  s.meshes[0].mesh = geom::cases::sphere(200, 100, {0, 0, 0}, 30);
  s.meshes[0].value.assign(s.meshes[0].mesh.vertices.size(), 0.001f);
  s.meshes[0].value[777] = -0.4f;
  s.meshes[0].value[9000] = 0.3f;
  SceneOptions options;
  options.max_triangles = 3000;
  const Decoded d(*scene_bytes(s, options));
  const json& mesh = d.directory["meshes"][0];
  EXPECT_EQ(mesh["of"], s.meshes[0].mesh.triangles.size());
  EXPECT_LE(mesh["triangles"], 3000);
  EXPECT_GT(mesh["triangles"], 700);
  const auto values = d.numbers("mesh.0.value");
  EXPECT_EQ(values.size(), d.numbers("mesh.0.point").size() / 3);
  EXPECT_NEAR(*std::min_element(values.begin(), values.end()), -0.4, 1e-5);
  EXPECT_NEAR(*std::max_element(values.begin(), values.end()), 0.3, 1e-5);
  EXPECT_EQ(d.directory["meshes"][1]["triangles"], 12);
}

TEST(Scene, LongListingsAreCutAtALine) {
  Scene s = full();
  s.program_text.clear();
  for (int i = 0; i < 1000; ++i) s.program_text += "G1 X" + std::to_string(i) + "\n";
  SceneOptions options;
  options.max_text_bytes = 100;
  const Decoded d(*scene_bytes(s, options));
  const std::string text = d.inflated(*d.chunk("program.text"));
  EXPECT_LE(text.size(), 100u);
  EXPECT_EQ(text, s.program_text.substr(0, text.size()));
  EXPECT_EQ(text.back(), '\n');
  EXPECT_EQ(d.directory["program"], (json{{"name", "a.nc"}, {"lines", 1000}, {"cut", true}}));
}

/// A finishing path as planners make them: zigzag over a bent face, axis swinging, feed near constant.
Scene long_path(std::size_t nodes) {
  Scene s;
  s.title = "long";
  s.tools.resize(1);
  SceneSeries radius{"effective radius", "mm", {}, false};
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto row = static_cast<double>(i / 500), t = static_cast<double>(i % 500) / 500;
    const double x = 100 * (i / 500 % 2 ? 1 - t : t), y = 0.25 * row;
    s.path.point.push_back({x, y, 10 * std::sin(x / 17) * std::cos(y / 23)});
    s.path.axis.push_back(geom::unit(Vec3{0.3 * std::cos(x / 17), 0.2 * std::sin(y / 23), 1}));
    s.path.time_s.push_back(0.012 * static_cast<double>(i) + 0.001 * std::sin(static_cast<double>(i)));
    s.path.kind.push_back(WayKind::feed);
    s.path.feed_mm_min.push_back(1000);
    s.path.move.push_back(static_cast<std::uint32_t>(i));
    s.path.line.push_back(static_cast<std::uint32_t>(i + 12));
    s.path.tool.push_back(0);
    s.path.group.push_back(static_cast<std::uint16_t>(i / 500));
    radius.value.push_back(static_cast<float>(20 + 5 * std::sin(x / 11)));
    s.program_text += "N" + std::to_string(i) + " G1 X" + std::to_string(x) + " Y" + std::to_string(y) +
                      " Z" + std::to_string(s.path.point.back().z) + "\n";
  }
  for (std::size_t i = 0; i <= nodes / 500; ++i) s.groups.push_back("pass " + std::to_string(i));
  s.series = {radius};
  return s;
}

TEST(Scene, TwoHundredThousandNodesStayBelowTenMegabytes) {
  const Scene s = long_path(200'000);
  const auto page = viewer_page(s);
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_LT(page->size(), 10u * 1000 * 1000);
  RecordProperty("bytes", static_cast<int>(page->size()));
}

TEST(Scene, PageHoldsTheSceneOnceAndNothingElseOfIt) {
  Scene s = full();
  const auto page = viewer_page(s);
  ASSERT_TRUE(page);
  const std::string open = "<script id=\"burin-scene\" type=\"text/plain\">";
  const std::size_t from = page->find(open);
  ASSERT_NE(from, std::string::npos);
  const std::size_t begin = from + open.size(), end = page->find("</script>", begin);
  EXPECT_EQ(test::decode64(page->substr(begin, end - begin)), *scene_bytes(s));
  EXPECT_NE(page->find("<title>part &lt;/script&gt; @SCENE@</title>"), std::string::npos);
  EXPECT_EQ(*page, *viewer_page(s));
  const std::string shell = viewer_shell("a & b");
  EXPECT_NE(shell.find(open + "</script>"), std::string::npos);
  EXPECT_NE(shell.find("<title>a &amp; b</title>"), std::string::npos);
}

}  // namespace
}  // namespace burin::view
