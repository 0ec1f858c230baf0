// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "burin/geom/point_tools.h"
#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/surface_cases.h"

namespace burin::orient {
namespace {

using geom::NurbsSurface;
using geom::Point2;
using geom::Point3;
using geom::Vec3;
using Pieces = std::vector<std::vector<CcPoint>>;

Part part_of(NurbsSurface surface, bool reversed = false, std::vector<std::vector<Point2>> trims = {}) {
  Part part;
  part.faces.push_back({std::move(surface), reversed, std::move(trims), 1});
  return part;
}

/// [0, 1] x [0, 1] onto a x b in the plane z = 0; normal upwards.
NurbsSurface plate(double a, double b) {
  NurbsSurface s;
  s.degree_u = s.degree_v = 1;
  s.count_u = s.count_v = 2;
  s.knots_u = s.knots_v = {0, 0, 1, 1};
  for (const double y : {0.0, b})
    for (const double x : {0.0, a}) s.points.push_back(geom::homogeneous({x, y, 0}, 1));
  return s;
}

std::vector<Point2> circle(Point2 middle, double radius, bool clockwise) {
  std::vector<Point2> loop;
  for (int i = 0; i < 200; ++i) {
    const double a = 2 * geom::kPi * i / 200 * (clockwise ? -1 : 1);
    loop.push_back({middle.x + radius * std::cos(a), middle.y + radius * std::sin(a)});
  }
  return loop;
}

PathFamily family_of(const Part& part, const PathOptions& options) {
  auto family = PathFamily::make(part, 0, options);
  EXPECT_TRUE(family.ok()) << (family.ok() ? "" : family.error().message);
  return std::move(*family);
}

void expect_sound(const Pieces& pieces, const PathOptions& o) {
  for (const auto& piece : pieces) {
    ASSERT_GE(piece.size(), 2U);
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const CcPoint& p = piece[i];
      ASSERT_NEAR(norm(p.n), 1, 1e-12);
      ASSERT_NEAR(norm(p.f), 1, 1e-12);
      ASSERT_NEAR(dot(p.n, p.f), 0, 1e-9);
      ASSERT_TRUE(std::isfinite(p.k_ff + p.k_ft + p.k_tt));
      if (i == 0) continue;
      ASSERT_GT(dot(p.c - piece[i - 1].c, p.f + piece[i - 1].f), 0) << i;
      ASSERT_LE(std::acos(std::min(1.0, dot(p.n, piece[i - 1].n))), o.max_turn * 1.0001);
      if (o.max_step_mm > 0) {
        ASSERT_LE(distance(p.c, piece[i - 1].c), o.max_step_mm * 1.0001);
      }
    }
  }
}

TEST(Paths, LatitudesOfASphere) {
  constexpr double kRadius = 50;
  PathOptions o;
  o.pattern = Pattern::iso_v;  // v goes round
  // Su x Sv points inwards: a tool inside sees a concave sphere, one outside a convex one.
  for (const bool outside : {false, true}) {
    const Part part = part_of(geom::cases::sphere(kRadius), outside);
    const PathFamily family = family_of(part, o);
    const double sign = outside ? -1 : 1;
    for (const double w : {0.02, 0.3, 0.5, 0.97}) {
      const Pieces pieces = family.at(w);
      ASSERT_EQ(pieces.size(), 1U);
      expect_sound(pieces, o);
      const double z = pieces[0][0].c.z, round = std::sqrt(kRadius * kRadius - z * z);
      for (std::size_t i = 0; i < pieces[0].size(); ++i) {
        const CcPoint& p = pieces[0][i];
        const Vec3 out = (p.c - Point3{}) / kRadius;
        EXPECT_NEAR(norm(out), 1, 1e-12);
        EXPECT_NEAR(norm(p.n + sign * out), 0, 1e-9);
        EXPECT_NEAR(p.k_ff, sign / kRadius, 1e-9);
        EXPECT_NEAR(p.k_tt, sign / kRadius, 1e-9);
        EXPECT_NEAR(p.k_ft, 0, 1e-9);
        if (i == 0) continue;
        const double half = 0.5 * distance(p.c, pieces[0][i - 1].c);
        EXPECT_LE(round - std::sqrt(round * round - half * half), o.chord_mm);
      }
      // Not many more points than the chord or the turn ask for.
      const double step = std::min(2 * std::acos(1 - o.chord_mm / round), o.max_turn * kRadius / round);
      EXPECT_LE(static_cast<double>(pieces[0].size()), 1.3 * 2 * geom::kPi / step + 9) << w;
      // Along meridians to another latitude.
      for (const double to : {w - 0.01, w + 0.02, 0.5}) {
        const Pieces other = family.at(to);
        if (other.empty()) continue;
        const double angle = std::abs(std::asin(other[0][0].c.z / kRadius) - std::asin(z / kRadius));
        EXPECT_NEAR(family.distance(pieces[0][3], w, to), kRadius * angle, 1e-6) << w << " " << to;
      }
    }
    // From pole to pole.
    EXPECT_NEAR(family.extent(), kRadius * geom::kPi, 0.01);
    expect_sound(family.at(0.001), o);
  }
}

TEST(Paths, MeridiansEndAtThePolesWithNormals) {
  const Part part = part_of(geom::cases::sphere(50), true);
  const PathOptions o;
  const Pieces pieces = family_of(part, o).at(0.3);
  ASSERT_EQ(pieces.size(), 1U);
  expect_sound(pieces, o);
  EXPECT_NEAR(pieces[0].front().c.z, -50, 1e-9);
  EXPECT_NEAR(pieces[0].front().n.z, -1, 1e-9);
  EXPECT_NEAR(pieces[0].back().n.z, 1, 1e-9);
  EXPECT_NEAR(pieces[0].back().k_tt, -0.02, 1e-4);
}

TEST(Paths, AConesApexHasANormalOnEachLine) {
  const Part part = part_of(geom::cases::cone(20, 30), true);
  const PathOptions o;
  const PathFamily family = family_of(part, o);
  for (const double w : {0.1, 0.4, 0.8}) {
    const Pieces pieces = family.at(w);
    ASSERT_EQ(pieces.size(), 1U);
    expect_sound(pieces, o);
    EXPECT_NEAR(norm(pieces[0].front().n - pieces[0].back().n), 0, 1e-6);
  }
}

TEST(Paths, StayInsideTrimsAndAwayFromBorders) {
  const std::vector<std::vector<Point2>> trims{circle({0.5, 0.5}, 0.4, false), circle({0.6, 0.5}, 0.1, true)};
  const Part part = part_of(plate(100, 100), false, trims);
  for (const Pattern pattern : {Pattern::iso_u, Pattern::iso_v, Pattern::plane}) {
    for (const double edge : {0.0, 2.0}) {
      PathOptions o;
      o.pattern = pattern, o.edge_mm = edge, o.max_step_mm = 3;
      const PathFamily family = family_of(part, o);
      std::size_t most = 0;
      for (int i = 1; i < 40; ++i) {
        const Pieces pieces = family.at(i / 40.0);
        expect_sound(pieces, o);
        most = std::max(most, pieces.size());
        double length = 0, across = -1;
        for (const auto& piece : pieces) {
          for (const CcPoint& p : piece) {
            const double outer = std::hypot(p.c.x - 50, p.c.y - 50),
                         hole = std::hypot(p.c.x - 60, p.c.y - 50);
            EXPECT_LE(outer, 40 - edge + 0.02);
            EXPECT_GE(hole, 10 + edge - 0.02);
          }
          length += distance(piece.front().c, piece.back().c);
          across = pattern == Pattern::iso_u ? piece[0].c.y : piece[0].c.x;
        }
        ASSERT_GE(across, 0) << i << static_cast<int>(pattern) << edge;
        // The chord of the disc less that of the hole.
        const auto chord = [](double r, double h) { return r > h ? 2 * std::sqrt(r * r - h * h) : 0.0; };
        const double hole_at = pattern == Pattern::iso_u ? 50 : 60;
        const double expected =
            chord(40 - edge, std::abs(across - 50)) - chord(10 + edge, std::abs(across - hole_at));
        EXPECT_NEAR(length, expected, edge > 0 ? 1.0 : 0.05) << i << " " << static_cast<int>(pattern);
      }
      EXPECT_EQ(most, 2U);
    }
  }
}

/// Every place where a dense net of lines passes through the plane lies on the path.
void expect_complete(const NurbsSurface& s, Vec3 up, const Pieces& pieces, double reach) {
  ASSERT_FALSE(pieces.empty());
  const double level = dot(pieces[0][0].c - Point3{}, up);
  for (const auto& piece : pieces)
    for (const CcPoint& p : piece) EXPECT_NEAR(dot(p.c - Point3{}, up), level, 1e-7);
  const auto u = s.domain(geom::Direction::u), v = s.domain(geom::Direction::v);
  constexpr int kLines = 37, kSteps = 400;
  for (int line = 0; line < 2 * kLines; ++line) {
    const double across = (line / 2 + 0.5) / kLines;
    Point3 before;
    for (int k = 0; k <= kSteps; ++k) {
      const double along = double(k) / kSteps;
      const double a = line % 2 == 0 ? across : along, b = line % 2 == 0 ? along : across;
      const Point3 p = geom::point(s, u.lo + a * u.length(), v.lo + b * v.length());
      const double f = dot(before - Point3{}, up) - level, g = dot(p - Point3{}, up) - level;
      if (k > 0 && (f < 0) != (g < 0)) {
        const Point3 q = lerp(before, p, f / (f - g));
        double nearest = 1e300;
        for (const auto& piece : pieces)
          for (std::size_t i = 1; i < piece.size(); ++i)
            nearest = std::min(nearest, geom::distance_to_segment(q, piece[i - 1].c, piece[i].c));
        EXPECT_LE(nearest, reach) << line << " " << k;
      }
      before = p;
    }
  }
}

TEST(Paths, PlaneCutsOfWavyFacesAreComplete) {
  geom::cases::Random random(3);
  PathOptions o;
  o.pattern = Pattern::plane;
  for (unsigned seed = 0; seed < 8; ++seed) {
    geom::cases::Shape shape;
    shape.height = 30;
    const NurbsSurface s = geom::cases::random_surface(seed, shape);
    // Steep cuts and level ones: loops, saddles, several pieces.
    o.plane_normal =
        seed % 2 == 0 ? Vec3{random.between(-1, 1), random.between(-1, 1), 0.1} : Vec3{0.1, 0.05, 1};
    const Part part = part_of(s, seed % 3 == 0);
    const PathFamily family = family_of(part, o);
    for (const double w : {0.1, 0.35, 0.5, 0.8}) {
      const Pieces pieces = family.at(w);
      expect_sound(pieces, o);
      expect_complete(s, geom::unit(o.plane_normal), pieces, 0.05);
      for (const auto& piece : pieces)
        for (const CcPoint& p : piece) EXPECT_GE(dot(p.t(), o.plane_normal), -1e-9);
    }
  }
}

TEST(Paths, PlaneCutsGoRoundSeams) {
  PathOptions o;
  o.pattern = Pattern::plane;
  o.plane_normal = {0.3, 0.2, 1};
  for (const bool torus : {false, true}) {
    const Part part = part_of(torus ? geom::cases::torus(40, 10) : geom::cases::sphere(50), true);
    const PathFamily family = family_of(part, o);
    for (int i = 1; i < 20; ++i) {
      const Pieces pieces = family.at(i / 20.0);
      expect_sound(pieces, o);
      EXPECT_GE(pieces.size(), 1U);
      EXPECT_LE(pieces.size(), 2U);
      for (const auto& piece : pieces) EXPECT_LT(distance(piece.front().c, piece.back().c), 1e-6) << i;
      const double here = dot(pieces[0][0].c - Point3{}, geom::unit(o.plane_normal));
      if (!torus) {
        const Pieces next = family.at(i / 20.0 + 0.01);
        const double there = dot(next[0][0].c - Point3{}, geom::unit(o.plane_normal));
        EXPECT_NEAR(family.distance(pieces[0][2], i / 20.0, i / 20.0 + 0.01),
                    50 * (std::asin(there / 50) - std::asin(here / 50)), 1e-5);
      }
    }
  }
}

TEST(Paths, ErrorsSayWhatIsWrong) {
  const Part part = part_of(plate(10, 10));
  PathOptions o;
  EXPECT_FALSE(PathFamily::make(part, 1, o).ok());
  o.edge_mm = 6;
  EXPECT_FALSE(PathFamily::make(part, 0, o).ok());
  o.edge_mm = 0, o.pattern = Pattern::plane, o.plane_normal = {0, 0, 1};
  const auto flat = PathFamily::make(part, 0, o);
  ASSERT_FALSE(flat.ok());
  EXPECT_EQ(flat.error().code, ErrorCode::geometry);
  const auto outside = PathFamily::make(part_of(plate(10, 10), false, {{{2, 2}, {3, 2}, {3, 3}}}), 0, {});
  EXPECT_FALSE(outside.ok());
}

TEST(Contacts, AreReadAndMadeUnit) {
  const auto read = read_contacts(
      "path,x,y,z,nx,ny,nz,fx,fy,fz\r\n# comment\r\n0,1,2,3,0,0,2,3,0,1\r\n\r\n0,2,2,3,0,0,1,1,0,0\n"
      "4,5,6,7,1e200,0,0,0,1e-3,0",
      "a.csv");
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ((*read)[0].points.size(), 2U);
  EXPECT_EQ((*read)[1].number, 4);
  EXPECT_EQ((*read)[0].points[0].c, (Point3{1, 2, 3}));
  EXPECT_EQ((*read)[0].points[0].n, (Vec3{0, 0, 1}));
  EXPECT_EQ((*read)[0].points[0].f, (Vec3{1, 0, 0}));
  EXPECT_EQ((*read)[1].points[0].n, (Vec3{1, 0, 0}));
  // Other columns and another order, as `--points` writes them.
  const auto more = read_contacts("fx,fy,fz,nx,ny,nz,state,x,y,z,path\n1,0,0,0,0,1,ok,7,8,9,2\n", "b.csv");
  ASSERT_TRUE(more.ok()) << more.error().message;
  EXPECT_EQ((*more)[0].points[0].c, (Point3{7, 8, 9}));
}

TEST(Contacts, ErrorsNameTheLine) {
  const std::string header = "path,x,y,z,nx,ny,nz,fx,fy,fz\n";
  const auto expect = [&](const std::string& text, ErrorCode code, int line) {
    const auto read = read_contacts(text, "c.csv");
    ASSERT_FALSE(read.ok()) << text;
    EXPECT_EQ(read.error().code, code) << text;
    EXPECT_EQ(read.error().where.line, line) << text;
    EXPECT_EQ(read.error().where.file, "c.csv");
  };
  expect("", ErrorCode::syntax, 0);
  expect(header, ErrorCode::geometry, 1);
  expect("path,x,y,z,nx,ny,nz,fx,fy\n", ErrorCode::syntax, 1);
  expect("path,x,y,z,nx,ny,nz,fx,fy,fz,x\n", ErrorCode::syntax, 1);
  expect(header + "0,1,2,3,0,0,1,1,0\n", ErrorCode::syntax, 2);
  expect(header + "0,1,2,3,0,0,1,1,0,nan\n", ErrorCode::syntax, 2);
  expect(header + "a,1,2,3,0,0,1,1,0,0\n", ErrorCode::syntax, 2);
  expect(header + "0,1,2,3,0,0,0,1,0,0\n", ErrorCode::geometry, 2);
  expect(header + "0,1,2,3,0,0,1,0,0,0\n", ErrorCode::geometry, 2);
  expect(header + "0,1,2,3,0,0,1,0,0,1\n", ErrorCode::geometry, 2);
  expect(header + "1,1,2,3,0,0,1,1,0,0\n0,1,2,3,0,0,1,1,0,0\n", ErrorCode::syntax, 3);
}

}  // namespace
}  // namespace burin::orient
