// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/slivers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

#include "burin/geom/point_tools.h"

namespace burin::verify {
namespace {

using geom::Mesh;
using geom::Point3;
using geom::Vec3;

TEST(Slivers, TheSameSurfaceInShorterPiecesThatShareTheirEdges) {
  // A band of 100 x 1 mm in slivers of both senses, and one square triangle that stays.
  Mesh m;
  for (int i = 0; i <= 10; ++i)
    for (const double x : {0.0, 100.0}) m.vertices.push_back({x, 0.1 * i, 0.01 * i * i});
  for (std::uint32_t i = 0; i < 10; ++i) {
    m.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    m.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }
  const auto n = static_cast<std::uint32_t>(m.vertices.size());
  for (const Point3 p : {Point3{0, 5, 0}, Point3{3, 5, 0}, Point3{0, 8, 0}}) m.vertices.push_back(p);
  m.triangles.push_back({n, n + 1, n + 2});
  const Mesh cut = cut_slivers(m, 2.0);

  const auto area = [](const Mesh& mesh) {
    Vec3 sum{};
    double all = 0;
    for (const auto& t : mesh.triangles) {
      const Vec3 a =
          cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]);
      EXPECT_GT(a.z, 0);
      sum = sum + a, all += norm(a);
    }
    EXPECT_NEAR(sum.z, norm(sum), all);
    return 0.5 * all;
  };
  EXPECT_NEAR(area(cut), area(m), 1e-9 * area(m));
  EXPECT_EQ(cut.triangles.back(), m.triangles.back());
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : cut.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      EXPECT_LE(distance(cut.vertices[a], cut.vertices[b]), t == m.triangles.back() ? 5 : 2.0 * 1.415)
          << a << " " << b;
      ++edges[{std::min(a, b), std::max(a, b)}];
    }
  // Border of the band: 64 pieces on both long sides, 10 at either end; and the lone triangle's.
  EXPECT_EQ(std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second == 1; }),
            2 * 64 + 20 + 3);
  // 64 slices: two triangles each but for the apex.
  EXPECT_EQ(cut.triangles.size(), 20u * 127 + 1);
}

TEST(Slivers, NothingIsCutThatNeedsItNotOrWouldBeTooMuch) {
  Mesh m;
  m.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 0.1, 0}};
  m.triangles = {{0, 1, 2}};
  EXPECT_EQ(cut_slivers(m, 2.0).triangles, m.triangles);
  EXPECT_EQ(cut_slivers(m, 0).triangles, m.triangles);
  EXPECT_EQ(cut_slivers(m, 1e-9, 1000).triangles, m.triangles);
}

}  // namespace
}  // namespace burin::verify
