// SPDX-License-Identifier: Apache-2.0
// For tests only: shapes cut into patches, patches written in other ways, and the check that a composite is
// what its patches were.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/join.h"
#include "burin/geom/surface/modify.h"
#include "burin/geom/surface/random_surface.h"
#include "burin/geom/surface/rows.h"

namespace burin::geom::test {

constexpr double kExact = 1e-9;  ///< relative to the size, as promised
constexpr Grouping kRules[] = {Grouping::largest, Grouping::first_block, Grouping::u_first,
                               Grouping::v_first};

inline Composite joined(const std::vector<NurbsSurface>& patches, JoinOptions options = {}) {
  Diagnostics diagnostics;
  auto result = join(patches, options, diagnostics);
  EXPECT_TRUE(result.ok());
  return result ? std::move(*result) : Composite{};
}

inline bool inside(Interval t, double x) {
  const double slack = 1e-9 * t.length();
  return x >= t.lo - slack && x <= t.hi + slack;
}

/// Largest distance between the patches and the surfaces that their points went to, through the members. A
/// point that no member holds gives infinity.
inline double difference(const std::vector<NurbsSurface>& patches, const Composite& composite, Random& random,
                         int points = 40) {
  double most = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    for (int k = 0; k < points; ++k) {
      const double fu = k < 4 ? k % 2 : uniform(random, 0, 1), fv = k < 4 ? k / 2 : uniform(random, 0, 1);
      const double u = at_fraction(patches[i].domain(Direction::u), fu),
                   v = at_fraction(patches[i].domain(Direction::v), fv);
      double best = std::numeric_limits<double>::infinity();
      for (const JoinedSurface& s : composite.surfaces) {
        for (const Member& m : s.members) {
          if (m.patch != i) continue;
          const Point2 at = joined_parameters(m, {u, v});
          if (!inside(m.u, at.x) || !inside(m.v, at.y)) continue;
          const Point2 back = patch_parameters(m, at);
          EXPECT_NEAR(back.x, u, 1e-9 * (1 + std::abs(u)));
          EXPECT_NEAR(back.y, v, 1e-9 * (1 + std::abs(v)));
          best = std::min(best, distance(point(s.surface, at.x, at.y), point(patches[i], u, v)));
        }
      }
      most = std::max(most, best);
    }
  }
  return most;
}

/// What holds for every result.
inline void check(const Composite& composite) {
  std::size_t last = 0;
  for (const JoinedSurface& s : composite.surfaces) {
    ASSERT_TRUE(validate(s.surface)) << validate(s.surface).error().message;
    EXPECT_EQ(s.surface.domain(Direction::u).lo, 0);
    EXPECT_EQ(s.surface.domain(Direction::v).lo, 0);
    ASSERT_FALSE(s.members.empty());
    std::size_t first = s.members.front().patch;
    for (const Member& m : s.members) first = std::min(first, m.patch);
    EXPECT_GE(first, last);
    last = first;
    // The orientation is that of the first patch (of one of its parts, where it meets itself turned round).
    EXPECT_TRUE(std::any_of(s.members.begin(), s.members.end(), [&](const Member& m) {
      return m.patch == first && m.pu[1] > 0 && m.pu[2] == 0 && m.pv[2] > 0;
    }));
    double area = 0;
    for (const Member& m : s.members) area += m.u.length() * m.v.length();
    const double whole = s.surface.domain(Direction::u).length() * s.surface.domain(Direction::v).length();
    EXPECT_NEAR(area, whole, 1e-9 * whole);
  }
}

/// One composite for each rule of grouping, checked.
inline std::vector<Composite> by_every_rule(const std::vector<NurbsSurface>& patches) {
  std::vector<Composite> all;
  for (const Grouping rule : kRules) {
    all.push_back(joined(patches, {1e-4, 0.01, rule}));
    check(all.back());
  }
  return all;
}

/// The same shape in one of 8 orientations.
inline NurbsSurface turned(const NurbsSurface& s, int orientation) {
  NurbsSurface out = s;
  if (orientation & 1) out = reversed(out, Direction::u);
  if (orientation & 2) out = reversed(out, Direction::v);
  if (orientation & 4) out = swapped(out);
  return out;
}

