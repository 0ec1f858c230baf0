// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/tessellate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "burin/geom/surface/closest.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/second_bounds.h"
#include "burin/geom/surface/surface_cases.h"

namespace burin::geom {
namespace {

double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += 0.5 *
           norm(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]));
  return sum;
}

/// Largest distance from places of the triangles to the surface, sampled.
double real_deviation(const NurbsSurface& surface, const Mesh& mesh, std::size_t samples) {
  const ClosestPointFinder finder(surface);
  double worst = 0;
  const std::size_t step = std::max<std::size_t>(1, mesh.triangles.size() / samples);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += step) {
    const auto& t = mesh.triangles[i];
    const Point3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    for (const Point3 p :
         {lerp(a, b, 0.5), lerp(b, c, 0.5), lerp(c, a, 0.5), lerp(lerp(a, b, 0.5), c, 1.0 / 3)})
      worst = std::max(worst, finder.find(p, 1e-7).distance);
  }
  return worst;
}

std::vector<NurbsSurface> shapes() {
  cases::Shape rational, plain;
  plain.weight_lo = plain.weight_hi = 1;
  plain.count_u = 9, plain.degree_v = 2;
  rational.weight_lo = 0.5, rational.weight_hi = 2, rational.count_v = 5, rational.degree_u = 4;
  return {cases::random_surface(3, plain),
          cases::random_surface(4, rational),
          cases::sphere(30),
          cases::cylinder(20, 80),
          cases::torus(40, 10),
          cases::cone(20, 30),
          cases::saddle(3)};
}

TEST(SecondBounds, HoldEverywhereAndAreNotFarOff) {
  for (const NurbsSurface& surface : shapes()) {
    for (const BezierPatch& patch : bezier_patches(surface)) {
      const auto b = detail::second_bounds(patch);
      detail::SecondBounds seen;
      for (int i = 0; i <= 12; ++i) {
        for (int j = 0; j <= 12; ++j) {
          const auto d = derivatives(patch.surface, patch.u.lo + patch.u.length() * i / 12,
                                     patch.v.lo + patch.v.length() * j / 12);
          const double slack = 1 + 1e-9;
          EXPECT_LE(norm(d.duu), b.uu * slack + 1e-9);
          EXPECT_LE(norm(d.duv), b.uv * slack + 1e-9);
          EXPECT_LE(norm(d.dvv), b.vv * slack + 1e-9);
          EXPECT_LE(norm(d.du), b.u * slack + 1e-9);
          EXPECT_LE(norm(d.dv), b.v * slack + 1e-9);
          seen.uu = std::max(seen.uu, norm(d.duu)), seen.vv = std::max(seen.vv, norm(d.dvv));
          seen.uv = std::max(seen.uv, norm(d.duv));
        }
      }
      // What counts is what they say of one cell.
      const auto deviation = [&patch](const detail::SecondBounds& m) {
        const double du = patch.u.length(), dv = patch.v.length();
        return du * du * m.uu + 2 * du * dv * m.uv + dv * dv * m.vv;
      };
      EXPECT_LT(deviation(b), 1.4 * deviation(seen) + 1e-9);
    }
  }
}

TEST(Tessellate, StaysWithinTheDeflectionItProves) {
  for (const NurbsSurface& surface : shapes()) {
    for (const double deflection : {0.5, 0.02}) {
      const auto t = tessellate(surface, false, {}, {deflection, 0, 2'000'000});
      ASSERT_TRUE(t.ok()) << t.error().to_string();
      EXPECT_LE(t->deflection_mm, deflection);
      EXPECT_LE(real_deviation(surface, t->mesh, 25), t->deflection_mm + 1e-7);
    }
  }
}

