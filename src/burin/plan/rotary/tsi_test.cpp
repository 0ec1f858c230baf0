// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "burin/geom/mesh/mesh_index.h"
#include "burin/plan/rotary/center_path.h"
#include "burin/plan/rotary/rotary_cases.h"

namespace burin::rotary {
namespace {

using geom::ArcSpline;
using geom::distance_to;
using geom::kPi;
using geom::Point2;
using geom::Point3;
using geom::Vec3;

constexpr double kTolerance = 0.01;

struct Bench {
  Bench(const SweptSection& s, double ball, Pattern pattern = Pattern::rings)
      : radius(ball), part(*make_swept(s, {})), index(part.mesh) {
    PatternOptions o;
    o.pattern = pattern;
    o.ball_radius = ball;
    Diagnostics diagnostics;
    paths = make_paths(part, o, diagnostics)->paths;
  }
  TsiResult resolve(const ContactPath& path, Tsi method = Tsi::surface) const {
    return resolve_tsi(path, index, {method, radius, kTolerance, part.deflection_mm});
  }
  const ContactPath& middle() const { return paths[paths.size() / 2]; }

  double radius;
  Part part;
  geom::MeshIndex index;
  std::vector<ContactPath> paths;
};

/// Points all over the surface between x0 and x1, straight from the section, in cells for looking near a
/// point.
class Samples {
 public:
  Samples(const SweptSection& s, double x0, double x1, double spacing) {
    const int nx = int(std::ceil((x1 - x0) / spacing));
    for (const geom::Segment& seg : s.section.segments) {
      const int n = int(std::ceil(length_of(seg) / spacing));
      for (int i = 0; i <= n; ++i) {
        const Point2 c = point_on(seg, double(i) / n);
        for (int k = 0; k <= nx; ++k) {
          const double x = x0 + (x1 - x0) * k / nx, a = s.turn_at(x);
          points_.push_back(
              {x, c.x * std::cos(a) - c.y * std::sin(a), c.x * std::sin(a) + c.y * std::cos(a)});
        }
      }
    }
    std::sort(points_.begin(), points_.end(), [](Point3 a, Point3 b) { return a.y < b.y; });
  }
  double nearest(Point3 c, double within) const {
    double least = within * within;
    const auto lower = [](Point3 p, double y) { return p.y < y; };
    auto it = std::lower_bound(points_.begin(), points_.end(), c.y - within, lower);
    for (; it != points_.end() && it->y <= c.y + within; ++it) {
      const Vec3 d = *it - c;
      if (std::abs(d.z) < within) least = std::min(least, dot(d, d));
    }
    return std::sqrt(least);
  }

