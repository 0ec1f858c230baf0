// SPDX-License-Identifier: Apache-2.0
#include "burin/io/stl/stl.h"

#include <gtest/gtest.h>

#include <cmath>

#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/mesh_cases.h"

namespace burin::io {
namespace {

using geom::Mesh;

/// Rounds to what single precision holds, so that a round trip is exact.
Mesh rounded(Mesh mesh) {
  for (auto& p : mesh.vertices) p = {double(float(p.x)), double(float(p.y)), double(float(p.z))};
  return mesh;
}

std::string as_text(const Mesh& mesh, const std::string& eol) {
  std::string out = "solid a part, of facet" + eol;
  for (const auto& t : mesh.triangles) {
    out += " facet normal nan nan nan" + eol + "  outer loop" + eol;
    for (const std::uint32_t i : t) {
      char line[120];
      const auto& p = mesh.vertices[i];
      std::snprintf(line, sizeof line, "   vertex %.17g %.17g %.17g", p.x, p.y, p.z);
      out += line + eol;
    }
    out += "  endloop" + eol + " endfacet" + eol;
  }
  return out + "endsolid a part" + eol;
}

void expect_same(const Mesh& a, const Mesh& b) {
  ASSERT_EQ(a.triangles.size(), b.triangles.size());
  for (std::size_t t = 0; t < a.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(a.vertices[a.triangles[t][k]], b.vertices[b.triangles[t][k]]);
  }
}

TEST(Stl, BinaryRoundTrip) {
  const Mesh mesh = rounded(geom::cases::cutter(600, 20, 10, 6, 5, 0.2));
  Diagnostics diagnostics;
  const auto back = read_stl(write_stl(mesh), {}, diagnostics);
  ASSERT_TRUE(back.ok()) << back.error().to_string();
  EXPECT_TRUE(diagnostics.empty());
  expect_same(*back, mesh);
  EXPECT_EQ(back->vertices.size(), mesh.vertices.size());
  EXPECT_TRUE(geom::examine(*back).holes.empty());
}

TEST(Stl, TextInAllItsForms) {
  const Mesh mesh = rounded(geom::cases::sphere(12, 8, {1, 2, 3}, 5));
  for (const std::string eol : {"\n", "\r\n", "\r", "\n\n", " \t\n"}) {
    for (const std::string mark : {"", "\xEF\xBB\xBF", "\n  "}) {
      Diagnostics diagnostics;
      const auto back = read_stl(mark + as_text(mesh, eol), {}, diagnostics);
      ASSERT_TRUE(back.ok()) << back.error().to_string();
      EXPECT_TRUE(diagnostics.empty());
      expect_same(*back, mesh);
    }
  }
  std::string upper = as_text(mesh, "\n");
  for (char& c : upper) c = static_cast<char>(std::toupper(c));
  Diagnostics diagnostics;
  EXPECT_TRUE(read_stl(upper, {}, diagnostics).ok());
}

TEST(Stl, BinaryThatBeginsWithSolid) {
  const Mesh mesh = rounded(geom::cases::box({0, 0, 0}, {1, 2, 3}));
  std::string bytes = write_stl(mesh);
  bytes.replace(0, 30, "solid facet normal 0 0 1 outer");
  Diagnostics diagnostics;
  const auto back = read_stl(bytes, {}, diagnostics);
  ASSERT_TRUE(back.ok()) << back.error().to_string();
  expect_same(*back, mesh);
  bytes += "abc";  // and with something behind it
  const auto more = read_stl(bytes, {}, diagnostics);
  ASSERT_TRUE(more.ok()) << more.error().to_string();
  EXPECT_EQ(diagnostics.count("trailing_data"), 1U);
  EXPECT_FALSE(diagnostics.anything_left_out());
}

TEST(Stl, ScaleSolidsAndDegenerateTriangles) {
  const Mesh mesh = rounded(geom::cases::box({0, 0, 0}, {1, 2, 3}));
  Diagnostics diagnostics;
  const auto inch = read_stl(write_stl(mesh), {.scale = 25.4}, diagnostics);
  ASSERT_TRUE(inch.ok());
  EXPECT_NEAR(geom::examine(*inch).signed_volume, 6 * 25.4 * 25.4 * 25.4, 1e-6);
  EXPECT_TRUE(diagnostics.empty());

  const auto two = read_stl(as_text(mesh, "\n") + as_text(mesh, "\n"), {}, diagnostics);
  ASSERT_TRUE(two.ok());
  EXPECT_EQ(two->triangles.size(), 24U);
  EXPECT_EQ(two->vertices.size(), 8U);
  EXPECT_EQ(diagnostics.count("several_solids"), 1U);

  Mesh more = mesh;
  more.triangles.push_back({0, 0, 1});
  const auto without = read_stl(write_stl(more), {}, diagnostics);
  ASSERT_TRUE(without.ok());
  EXPECT_EQ(without->triangles.size(), 12U);
  EXPECT_EQ(diagnostics.count("degenerate_triangles"), 1U);
}

TEST(Stl, ZeroOfEitherSignIsOnePlace) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, -0.0}, {-1, 0, 0}, {0, -1, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  Diagnostics diagnostics;
  const auto back = read_stl(write_stl(mesh), {}, diagnostics);
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(back->vertices.size(), 5U);
}

}  // namespace
}  // namespace burin::io