TEST(Tessellate, HasTheAreaAndTheSenseOfTheSphere) {
  const auto inward = tessellate(cases::sphere(30), false, {}, {0.01, 0, 2'000'000});
  const auto outward = tessellate(cases::sphere(30), true, {}, {0.01, 0, 2'000'000});
  ASSERT_TRUE(inward.ok() && outward.ok());
  EXPECT_NEAR(area(outward->mesh), 4 * kPi * 900, 4 * kPi * 900 * 2e-3);
  const auto volume = [](const Mesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles)
      sum += dot(mesh.vertices[t[0]] - Point3{},
                 cross(mesh.vertices[t[1]] - Point3{}, mesh.vertices[t[2]] - Point3{})) /
             6;
    return sum;
  };
  EXPECT_NEAR(volume(outward->mesh), 4.0 / 3 * kPi * 27000, 4.0 / 3 * kPi * 27000 * 2e-3);
  EXPECT_NEAR(volume(inward->mesh), -4.0 / 3 * kPi * 27000, 4.0 / 3 * kPi * 27000 * 2e-3);
}

/// Every inner edge has two triangles: no cracks.
TEST(Tessellate, NeighboursShareTheirEdges) {
  const auto t = tessellate(shapes()[0], false, {}, {0.05, 0, 2'000'000});
  ASSERT_TRUE(t.ok());
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& c : t->mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = c[k], b = c[(k + 1) % 3];
      ++edges[{std::min(a, b), std::max(a, b)}];
    }
  // The edges with one triangle are the four sides of the surface.
  const NurbsSurface surface = shapes()[0];
  double border = 0, sides = 0;
  for (const auto& [edge, count] : edges) {
    EXPECT_LE(count, 2);
    if (count == 1) border += distance(t->mesh.vertices[edge.first], t->mesh.vertices[edge.second]);
  }
  const Interval u = surface.domain(Direction::u), v = surface.domain(Direction::v);
  constexpr int kSteps = 20000;
  const auto at = [](const Interval& i, int k) { return i.lo + i.length() * k / kSteps; };
  for (int k = 0; k < kSteps; ++k) {
    for (const double end : {v.lo, v.hi})
      sides += distance(point(surface, at(u, k), end), point(surface, at(u, k + 1), end));
    for (const double end : {u.lo, u.hi})
      sides += distance(point(surface, end, at(v, k)), point(surface, end, at(v, k + 1)));
  }
  EXPECT_NEAR(border, sides, 1e-3 * sides);
}

TEST(Tessellate, GetsCoarserWhenThereWouldBeTooManyAndSaysHowMuch) {
  const NurbsSurface surface = shapes()[0];
  const auto t = tessellate(surface, false, {}, {1e-5, 0, 5000});
  ASSERT_TRUE(t.ok());
  EXPECT_LE(t->mesh.triangles.size(), 5000u);
  EXPECT_GT(t->mesh.triangles.size(), 2000u);
  EXPECT_GT(t->deflection_mm, 1e-5);
  EXPECT_LE(real_deviation(surface, t->mesh, 25), t->deflection_mm);
  const auto few = tessellate(surface, false, {}, {1e-5, 0, 10});
  ASSERT_FALSE(few.ok());
  EXPECT_EQ(few.error().code, ErrorCode::range);
  EXPECT_FALSE(tessellate(surface, false, {}, {0, 0, 5000}).ok());
}

TEST(Tessellate, FlatFacesNeedTwoTrianglesUnlessEdgesAreLimited) {
  NurbsSurface plane = cases::saddle(3);
  for (HPoint& h : plane.points) h.z = 0;
  const auto two = tessellate(plane, false, {}, {1e-6, 0, 100});
  ASSERT_TRUE(two.ok());
  EXPECT_EQ(two->mesh.triangles.size(), 2u);
  const auto more = tessellate(plane, false, {}, {1e-6, 0.1, 100'000});
  ASSERT_TRUE(more.ok());
  double longest = 0;
  for (const auto& t : more->mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, distance(more->mesh.vertices[t[k]], more->mesh.vertices[t[(k + 1) % 3]]));
  EXPECT_LE(longest, 0.1);
  EXPECT_GT(longest, 0.05);
}

}  // namespace
}  // namespace burin::geom