 private:
  std::vector<Point3> points_;
};

/// For sections that are not twisted: the ball is a disc in the plane of the section.
void expect_disc_clear(const ArcSpline& section, const CenterPath& path, double radius) {
  const std::size_t n = path.places.size();
  double deepest = 0, farthest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point3 a = path.places[i].center, b = path.places[(i + 1) % n].center;
    for (const double f : {0.0, 0.25, 0.5, 0.75}) {
      const Point3 c = lerp(a, b, f);
      const Point2 q{c.y, c.z};
      EXPECT_EQ(winding_number(section, q), 0);
      deepest = std::max(deepest, radius - distance_to(section, q));
    }
    farthest = std::max(farthest, distance_to(section, {a.y, a.z}) - radius);
  }
  EXPECT_LE(deepest, 0.5 * kTolerance);
  EXPECT_LE(farthest, 0.5 * kTolerance) << "a place that does not touch";
}

void expect_places_consistent(const TsiResult& r, double radius) {
  std::size_t moved = 0;
  double excess = 0;
  for (const Place& p : r.path.places) {
    EXPECT_LT(distance(p.center, p.contact.p + radius * p.contact.n), 1e-9);
    EXPECT_NEAR(norm(p.contact.n), 1, 1e-9);
    moved += p.state == State::moved;
    excess = std::max(excess, p.excess_mm);
  }
  EXPECT_EQ(moved, r.moved);
  EXPECT_NEAR(excess, r.excess_max_mm, 1e-12);
}

double longest_step(const CenterPath& path) {
  double longest = 0;
  const std::size_t n = path.places.size();
  for (std::size_t i = 0; i + 1 < n + (path.closed ? 1 : 0); ++i) {
    longest = std::max(longest, distance(path.places[i].center, path.places[(i + 1) % n].center));
  }
  return longest;
}

double way_of(const CenterPath& path) {
  double way = 0;
  const std::size_t n = path.places.size();
  for (std::size_t i = 0; i + 1 < n + (path.closed ? 1 : 0); ++i) {
    way += distance(path.places[i].center, path.places[(i + 1) % n].center);
  }
  return way;
}

TEST(TsiSurface, WithoutHollowsNothingChanges) {
  for (const ArcSpline& s : {cases::circle(10), cases::ellipse(12, 7), cases::cam(12, 4, 6)}) {
    const Bench bench(cases::swept(s, 5, 0.4), 2);
    for (const ContactPath& path : bench.paths) {
      const TsiResult r = bench.resolve(path);
      EXPECT_EQ(r.interfering, 0u);
      EXPECT_EQ(r.moved, 0u);
      EXPECT_EQ(r.excess_max_mm, 0);
      EXPECT_GE(r.path.places.size(), path.points.size());
      EXPECT_TRUE(r.path.closed);
    }
  }
}

TEST(TsiSurface, InASharpCornerOnlyTheCornerRemains) {
  // A keyway 4 wide with a ball of 1.5: two corners at the bottom.
  const double r = 1.5;
  const Bench bench(cases::swept(cases::keyway(10, 4, 3), 6, 0), r);
  const TsiResult result = bench.resolve(bench.middle());
  expect_places_consistent(result, r);
  expect_disc_clear(bench.part.swept->section, result.path, r);
  EXPECT_GT(result.interfering, 0u);
  // What is left in a corner of a right angle, to the place of the mesh's and tolerance's size.
  EXPECT_NEAR(result.excess_max_mm, (std::sqrt(2.0) - 1) * r, kTolerance);
  // The way: round the shaft, about both edges, down and up, and along the bottom.
  const double h = std::sqrt(100.0 - 4), edge = std::asin(0.2), depth = h - 7 - r;
  const double turn = kPi / 2 + edge;  // from the circle's normal to the wall's
  const double expected = (2 * kPi - 2 * edge) * (10 + r) + 2 * r * turn + 2 * depth + (4 - 2 * r);
  // At either corner the ball may sink into the other wall by a quarter of the tolerance.
  EXPECT_NEAR(way_of(result.path), expected, 3 * kTolerance);
  EXPECT_LE(longest_step(result.path), 2 * std::sqrt(r * kTolerance));
}

TEST(TsiSurface, OverASlotThatIsTooNarrowTheBallRestsOnBothEdges) {
  const double r = 2.5;
  const Bench bench(cases::swept(cases::keyway(10, 4, 3), 6, 0), r);
  const TsiResult result = bench.resolve(bench.middle());
  expect_places_consistent(result, r);
  expect_disc_clear(bench.part.swept->section, result.path, r);
  const double center = std::sqrt(96.0) + std::sqrt(r * r - 4);
  EXPECT_NEAR(result.excess_max_mm, std::hypot(2, center - 7) - r, 2 * kTolerance);
  EXPECT_LE(longest_step(result.path), 2 * std::sqrt(r * kTolerance));
}

TEST(TsiSurface, RandomSectionsAreClearAndTouched) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE(round);
    const ArcSpline s = cases::random_star(random);
    if (!make_swept(cases::swept(s, 1, 0), {})) continue;
    const double r = 1 + 0.1 * double(random() % 20);
    const Bench bench(cases::swept(s, 3, 0), r);
    // Where a section is not as long as the ball is wide, its ends are no part of the disc's world: the
    // middle.
    const TsiResult result = bench.resolve(bench.middle());
    expect_places_consistent(result, r);
    expect_disc_clear(bench.part.swept->section, result.path, r);
    EXPECT_LE(longest_step(result.path), 2 * std::sqrt(r * kTolerance));
  }
}

