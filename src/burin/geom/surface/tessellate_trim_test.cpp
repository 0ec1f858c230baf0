// SPDX-License-Identifier: Apache-2.0
// Trimmed faces in triangles: over a plane with u = x, v = y everything can be compared with the polygons.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "burin/geom/point_tools.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/surface_cases.h"
#include "burin/geom/surface/tessellate.h"

namespace burin::geom {
namespace {

using Loop = std::vector<Point2>;

/// z = bend * x * y over [-1, 1]^2.
NurbsSurface plate(double bend = 0) {
  NurbsSurface s = cases::saddle(1);
  for (HPoint& h : s.points) h.z *= bend;
  return s;
}

double shoelace(const Loop& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Point2 a = p[i], b = p[(i + 1) % p.size()];
    sum += 0.5 * (a.x * b.y - a.y * b.x);
  }
  return sum;
}

double length(const Loop& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += distance(p[i], p[(i + 1) % p.size()]);
  return sum;
}

Loop circle(Point2 c, double r, int n, double wave = 0) {
  Loop loop;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * kPi * i / n, q = r * (1 + wave * std::cos(7 * a));
    loop.push_back({c.x + q * std::cos(a), c.y + q * std::sin(a)});
  }
  return loop;
}

Loop rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

struct Seen {
  double area = 0, least = 1e9, border = 0;
  int bad_edges = 0;
};

/// Flat area, smallest triangle, length of edges with one triangle, edges with more than two or the wrong
/// sense.
Seen look(const Mesh& mesh) {
  Seen seen;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double area = 0.5 * cross(xy(b) - xy(a), xy(c) - xy(a));
    seen.area += area;
    seen.least = std::min(seen.least, area);
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    if (count > 1) ++seen.bad_edges;
    if (edges.count({edge.second, edge.first}) == 0)
      seen.border += distance(xy(mesh.vertices[edge.first]), xy(mesh.vertices[edge.second]));
  }
  return seen;
}

void expect_trimmed(const std::vector<Loop>& loops, double edge, double bend = 0) {
  const auto t = tessellate(plate(bend), false, loops, {0.01, edge, 2'000'000});
  ASSERT_TRUE(t.ok()) << t.error().to_string();
  double area = 0, border = 0;
  for (const Loop& loop : loops) area += shoelace(loop), border += length(loop);
  const Seen seen = look(t->mesh);
  EXPECT_NEAR(seen.area, area, 1e-7);
  EXPECT_GT(seen.least, 0);
  EXPECT_NEAR(seen.border, border, 1e-6);  // no cracks, no holes, no overlaps
  EXPECT_EQ(seen.bad_edges, 0);
  EXPECT_LE(t->deflection_mm, 0.01);
}

TEST(TessellateTrims, CutAlongPolygonsWhateverTheGrid) {
  Loop hole = circle({0.1, 0.05}, 0.3, 60);
  std::reverse(hole.begin(), hole.end());
  Loop small = circle({-0.4, 0.3}, 0.001, 12);
  std::reverse(small.begin(), small.end());
  for (const double edge : {0.0, 0.7, 0.1, 0.04}) {
    expect_trimmed({circle({0, 0}, 0.9, 400, 0.05)}, edge);
    expect_trimmed({circle({0, 0}, 0.9, 400, 0.05), hole, small}, edge);
    expect_trimmed({circle({0, 0}, 0.9, 400, 0.05), hole, small}, edge, 0.3);
    expect_trimmed(
        {
            {{-0.9, -0.9}, {0.9, -0.7}, {0.1, 0.95}},
        },
        edge);
    expect_trimmed({circle({-0.5, 0}, 0.3, 30), circle({0.5, 0}, 0.3, 30)}, edge);  // two parts
  }
}