/// The same shape in another form: domain, weights, degree, knots, orientation.
inline NurbsSurface disguised(Random& random, const NurbsSurface& s) {
  NurbsSurface out = with_weights_scaled(s, std::exp(uniform(random, -3, 3)));
  for (const Direction d : {Direction::u, Direction::v}) {
    out = *elevate_degree(out, d, integer(random, 0, 2));
    if (integer(random, 0, 1) == 1) {
      const std::vector<double> more{at_fraction(out.domain(d), uniform(random, 0.1, 0.9))};
      out = insert_knots(out, d, more);
    }
    const double lo = uniform(random, -3, 3);
    out = with_domain(out, d, {lo, lo + std::exp(uniform(random, -1, 1))});
  }
  return turned(out, integer(random, 0, 7));
}

template <class T>
void shuffle(Random& random, std::vector<T>& items) {
  for (std::size_t i = items.size(); i > 1; --i)
    std::swap(items[i - 1], items[static_cast<std::size_t>(integer(random, 0, static_cast<int>(i) - 1))]);
}

/// columns x rows parts along random parameter lines; u fastest.
inline std::vector<NurbsSurface> cut_into(Random& random, const NurbsSurface& s, int columns, int rows) {
  const auto lines = [&](Interval t, int n) {
    std::vector<double> at{t.lo};
    for (int k = 1; k < n; ++k) at.push_back(at_fraction(t, (k + uniform(random, -0.3, 0.3)) / n));
    at.push_back(t.hi);
    return at;
  };
  const std::vector<double> us = lines(s.domain(Direction::u), columns),
                            vs = lines(s.domain(Direction::v), rows);
  std::vector<NurbsSurface> out;
  for (std::size_t j = 0; j + 1 < vs.size(); ++j)
    for (std::size_t i = 0; i + 1 < us.size(); ++i)
      out.push_back(sub_surface(s, {us[i], us[i + 1]}, {vs[j], vs[j + 1]}));
  return out;
}

/// Bilinear, degree 1.
inline NurbsSurface quad(Point3 p00, Point3 p10, Point3 p01, Point3 p11) {
  return {1,
          1,
          2,
          2,
          {0, 0, 1, 1},
          {0, 0, 1, 1},
          {homogeneous(p00, 1), homogeneous(p10, 1), homogeneous(p01, 1), homogeneous(p11, 1)}};
}
inline NurbsSurface rectangle(double x0, double y0, double x1, double y1, double z = 0) {
  return quad({x0, y0, z}, {x1, y0, z}, {x0, y1, z}, {x1, y1, z});
}

/// The arc of the unit circle from angle a over b < pi: rational quadratic in the plane, standard weights.
struct Arc {
  Vec2 p[3];
  double w[3];
};
inline Arc arc(double a, double b) {
  const double h = std::cos(0.5 * b), m = a + 0.5 * b;
  return {
      {{std::cos(a), std::sin(a)}, {std::cos(m) / h, std::sin(m) / h}, {std::cos(a + b), std::sin(a + b)}},
      {1, h, 1}};
}

/// Part of a cylinder about z: u round, v up.
inline NurbsSurface cylinder(double r, double a, double b, double z0, double z1) {
  const Arc c = arc(a, b);
  NurbsSurface s{2, 1, 3, 2, {0, 0, 0, 1, 1, 1}, {0, 0, 1, 1}, {}};
  for (const double z : {z0, z1})
    for (int i = 0; i < 3; ++i) s.points.push_back(homogeneous({r * c.p[i].x, r * c.p[i].y, z}, c.w[i]));
  return s;
}

/// The profile arc (radius r about (c, z = 0), in the plane of axis and radius) turned about z: u along the
/// profile, v round. c = 0: sphere; c > r: torus.
inline NurbsSurface turned_arc(double c, double r, double a, double b, double round, double by) {
  const Arc p = arc(a, b), q = arc(round, by);
  NurbsSurface s{2, 2, 3, 3, {0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1, 1}, {}};
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      double radius = c + r * p.p[i].x;
      if (std::abs(radius) < 1e-12 * r) radius = 0;
      s.points.push_back(homogeneous({radius * q.p[j].x, radius * q.p[j].y, r * p.p[i].y}, p.w[i] * q.w[j]));
    }
  return s;
}

}  // namespace burin::geom::test