TEST(TsiSurface, TwistedPartsAreClearAndTouched) {
  struct Case {
    const char* name;
    SweptSection swept;
    double radius;
  };
  for (const Case& c : {Case{"cutter", cases::swept(cases::cutter(8, 20, 13, 1.5), 20, 20 * kPi / 50), 2},
                        Case{"keyway", cases::swept(cases::keyway(10, 5, 3), 20, 2), 1.5},
                        Case{"narrow keyway", cases::swept(cases::keyway(10, 4, 3), 20, 2), 2.4},
                        Case{"steep cam", cases::swept(cases::cam(12, 4, 6), 20, 5), 2}}) {
    SCOPED_TRACE(c.name);
    const Bench bench(c.swept, c.radius);
    const double x = bench.middle().points.front().p.x;
    const double spacing = 0.06;
    const Samples samples(c.swept, std::max(0.0, x - 2 * c.radius), std::min(20.0, x + 2 * c.radius),
                          spacing);
    const TsiResult result = bench.resolve(bench.middle());
    expect_places_consistent(result, c.radius);
    double deepest = 0, farthest = 0;
    const std::size_t n = result.path.places.size();
    for (std::size_t i = 0; i < n; i += 7) {
      const Point3 a = result.path.places[i].center, b = result.path.places[(i + 1) % n].center;
      if (std::abs(a.x - x) > 1.9 * c.radius) continue;
      const double least = samples.nearest(a, c.radius + 1);
      deepest =
          std::max({deepest, c.radius - least, c.radius - samples.nearest(lerp(a, b, 0.5), c.radius + 1)});
      farthest = std::max(farthest, least - c.radius);
    }
    EXPECT_LE(deepest, 0.5 * kTolerance);
    // Samples lie half a diagonal off at most.
    EXPECT_LE(farthest, 0.5 * kTolerance + spacing * spacing / (2 * c.radius));
    EXPECT_LE(longest_step(result.path), 2 * std::sqrt(c.radius * kTolerance)) << c.name;
  }
}

TEST(TsiSurface, LinesInASlotRestOnItsEdges) {
  const double r = 2.5;
  const Bench bench(cases::swept(cases::keyway(10, 4, 3), 12, 0), r, Pattern::lines);
  const double center = std::sqrt(96.0) + std::sqrt(r * r - 4);
  std::size_t bottoms = 0;
  for (const ContactPath& path : bench.paths) {
    const TsiResult result = bench.resolve(path);
    expect_places_consistent(result, r);
    // On the bottom; right under an edge the ball may as well rest on top of that edge.
    if (std::abs(path.points.front().p.z - 7) > 1e-9 || std::abs(path.points.front().p.y) > 1.5) continue;
    ++bottoms;  // gouges from end to end
    EXPECT_EQ(result.interfering, path.points.size());
    ASSERT_GT(result.path.places.size(), 10u);
    EXPECT_FALSE(result.path.closed);
    for (const Place& p : result.path.places) EXPECT_NEAR(p.center.z, center, kTolerance);
    EXPECT_NEAR(way_of(result.path), 12, 0.05);
  }
  EXPECT_GT(bottoms, 0u);
}

TEST(TsiSurface, ThinnedPathsOfRandomSectionsKeepTheTolerance) {
  std::mt19937_64 random(5);
  std::size_t points = 0, halving = 0;
  for (int round = 0; round < 25; ++round) {
    SCOPED_TRACE(round);
    const ArcSpline s = cases::random_star(random);
    if (!make_swept(cases::swept(s, 1, 0), {})) continue;
    const double r = 1 + 0.1 * double(random() % 20);
    const Bench bench(cases::swept(s, 3, 0), r);
    const TsiResult resolved = bench.resolve(bench.middle());
    const SsiResult thinned = thin(resolved.path, r, kTolerance);
    points += thinned.points.size();
    halving += thinned.halving_points;
    EXPECT_LE(thinned.error_max_mm, kTolerance * (1 + 1e-9));
    const std::size_t n = thinned.points.size();
    double deepest = 0, excess = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Point3 a = thinned.points[i].center, b = thinned.points[(i + 1) % n].center;
      excess = std::max(excess, thinned.points[i].excess_mm);
      for (int k = 0; k < 16; ++k) {
        const Point3 c = lerp(a, b, k / 16.0);
        deepest = std::max(deepest, r - distance_to(s, {c.y, c.z}));
      }
    }
    // The half of the tolerance that a place may take, and that of the step.
    EXPECT_LE(deepest, 1.5 * kTolerance);
    EXPECT_NEAR(excess, resolved.excess_max_mm, 1e-12);
    // What is left of the section is within the tolerance or said.
    for (const geom::Segment& seg : s.segments) {
      for (int k = 0; k <= 40; ++k) {
        const Point2 q = point_on(seg, k / 40.0);
        double least = 1e9;
        for (std::size_t i = 0; i < n; ++i) {
          const Point3 a = thinned.points[i].center, b = thinned.points[(i + 1) % n].center;
          least = std::min(least, geom::nearest_on(geom::make_line({a.y, a.z}, {b.y, b.z}), q).distance);
        }
        EXPECT_LE(least - r, excess + 1.5 * kTolerance);
      }
    }
  }
  EXPECT_LT(points, halving);
}

