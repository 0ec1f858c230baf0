// SPDX-License-Identifier: Apache-2.0
// Whatever the bytes are: an error that says what and where, never a crash, never memory without bound.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "burin/geom/mesh/mesh_cases.h"
#include "burin/io/stl/stl.h"

namespace burin::io {
namespace {

Error error_of(const std::string& bytes, const ReadStlOptions& options = {.file_name = "part.stl"}) {
  Diagnostics diagnostics;
  const auto mesh = read_stl(bytes, options, diagnostics);
  if (mesh) return {ErrorCode::internal, "was read", {}};
  EXPECT_EQ(mesh.error().where.file, options.file_name);
  return mesh.error();
}

std::string binary() {
  return write_stl(geom::cases::box({0, 0, 0}, {1, 2, 3}));
}
void set_count(std::string& bytes, std::uint32_t count) {
  std::memcpy(bytes.data() + 80, &count, 4);
}

TEST(StlBadInput, Truncated) {
  const std::string whole = binary();
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const Error error = error_of(whole.substr(0, n));
    EXPECT_EQ(error.code, ErrorCode::syntax) << n << error.message;
  }
  EXPECT_NE(error_of(whole.substr(0, 500)).message.find("12 triangles and is long enough for 8"),
            std::string::npos);
  const std::string text =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\nendsolid";
  for (std::size_t n = 0; n + 1 < text.size(); ++n)
    EXPECT_EQ(error_of(text.substr(0, n)).code, ErrorCode::syntax) << n;
}

TEST(StlBadInput, CountsAreComparedBeforeMemoryIsTaken) {
  std::string bytes = binary();
  set_count(bytes, 0xffffffffU);
  EXPECT_NE(error_of(bytes).message.find("4294967295 triangles"), std::string::npos);
  set_count(bytes, 13);
  EXPECT_EQ(error_of(bytes).code, ErrorCode::syntax);
  set_count(bytes, 0);
  EXPECT_EQ(error_of(bytes).message, "holds no triangles");
  EXPECT_EQ(error_of(binary(), {.file_name = "f", .max_triangles = 11}).code, ErrorCode::range);
  set_count(bytes, 10);
  Diagnostics diagnostics;
  EXPECT_TRUE(read_stl(bytes, {}, diagnostics).ok());
  EXPECT_TRUE(diagnostics.anything_left_out());
}

TEST(StlBadInput, NumbersThatAreNone) {
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity(), 3e38F}) {
    std::string bytes = binary();
    std::memcpy(bytes.data() + 84 + 50 * 4 + 12 + 8, &bad, 4);
    const Error error = error_of(bytes);
    EXPECT_EQ(error.code, ErrorCode::syntax);
    EXPECT_EQ(error.where.entity, "triangle 5");
  }
  for (const std::string bad : {"nan", "inf", "1e999", "1,5", "x", "1e9", "--1"}) {
    const Error error = error_of("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 " + bad +
                                 " 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n");
    EXPECT_EQ(error.code, ErrorCode::syntax) << bad;
    // Too far out is seen when the triangle is complete.
    EXPECT_EQ(error.where.line, bad == "1e9" ? 6 : 5) << bad;
  }
}

TEST(StlBadInput, TextWithErrorsAtTheirLine) {
  const auto line = [](const std::string& text) { return error_of(text).where.line; };
  EXPECT_EQ(line("solid a\nfacet norm 0 0 1\n"), 2);
  EXPECT_EQ(line("solid a\nfacet normal 0 0\nouter loop\n"), 3);
  EXPECT_EQ(line("solid a\r\nfacet normal 0 0 1\r\nouter lop\r\n"), 3);
  EXPECT_EQ(line("solid a\rfacet normal 0 0 1\router loop\rvertex 1 2\rvertex"), 5);
  EXPECT_EQ(line("solid a\nendsolid\nfacet"), 3);
  EXPECT_EQ(line("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex "
                 "1 1 0\n"),
            7);
  EXPECT_NE(
      error_of(
          "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 1 1 0\n")
          .message.find("more than three corners"),
      std::string::npos);
  EXPECT_EQ(error_of("solid a\nendsolid a\n").message, "holds no triangles");
  EXPECT_NE(error_of("solid a\n" + std::string(100'000, 'x')).message.find("...\" is not what belongs here"),
            std::string::npos);
}

TEST(StlBadInput, OtherFiles) {
  EXPECT_NE(error_of("").message.find("empty"), std::string::npos);
  EXPECT_NE(error_of("G1 X0 Y0\n").message.find("is no STL file: 9 bytes"), std::string::npos);
  EXPECT_NE(error_of("ISO-10303-21;\n" + std::string(500, 'a')).message.find("no STL file"),
            std::string::npos);
  EXPECT_EQ(error_of("\x89PNG\r\n\x1a\n").code, ErrorCode::syntax);
}

TEST(StlBadInput, ScalesThatAreNone) {
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_EQ(error_of(binary(), {.file_name = "f", .scale = bad}).code, ErrorCode::usage);
}

TEST(StlBadInput, DamagedFilesNeverCrash) {
  std::mt19937 random(1);
  const std::string text =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\nendsolid";
  for (const std::string& whole : {binary(), text}) {
    for (int i = 0; i < 3000; ++i) {
      std::string bytes = whole;
      for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
      Diagnostics diagnostics;
      const auto mesh = read_stl(bytes, {}, diagnostics);
      if (!mesh) continue;
      for (const auto& t : mesh->triangles) {
        for (const std::uint32_t v : t) ASSERT_LT(v, mesh->vertices.size());
      }
    }
  }
}

}  // namespace
}  // namespace burin::io