TEST(TessellateTrims, AlongGridLinesAndThroughTheirCrossings) {
  for (const double edge : {0.0, 1.0, 0.25, 0.06}) {
    expect_trimmed({rectangle(-1, -1, 1, 1)}, edge);
    expect_trimmed({rectangle(-0.5, -0.5, 0.5, 0.25)}, edge);
    expect_trimmed({rectangle(-1, -1, 0, 1)}, edge);
    expect_trimmed({{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}}, edge);  // corner to corner of cells
    Loop hole = {{0, -0.5}, {0.5, 0}, {0, 0.5}, {-0.5, 0}};
    std::reverse(hole.begin(), hole.end());
    expect_trimmed({rectangle(-1, -1, 1, 1), hole}, edge);
    expect_trimmed({{{-1, -1}, {1, -1}, {1, 1}, {0, 0}, {-1, 1}}}, edge);
    // Corners on grid lines, sides within cells.
    expect_trimmed({{{-0.5, -0.8}, {-0.2, -0.5}, {-0.5, -0.1}, {-0.8, -0.5}}}, edge);
  }
}

TEST(TessellateTrims, RandomPolygonsByEvenOdd) {
  // They cross themselves: sampled places are covered once or not at all, as the even-odd rule says.
  cases::Random r(5);
  for (int round = 0; round < 12; ++round) {
    std::vector<Loop> loops(1 + static_cast<std::size_t>(round) % 3);
    for (Loop& loop : loops) {
      const int n = r.integer(3, 14);
      const bool coarse = round % 4 == 3;  // corners that coincide, edges that overlap
      for (int i = 0; i < n; ++i) {
        Point2 p{r.between(-1, 1), r.between(-1, 1)};
        if (coarse) p = {std::round(4 * p.x) / 4, std::round(4 * p.y) / 4};
        loop.push_back(p);
      }
    }
    for (const double edge : {0.0, 1.0, 0.11}) {
      const auto t = tessellate(plate(), false, loops, {0.01, edge, 2'000'000});
      ASSERT_TRUE(t.ok());
      EXPECT_TRUE(t->mesh.triangles.empty() || look(t->mesh).least > 0);
      for (int k = 0; k < 200; ++k) {
        const Point2 p{r.between(-1, 1), r.between(-1, 1)};
        bool near = false, in = false;
        for (const Loop& loop : loops) {
          in = in != inside_polygon(loop, p);
          for (std::size_t i = 0; i < loop.size(); ++i)
            near = near || distance_to_segment(p, loop[i], loop[(i + 1) % loop.size()]) < 1e-6;
        }
        if (near) continue;
        int covered = 0;
        for (const auto& c : t->mesh.triangles) {
          const Loop triangle{xy(t->mesh.vertices[c[0]]), xy(t->mesh.vertices[c[1]]),
                              xy(t->mesh.vertices[c[2]])};
          covered += inside_polygon(triangle, p) ? 1 : 0;
        }
        EXPECT_EQ(covered, in ? 1 : 0) << "round " << round << " edge " << edge << " " << p.x << " " << p.y;
      }
    }
  }
}

TEST(TessellateTrims, RefusesWhatItCannotCut) {
  EXPECT_FALSE(tessellate(plate(), false, {{{0, 0}, {1, std::nan("")}, {0, 1}}}, {0.01, 0, 1000}).ok());
  // Nothing left, nothing wrong.
  const auto none = tessellate(plate(), false, {{{0.1, 0.1}, {0.2, 0.2}, {0.1, 0.1}}}, {0.01, 0, 1000});
  ASSERT_TRUE(none.ok());
  EXPECT_TRUE(none->mesh.triangles.empty());
  // More corners than triangles.
  const auto most = tessellate(plate(), false, {circle({0, 0}, 0.5, 5000)}, {0.01, 0, 1000});
  ASSERT_FALSE(most.ok());
  EXPECT_EQ(most.error().code, ErrorCode::range);
  // Outside of the domain: cut off at its sides.
  const auto beyond = tessellate(plate(), false, {rectangle(-5, -5, 5, 5)}, {0.01, 0, 1000});
  ASSERT_TRUE(beyond.ok());
  EXPECT_NEAR(look(beyond->mesh).area, 4, 1e-9);
}

}  // namespace
}  // namespace burin::geom