/// A shaft with a groove all round, from profile points (x, r), closed at both ends.
geom::Mesh turned(const std::vector<Point2>& profile, int n) {
  geom::Mesh mesh;
  for (const Point2 p : profile) {
    for (int k = 0; k < n; ++k) {
      const double a = 2 * kPi * k / n;
      mesh.vertices.push_back({p.x, p.y * std::cos(a), p.y * std::sin(a)});
    }
  }
  const std::size_t rows = profile.size();
  const auto at = [n](std::size_t row, int k) {
    return std::uint32_t(row * std::size_t(n) + std::size_t(k % n));
  };
  for (std::size_t i = 0; i + 1 < rows; ++i) {
    for (int k = 0; k < n; ++k) {
      mesh.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k)});
      mesh.triangles.push_back({at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)});
    }
  }
  for (int k = 1; k + 1 < n; ++k) {
    mesh.triangles.push_back({at(0, 0), at(0, k + 1), at(0, k)});
    mesh.triangles.push_back({at(rows - 1, 0), at(rows - 1, k), at(rows - 1, k + 1)});
  }
  return mesh;
}

TEST(TsiSurface, AGrooveNarrowerThanTheBallIsBridgedAllRound) {
  const geom::MeshIndex index(turned({{0, 10}, {8, 10}, {8, 6}, {10, 6}, {10, 10}, {20, 10}}, 720));
  ContactPath path;
  path.closed = true;
  for (int k = 0; k < 300; ++k) {
    const double a = 2 * kPi * k / 300;
    path.points.push_back(
        {{9, 6 * std::cos(a), 6 * std::sin(a)}, {0, std::cos(a), std::sin(a)}, k / 300.0, 0.45});
  }
  const double r = 3;
  const TsiResult result = resolve_tsi(path, index, {Tsi::surface, r, kTolerance, 1e-4});
  EXPECT_EQ(result.interfering, 300u);
  EXPECT_TRUE(result.path.closed);
  expect_places_consistent(result, r);
  const double center = 10 + std::sqrt(r * r - 1);
  for (const Place& p : result.path.places) {
    EXPECT_NEAR(std::hypot(p.center.y, p.center.z), center, kTolerance);
    EXPECT_NEAR(p.center.x, 9, 0.05);
  }
  EXPECT_NEAR(way_of(result.path), 2 * kPi * center, 0.05);
  EXPECT_NEAR(result.excess_max_mm, center - 6 - r, kTolerance);
}

TEST(TsiPath, RemovesTheLoopsOfCorners) {
  const double r = 1.5;
  const Bench bench(cases::swept(cases::keyway(10, 4, 3), 6, 0), r);
  const TsiResult by_path = bench.resolve(bench.middle(), Tsi::path);
  const TsiResult by_surface = bench.resolve(bench.middle());
  EXPECT_GT(by_path.interfering, 0u);
  EXPECT_EQ(by_path.moved, 0u);
  // Without what lies off the plane both end up on the same way.
  EXPECT_NEAR(way_of(by_path.path), way_of(by_surface.path), 0.3);
  for (const Place& p : by_path.path.places) {
    EXPECT_GT(distance_to(bench.part.swept->section, {p.center.y, p.center.z}), r - 0.1);
  }
  // A path that crosses the seam in a loop: the same from another start.
  ContactPath turned_path = bench.middle();
  for (std::size_t shift = 0; shift < turned_path.points.size(); shift += turned_path.points.size() / 13) {
    ContactPath p = bench.middle();
    std::rotate(p.points.begin(), p.points.begin() + std::ptrdiff_t(shift), p.points.end());
    EXPECT_NEAR(double(bench.resolve(p, Tsi::path).interfering), double(by_path.interfering), 2);
  }
}

TEST(TsiPath, MissesWhatLiesOffThePlane) {
  // Where the twist is strong the ball meets the part beside the ring: seen by the surface, not by the path.
  const Bench bench(cases::swept(cases::cam(12, 4, 6), 20, 5), 2);
  EXPECT_EQ(bench.resolve(bench.middle(), Tsi::path).interfering, 0u);
  EXPECT_GT(bench.resolve(bench.middle(), Tsi::surface).interfering, 0u);
}

TEST(Tsi, NothingInNothingOut) {
  const Bench bench(cases::swept(cases::circle(10), 5, 0), 2);
  EXPECT_TRUE(bench.resolve({}).path.places.empty());
  EXPECT_TRUE(bench.resolve({}, Tsi::path).path.places.empty());
  ContactPath one;
  one.points.push_back(bench.middle().points.front());
  EXPECT_EQ(bench.resolve(one).path.places.size(), 1u);
  one.closed = true;
  EXPECT_EQ(bench.resolve(one).path.places.size(), 1u);
  EXPECT_EQ(bench.resolve(one, Tsi::path).path.places.size(), 1u);
}

}  // namespace
}  // namespace burin::rotary
